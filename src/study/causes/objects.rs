//! Objects that are missing, or that cast no shadow.

use super::case::Case;
use super::jury::{Hypothesis, Jury};
use super::quick::{Quick, spread_in};
use crate::raycast::{Tracer, open_kernels};
use crate::scene::{Facet, NO_FACET, Region, Stage};
use crate::solution::FormFactors;
use crate::solver::Transport;
use std::collections::BTreeSet;

/// An object of more than this share of the area is the scene itself.
const MOST_AREA: f64 = 0.5;

pub(super) fn hear(jury: &mut Jury, quick: &Quick) {
    let case = jury.case;
    // Point lights have shadows of their own, which no matrix holds.
    if !case.stage.lights.is_empty() {
        return;
    }
    let objects = worth_it(case, quick);
    let cut = if objects.left_out > 0 {
        format!(" (of the objects, the {} that cover least were not tried)", objects.left_out)
    } else {
        String::new()
    };
    for object in &objects.tried {
        let Some(world) = Without::new(quick, object) else { continue };
        if let Some(change) = world.gone(quick) {
            let sentence = format!("object \"{object}\" is missing{cut}");
            say(jury, "missing-object", object, sentence, change);
        }
        if let Some(change) = world.transparent(quick) {
            let sentence = format!("object \"{object}\" casts no shadow, though it is lit{cut}");
            say(jury, "missing-occluder", object, sentence, change);
        }
    }
}

fn say(jury: &mut Jury, kind: &'static str, object: &str, sentence: String, change: Vec<f64>) {
    let place = Some(object.to_string());
    jury.hear(Hypothesis { family: "object", kind, place, parameters: 0, sentence, partly: true }, change);
}

struct Objects {
    tried: Vec<String>,
    left_out: usize,
}

/// Objects by how much of the view of all others they take.
fn worth_it(case: &Case, quick: &Quick) -> Objects {
    let name = |i: usize| &case.stage.surfaces[case.stage.patches[i].surface as usize].object;
    let names: BTreeSet<&String> = (0..case.areas.len()).filter(|i| case.areas[*i] > 0.0).map(name).collect();
    let total: f64 = case.areas.iter().sum();
    let area = |o: &String| (0..case.areas.len()).filter(|i| name(*i) == o).map(|i| case.areas[i]).sum::<f64>();
    let mut seen: Vec<f64> = vec![0.0; case.areas.len()];
    for i in 0..case.areas.len() {
        quick.matrix.row(i).for_each(|(j, f)| seen[j] += case.areas[i] * f);
    }
    let weight = |o: &String| (0..seen.len()).filter(|i| name(*i) == o).map(|i| seen[i]).sum::<f64>();
    let mut all: Vec<(&String, f64)> =
        names.into_iter().filter(|o| area(o) <= MOST_AREA * total).map(|o| (o, weight(o))).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(b.0)));
    let tried: Vec<String> = all.iter().take(quick.most_objects).map(|(o, _)| (*o).clone()).collect();
    Objects { left_out: all.len() - tried.len(), tried }
}

/// The scene without an object.
struct Without {
    /// Patches of the object.
    own: Vec<bool>,
    /// Rows of the patches that see the object; of all others those of the whole scene hold.
    matrix: FormFactors,
    /// Rows that are in `matrix`.
    cast: Vec<bool>,
}

impl Without {
    fn new(quick: &Quick, object: &str) -> Option<Self> {
        let base = quick.case.stage;
        let of = |surface: u32| base.surfaces[surface as usize].object == object;
        let own: Vec<bool> = base.patches.iter().map(|p| of(p.surface)).collect();
        let stage = without(base, &of);
        let sees = |i: usize| quick.matrix.row(i).any(|(j, _)| own[j]);
        let changed = |i: usize| stage.patches[i].region != base.patches[i].region;
        let cast: Vec<bool> = (0..own.len()).map(|i| !own[i] && (sees(i) || changed(i))).collect();
        let kernels = open_kernels(quick.session.kind(), &stage).ok()?;
        let tracer = Tracer::new(&stage, kernels.kernel, kernels.exact, quick.session.is_enclosure());
        let matrix = quick.matrix_in(&tracer, |i| cast[i]);
        Some(Self { own, matrix, cast })
    }

    /// What changes if the object is not there; its own patches are dark.
    fn gone(&self, quick: &Quick) -> Option<Vec<f64>> {
        self.change(quick, false)
    }

    /// What changes if the object is lit and lights, and all others see through it.
    fn transparent(&self, quick: &Quick) -> Option<Vec<f64>> {
        self.change(quick, true)
    }

    fn change(&self, quick: &Quick, stays: bool) -> Option<Vec<f64>> {
        let case = quick.case;
        let f = self.assembled(quick, stays);
        let mut arriving = vec![0.0; case.truth.len()];
        f.apply(&case.truth, case.bands, &mut arriving);
        let before = quick.arriving(&case.truth);
        let goes = |k: usize| !stays && self.own[k / case.bands];
        let source: Vec<f64> = (0..case.truth.len())
            .map(|k| if goes(k) { -case.truth[k] } else { case.reflectance[k] * (arriving[k] - before[k]) })
            .collect();
        // Light that the object sent is already missing in what arrives: its own patches are taken out of the matrix.
        let reflectance: Vec<f64> =
            (0..case.truth.len()).map(|k| if goes(k) { 0.0 } else { case.reflectance[k] }).collect();
        spread_in(&f, &source, &reflectance, case.bands)
    }

    /// Rows without the object where it was seen, and with `stays` its own entries kept beside what is behind it.
    fn assembled(&self, quick: &Quick, stays: bool) -> FormFactors {
        let row = |i: usize| -> Vec<(u32, f64)> {
            let whole = || quick.matrix.row(i).map(|(j, f)| (j as u32, f));
            if self.own[i] {
                return if stays { whole().collect() } else { Vec::new() };
            }
            if !self.cast[i] {
                return whole().collect();
            }
            let mut row: Vec<(u32, f64)> = self.matrix.row(i).map(|(j, f)| (j as u32, f)).collect();
            if stays {
                row.extend(whole().filter(|(j, _)| self.own[*j as usize]));
                row.sort_unstable_by_key(|e| e.0);
            }
            row
        };
        FormFactors::from_exact_rows((0..self.own.len()).map(row).collect())
    }
}

/// The stage with the facets of some surfaces taken out. What they covered of others is whole again, unless something
/// else covers it too.
fn without(base: &Stage, gone: &dyn Fn(u32) -> bool) -> Stage {
    let mut number = vec![NO_FACET; base.facets.len()];
    let mut kept = Vec::new();
    for (old, facet) in base.facets.iter().enumerate().filter(|(_, f)| !gone(f.surface)) {
        number[old] = kept.len() as u32;
        kept.push((old, facet));
    }
    let twins = |f: &Facet| f.twins.iter().map(|t| number[*t as usize]).filter(|t| *t != NO_FACET).collect::<Vec<_>>();
    let mut stage = base.clone();
    stage.facets = kept.iter().map(|(_, f)| Facet { twins: twins(f), ..(*f).clone() }).collect();
    for patch in &mut stage.patches {
        let old = patch.facet;
        if old == NO_FACET {
            continue;
        }
        patch.facet = number[old as usize];
        if patch.facet == NO_FACET {
            (patch.area, patch.region) = (0.0, Region::default());
            patch.corners.clear();
            continue;
        }
        let uncovered = base.facets[old as usize].twins.len() > stage.facets[patch.facet as usize].twins.len();
        if uncovered && stage.facets[patch.facet as usize].twins.is_empty() {
            patch.region = Region::whole(patch.corners.clone());
            patch.area = patch.region.area();
        }
    }
    stage
}
