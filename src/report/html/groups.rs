//! Errors by surface and by object, as rows of a table.

use super::context::minus;
use crate::metrics::GroupError;
use crate::report::asked::Level;
use crate::report::format::{column, column_error, count, percent, percent_estimate, places, significant};
use crate::study::Record;
use serde::Serialize;

/// More rows than these are counted, not shown; the record has them all.
const SHOWN: usize = 12;

#[derive(Debug, Serialize)]
pub(super) struct GroupTable {
    pub title: &'static str,
    pub noun: &'static str,
    /// Name of what is counted.
    pub receivers: &'static str,
    pub receiver: &'static str,
    pub rows: Vec<GroupRow>,
    /// What is left out, in a sentence.
    pub more: Option<String>,
    /// True if the whole error cannot be told from noise: no shares then.
    pub only_noise: bool,
}

#[derive(Debug, Serialize)]
pub(super) struct GroupRow {
    pub name: String,
    pub object: Option<String>,
    pub receivers: String,
    pub area: String,
    pub reference: String,
    pub solution: String,
    pub bias: String,
    /// Plus or minus this: one standard error.
    pub std_err: Option<String>,
    /// Bias relative to the reference.
    pub relative: Option<String>,
    pub share: Option<Share>,
    pub worst: usize,
    /// The patch that shows it in the scene to turn.
    pub worst_patch: Option<usize>,
    pub worst_difference: String,
}

/// A share with its interval, in words and as places from the left in percent.
#[derive(Debug, Serialize)]
pub(super) struct Share {
    pub value: String,
    pub interval: Option<String>,
    pub at: String,
    pub low: String,
    pub width: String,
}

/// Tables by object, where there is more than one, and by surface.
pub(super) fn group_tables(record: &Record) -> Vec<GroupTable> {
    let Some(breakdown) = &record.breakdown else { return Vec::new() };
    let mut tables = Vec::new();
    let objects = &breakdown.objects;
    if objects.len() > 1 && objects.len() < breakdown.surfaces.len() {
        tables.push(table(record, "By object", "Object", objects));
    }
    // A comparison without a scene has one nameless surface: the whole of it.
    if breakdown.surfaces.iter().any(|g| !g.name.is_empty()) {
        tables.push(table(record, "By surface", "Surface", &breakdown.surfaces));
    }
    tables
}

fn table(record: &Record, title: &'static str, noun: &'static str, groups: &[GroupError]) -> GroupTable {
    let level = Level::of(record);
    let shown = &groups[..groups.len().min(SHOWN)];
    let of = |get: fn(&GroupError) -> f64| -> Vec<f64> { shown.iter().map(get).collect() };
    let (references, solutions) = (of(|g| g.reference.value), of(|g| g.solution));
    let both = places(&[references.clone(), solutions.clone()].concat());
    let (biases, worst) = (of(|g| g.bias.value), of(|g| g.worst_difference));
    let columns = [
        column(&references, both, false),
        column(&solutions, both, false),
        column(&biases, places(&biases), true),
        column(&worst, places(&worst), true),
    ];
    let objects_differ = groups.iter().any(|g| g.object != groups[0].object);
    let row = |(k, g): (usize, &GroupError)| GroupRow {
        name: g.name.clone(),
        object: g.object.clone().filter(|_| objects_differ),
        receivers: count(g.receivers),
        area: significant(g.area, 3),
        reference: minus(&columns[0][k]),
        solution: minus(&columns[1][k]),
        bias: minus(&columns[2][k]),
        std_err: g.bias.std_err.map(|e| column_error(e, places(&biases))),
        relative: (g.reference.value != 0.0).then(|| minus(&signed_percent(g.bias.value / g.reference.value))),
        share: g.share.as_ref().map(share),
        worst: g.worst,
        worst_patch: level.patch(record, g.worst),
        worst_difference: minus(&columns[3][k]),
    };
    GroupTable {
        title,
        noun,
        receivers: level.nouns(),
        receiver: level.noun(),
        rows: shown.iter().enumerate().map(row).collect(),
        more: more(noun, &groups[shown.len()..]),
        only_noise: groups.iter().all(|g| g.share.is_none() && g.bias.std_err.is_some()),
    }
}

fn more(noun: &str, left: &[GroupError]) -> Option<String> {
    if left.is_empty() {
        return None;
    }
    let (noun, s) = (noun.to_lowercase(), if left.len() == 1 { "" } else { "s" });
    let share: Option<f64> = left.iter().map(|g| g.share.map(|s| s.value)).sum();
    let holding = share.map_or(String::new(), |s| format!(" with {} of the squared error", percent(s)));
    Some(minus(&format!("{} more {noun}{s}{holding}: all of them are in record.json.", count(left.len()))))
}

fn share(e: &crate::stats::Estimate) -> Share {
    let shown = percent_estimate(e, false);
    let place = |x: f64| 100.0 * x.clamp(0.0, 1.0);
    let text = |x: f64| format!("{x:.1}");
    Share {
        value: minus(&shown.value),
        interval: shown.interval.map(|i| minus(&i)),
        at: text(place(e.value)),
        low: text(place(e.low)),
        width: text(place(e.high) - place(e.low)),
    }
}

fn signed_percent(x: f64) -> String {
    format!("{}{}", if x > 0.0 { "+" } else { "" }, percent(x))
}
