//! Form factors in closed form where nothing stands between, and what form factors have to obey: reciprocity and
//! closure, tested in units of their own errors and enforced by weighted least squares.

pub mod catalogue;
mod closure;
mod contour;
mod defect;
mod edge;
mod enforce;
mod exchanges;
mod far;
mod gauss;
mod impossible;
mod lambert;
mod leftover;
mod mistake;
mod moves;
mod multipliers;
mod obstructed;
mod opening;
mod polygons;
mod residue;
mod surroundings;
#[cfg(test)]
mod testing;
mod thin;

pub use closure::{PairDefect, Physics, RowDefect, Rule, Tested, examine};
pub use defect::{Groups, Reciprocity, reciprocity};
pub use enforce::{Enforced, Enforcement, ErrorsAfter, UnmetRow, Weights, enforce};
pub use exchanges::attach_errors;
pub use impossible::{Impossible, Reason};
pub use lambert::point_to_polygon;
pub use mistake::{Layout, Mistake, undo};
pub use moves::{Move, Moves};
pub use obstructed::{Effort, Eye, Hidden, Obstacle, PointView, Screen, facing, hidden_exchange};
pub use polygons::polygon_to_polygon;
pub use residue::{Residue, residue};
pub use surroundings::{NoExchange, Surroundings};
