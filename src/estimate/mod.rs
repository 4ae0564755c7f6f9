//! Form factors: pairs settled exactly, and rays for the rest: who emits, how many rays, the hit counts that come
//! of it.

mod aim;
mod blend;
mod bounds;
mod checkpoint;
mod closed;
mod counts;
mod direct;
mod emitter;
mod packed;
mod pairs;
mod paths;
mod plan;
mod points;
mod receivers;
mod replicate;
mod rows;
mod settle;
mod shadow;

pub use aim::{BATCH, fill, turned_frame};
pub use blend::Blend;
pub use checkpoint::{Block, Checkpoint, FinishedRow, NoCheckpoint};
pub use closed::is_closed;
pub use counts::{Entry, HitCounts};
pub use direct::{DirectLight, Lit, direct_light, lit_elements, lit_patches};
pub use emitter::{Emitter, element_emitters, patch_emitters};
pub use pairs::{Coverage, Left, PairFactors, PairPlan, PairTally, pair_form_factors};
pub use paths::{Gathering, PathGatherer, PathSums};
pub use plan::{Estimator, Plan, Reached};
pub use points::{PointSight, Sight, open_factor, open_mean};
pub use receivers::irradiance;
pub use rows::{Casting, cast, cast_on, row_batches, sample_batches};
pub use settle::settle;
