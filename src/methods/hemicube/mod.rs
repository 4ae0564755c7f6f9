//! The hemi-cube and the full-matrix radiosity solution of Cohen and Greenberg 1985.
//!
//! An imaginary half cube stands on the centre of each patch; the environment is projected onto its five faces
//! through depth and item buffers; the delta form factors of the pixels that show patch j add up to F_ij. The
//! patch system is then solved by Gauss-Seidel.
//!
//! What it leaves out is what the reference measures: one point stands for the patch (proximity, visibility), one
//! point for the pixel (aliasing), and the table of 1985 sums to a little more than one.

mod by_rays;
mod delta;
mod error;
mod item_buffer;
mod params;
mod project;
mod raster;
mod row;
mod solve;
mod stand;
mod world;

pub use by_rays::{Disagreement, by_rays, compare, compare_closely};
pub use delta::{DeltaTable, Pixel, delta_side, delta_top};
pub use error::HemicubeError;
pub use item_buffer::{ItemBuffer, item_buffer, item_buffer_at};
pub use params::{Delta, Params};
pub use project::{FACES, Face};
pub use raster::Item;
pub use row::{Counted, Hemicube, Lost};
pub use solve::{element_form_factors, form_factors, rows_of, solve, solve_with};
pub use stand::{Stand, divided, drawn, stand, stands};
pub use world::{World, centre};
