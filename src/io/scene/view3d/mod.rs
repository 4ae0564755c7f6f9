//! A View3D input file (`.vs3`) that stands for a scene: its surfaces with their names and emittances.
//!
//! Facts about the format: `references/view3d-format.md`.

mod assemble;
mod parse;
mod shape;
mod words;

use super::SceneOptions;
use super::alone::refusal;
use super::check::{Check, Checked};
use super::error::{Refusal, SceneFileError};
use super::folder::text_of;
use super::polygon::Division;
use super::read::{edge_asked, survey};
use super::source::Source;
use crate::scene::Scene;
use crate::view::{Photometry, Primaries};
use std::path::Path;

/// True if the ending of a file name is that of View3D input.
pub(super) fn is_view3d(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("vs3"))
}

/// The scene of a View3D file, named after the file. One band; reflectance is 1 - emittance; nothing emits.
pub(super) fn read_view3d(path: &Path, options: &SceneOptions) -> Checked<Scene> {
    let text = text_of(path).map_err(|why| {
        let message = format!("cannot read the scene: {why}");
        SceneFileError::whole(&path.display().to_string(), Refusal::Unreadable, message)
            .mend("give a file that is there and can be read")
    })?;
    let source = Source::new(path, text);
    let check = Check { source: &source };
    let file = parse::parse(check)?;
    let division = Division { patches: None, elements: None, max_edge: edge_asked(options)?, mesh: true };
    let parts = assemble::assemble(check, &file, &division)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = Scene {
        name: stem.chars().take(60).map(|c| if c.is_control() { '_' } else { c }).collect(),
        photometry: Photometry { bands: vec!["y".into()], weights: Primaries::Mono.weights().to_vec() },
        enclosure: file.encloses.then_some(true),
        materials: parts.materials,
        surfaces: parts.surfaces,
        absent: Vec::new(),
        edits: Vec::new(),
        lights: Vec::new(),
        receivers: Vec::new(),
        cameras: Vec::new(),
        notices: file.notices.into_iter().chain(parts.notices).collect(),
    };
    survey(&mut scene).map_err(|e| refusal(path, &e))?;
    Ok(scene)
}
