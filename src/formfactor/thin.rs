//! Polygons too thin or too small for the contour integral: Lambert's formula integrated over the smaller one. All
//! terms are positive, so nothing cancels.

use super::edge::Edge;
use super::far::Shape;
use super::gauss::{Singularity, integrate, panel};
use super::lambert::contour_sum;
use crate::math::DVec3;
use std::f64::consts::PI;

/// Aim as a share of the polygon's area: the error of its form factor.
const TOLERANCE: f64 = 1e-14;

/// Halvings at most of a strip; the factor is bounded, so that what is left is below rounding.
const DEEPEST: usize = 45;

/// Points across a strip.
const ACROSS: usize = 10;

/// Exchange `A_a F_ab` of two polygons, each wholly in front of the other, integrated over `a`.
pub(super) fn exchange(a: &Shape, b: &Shape) -> f64 {
    let Some(longest) = a.edges.iter().max_by(|e, f| e.length.total_cmp(&f.length)) else { return 0.0 };
    let across = a.normal.cross(longest.direction);
    let height = |p: &DVec3| (*p - longest.from).dot(across);
    let top = a.polygon.iter().map(height).fold(0.0, f64::max);
    let mut cuts: Vec<f64> = a.polygon.iter().chain(b.polygon).map(height).map(|v| v.clamp(0.0, top)).collect();
    cuts.sort_by(f64::total_cmp);
    let chord = |v: f64| across_polygon(a, longest.from + across * v, longest.direction);
    let along = |v: f64| chord(v).map_or(0.0, |c| along_chord(&c, a.normal, &b.edges));
    let strips = cuts.windows(2).filter(|w| w[1] > w[0]);
    let tolerance = TOLERANCE * a.area;
    let whole = |w: &[f64]| halved(w[0], w[1], panel(w[0], w[1], ACROSS, &along), tolerance, DEEPEST, &along);
    strips.map(whole).sum::<f64>() / (2.0 * PI)
}

/// Halves until two halves agree with the whole.
fn halved(lo: f64, hi: f64, whole: f64, tolerance: f64, depth: usize, f: &impl Fn(f64) -> f64) -> f64 {
    let mid = 0.5 * (lo + hi);
    let (left, right) = (panel(lo, mid, ACROSS, f), panel(mid, hi, ACROSS, f));
    if depth == 0 || (left + right - whole).abs() <= tolerance || mid <= lo || mid >= hi {
        return left + right;
    }
    halved(lo, mid, left, tolerance, depth - 1, f) + halved(mid, hi, right, tolerance, depth - 1, f)
}

/// The part of the line `through + s direction` inside a convex polygon.
fn across_polygon(a: &Shape, through: DVec3, direction: DVec3) -> Option<Edge> {
    let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
    for e in &a.edges {
        let inward = a.normal.cross(e.direction);
        let (depth, slope) = ((through - e.from).dot(inward), direction.dot(inward));
        if slope > 1e-15 {
            lo = lo.max(-depth / slope);
        } else if slope < -1e-15 {
            hi = hi.min(-depth / slope);
        }
    }
    (lo < hi && lo.is_finite() && hi.is_finite())
        .then(|| Edge::between(through + direction * lo, through + direction * hi))?
}

/// Lambert's sum integrated along a chord.
fn along_chord(chord: &Edge, normal: DVec3, edges: &[Edge]) -> f64 {
    let of_edge = |e: &Edge| {
        let (places, count) = chord.singularities(e);
        places.into_iter().take(count)
    };
    let singular: Vec<Singularity> = edges.iter().flat_map(of_edge).collect();
    integrate(0.0, chord.length, &singular, TOLERANCE * chord.length, &|s| contour_sum(chord.at(s), normal, edges))
}
