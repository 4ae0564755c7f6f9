//! The scene to turn and zoom: data, program and markup of the 3-D view that a page holds.
//!
//! Data are per patch and base64; the program looks a patch's value up by its number, so that another layer or range
//! changes no geometry.

mod encode;
mod film;
mod geometry;
mod layers;
mod page;

pub use film::{Filmed, film};
#[cfg(test)]
pub(in crate::report) use page::LIBRARY;
pub use page::Parts;
pub(in crate::report) use page::TEMPLATES;

use super::asked::Level;
use crate::scene::Stage;
use crate::study::Record;
use crate::view::Camera;
use encode::{counts, numbers};
use geometry::Geometry;
use layers::{Colouring, Layer, Maps, colourings, layers};
use serde::Serialize;

/// All that the view of one scene shows.
#[derive(Debug, Serialize)]
pub(in crate::report) struct SceneView {
    /// Number of patches, those that are not there included.
    patches: usize,
    geometry: Geometry,
    /// The scene before the edit.
    before: Option<Geometry>,
    /// What stood there before, in a sentence.
    before_note: Option<String>,
    /// (surface, object) by number.
    surfaces: Vec<[String; 2]>,
    materials: Vec<String>,
    /// Surface, material (u32) and area in square metres (f32) of each patch.
    surface: String,
    material: String,
    area: String,
    cameras: Vec<Camera>,
    maps: Maps,
    /// Ways to show natural colours; the first is shown.
    pub colourings: Vec<Colouring>,
    /// What is shown in false colour.
    pub layers: Vec<Layer>,
    films: Vec<film::Film>,
    /// What is shown first: `natural-reference`, `natural-candidate`, `natural-before` or the key of a layer.
    start: String,
    /// The worst patches, the worst first.
    worst: Vec<usize>,
}

impl SceneView {
    fn new(stage: &Stage, cameras: &[Camera]) -> Self {
        Self {
            patches: stage.patch_count(),
            geometry: Geometry::of(stage),
            before: None,
            before_note: None,
            surfaces: stage.surfaces.iter().map(|s| [s.name.clone(), s.object.clone()]).collect(),
            materials: stage.materials.iter().map(|m| m.name.clone()).collect(),
            surface: counts(stage.patches.iter().map(|p| p.surface)),
            material: counts(stage.patches.iter().map(|p| p.material)),
            area: numbers(stage.patches.iter().map(|p| Some(p.area))),
            cameras: cameras.to_vec(),
            maps: Maps::new(),
            colourings: Vec::new(),
            layers: Vec::new(),
            films: Vec::new(),
            start: "difference".into(),
            worst: Vec::new(),
        }
    }

    fn is_film(&self) -> bool {
        !self.films.is_empty()
    }
}

/// The view of a record; `None` where there is no geometry.
pub(in crate::report) fn scene_view(record: &Record, cameras: &[Camera]) -> Option<SceneView> {
    let stage = &record.stage;
    if !has_geometry(stage) {
        return None;
    }
    let before = record.before.as_ref().filter(|b| fits(b.reference.len(), &b.stage, stage));
    let level = Level::of(record);
    let mut worst = Vec::new();
    for patch in record.comparison.worst.iter().filter_map(|w| level.patch(record, w.patch)) {
        if !worst.contains(&patch) {
            worst.push(patch);
        }
    }
    Some(SceneView {
        before: before.map(|b| Geometry::of(&b.stage)),
        before_note: before.map(layers::before_note),
        colourings: colourings(record, before),
        layers: layers(record, before),
        worst,
        ..SceneView::new(stage, cameras)
    })
}

fn has_geometry(stage: &Stage) -> bool {
    !stage.facets.is_empty() && stage.patches.iter().any(|p| p.is_present())
}

/// A state before is drawn where it has the numbers and the bands of the state after.
fn fits(values: usize, before: &Stage, after: &Stage) -> bool {
    has_geometry(before)
        && values == before.patch_count()
        && before.patch_count() == after.patch_count()
        && before.band_count() == after.band_count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::record;
    use crate::study::{Before, anonymous_stage};

    #[test]
    fn a_record_without_geometry_has_no_view() {
        let mut r = record();
        assert!(scene_view(&r, &[]).is_some());
        r.stage = anonymous_stage(r.stage.patch_count(), r.stage.photometry.clone());
        assert!(scene_view(&r, &[]).is_none());
    }

    #[test]
    fn the_state_before_an_edit_has_a_geometry_of_its_own() {
        let mut r = record();
        let mut stage = r.stage.clone();
        stage.patches[3].area = 0.0;
        stage.patches[3].region.pieces.clear();
        r.before = Some(Before { name: "old.ref".into(), reference: r.reference.clone(), stage });
        let view = scene_view(&r, &[]).expect("a view");
        let json = serde_json::to_value(&view).expect("json");
        assert_ne!(json["geometry"]["loops"], json["before"]["loops"]);
        assert!(view.layers.iter().any(|l| l.key == "before" && l.before));
        assert_eq!(view.before_note.as_deref(), Some("State 0 of the scene, by the reference old.ref."));
        // One of another division is left out: its numbers mean other patches.
        r.before.as_mut().expect("before").reference.values.truncate(3);
        assert!(scene_view(&r, &[]).expect("a view").before.is_none());
    }

    #[test]
    fn the_worst_elements_lead_to_their_patches_once() {
        let r = record();
        let view = scene_view(&r, &[]).expect("a view");
        assert_eq!(view.worst[0], r.comparison.worst[0].patch);
        assert_eq!(view.worst.len(), r.comparison.worst.len());
    }
}
