//! A mesh file that stands for a scene by itself.

use super::SceneOptions;
use super::check::{Check, Checked};
use super::error::{Refusal, SceneFileError};
use super::folder::Folder;
use super::mesh::{self, Fallback, Format, Gathered, MeshFile, MeshSpec};
use super::photometry::Materials;
use super::polygon::Division;
use super::read::{edge_asked, survey};
use super::source::Source;
use crate::scene::{Scene, SceneError, Surface};
use crate::view::Photometry;
use std::path::Path;

/// True if the ending of a file name is that of a mesh format.
pub(super) fn is_mesh(path: &Path) -> bool {
    Format::of(path).is_some()
}

/// The scene of one surface, named after the file. Axes, sides and units are the format's own; faces without a
/// usable material are grey.
pub(super) fn read_mesh(path: &Path, options: &SceneOptions) -> Checked<Scene> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name: String = stem.chars().take(60).map(|c| if c.is_control() { '_' } else { c }).collect();
    // Nothing refers to it: what a scene file would say takes its default.
    let source = Source::new(path, String::new());
    let check = Check { source: &source };
    let spec = MeshSpec {
        surface: &name,
        file: MeshFile::given(path),
        scale: 1.0,
        y_up: None,
        two_sided: None,
        material: None,
        fallback: Fallback::Grey,
        division: Division { patches: None, elements: None, max_edge: edge_asked(options)?, mesh: true },
    };
    let photometry = Photometry::rec709();
    let (mut materials, mut notices) = (Materials::default(), Vec::new());
    let mut gathered =
        Gathered { materials: &mut materials, notices: &mut notices, bands: &photometry.bands, rgb: true };
    let (faces, groups) = mesh::faces(check, &Folder::of(path), &spec, &mut gathered)?;
    let surface = Surface { name: name.clone(), object: "scene".into(), faces, groups, from_mesh: true };
    let mut scene = Scene {
        name,
        photometry,
        enclosure: None,
        materials: materials.list,
        surfaces: vec![surface],
        absent: Vec::new(),
        edits: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        receivers: Vec::new(),
        notices,
    };
    survey(&mut scene).map_err(|e| refusal(path, &e))?;
    Ok(scene)
}

/// A fault of the scene as a whole, as that of its one file.
pub(super) fn refusal(path: &Path, e: &SceneError) -> SceneFileError {
    let kind = match e {
        SceneError::TooMany { .. } => Refusal::Counts,
        _ => Refusal::Geometry,
    };
    let text = e.to_string();
    let (message, mend) = text.split_once("; ").unwrap_or((&text, ""));
    SceneFileError::whole(&path.display().to_string(), kind, message).mend(mend)
}
