//! Radiosities, form factors and replicates: data only.

mod form_factors;
mod radiosity;

pub use form_factors::FormFactors;
pub use radiosity::{Radiosity, Replicates};
