//! A Mitsuba 3 scene (`.xml`): diffuse shapes with area and point emitters.
//!
//! Facts about the format: `references/mitsuba-format.md`.

mod bsdf;
mod colour;
mod emitter;
mod load;
mod sensor;
mod shape;
mod spectrum;
mod surfaces;
mod transform;
mod tree;

use super::SceneOptions;
use super::alone::refusal;
use super::check::Checked;
use super::error::{Refusal, SceneFileError};
use super::folder::{Folder, text_of};
use super::pieces::scene_name;
use super::polygon::Division;
use super::read::{edge_asked, survey};
use crate::scene::Scene;
use crate::view::Photometry;
use std::path::Path;

/// True if the ending of a file name is that of a Mitsuba scene.
pub(super) fn is_mitsuba(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xml"))
}

/// The scene of a Mitsuba file, named after the file. Bands are red, green and blue of Rec. 709; coordinates and
/// units are the file's own, in metres.
pub(super) fn read_mitsuba(path: &Path, options: &SceneOptions) -> Checked<Scene> {
    let text = text_of(path).map_err(|why| {
        let message = format!("cannot read the scene: {why}");
        SceneFileError::whole(&path.display().to_string(), Refusal::Unreadable, message)
            .mend("give a file that is there and can be read")
    })?;
    let folder = Folder::of(path);
    let tree = load::load(path, text, &folder)?;
    let division = Division { patches: None, elements: None, max_edge: edge_asked(options)?, mesh: true };
    let parts = surfaces::gather(&tree, &folder, division)?;
    let mut scene = Scene {
        name: scene_name(path),
        photometry: Photometry::rec709(),
        enclosure: None,
        materials: parts.palette.materials.list,
        surfaces: parts.surfaces,
        absent: Vec::new(),
        edits: Vec::new(),
        cameras: parts.cameras,
        lights: parts.lights,
        receivers: Vec::new(),
        notices: parts.notices,
    };
    survey(&mut scene).map_err(|e| refusal(path, &e))?;
    Ok(scene)
}
