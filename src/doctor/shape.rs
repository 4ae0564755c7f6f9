//! Sizes: units and slivers.

use super::text::{LISTED, metres, patches, verb};
use crate::math::{Bounds, area, diameter};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, Stage};
use std::collections::BTreeMap;

/// Rooms and buildings in metres have diagonals between these.
const USUAL: [f64; 2] = [0.05, 400.0];
/// Objects this many times smaller or larger than the next may be in another unit.
const LEAP: f64 = 90.0;
/// A patch narrower than this share of its length is a sliver.
const SLIVER: f64 = 0.01;

/// Sizes that look like another unit than metres.
pub(super) fn units(stage: &Stage) -> Vec<Finding> {
    let (lo, hi) = stage.bounds();
    let diagonal = lo.distance(hi);
    let mut findings = Vec::new();
    if !(USUAL[0]..=USUAL[1]).contains(&diagonal) {
        let guess = if diagonal > USUAL[1] { "millimetres (scale = 0.001)" } else { "kilometres, or the scale twice" };
        findings.push(Finding {
            kind: FindingKind::Units,
            severity: Severity::Warning,
            place: Place { point: Some(lo.midpoint(hi).to_array()), ..Place::default() },
            what: format!("the scene measures {} from corner to corner; is it in {guess}?", metres(diagonal)),
            consequence: Some(Consequence {
                text: "form factors and radiosities do not depend on the unit; areas, powers and max_edge do".into(),
                value: diagonal,
                std_err: None,
                unit: "m".into(),
            }),
            mend: "give the mesh a scale = (file units to metres), or leave it so if it is meant".into(),
        });
    }
    findings.extend(odd_object(stage));
    findings
}

/// The smallest or largest object, if it is far out of proportion to all others.
fn odd_object(stage: &Stage) -> Option<Finding> {
    let mut boxes: BTreeMap<&str, Bounds> = BTreeMap::new();
    for f in &stage.facets {
        let b = boxes.entry(stage.surfaces[f.surface as usize].object.as_str()).or_insert(Bounds::NOTHING);
        *b = b.joined(Bounds::of(&f.vertices));
    }
    let mut sizes: Vec<(f64, &str, Bounds)> = boxes.iter().map(|(n, b)| (b.lo.distance(b.hi), *n, *b)).collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(b.1)));
    let last = sizes.len().checked_sub(2)?;
    let (small, large) = (sizes[1].0 / sizes[0].0, sizes[last + 1].0 / sizes[last].0);
    let ((size, name, bounds), ratio, than) = match small >= large {
        true => (sizes[0], small, "smaller"),
        false => (sizes[last + 1], large, "larger"),
    };
    (ratio > LEAP).then(|| Finding {
        kind: FindingKind::Units,
        severity: Severity::Warning,
        place: Place {
            surfaces: stage.surfaces.iter().filter(|s| s.object == name).map(|s| s.name.clone()).collect(),
            point: Some(bounds.lo.midpoint(bounds.hi).to_array()),
            ..Place::default()
        },
        what: format!("the object \"{name}\" ({}) is {ratio:.0} times {than} than the next one", metres(size)),
        consequence: Some(Consequence {
            text: format!("a ratio of {ratio:.0}: is one of them in another unit?"),
            value: ratio,
            std_err: None,
            unit: "ratio".into(),
        }),
        mend: "check scale = of its mesh, or leave it so if it is meant".into(),
    })
}

/// Widths are told in steps of this, metres.
const SLIVER_UNIT: f64 = 1e-9;

/// Needles among the patches: one finding for each surface that has some.
pub(super) fn slivers(stage: &Stage) -> Vec<Finding> {
    let mut found: BTreeMap<u32, Vec<(u32, f64)>> = BTreeMap::new();
    for (i, p) in (0..).zip(&stage.patches).filter(|(_, p)| p.is_present()) {
        let length = diameter(&p.corners);
        // To nine digits, so that equal strips stay in order.
        let width = (area(&p.corners) / length / SLIVER_UNIT).round() * SLIVER_UNIT;
        if width < SLIVER * length {
            found.entry(p.surface).or_default().push((i, width));
        }
    }
    found.into_iter().map(|(surface, list)| sliver(stage, surface, list)).collect()
}

fn sliver(stage: &Stage, surface: u32, mut list: Vec<(u32, f64)>) -> Finding {
    list.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let numbers: Vec<u32> = list.iter().map(|l| l.0).collect();
    let (worst, width) = list[0];
    let name = &stage.surfaces[surface as usize].name;
    let corners = &stage.patches[worst as usize].corners;
    Finding {
        kind: FindingKind::Sliver,
        severity: Severity::Warning,
        place: Place {
            surfaces: vec![name.clone()],
            patches: numbers.iter().copied().take(LISTED).collect(),
            values: list.iter().map(|l| l.1).take(LISTED).collect(),
            point: Some(crate::math::centroid(corners).to_array()),
        },
        what: format!(
            "{} of \"{name}\" {} more than 100 times longer than wide ({worst}: {} by {})",
            patches(&numbers),
            verb(numbers.len(), "is", "are"),
            metres(diameter(corners)),
            metres(width)
        ),
        // On the axis of a hemi-cube of resolution 100 a pixel measures 2/100 of the distance.
        consequence: Some(Consequence {
            text: format!(
                "a hemi-cube of resolution 100 sees it or misses it by chance from farther than {}",
                metres(50.0 * width)
            ),
            value: width,
            std_err: None,
            unit: "m".into(),
        }),
        mend: "divide the face across (patches, max_edge), or join it with its neighbour".into(),
    }
}
