//! Form factors by rays: who emits, how many rays, and the hit counts that come of it.

mod aim;
mod bounds;
mod checkpoint;
mod counts;
mod emitter;
mod packed;
mod plan;
mod replicate;
mod rows;

pub use checkpoint::{Block, Checkpoint, FinishedRow, NoCheckpoint};
pub use counts::{Entry, HitCounts};
pub use emitter::{Emitter, element_emitters, patch_emitters};
pub use plan::{Plan, Reached};
pub use rows::{Casting, cast, cast_on, row_batches, sample_batches};
