//! Pictures of solutions: who sees which patch, tone, colour maps, rasters.
//!
//! One [`View`] is one visibility pass of one camera; any number of pictures is painted from it.

mod colormap;
mod exposure;
mod field;
mod fit;
mod items;
mod junctions;
mod mesh;
mod paint;
mod paint_world;
mod scale;
mod shade;
mod shares;
mod sheet;
mod smooth;
#[cfg(test)]
pub(crate) mod testing;
mod text;
mod tonemap;
mod unfolded;
mod vertices;
mod visibility;
mod weld;
mod world;

pub use colormap::{ColourMap, LinearRgb, to_byte, to_srgb8};
pub use exposure::{DisplayColour, Exposure};
pub use field::{Field, difference, in_standard_errors, luminance, luminance_std_err, relative_difference};
pub use fit::{fit_camera, resized};
pub use items::{item_colour, paint_items};
pub use mesh::{Mesh, Vertex};
pub use paint::{Raster, paint, paint_cells, paint_field, paint_smooth};
pub use paint_world::{paint_radiances, paint_world};
pub use scale::{Scale, Tick, area_percentile};
pub use shade::Shade;
pub use shares::{Seen, picture_levels};
pub use sheet::{Bar, Sheet, side_by_side};
pub use smooth::vertex_colours;
pub use tonemap::{Clipped, ToneMap};
pub use unfolded::{Outline, Shown, Silhouette, UnfoldedFace, UnfoldedHemicube, Wrong};
pub use vertices::Stencils;
pub use visibility::{SUPERSAMPLING, View, Visibility, views};
pub use world::{Centre, WorldView, distance};
