//! Pictures of solutions on their way, beside the references [GSG90 fig. 6].

use crate::io::image::png;
use crate::render::{Mesh, Seen, Stencils, ToneMap, View, luminance, paint_smooth, vertex_colours};
use crate::report::format::count;
use crate::report::{ReportError, tone_words};
use crate::scene::Stage;
use crate::solution::{Radiosity, Series, Snapshot};
use crate::study::Onlooker;
use base64::Engine;

/// Pictures of one state through one camera.
#[derive(Debug, Clone)]
pub struct Pictures {
    /// The state.
    pub edit: usize,
    /// Rows of pictures: the references, then one row for each number of shots.
    pub rows: Vec<Vec<Picture>>,
    /// How they are shown, in a few sentences.
    pub words: String,
}

/// One picture.
#[derive(Debug, Clone)]
pub struct Picture {
    /// What is shown.
    pub caption: String,
    /// File name in the folder of the run.
    pub file: String,
    /// The file.
    pub png: Vec<u8>,
}

impl Picture {
    /// As an address that a page can hold.
    pub(super) fn inline(&self) -> String {
        format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(&self.png))
    }
}

/// A state with its reference and what a camera sees of it.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// The state.
    pub stage: &'a Stage,
    /// Mean of the reference, per patch.
    pub reference: &'a Radiosity,
    /// The camera.
    pub view: &'a View,
}

/// Pictures of a state, of the state before it if there is one, and of every series after each number of shots since
/// the edit: the last snapshot not after it. All as an eye sees them that is adapted to the reference.
///
/// # Errors
/// [`ReportError`] where a picture cannot be written.
pub fn pictures(now: Shown, before: Option<Shown>, series: &[Series], shots: &[u64]) -> Result<Pictures, ReportError> {
    let stage = now.stage;
    let (eye, words) = eye(now);
    let mut rows = vec![Vec::new()];
    if let Some(before) = before {
        rows[0].push(painted(before, before.reference, &eye, "Reference before the edit".into(), "reference-before")?);
    }
    rows[0].push(painted(now, now.reference, &eye, "Reference".into(), "reference")?);
    for n in shots {
        let mut row = Vec::new();
        for (k, series) in series.iter().enumerate() {
            let Some(snapshot) = after(series, stage.state, *n) else { continue };
            let caption = format!("{} after {} shots", series.name, count(*n as usize));
            let stem = format!("method-{}-after-{n}", k + 1);
            row.push(painted(now, &snapshot.radiosity, &eye, caption, &stem)?);
        }
        rows.push(row);
    }
    rows.retain(|r| !r.is_empty());
    Ok(Pictures { edit: stage.state, rows, words })
}

/// An eye adapted to what the camera shows of the reference, and what is said of it.
fn eye(now: Shown) -> (ToneMap, String) {
    let stage = now.stage;
    let is_lamp: Vec<bool> = (0..stage.patch_count()).map(|i| stage.emission(i).iter().any(|e| *e > 0.0)).collect();
    let seen = Seen::of(&Mesh::of_patches(stage), [&now.view.visibility]);
    let luminances = luminance(&stage.photometry, now.reference);
    let eye = ToneMap::new(Onlooker::default().look(&seen, &luminances, &is_lamp), &stage.photometry);
    let words = tone_words(&eye.viewer, eye.clipped(luminances.into_iter().zip(seen.shares)));
    (eye, words)
}

/// The last snapshot of a state with at most `shots` since the edit.
fn after(series: &Series, edit: usize, shots: u64) -> Option<&Snapshot> {
    let before = series.snapshots.iter().rfind(|s| s.edit < edit).map_or(0, |s| s.shots);
    series.snapshots.iter().rfind(|s| s.edit == edit && s.shots <= before + shots)
}

fn painted(
    shown: Shown,
    radiosity: &Radiosity,
    eye: &ToneMap,
    caption: String,
    stem: &str,
) -> Result<Picture, ReportError> {
    let mesh = Mesh::of_patches(shown.stage);
    let raster = paint_smooth(
        &shown.view.visibility,
        &mesh,
        &vertex_colours(&Stencils::of(&mesh), eye, radiosity),
        eye.viewer.display.response,
    );
    let file = format!("picture-edit-{}-{stem}.png", shown.stage.state);
    Ok(Picture { caption, file, png: png(raster.width, raster.height, &raster.rgba)? })
}
