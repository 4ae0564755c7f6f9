//! How natural colours are made.

use crate::render::{Exposure, Mesh, Seen, Shade, ToneMap, View, luminance};
use crate::report::format::significant;
use crate::report::tone::tone_words;
use crate::study::Record;

/// How all pictures in natural colours are made, with what is said of it.
pub(super) struct Look {
    /// From radiosities to the screen.
    pub shade: Box<dyn Shade>,
    /// What is said of it.
    pub words: String,
}

impl Look {
    /// Through the eye that the record was looked at with, else on one linear scale.
    pub(super) fn of(record: &Record, views: &[View], mesh: &Mesh) -> Self {
        let Some(seen) = &record.as_seen else {
            let exposure = exposure(record);
            return Self { words: exposed(&exposure), shade: Box::new(exposure) };
        };
        let map = ToneMap::new(seen.viewer.clone(), &record.stage.photometry);
        let shares = Seen::of(mesh, views.iter().map(|v| &v.visibility)).shares;
        let clipped = map.clipped(luminance(&record.stage.photometry, &record.reference).into_iter().zip(shares));
        Self { words: tone_words(&map.viewer, clipped), shade: Box::new(map) }
    }
}

/// One exposure for all pictures in natural colours.
pub(in crate::report) fn exposure(record: &Record) -> Exposure {
    let stage = &record.stage;
    let is_emitter: Vec<bool> = (0..stage.patch_count()).map(|i| stage.emission(i).iter().any(|e| *e > 0.0)).collect();
    Exposure::fit(&stage.photometry, &luminance(&stage.photometry, &record.reference), &stage.areas(), &is_emitter)
}

/// What an exposure does, in a sentence.
pub(in crate::report) fn exposed(exposure: &Exposure) -> String {
    format!(
        "One linear scale for both pictures, then the sRGB curve: a luminance of {} W/m\u{b2} is shown white (99 % of \
         the reflecting area stays below); lamps may burn out.",
        significant(exposure.white_luminance, 3)
    )
}
