//! The audit of environment maps: world projections from centres in an object against rays from its surface, after Greene (1986).

mod bench;
mod filters;
mod findings;
mod irradiance;
mod pictures;
mod range;
mod record;
mod reflection;
mod request;
mod run;
mod sizes;

pub use pictures::{By, Picture};
pub use record::{At, AtReach, AtSize, EnvmapRecord, FilterRow, Parts, PointRow, Range, RoundTripRow, Speed};
pub use request::{EnvmapError, EnvmapRequest, Light, REPLICATES};
pub use run::{Audited, envmap, object};
