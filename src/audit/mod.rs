//! Audit of hemi-cube form factors: which pairs are wrong, by how much and why, what it does to radiosities, what would
//! mend it; and what can be told of a matrix that somebody else's hemi-cube made.

mod beats;
mod causes;
mod cures;
mod effect;
pub mod fingerprint;
mod rank;
mod seen;

pub use beats::Beat;
pub use causes::{Cause, Pair, Split, Truth};
pub use cures::{Cure, Cured, POINTS, cured, resolution_by_pixels, spatial_errors, subdivision_distance};
pub use effect::Effect;
pub use fingerprint::{Fingerprint, fingerprint};
pub use rank::{FirstBounce, Source, first_bounce};
pub use seen::{Seen, View, seen, views};
