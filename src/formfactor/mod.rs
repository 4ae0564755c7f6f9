//! Form factors in closed form where nothing stands between, and what form factors have to obey: reciprocity, tested
//! in units of its own errors.

pub mod catalogue;
mod contour;
mod defect;
mod edge;
mod far;
mod gauss;
mod lambert;
mod polygons;
mod thin;

pub use defect::{Groups, Reciprocity, reciprocity};
pub use lambert::point_to_polygon;
pub use polygons::polygon_to_polygon;
