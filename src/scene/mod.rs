//! Surfaces, materials, patches, elements, states and edits.
//!
//! A [`Scene`] is what the author wrote, all states at once; a [`Stage`] is what stands there in one
//! state, divided into numbered patches. Everything downstream works on stages.

mod hash;
mod model;
mod plain;
mod region;
mod stage;

pub use model::{Edit, Face, Grid, Material, Scene, Surface, Transform};
pub use region::Region;
pub use stage::{Element, Facet, NO_FACET, Patch, Stage, StageSurface};
