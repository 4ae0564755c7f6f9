//! Audits. Of environment maps: [`envmap`]. Of hemi-cube form factors: which pairs are wrong, by how much and why, what
//! it does to radiosities, what would mend it; and what can be told of a matrix that somebody else's hemi-cube made.

mod beats;
mod causes;
mod cures;
mod effect;
pub mod envmap;
pub mod fingerprint;
pub mod picture;
mod rank;
mod seen;
mod split;
mod unfolded;

pub use beats::Beat;
pub use causes::{Cause, Pair};
pub use cures::{Cure, Cured, POINTS, cured, resolution_by_pixels, subdivision_distance};
pub use effect::{Effect, radiosity};
pub use fingerprint::{Fingerprint, fingerprint};
pub use rank::{FirstBounce, Source, first_bounce, source_error};
pub use seen::{Seen, View, seen, views};
pub use split::{Split, Truth, from_shooters};
pub use unfolded::{Unfolded, unfold};
