//! What form factors have to obey: reciprocity and closure, tested in units of their own errors.

mod defect;

pub use defect::{Groups, Reciprocity, reciprocity};
