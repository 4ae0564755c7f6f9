//! The scene file `etalon-scene/1` (TOML), the meshes it names (OBJ with MTL, PLY, glTF), and
//! scenes of other programs: View3D, Mitsuba 3, Radiance.

mod alone;
mod builtin;
mod cameras;
mod check;
mod edits;
mod error;
mod folder;
mod lighting;
pub(in crate::io) mod mesh;
mod mitsuba;
mod photometry;
mod pieces;
mod polygon;
mod radiance;
mod raw;
mod read;
mod source;
mod surfaces;
mod view3d;

pub use builtin::{builtin, builtin_names, builtin_text, open_scene};
pub use error::{Refusal, SceneFileError};
pub use read::{SCENE_FORMAT, read_scene};

/// What the command line may change while a scene is read.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SceneOptions {
    /// Takes the place of the file's `[discretisation] max_edge`, metres; surfaces with `patches` keep theirs.
    pub max_edge_override: Option<f64>,
}
