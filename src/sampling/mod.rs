//! Index-addressed random streams, scrambled low-discrepancy nets, and maps onto hemispheres and polygons.
//!
//! Nothing here remembers anything: a sample is a function of its address alone, so the number of threads
//! cannot matter.

mod maps;
mod net;
mod sobol;
mod stream;

pub use maps::{PointMap, concentric_disk, cosine_hemisphere, fold};
pub use net::Net;
pub use sobol::{owen_scrambled, sobol};
pub use stream::{Role, Stream};
