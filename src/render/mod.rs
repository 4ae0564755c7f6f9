//! Pictures of solutions: who sees which patch, tone, colour maps, rasters.
//!
//! One [`View`] is one visibility pass of one camera; any number of pictures is painted from it.

mod colormap;
mod exposure;
mod field;
mod fit;
mod paint;
mod scale;
#[cfg(test)]
pub(crate) mod testing;
mod visibility;

pub use colormap::{ColourMap, LinearRgb, to_srgb8};
pub use exposure::{DisplayColour, Exposure};
pub use field::{Field, difference, in_standard_errors, luminance, luminance_std_err, relative_difference};
pub use fit::fit_camera;
pub use paint::{Raster, paint};
pub use scale::{Scale, Tick, area_percentile};
pub use visibility::{SUPERSAMPLING, View, Visibility, views};
