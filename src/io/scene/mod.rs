//! The scene file `etalon-scene/1` and the lighting file `etalon-lighting/1` (TOML), the meshes and pictures they name
//! (OBJ with MTL, PLY, glTF; PNG), and scenes of other programs: View3D, Mitsuba 3, Radiance.

mod alone;
mod builtin;
mod cameras;
mod check;
mod edits;
mod error;
mod finishes;
mod folder;
mod format;
mod lamp_keys;
mod lamps;
mod lighting;
mod look;
pub(in crate::io) mod mesh;
mod mitsuba;
mod photometry;
mod pictures;
mod pieces;
mod polygon;
mod radiance;
mod raw;
mod raw_look;
mod read;
mod shapes;
mod source;
mod staged;
mod surfaces;
mod surroundings;
mod view3d;

pub use builtin::{builtin, builtin_names, builtin_text, open_scene};
pub use error::{Refusal, SceneFileError};
pub use look::Look;
pub use read::{SCENE_FORMAT, read_scene};
pub use shapes::{Shapes, Shining};
pub use staged::{LIGHTING_FORMAT, open_staged, open_with_look, read_lighting};

/// What the command line may change while a scene is read.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SceneOptions {
    /// Takes the place of the file's `[discretisation] max_edge`, metres; surfaces with `patches` keep theirs.
    pub max_edge_override: Option<f64>,
}
