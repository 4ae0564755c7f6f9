//! Patches whose middle lies inside another object: where hemi-cubes leak.

use super::Patient;
use super::probe::{fraction, total};
use super::text::{LISTED, digits, names, patches, percent, surfaces_of, verb};
use super::winding::Turned;
use crate::estimate::{Emitter, patch_emitters};
use crate::math::{DVec3, area, intersect_convex, unit_normal};
use crate::raycast::{BACK, RayBatch, Tracer};
use crate::sampling::{cosine_hemisphere, sobol};
use crate::scene::{Consequence, Finding, FindingKind, Patch, Place, Severity, Stage};
use std::collections::{BTreeMap, BTreeSet};

/// Rays of the fan that looks around from a middle.
const FAN: usize = 64;

/// One finding for each surface with such patches.
pub(super) fn findings(patient: &Patient, turned: &Turned) -> Vec<Finding> {
    let stage = patient.stage;
    let tracer = patient.probe.tracer(stage);
    let emitters = patch_emitters(stage);
    let mut found: BTreeMap<(u32, Severity), (Vec<u32>, BTreeSet<u32>)> = BTreeMap::new();
    for (i, p) in stage.patches.iter().enumerate().filter(|(_, p)| p.is_present()) {
        let covered = is_covered(p);
        let around = match covered {
            true => covering(stage, p),
            false => {
                emitters[i].as_ref().filter(|_| sees_backs(patient, i)).and_then(|e| buried(&tracer, e, middle(p)))
            }
        };
        if let Some(facets) = around {
            // Contact is legal and handled; to reach into a body is neither.
            let severity = if covered { Severity::Note } else { Severity::Warning };
            let entry = found.entry((p.surface, severity)).or_default();
            entry.0.push(i as u32);
            entry.1.extend(facets);
        }
    }
    found
        .into_iter()
        .map(|(key, (list, around))| {
            let solid = |f: &u32| turned.bodies[turned.body_of[*f as usize] as usize].is_solid();
            let how = if key.1 == Severity::Note || around.iter().any(solid) { "inside" } else { "close behind" };
            finding(stage, key, (how, &list), &around)
        })
        .collect()
}

/// Mean of the corners of quadrilaterals and triangles: where hemi-cubes are put.
fn middle(p: &Patch) -> DVec3 {
    p.corners.iter().sum::<DVec3>() / p.corners.len() as f64
}

fn sees_backs(patient: &Patient, i: usize) -> bool {
    patient.probe.sent[i].as_ref().is_some_and(|s| s.backs.values().map(total).sum::<u64>() > 0)
}

/// True if the middle is not in the part that radiates.
fn is_covered(p: &Patch) -> bool {
    let m = middle(p);
    let holds = |piece: &Vec<DVec3>| {
        let n = unit_normal(piece);
        (0..piece.len()).all(|k| n.cross(piece[(k + 1) % piece.len()] - piece[k]).dot(m - piece[k]) >= -1e-12)
    };
    p.area < (1.0 - 1e-9) * area(&p.corners) && !p.region.pieces.iter().any(holds)
}

/// Facets that coincide with the patch at its middle.
fn covering(stage: &Stage, p: &Patch) -> Option<Vec<u32>> {
    let common = |t: &&u32| intersect_convex(&p.corners, &stage.facets[**t as usize].vertices).len() > 2;
    Some(stage.facets[p.facet as usize].twins.iter().filter(common).copied().collect())
}

/// Facets whose backs are seen from a place, if they are more than half of what is seen.
fn buried(tracer: &Tracer, emitter: &Emitter, place: DVec3) -> Option<Vec<u32>> {
    let mut rays = RayBatch::zeroed(FAN);
    rays.from = emitter.facet;
    for k in 0..FAN {
        let [s, t] = [0, 1].map(|d| fraction(sobol(k as u64, d), 0));
        rays.set(k, place, emitter.frame.to_world(cosine_hemisphere(s, t)));
    }
    let backs: Vec<u32> = tracer.look(&rays).iter().flatten().filter(|h| h.2 == BACK).map(|h| h.0).collect();
    (2 * backs.len() > FAN).then_some(backs)
}

fn finding(
    stage: &Stage,
    (surface, severity): (u32, Severity),
    (how, list): (&str, &[u32]),
    around: &BTreeSet<u32>,
) -> Finding {
    let name = &stage.surfaces[surface as usize].name;
    let what_around = surfaces_of(stage, around.iter().copied());
    let size: f64 = list.iter().map(|i| stage.patches[*i as usize].area).sum();
    let all: f64 = stage.areas().iter().sum();
    let inside = if what_around.is_empty() { how.into() } else { format!("{how} {}", names(&what_around)) };
    Finding {
        kind: FindingKind::BuriedCentre,
        severity,
        place: Place {
            surfaces: std::iter::once(name.clone()).chain(what_around.iter().cloned()).collect(),
            patches: list.iter().copied().take(LISTED).collect(),
            values: Vec::new(),
            point: Some(middle(&stage.patches[list[0] as usize]).to_array()),
        },
        what: format!(
            "the {} of {} of \"{name}\" {} {inside}",
            verb(list.len(), "middle", "middles"),
            patches(list),
            verb(list.len(), "lies", "lie")
        ),
        consequence: Some(Consequence {
            text: format!(
                "a hemi-cube put there sees black backs: {} m², {} of the scene's area, get its light",
                digits(size),
                percent(size / all)
            ),
            value: size / all,
            std_err: None,
            unit: "share".into(),
        }),
        mend: "divide the surface so that patches end where the object stands (patches, or a polygon of its own); ray \
               casting and our hemi-cubes start from the uncovered part"
            .into(),
    }
}
