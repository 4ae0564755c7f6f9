//! Surfaces, materials, patches, elements, states and edits.
//!
//! A [`Scene`] is what the author wrote, all states at once; a [`Stage`] is what stands there in one
//! state, divided into numbered patches. Everything downstream works on stages.

mod appearance;
mod build;
mod contact;
mod divide;
mod error;
mod finding;
mod hash;
mod lighting;
mod model;
mod names;
mod numbering;
mod plain;
mod region;
mod shared;
mod stage;
mod states;
mod without;

pub use appearance::{
    Appearance, Background, Clouds, Finish, Fog, IntensityCurve, Light, LightShape, Picture, SkyModel, Texture, Tree,
};
pub use contact::COINCIDENCE_TOLERANCE;
pub use error::SceneError;
pub use finding::{Consequence, Finding, FindingKind, Place, Severity};
pub use lighting::{Distribution, PointLight, Receiver};
pub use model::{Edit, Face, Grid, Material, OBSTRUCTIONS, Scene, Surface, Transform};
pub use numbering::{MAX_ELEMENTS, MAX_PATCHES};
pub use region::Region;
pub use shared::SharedArea;
pub use stage::{Element, Facet, NO_FACET, Patch, Stage, StageSurface};
