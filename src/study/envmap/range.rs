//! How far from its centre a map can be used, in the open: over all directions and normals.

use super::bench::{Bench, Probe};
use super::record::{At, Range};
use crate::audit::envmap::{Lobe, Station, within_reach};
use crate::scene::NO_FACET;
use crate::stats::Estimate;

/// Distances that are tried.
const STEPS: usize = 12;
/// The nearest and the farthest of them, as shares of the scene's diagonal.
const SPAN: [f64; 2] = [1.0 / 512.0, 0.5];
/// Places at each.
const PLACES: usize = 128;

pub(super) fn range(bench: &Bench, probe: &Probe) -> Range {
    let (lo, hi) = bench.bare.stage().bounds();
    let diagonal = (hi - lo).length();
    let step = (SPAN[1] / SPAN[0]).powf(1.0 / (STEPS - 1) as f64);
    let curve: Vec<At> = (0..STEPS)
        .map(|k| diagonal * SPAN[0] * step.powi(k as i32))
        .filter_map(|reach| at(bench, probe, reach))
        .collect();
    let stated = bench.request.stated;
    let crossing = |of: fn(&Estimate) -> f64| within(&curve, stated, of);
    Range {
        stated,
        within: crossing(|e| e.value),
        between: [crossing(|e| e.high), crossing(|e| e.low)],
        open: !curve.is_empty() && curve.iter().all(|a| a.parts.total.is_some_and(|e| e.value <= stated)),
        curve,
    }
}

fn at(bench: &Bench, probe: &Probe, reach: f64) -> Option<At> {
    let centre = probe.centre.point;
    let places = within_reach(&bench.bare, centre, reach, PLACES, bench.stream.child(1));
    let station = |place, normal| Station { place, axis: normal, horizon: Some(normal), facet: NO_FACET };
    let there: Vec<Station> = places.iter().map(|(p, n)| station(*p, *n)).collect();
    let here: Vec<Station> = places.iter().map(|(_, n)| station(centre, *n)).collect();
    let map: Vec<f64> = places.iter().map(|(_, n)| probe.irradiance(*n)).collect();
    let truth = bench.arrives(false, &there, Lobe::Cosine);
    let mut parts = bench.parts(&map, &bench.arrives(false, &here, Lobe::Cosine), &truth, &truth);
    // There is no object in this question.
    parts.occlusion = None;
    (!places.is_empty()).then_some(At { x: reach, parts })
}

/// Where the curve first rises above `stated`, between its points by logarithms of distance; the last distance where it
/// never does.
fn within(curve: &[At], stated: f64, of: fn(&Estimate) -> f64) -> Option<f64> {
    let y = |a: &At| a.parts.total.as_ref().map_or(f64::INFINITY, of);
    let first = curve.iter().position(|a| y(a) > stated);
    match first {
        None => curve.last().map(|a| a.x),
        Some(0) => None,
        Some(k) => {
            let (a, b) = (&curve[k - 1], &curve[k]);
            let share = if y(b).is_finite() { (stated - y(a)) / (y(b) - y(a)) } else { 0.0 };
            Some(a.x * (b.x / a.x).powf(share))
        }
    }
}
