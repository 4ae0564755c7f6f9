//! Gaps in what looks closed, and corners inside edges.

use super::Patient;
use super::opening::Opening;
use super::probe::{Hits, Sent};
use super::skin::Junction;
use super::text::{metres, names, percent, point, share, surfaces_of, verb};
use super::winding::{Turned, senders};
use crate::math::{area, intersect_convex};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, Stage};
use std::collections::BTreeMap;

/// A scene that loses more than this share of its light was meant to be open.
const OPEN: f64 = 0.25;
/// An opening that takes more than this share may well be meant.
const MEANT: f64 = 0.05;

/// One finding for each opening that light leaves through, and for each crack.
pub(super) fn findings(patient: &Patient, turned: &Turned) -> Vec<Finding> {
    let stage = patient.stage;
    let all = senders(patient, turned);
    let escaped = patient.probe.share(stage, &all, |s| s.escapes).mean;
    if stage.enclosure == Some(false) || (stage.enclosure.is_none() && escaped > OPEN) {
        return Vec::new();
    }
    let mut findings: Vec<Finding> = (0..patient.openings.len()).filter_map(|k| gap(patient, &all, k)).collect();
    if findings.is_empty() && escaped > 0.0 {
        findings.push(leak(patient, &all));
    }
    findings
}

fn through(k: usize) -> impl Fn(&Sent) -> Hits {
    move |s| s.openings.get(&k).copied().unwrap_or_default()
}

fn gap(patient: &Patient, all: &[usize], k: usize) -> Option<Finding> {
    let stage = patient.stage;
    let opening = &patient.openings[k];
    let lost = patient.probe.share(stage, all, through(k));
    if lost.mean == 0.0 && opening.crack.is_none() {
        return None;
    }
    let surfaces = surfaces_of(stage, opening.facets.iter().copied());
    let what = format!(
        "{} at {} between {}: {} of border joined to nothing",
        if opening.crack.is_some() { "a crack" } else { "a gap" },
        point(opening.centre),
        names(&surfaces),
        metres(opening.length)
    );
    Some(Finding {
        kind: FindingKind::Gap,
        severity: severity(stage, lost.mean),
        place: Place { surfaces, point: Some(opening.centre.to_array()), ..Place::default() },
        what: what + &size(opening),
        consequence: Some(match lost.mean > 0.0 {
            true => Consequence {
                text: leaving(patient, all, k) + &format!("; of all surfaces, {}", share(&lost)),
                value: lost.mean,
                std_err: lost.std_err(),
                unit: "share".into(),
            },
            false => unseen(patient, all),
        }),
        mend: "move the corners together or add the missing face; if the opening is meant, say enclosure = false"
            .into(),
    })
}

fn severity(stage: &Stage, lost: f64) -> Severity {
    match stage.enclosure {
        Some(true) => Severity::Error,
        _ if lost > MEANT => Severity::Note,
        _ => Severity::Warning,
    }
}

fn size(opening: &Opening) -> String {
    match opening.crack {
        Some(width) => format!(", up to {} wide", metres(width)),
        None => {
            let mut sides = opening.extent().to_array();
            sides.sort_by(f64::total_cmp);
            format!(", {} by {}", metres(sides[2]), metres(sides[1]))
        }
    }
}

/// "3.2 % of the light of "floor" leaves there": the surface that loses most.
fn leaving(patient: &Patient, all: &[usize], k: usize) -> String {
    let stage = patient.stage;
    let mut surfaces: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    all.iter().for_each(|i| surfaces.entry(stage.patches[*i].surface).or_default().push(*i));
    let shares = surfaces.iter().map(|(s, list)| (patient.probe.share(stage, list, through(k)), *s));
    let worst = shares.max_by(|a, b| a.0.mean.total_cmp(&b.0.mean).then(b.1.cmp(&a.1)));
    worst.map_or(String::new(), |(m, s)| {
        format!("{} of the light of \"{}\" leaves there", share(&m), stage.surfaces[s as usize].name)
    })
}

/// No ray found the crack: what that proves.
fn unseen(patient: &Patient, all: &[usize]) -> Consequence {
    let rays = patient.probe.rays_of(all);
    // Three expected hits are missed once in twenty times.
    let bound = 3.0 / rays.max(1) as f64;
    Consequence {
        text: format!("none of {rays} rays found it: less than {} of the light leaves there (95 %)", percent(bound)),
        value: bound,
        std_err: None,
        unit: "share".into(),
    }
}

/// Light leaves, and no edge is free: faces that cross, or an outline the edges do not show.
fn leak(patient: &Patient, all: &[usize]) -> Finding {
    let stage = patient.stage;
    let lost = patient.probe.share(stage, all, |s| s.escapes);
    Finding {
        kind: FindingKind::Gap,
        severity: severity(stage, lost.mean),
        place: Place::default(),
        what: "light leaves the scene although every edge is joined to something".into(),
        consequence: Some(Consequence {
            text: format!("{} of the light of all surfaces leaves", share(&lost)),
            value: lost.mean,
            std_err: lost.std_err(),
            unit: "share".into(),
        }),
        mend: "look for a part that stands outside; if the scene is meant to be open, say enclosure = false".into(),
    }
}

/// Corners where an edge is free beside them belong to a gap, corners of overlapping faces to the overlap.
fn is_told_here(patient: &Patient, j: &Junction) -> bool {
    let facets = &patient.stage.facets;
    let (a, b) = (&facets[j.edge_of as usize], &facets[j.corner_of as usize]);
    let common = intersect_convex(&a.vertices, &b.vertices);
    let overlap = a.normal.dot(b.normal) > 0.999 && common.len() > 2 && area(&common) > 1e-6 * area(&b.vertices);
    let near = 16.0 * patient.skin.tolerance;
    let gap = patient.skin.free.iter().any(|e| e.from.distance(j.point) < near || e.to.distance(j.point) < near);
    !overlap && !gap
}

/// All corners inside edges of others, in one finding.
pub(super) fn junctions(patient: &Patient) -> Option<Finding> {
    let stage = patient.stage;
    let list: Vec<&Junction> = patient.skin.junctions.iter().filter(|j| is_told_here(patient, j)).collect();
    let worst = list.iter().max_by(|a, b| a.off.total_cmp(&b.off).then(b.edge_of.cmp(&a.edge_of)))?;
    let mut places: Vec<[u64; 3]> = list.iter().map(|j| j.point.to_array().map(f64::to_bits)).collect();
    places.sort_unstable();
    places.dedup();
    let surfaces = surfaces_of(stage, list.iter().flat_map(|j| [j.edge_of, j.corner_of]));
    // What rounding of coordinates alone would make.
    let rounding = 1e-9 * patient.skin.diagonal;
    let count = places.len();
    Some(Finding {
        kind: FindingKind::TJunction,
        severity: if worst.off > rounding { Severity::Warning } else { Severity::Note },
        what: format!(
            "{count} {} inside edges of neighbours (of {}), such as {}",
            verb(count, "corner lies", "corners lie"),
            names(&surfaces),
            point(worst.point)
        ),
        place: Place { surfaces, point: Some(worst.point.to_array()), ..Place::default() },
        consequence: Some(Consequence {
            text: match worst.off > rounding {
                true => format!("cracks of up to {}; smoothed pictures break there", metres(worst.off)),
                false => "no crack beyond rounding; smoothed pictures break there".into(),
            },
            value: worst.off,
            std_err: None,
            unit: "m".into(),
        }),
        mend: "divide the long edge where the corner lies, if pictures or a solver that shares corners need it".into(),
    })
}
