//! One picture under lamps of many strengths, each as the eye would see it: from searchlight to firefly [TR93 fig. 5].

use super::Look;
use super::natural::Shown;
use super::picture::{Painter, figures};
use super::subject::Subject;
use crate::cli::exit::Failure;
use crate::render::{Bar, Raster, Sheet, Visibility};
use crate::view::Response;
use serde_json::{Value, json};

/// Steps of the strip of equal frame-buffer values.
const STRIP: usize = 16;

/// A sheet with one panel for each lamp, brightest as given first.
pub(super) struct Series {
    pub raster: Raster,
    /// What is said of each panel, in order.
    pub words: Vec<String>,
    pub json: Vec<Value>,
}

/// Paints the series through one camera.
pub(super) fn series(subject: &Subject, look: &Look, seen: &Visibility, lamps: &[f64]) -> Result<Series, Failure> {
    let (mut panels, mut words, mut json) = (Vec::new(), Vec::new(), Vec::new());
    for lamp in lamps {
        let lit = subject.lit(*lamp, look.args.viewing.efficacy.0)?;
        let painter = Painter::new(&lit, look)?;
        let shown = painter.look(seen);
        panels.push((format!("{} cd/m\u{b2}", figures(*lamp)), painter.plain(seen, shown.as_ref())));
        words.push(format!("Lamp of {} cd/m\u{b2}: {}", figures(*lamp), shown.as_ref().map_or(String::new(), short)));
        json.push(json!({ "lamp": lamp, "tone": shown.as_ref().map(Shown::json) }));
    }
    let n = |k: usize| k as f64 / (STRIP - 1) as f64;
    let strip = Bar {
        // Many colours a step: the bar is drawn smooth between them.
        colours: (0..STRIP * 16).map(|k| [Response::Srgb.light(n(k / 16)); 3]).collect(),
        marks: [0, 5, 10, 15].map(|k| ((k as f64 + 0.5) / STRIP as f64, format!("{:.2}", n(k)))).into(),
        title: "equal steps of the frame-buffer value n".into(),
    };
    let sheet = Sheet { panels, bar: Some(strip), caption: words.join(" ") };
    Ok(Series { raster: sheet.compose(), words, json })
}

fn short(shown: &Shown) -> String {
    match shown {
        Shown::Linear(_) => shown.words(),
        Shown::Eye(map, clipped) => {
            let flaw = if map.viewer.tone.too_dark.is_some() { ", below the model's 27 dB" } else { "" };
            let adapted = crate::view::Observer::new(map.viewer.levels.adapts_to());
            format!(
                "eye adapted to {} cd/m\u{b2} ({} dB{flaw}), {} % black, {} % white.",
                figures(adapted.adapted_to),
                figures(adapted.stevens()),
                figures(100.0 * clipped.black),
                figures(100.0 * clipped.white)
            )
        }
    }
}
