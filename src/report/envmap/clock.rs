//! What the clock says: seconds of a look-up by fast and by exact filters, and of making the maps.

use crate::report::format::{count, percent, round_number, significant};
use crate::report::html::context::minus;
use crate::report::number::UNKNOWN;
use crate::study::envmap::{EnvmapRecord, FilterRow, Speed};
use serde::Serialize;

/// A fast filter.
#[derive(Debug, Serialize)]
pub(super) struct FilterLine {
    pub layout: &'static str,
    pub filter: &'static str,
    pub width: String,
    pub stretch: String,
    pub error: String,
    pub near_poles: String,
    pub worst: String,
    /// Microseconds of a look-up, and of an exact one.
    pub fast: String,
    pub exact: String,
    /// How many times as fast.
    pub times: String,
}

/// A part of the work.
#[derive(Debug, Serialize)]
pub(super) struct SpeedLine {
    pub name: &'static str,
    pub count: String,
    pub seconds: String,
    pub rate: String,
}

/// What a filter is called.
pub(super) fn filter_name(filter: &'static str) -> &'static str {
    match filter {
        "box" => "box",
        "ewa" => "elliptical weighted average",
        other => other,
    }
}

/// A quotient; a dash where there is none.
fn over(a: f64, b: f64) -> Option<f64> {
    Some(a / b).filter(|x| b > 0.0 && x.is_finite())
}

pub(super) fn filters(record: &EnvmapRecord) -> Vec<FilterLine> {
    let micro = |seconds: f64| significant(1e6 * seconds, 3);
    let share = |x: f64| minus(&percent(x));
    let line = |f: &FilterRow| FilterLine {
        layout: f.layout,
        filter: filter_name(f.filter),
        width: round_number(f.width),
        stretch: round_number(f.stretch),
        error: share(f.error),
        near_poles: f.near_poles.map_or(UNKNOWN.into(), share),
        worst: share(f.worst),
        fast: micro(f.seconds),
        exact: micro(f.exact_seconds),
        times: over(f.exact_seconds, f.seconds).map_or(UNKNOWN.into(), |x| significant(x, 3)),
    };
    // Layouts that are to be compared stand together.
    let mut rows: Vec<&FilterRow> = record.filters.iter().collect();
    rows.sort_by(|a, b| a.filter.cmp(b.filter).then(a.stretch.total_cmp(&b.stretch)).then(a.width.total_cmp(&b.width)));
    rows.into_iter().map(line).collect()
}

pub(super) fn speed(record: &EnvmapRecord) -> Vec<SpeedLine> {
    let line = |s: &Speed| SpeedLine {
        name: s.name,
        count: count(s.count as usize),
        seconds: significant(s.seconds, 3),
        rate: over(s.count as f64, s.seconds).map_or(UNKNOWN.into(), |r| count(r.round() as usize)),
    };
    record.speed.iter().map(line).collect()
}
