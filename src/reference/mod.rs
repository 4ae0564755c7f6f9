//! The judge: reference radiosities with standard errors, and the check of the judge itself.

mod continuous;
mod error;
mod pair_check;
mod patch_system;
mod self_check;
mod transport;

pub use continuous::{ContinuousReference, compute_continuous};
pub use error::ReferenceError;
pub use pair_check::check_pairs;
pub use patch_system::{Kept, Options, Progress, Reference, check_size, compute, compute_on};
pub use self_check::{Evidence, test_reciprocity};
