//! Radiosities, form factors, replicates and provenance: data only.

mod form_factors;
mod provenance;
mod radiosity;

pub use form_factors::FormFactors;
pub use provenance::{Check, Provenance, SelfCheck, TruthLevel};
pub use radiosity::{Radiosity, Replicates};
