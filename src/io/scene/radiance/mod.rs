//! A Radiance scene description (`.rad`): polygons of plastic, and lights.
//!
//! Facts about the format: `references/radiance-format.md`.

mod assemble;
mod genbox;
mod material;
mod parse;
mod words;

use super::SceneOptions;
use super::alone::refusal;
use super::check::{Check, Checked};
use super::error::{Refusal, SceneFileError};
use super::folder::text_of;
use super::pieces::scene_name;
use super::polygon::Division;
use super::read::{edge_asked, survey};
use super::source::Source;
use crate::scene::Scene;
use crate::view::Photometry;
use std::path::Path;

/// Luminance weights of Radiance's red, green and blue: primaries (0.640, 0.330), (0.290, 0.600), (0.150, 0.060) and
/// the white (0.3333, 0.3333).
const WEIGHTS: [f64; 3] = [0.265_074_126_460_265, 0.670_114_630_510_670_2, 0.064_811_243_029_064_81];

/// True if the ending of a file name is that of a Radiance scene.
pub(super) fn is_radiance(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("rad"))
}

/// The scene of a Radiance file, named after the file. Bands are Radiance's red, green and blue; coordinates are
/// taken as metres.
pub(super) fn read_radiance(path: &Path, options: &SceneOptions) -> Checked<Scene> {
    let text = text_of(path).map_err(|why| {
        let message = format!("cannot read the scene: {why}");
        SceneFileError::whole(&path.display().to_string(), Refusal::Unreadable, message)
            .mend("give a file that is there and can be read")
    })?;
    let source = Source::new(path, text);
    let check = Check { source: &source };
    let primitives = parse::parse(check)?;
    let division = Division { patches: None, elements: None, max_edge: edge_asked(options)?, mesh: true };
    let parts = assemble::assemble(check, &primitives, division)?;
    let mut scene = Scene {
        name: scene_name(path),
        photometry: Photometry { weights: WEIGHTS.to_vec(), ..Photometry::rec709() },
        enclosure: None,
        materials: parts.palette.materials.list,
        surfaces: parts.surfaces,
        absent: Vec::new(),
        edits: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        receivers: Vec::new(),
        notices: parts.notices,
    };
    survey(&mut scene).map_err(|e| refusal(path, &e))?;
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3};

    #[test]
    fn the_weights_are_those_of_the_primaries() {
        // Columns: XYZ of each primary of luminance 1; their mixture is to be white.
        let xyz = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
        let mixture = DMat3::from_cols(xyz(0.640, 0.330), xyz(0.290, 0.600), xyz(0.150, 0.060));
        let weights = mixture.inverse() * xyz(0.3333, 0.3333);
        assert!((weights - DVec3::from(WEIGHTS)).length() < 1e-12, "{weights:?}");
    }
}
