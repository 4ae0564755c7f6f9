//! Polygon to polygon by the double contour integral `1/(2 pi) sum over edge pairs of (d . d') integral ln r ds ds'`.

use super::edge::Edge;
use super::gauss::{ellipse, integrate};
use crate::math::DVec3;
use std::cell::Cell;
use std::f64::consts::PI;

/// Shortest panel as a share of the edge: what a logarithm does on it is its square, below rounding.
const FLOOR: f64 = 1e-9;

/// Parallel edges closer than this ellipse take the closed form; further away its differences lose digits.
const CLOSED_FORM_WITHIN: f64 = 4.0;

/// An exchange with an estimate of its rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exchange {
    /// `A_a F_ab`, in squared units of length.
    pub value: f64,
    /// Rounding to be expected, same unit.
    pub rounding: f64,
}

/// Exchange `A_a F_ab = A_b F_ba` of two polygons, each wholly in front of the other. Lengths near 1 keep most digits.
pub(super) fn exchange(a: &[Edge], b: &[Edge]) -> Exchange {
    let (mut value, mut size) = (0.0, 0.0);
    for e in a {
        for f in b {
            let (pair, terms) = edge_pair(e, f);
            value += pair;
            size += terms;
        }
    }
    Exchange { value: value / (2.0 * PI), rounding: f64::EPSILON * size / (2.0 * PI) }
}

/// `(d . d') integral (ln r + 1) ds ds'` of two edges, and the sum of the absolute values it was made of. The 1 drops
/// out around closed contours.
fn edge_pair(e: &Edge, f: &Edge) -> (f64, f64) {
    let cosine = e.direction.dot(f.direction);
    if cosine.abs() < f64::EPSILON {
        return (0.0, 0.0);
    }
    let (places, count) = e.singularities(f);
    let singular = &places[..count];
    if e.is_parallel_to(f) && ellipse(0.0, e.length, singular) < CLOSED_FORM_WITHIN {
        return parallel_pair(e, f);
    }
    if let Some(pair) = coplanar_pair(e, f, cosine) {
        return pair;
    }
    let largest = Cell::new(0.0f64);
    let inner = |s: f64| {
        let (value, size) = log_potential(e, s, f);
        largest.set(largest.get().max(size));
        value
    };
    let outer = integrate(0.0, e.length, singular, FLOOR * e.length, &inner);
    (cosine * outer, (cosine * e.length * largest.get()).abs())
}

/// `integral (ln r + 1) dt` over the edge f from the point at s of e, and the size of its largest term.
fn log_potential(e: &Edge, s: f64, f: &Edge) -> (f64, f64) {
    let x = e.at(s);
    let (w0, w1) = (f.from - x, f.to - x);
    let (t0, t1) = (w0.dot(f.direction), w1.dot(f.direction));
    let (r0, r1) = (w0.length_squared(), w1.length_squared());
    let h = f.line_distance(x);
    let first = 0.5 * times_log(t0, r0);
    let last = 0.5 * times_log(t1, r1);
    let angle = (h * f.length).atan2(h * h + t0 * t1);
    (last - first + h * angle, first.abs().max(last.abs()).max(h * angle))
}

/// `t ln x`, with its limit 0 where both vanish.
fn times_log(t: f64, x: f64) -> f64 {
    if x > 0.0 { t * x.ln() } else { 0.0 }
}

/// The same for parallel edges: second antiderivatives at the four differences of the ends.
fn parallel_pair(e: &Edge, f: &Edge) -> (f64, f64) {
    // Distance of the lines, from the two ends that are nearest to each other.
    let h = f.line_distance(e.from).min(f.line_distance(e.to));
    let along = |p: DVec3, q: DVec3| second_antiderivative((p - q).dot(f.direction), h);
    let terms = [along(e.to, f.from), -along(e.from, f.from), -along(e.to, f.to), along(e.from, f.to)];
    (terms.iter().sum(), terms.iter().map(|t: &f64| t.abs()).sum())
}

/// The same for edges whose lines cross. With s and t measured from the crossing, `ln r` scales with both: Euler's
/// theorem takes the area integral to the rim, where it is the closed inner integral.
fn coplanar_pair(e: &Edge, f: &Edge, cosine: f64) -> Option<(f64, f64)> {
    let (s, t) = e.lines_cross(f)?;
    let ends = [
        (s + e.length, log_potential(e, e.length, f)),
        (-s, log_potential(e, 0.0, f)),
        (t + f.length, log_potential(f, f.length, e)),
        (-t, log_potential(f, 0.0, e)),
    ];
    let sum: f64 = ends.iter().map(|(arm, (value, _))| arm * value).sum();
    let size: f64 = ends.iter().map(|(arm, (_, size))| (arm * size).abs()).sum();
    Some((0.5 * cosine * (sum - e.length * f.length), (cosine * size).abs()))
}

/// K with `K'' = ln sqrt(u^2 + h^2) + 1` in u.
fn second_antiderivative(u: f64, h: f64) -> f64 {
    let turn = if h > 0.0 { u * h * (u / h).atan() } else { 0.0 };
    0.25 * times_log(u * u - h * h, u * u + h * h) + turn - 0.25 * u * u
}
