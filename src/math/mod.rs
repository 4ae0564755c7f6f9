//! Double-precision vectors, frames, convex polygons and compensated sums. Knows nobody.

mod boxes;
mod frame;
mod polygon;
mod polytope;
mod quad;
mod sum;

pub use boxes::{Bounds, BoxTree};
pub use frame::Frame;
pub use glam::{DMat3, DVec2, DVec3};
pub use polygon::{
    area, area_vector, centroid, clip_to_half_space, convex_defect, diameter, intersect_convex, plane_defect,
    subtract_convex, unit_normal,
};
pub use polytope::{Plane, Polytope, PolytopeEdge};
pub use quad::{Bilinear, triangle_cell, triangle_cell_corners};
pub use sum::{Compensated, compensated_sum};
