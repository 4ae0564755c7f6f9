//! Radiosities, form factors, replicates and provenance: data only.

mod bounds;
mod form_factors;
mod mesh_values;
mod provenance;
mod radiosity;
mod series;

pub use bounds::FormFactorBounds;
pub use form_factors::FormFactors;
pub use mesh_values::{MeshValues, ValuesPer};
pub use provenance::{Check, Provenance, SelfCheck, TruthLevel};
pub use radiosity::{Radiosity, Replicates};
pub use series::{Series, Snapshot};
