//! Form factors by rays: who emits, how many rays, and the hit counts that come of it.

mod aim;
mod checkpoint;
mod counts;
mod direct;
mod emitter;
mod packed;
mod plan;
mod receivers;
mod replicate;
mod rows;
mod shadow;

pub use checkpoint::{Block, Checkpoint, FinishedRow, NoCheckpoint};
pub use counts::{Entry, HitCounts};
pub use direct::{DirectLight, Lit, direct_light, lit_elements, lit_patches};
pub use emitter::{Emitter, element_emitters, patch_emitters};
pub use plan::{Plan, Reached};
pub use receivers::irradiance;
pub use rows::{Casting, cast, cast_on, row_batches, sample_batches};
