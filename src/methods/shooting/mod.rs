//! Shooting: progressive refinement, and redistribution of energy already shot when the scene changes.
//!
//! Patches shoot, elements receive. All bookkeeping is in power (W per band), not in radiosity: the power `P` that
//! has arrived at each element, and the power `Q` that each patch has shot, kept apart by the *version* of the
//! geometry it was shot in. Radiosities follow:
//!
//! ```text
//! B = E + rho P / A        unshot = A E + rho P - Q        P = sum over versions of F_v^T Q_v
//! ```
//!
//! The last equation holds after every step. An edit makes a new version; to redistribute a patch is to move its
//! `Q` from an old version to the newest, which adds `(F_new - F_old)^T Q` to `P`: the term of [GSG90 eq. 5], for any
//! number of changes at once. What it adds is unshot, and is propagated like any other: [GSG90 eq. 6]. When nothing
//! is left in old versions and nothing is unshot, B solves the radiosity equation of the new scene exactly, whatever
//! happened before. A change of reflectance or emission takes no redistribution: P stays, B and what is unshot
//! follow.
//!
//! Form factors are by rays (default) or by hemi-cube at the shooter. A patch's rays depend on the seed and the
//! patch alone; those that meet neither the old nor the new place of what has changed are not traced again.

mod cast;
mod change;
mod counter;
mod edit;
mod energy;
mod error;
mod fan;
mod field;
mod geometry;
mod importance;
mod params;
mod preview;
mod read;
mod row;
mod run;
mod saved;
mod schedule;
mod shadow;
mod shots;
mod solver;
mod version;

pub use energy::Energy;
pub use error::ShootingError;
pub use params::{Factors, Params, Ranking, Stop, Strategy};
pub use run::{Budget, End, Event, Step};
pub use saved::{Fingerprint, Saved};
pub use solver::{Costs, Shooting};
pub use version::LogEntry;
