//! What the scene doctor found, as rows.

use super::context::minus;
use crate::scene::{Finding, Severity};
use crate::study::Record;
use serde::Serialize;

/// Surfaces and patches named one by one.
const NAMED: usize = 6;

#[derive(Debug, Serialize)]
pub(super) struct FindingRow {
    pub kind: &'static str,
    pub severity: &'static str,
    /// What the template chooses the colour by.
    pub class: &'static str,
    pub place: String,
    pub what: String,
    pub consequence: Option<String>,
    pub mend: String,
}

pub(super) fn finding_rows(record: &Record) -> Vec<FindingRow> {
    record.findings.iter().map(row).collect()
}

fn row(f: &Finding) -> FindingRow {
    FindingRow {
        kind: f.kind.name(),
        severity: f.severity.name(),
        class: match f.severity {
            Severity::Note => "none",
            Severity::Warning => "open",
            Severity::Error => "fail",
        },
        place: place(f),
        what: minus(&f.what),
        consequence: f.consequence.as_ref().map(|c| minus(&c.text)),
        mend: f.mend.clone(),
    }
}

fn place(f: &Finding) -> String {
    let mut parts = Vec::new();
    if !f.place.surfaces.is_empty() {
        parts.push(listed("surface", &f.place.surfaces));
    }
    if !f.place.patches.is_empty() {
        parts.push(listed("patch", &f.place.patches));
    }
    parts.extend(f.place.point.map(|[x, y, z]| minus(&format!("at ({x:.3}, {y:.3}, {z:.3}) m"))));
    if parts.is_empty() { "the whole scene".into() } else { parts.join("; ") }
}

fn listed(noun: &str, all: &[impl ToString]) -> String {
    let named: Vec<String> = all.iter().take(NAMED).map(ToString::to_string).collect();
    let plural = match (all.len(), noun) {
        (1, _) => noun.to_string(),
        (_, "patch") => "patches".to_string(),
        _ => format!("{noun}s"),
    };
    let more = if all.len() > NAMED { format!(" and {} more", all.len() - NAMED) } else { String::new() };
    format!("{plural} {}{more}", named.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{FindingKind, Place};

    #[test]
    fn places_are_named_and_counted() {
        let mut f = Finding {
            kind: FindingKind::Gap,
            severity: Severity::Warning,
            place: Place {
                surfaces: vec!["wall".into()],
                patches: (0..9).collect(),
                point: Some([0.5, -1.0, 2.0]),
                ..Place::default()
            },
            what: String::new(),
            consequence: None,
            mend: String::new(),
        };
        let expected = "surface wall; patches 0, 1, 2, 3, 4, 5 and 3 more; at (0.500, \u{2212}1.000, 2.000) m";
        assert_eq!(row(&f).place, expected);
        f.place = Place::default();
        assert_eq!((row(&f).place.as_str(), row(&f).class), ("the whole scene", "open"));
    }
}
