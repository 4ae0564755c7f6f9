//! Environment maps taken apart: what one world projection says of the light at an object, against what rays from the
//! object itself say, and why the two differ, after Greene (1986).
//!
//! Everything is in mean radiosity B of what is gathered: over a cosine-weighted hemisphere that is the irradiance; of a
//! cone, pi times its mean radiance.

mod error;
mod gather;
mod hybrid;
mod points;

pub use error::{Weighted, relative_error, weighted_share};
pub use gather::{Lobe, Station, gather, mean_in};
pub use hybrid::{Add, gather_near, mean_near};
pub use points::{Point, over, within_reach};
