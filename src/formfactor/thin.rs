//! Polygons too thin or too small for the contour integral: Lambert's formula integrated over the smaller one. All
//! terms are positive, so nothing cancels.

use super::edge::Edge;
use super::far::Shape;
use super::gauss::{Singularity, integrate, panel};
use super::lambert::contour_sum;
use crate::math::DVec3;
use std::cell::Cell;
use std::f64::consts::PI;

/// Two halves and the whole may differ by this share of the area, or of the value; the halves then err by much less.
const TOLERANCE: f64 = 1e-13;

/// Shortest panel as a share of the chord. The factor is bounded, so that it can do no more than this on it.
const FLOOR: f64 = 1e-14;

/// Halvings at most across a triangle: some hundred suffice but where rounding makes the integrand rough.
const MOST_HALVINGS: usize = 1000;

/// Points across a strip.
const ACROSS: usize = 10;

/// Exchange of the polygon `a`, of which only what is in front of the plane of `b` counts, with `b`, wholly in front
/// of `a`. `normal` is that of `a`.
pub(super) fn exchange(a: &[DVec3], normal: DVec3, b: &Shape) -> f64 {
    let fan = a[1..].windows(2).map(|w| over_triangle([a[0], w[0], w[1]], normal, b));
    fan.sum::<f64>() / (2.0 * PI)
}

/// Lambert's sum integrated over a triangle: along chords parallel to the longest side, then from the apex to that
/// side. Chords end on the sides exactly, however thin the triangle is.
fn over_triangle(corners: [DVec3; 3], normal: DVec3, b: &Shape) -> f64 {
    let [p, q, r] = corners;
    let twice = (q - p).cross(r - p).dot(normal);
    let turned = [[p, q, r], [q, r, p], [r, p, q]];
    let base = |t: &[DVec3; 3]| t[1].distance_squared(t[2]);
    let [apex, left, right] = turned.into_iter().max_by(|s, t| base(s).total_cmp(&base(t))).unwrap_or(corners);
    if twice <= 0.0 {
        return 0.0;
    }
    let along = |t: f64| {
        let chord = Edge::between(apex.lerp(left, t), apex.lerp(right, t));
        chord.map_or(0.0, |c| twice * t * mean_along(&c, normal, b))
    };
    let tolerance = TOLERANCE * twice;
    let left_over = Cell::new(MOST_HALVINGS);
    let strip = |w: &[f64]| halved(w[0], w[1], panel(w[0], w[1], ACROSS, &along), tolerance, &left_over, &along);
    cuts([apex, left, right], normal, b).windows(2).filter(|w| w[1] > w[0]).map(strip).sum()
}

/// Where, between apex (0) and base (1), the mean along the chord bends: beside the vertices of `b`, and where its
/// edges or its plane cross the sides.
fn cuts(triangle: [DVec3; 3], normal: DVec3, b: &Shape) -> Vec<f64> {
    let [apex, left, right] = triangle;
    let up = normal.cross(right - left);
    let at = |p: DVec3| ((p - apex).dot(up) / (left - apex).dot(up)).clamp(0.0, 1.0);
    let sides = [Edge::between(apex, left), Edge::between(apex, right)];
    let crossings = sides.iter().flatten().flat_map(|side| {
        let of_edge = move |e: &Edge| {
            let (places, count) = side.singularities(e);
            (count == 3).then(|| side.at(places[2].at))
        };
        b.edges.iter().filter_map(of_edge)
    });
    let on_plane = |end: DVec3| (height(apex, b) / (height(apex, b) - height(end, b))).clamp(0.0, 1.0);
    let fixed = [0.0, 1.0, on_plane(left), on_plane(right)];
    let mut out: Vec<f64> = b.polygon.iter().copied().chain(crossings).map(at).chain(fixed).collect();
    out.retain(|t| !t.is_nan());
    out.sort_by(f64::total_cmp);
    out
}

/// Halves until two halves agree with the whole.
fn halved(lo: f64, hi: f64, whole: f64, tolerance: f64, left_over: &Cell<usize>, f: &impl Fn(f64) -> f64) -> f64 {
    let mid = 0.5 * (lo + hi);
    let (left, right) = (panel(lo, mid, ACROSS, f), panel(mid, hi, ACROSS, f));
    if left_over.get() == 0 || (left + right - whole).abs() <= tolerance + TOLERANCE * whole.abs() {
        return left + right;
    }
    left_over.set(left_over.get() - 1);
    halved(lo, mid, left, tolerance, left_over, f) + halved(mid, hi, right, tolerance, left_over, f)
}

/// Height of a point above the plane of a polygon.
fn height(p: DVec3, b: &Shape) -> f64 {
    (p - b.centre).dot(b.normal)
}

/// Mean of Lambert's sum along a chord, 0 where it runs behind the plane of `b`.
fn mean_along(chord: &Edge, normal: DVec3, b: &Shape) -> f64 {
    let (from, to) = (height(chord.from, b), height(chord.to, b));
    let crossing = chord.length * (from / (from - to)).clamp(0.0, 1.0);
    let (lo, hi) = match (from > 0.0, to > 0.0) {
        (true, true) => (0.0, chord.length),
        (true, false) => (0.0, crossing),
        (false, true) => (crossing, chord.length),
        (false, false) => return 0.0,
    };
    let of_edge = |e: &Edge| {
        let (places, count) = chord.singularities(e);
        places.into_iter().take(count)
    };
    let singular: Vec<Singularity> = b.edges.iter().flat_map(of_edge).collect();
    let sum = |s: f64| contour_sum(chord.at(s), normal, &b.edges);
    integrate(lo, hi, &singular, FLOOR * chord.length, &sum) / chord.length
}
