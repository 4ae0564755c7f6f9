//! The sources: who brings the errors, and to whom.

use crate::audit::{Beat, Cause, View};
use crate::report::format::{count, number, percent, significant, with_error};
use crate::report::html::context::minus;
use crate::study::audit::{AuditRecord, Form, SourceAudit};
use serde::Serialize;

/// A source.
#[derive(Debug, Serialize)]
pub(super) struct SourceRow {
    pub name: String,
    pub patches: String,
    pub luminance: String,
    pub error: String,
    /// Lengths of the parts of its bar, percent of the axis: (class, from, width).
    pub bar: Vec<(String, String, String)>,
    /// (class, cause, share of the light) of each cause.
    pub causes: Vec<(String, &'static str, String)>,
    pub main_cause: &'static str,
    pub receivers: String,
    pub distance: String,
    pub pixels: [String; 3],
    pub missed: String,
    pub half: String,
    pub doubled: String,
    /// Resolution at which counting would do.
    pub by_pixels: Option<String>,
    /// The cheapest cure that mends it; what the clock says.
    pub mended_by: Option<String>,
    pub worst: Vec<WorstRow>,
    pub beats: Vec<String>,
}

/// One of its receivers.
#[derive(Debug, Serialize)]
pub(super) struct WorstRow {
    pub rank: usize,
    pub patch: u32,
    pub surface: String,
    pub distance: String,
    pub cube: String,
    pub point: String,
    pub mean: String,
    pub ratio: String,
    pub pixels: String,
    pub counted: String,
    pub share: String,
}

/// All sources that were looked at, the largest error first.
pub(super) fn rows(record: &AuditRecord) -> Vec<SourceRow> {
    let longest = record.sources.iter().map(|s| s.source.error).fold(0.0, f64::max);
    record.sources.iter().map(|s| row(s, record, longest)).collect()
}

/// A number of pixels: two figures where few.
fn pixels(x: f64) -> String {
    if x < 100.0 { significant(x, 2) } else { count(x.round() as usize) }
}

fn row(s: &SourceAudit, record: &AuditRecord, longest: f64) -> SourceRow {
    let seen = &s.seen;
    let metres = seen.distance.map(|d| significant(d, 3));
    SourceRow {
        name: s.source.name.clone(),
        patches: count(s.source.patches.len()),
        luminance: minus(&number(s.source.luminance)),
        error: minus(&percent(s.source.error)),
        bar: bar(s, longest),
        causes: (Cause::ALL.iter().zip(s.source.by_cause).enumerate())
            .map(|(k, (c, e))| (format!("c{k}"), c.name(), minus(&percent(e))))
            .collect(),
        main_cause: s.main_cause.name(),
        receivers: count(seen.receivers),
        distance: format!("{} to {} m", metres[0], metres[2]),
        pixels: seen.pixels.map(pixels),
        missed: count(seen.missed),
        half: count(seen.less_than_half),
        doubled: count(seen.doubled),
        by_pixels: s.resolution_by_pixels.map(|r| count(r as usize)),
        mended_by: if record.limit.is_some_and(|l| s.source.error <= l) {
            Some("needs none: within the limit".into())
        } else {
            s.mended_by.and_then(|k| record.cures.get(k)).map(|c| c.words.clone())
        },
        worst: seen.worst.iter().enumerate().map(|(k, v)| worst(k, v, record.form)).collect(),
        beats: seen.beats.iter().map(beat).collect(),
    }
}

/// The bar is as long as the error; its parts are as the causes alone are to each other.
fn bar(s: &SourceAudit, longest: f64) -> Vec<(String, String, String)> {
    let all: f64 = s.source.by_cause.iter().sum();
    if all == 0.0 || longest == 0.0 {
        return Vec::new();
    }
    let length = 100.0 * s.source.error / longest;
    let mut from = 0.0;
    let part = |(k, cause): (usize, &f64)| {
        let width = length * cause / all;
        from += width;
        (format!("c{k}"), format!("{:.2}", from - width), format!("{width:.2}"))
    };
    s.source.by_cause.iter().enumerate().map(part).collect()
}

fn worst(rank: usize, v: &View, form: Form) -> WorstRow {
    WorstRow {
        rank: rank + 1,
        patch: v.patch,
        surface: v.surface.clone(),
        distance: significant(v.distance, 3),
        cube: number(v.cube),
        point: number(v.point),
        mean: minus(with_error(v.mean, Some(v.mean_error)).trim_start_matches('+')),
        ratio: if v.point > 0.0 { significant(v.cube / v.point, 3) } else { "unseen".into() },
        pixels: pixels(v.pixels),
        // Pixels of the shooters are not those of the receivers.
        counted: if form == Form::Receiver { pixels(v.counted) } else { String::new() },
        share: percent(v.share),
    }
}

fn beat(b: &Beat) -> String {
    minus(&format!(
        "Beats across {}: a wave of {} m ({} patches) along its {} axis holds {} of a variation of {}.",
        b.surface,
        significant(b.period, 3),
        significant(b.patches, 3),
        if b.axis == 0 { "first" } else { "second" },
        percent(b.share),
        percent(b.spread)
    ))
}
