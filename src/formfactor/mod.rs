//! Form factors in closed form where nothing stands between, and what form factors have to obey: reciprocity and
//! closure, tested in units of their own errors and enforced by weighted least squares.

mod contour;
mod defect;
mod edge;
mod enforce;
mod exchanges;
mod far;
mod gauss;
mod lambert;
mod leftover;
mod moves;
mod multipliers;
mod opening;
mod polygons;
mod residue;
mod surroundings;
mod thin;

pub use defect::{Groups, Reciprocity, reciprocity};
pub use enforce::{Enforced, Enforcement, ErrorsAfter, UnmetRow, Weights, enforce};
pub use lambert::point_to_polygon;
pub use moves::{Move, Moves};
pub use polygons::polygon_to_polygon;
pub use residue::{Residue, residue};
pub use surroundings::{NoExchange, Surroundings};
