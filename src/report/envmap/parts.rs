//! What the error of the irradiance is made of.

use crate::report::format::percent;
use crate::report::html::context::minus;
use crate::report::number::{Number, UNKNOWN, number};
use crate::stats::Estimate;
use crate::study::envmap::Parts;
use serde::Serialize;

/// One line of the table.
#[derive(Debug, Serialize)]
pub(super) struct PartRow {
    /// Class of its colour.
    pub class: &'static str,
    pub name: &'static str,
    pub meaning: &'static str,
    pub error: Number,
    /// Length of its bar, percent of the longest.
    pub length: String,
    /// Share of the squared whole.
    pub share: String,
}

/// Class, name, meaning.
const ROWS: [(&str, &str, &str); 4] = [
    ("c0", "Map", "texels, filter and table: the map against what arrives at its centre"),
    ("c1", "Parallax", "the place: what arrives at the centre against what arrives at the point"),
    ("c2", "Object", "what the object hides from the point, less what it sends there"),
    ("whole", "All together", "the map against what arrives at the point"),
];

/// Map, parallax, object and whole.
pub(super) fn errors(p: &Parts) -> [Option<&Estimate>; 4] {
    [&p.map, &p.parallax, &p.occlusion, &p.total].map(Option::as_ref)
}

/// Shares of map, parallax and object; they add up to 1, and where all are 0 nothing is known of them.
pub(super) fn shares(p: &Parts) -> [Option<f64>; 3] {
    let known = p.shares.iter().any(|s| *s != 0.0);
    p.shares.map(|s| known.then_some(s))
}

/// Signed; of no light there is none.
pub(super) fn bias(p: &Parts) -> Option<f64> {
    p.total.is_some().then_some(p.bias)
}

pub(super) fn rows(p: &Parts) -> Vec<PartRow> {
    let (errors, shares) = (errors(p), shares(p));
    let longest = errors.iter().flatten().map(|e| e.value).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let length = |e: Option<&Estimate>| match e {
        Some(e) if longest > 0.0 => format!("{:.2}", 100.0 * e.value / longest),
        _ => "0".into(),
    };
    let row = |(k, (class, name, meaning)): (usize, (&'static str, &'static str, &'static str))| PartRow {
        class,
        name,
        meaning,
        error: number(errors[k]),
        length: length(errors[k]),
        share: match shares.get(k) {
            Some(share) => share.map_or(UNKNOWN.into(), |s| minus(&percent(s))),
            None if shares[0].is_some() => "100\u{202f}%".into(),
            None => UNKNOWN.into(),
        },
    };
    ROWS.into_iter().enumerate().map(row).collect()
}
