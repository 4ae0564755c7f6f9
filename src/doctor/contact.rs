//! Contact: what of each patch is covered by the front of something standing on it.

use super::text::{LISTED, digits, names, patches, percent, verb};
use crate::math::{area, centroid};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, Stage};
use std::collections::{BTreeMap, BTreeSet};

/// Covered patches of one surface.
#[derive(Default)]
struct Covered {
    /// Number, covered share, covered area.
    patches: Vec<(u32, f64, f64)>,
    partners: BTreeSet<u32>,
}

/// One finding for each surface that something stands on.
pub(super) fn findings(stage: &Stage) -> Vec<Finding> {
    let mut found: BTreeMap<u32, Covered> = BTreeMap::new();
    for (i, p) in (0..).zip(&stage.patches).filter(|(_, p)| !p.corners.is_empty()) {
        let whole = area(&p.corners);
        let covered = whole - p.area;
        if covered > 1e-9 * whole {
            let twins = &stage.facets[p.facet as usize].twins;
            let partners: Vec<u32> = twins.iter().copied().filter(|t| touches(stage, *t, &p.corners)).collect();
            // Without one it is covered by a face that looks the same way: an overlap, told elsewhere.
            if !partners.is_empty() {
                let entry = found.entry(p.surface).or_default();
                entry.patches.push((i, covered / whole, covered));
                entry.partners.extend(partners.iter().map(|t| stage.facets[*t as usize].surface));
            }
        }
    }
    // What is covered wholly stands on something that is told already, unless that is covered wholly too.
    let whole: BTreeSet<u32> =
        found.iter().filter(|(_, c)| c.patches.iter().all(|p| p.1 > 1.0 - 1e-9)).map(|(s, _)| *s).collect();
    let told = |s: u32, c: &Covered| {
        !whole.contains(&s) || c.partners.iter().all(|p| whole.contains(p) && s < *p || !found.contains_key(p))
    };
    found.iter().filter(|(s, c)| told(**s, c)).map(|(s, c)| finding(stage, *s, c)).collect()
}

/// True if a facet reaches over some of a polygon in its plane.
fn touches(stage: &Stage, facet: u32, polygon: &[crate::math::DVec3]) -> bool {
    let common = crate::math::intersect_convex(polygon, &stage.facets[facet as usize].vertices);
    common.len() > 2 && area(&common) > 1e-9 * area(polygon)
}

fn finding(stage: &Stage, surface: u32, covered: &Covered) -> Finding {
    let mut list = covered.patches.clone();
    list.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let numbers: Vec<u32> = list.iter().map(|l| l.0).collect();
    let total: f64 = list.iter().map(|l| l.2).sum();
    let of_surface = stage.patches.iter().filter(|p| p.surface == surface && !p.corners.is_empty());
    let share = total / of_surface.map(|p| area(&p.corners)).sum::<f64>();
    let wholly = list.iter().filter(|l| l.1 > 1.0 - 1e-9).count();
    let name = &stage.surfaces[surface as usize].name;
    let partners: Vec<&str> = covered.partners.iter().map(|s| stage.surfaces[*s as usize].name.as_str()).collect();
    let by = if partners.is_empty() { String::new() } else { format!(" by {}", names(&partners)) };
    let mut surfaces = vec![name.clone()];
    surfaces.extend(partners.iter().map(|p| p.to_string()));
    Finding {
        kind: FindingKind::Contact,
        severity: Severity::Note,
        place: Place {
            surfaces,
            patches: numbers.iter().copied().take(LISTED).collect(),
            values: list.iter().map(|l| l.1).take(LISTED).collect(),
            point: Some(centroid(&stage.patches[numbers[0] as usize].corners).to_array()),
        },
        what: format!(
            "{} of \"{name}\" {} covered{by}, {wholly} of them wholly (patch {}: {})",
            patches(&numbers),
            verb(numbers.len(), "is", "are"),
            numbers[0],
            percent(list[0].1)
        ),
        consequence: Some(Consequence {
            text: format!("{} m² take no part: {} of the area of \"{name}\"", digits(total), percent(share)),
            value: total,
            std_err: None,
            unit: "m^2".into(),
        }),
        mend: "none needed: covered areas are left out of form factors, means and metrics. A solver that keeps them \
               lights the underside of what stands there"
            .into(),
    }
}
