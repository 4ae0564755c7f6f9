//! World projections: what is seen from one point in all directions, laid out on planes, filtered and looked up, after Greene (1986).
//!
//! Knows directions and values only; what is projected, and how right it is, others know.

mod above;
mod blur;
mod box_filter;
mod cone;
mod convert;
mod diffuse;
mod ewa;
mod exact;
#[cfg(test)]
mod filter_tests;
mod footprint;
mod harmonics;
mod irradiance;
mod layout;
mod map;
mod pyramid;
mod ramp;
mod sky;
mod unfold;
mod weights;

pub use blur::{swept, swept_exactly};
pub use cone::{Cone, SHARPNESS};
pub use convert::{RoundTrip, exact_picture, mean, picture, resample, round_trip};
pub use diffuse::{DIFFUSE_SIZE, DiffuseMap};
pub use exact::{exact, exact_into, for_each_weight};
pub use footprint::outline;
pub use harmonics::{HARMONICS, Harmonics};
pub use irradiance::irradiance_exact;
pub use layout::{Face, Layout, Shape, Spot};
pub use map::WorldMap;
pub use pyramid::Pyramid;
pub use ramp::Ramp;
pub use sky::{half_cube, over, rotated};
pub use unfold::{Unfolded, unfolded};
