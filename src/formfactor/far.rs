//! Polygons far apart: Gauss points on both, or on one with Lambert's formula to the other, with a proven bound.
//!
//! The integrand `cos cos / (pi r^2)` around the centres is a power series in the displacement w: `|c + w|^-4` is a
//! series of Gegenbauer polynomials whose k-th is at most `(k+3 over 3)`, and the cosines bring in two powers more. With
//! `q = |w| / |c|` the terms of degree k are at most `T_k q^k / (pi |c|^2)`. A rule with positive weights that is exact
//! to degree m errs by at most twice what lies beyond, so a form factor by `2 A_b / (pi D^2) sum over k > m of T_k q^k`.

use super::edge::Edge;
use super::gauss::rule;
use super::lambert::contour_sum;
use crate::math::{DVec3, area, centroid, unit_normal};
use std::f64::consts::PI;

/// Bound aimed at, relative to the estimate from the centres.
const RELATIVE: f64 = 1e-11;

/// Bound aimed at, absolute.
const ABSOLUTE: f64 = 1e-14;

/// Cosines below this count as this in the relative bound: edge-on pairs do not ask for more than there is.
const LEAST_COSINES: f64 = 1e-2;

/// Most points per axis, both polygons sampled.
const MOST_BOTH: usize = 5;

/// Most points per axis, one polygon sampled: what is faster than the contour integral, and what is worth its digits.
const FEW_ONE: usize = 4;
const MOST_ONE: usize = 12;

/// A polygon with what the rules ask about it.
pub(super) struct Shape<'a> {
    /// Vertices.
    pub polygon: &'a [DVec3],
    /// Edges.
    pub edges: Vec<Edge>,
    /// Unit normal on the front.
    pub normal: DVec3,
    /// Area.
    pub area: f64,
    /// Centre of area.
    pub centre: DVec3,
    /// Largest distance of a vertex from the centre.
    pub radius: f64,
}

impl<'a> Shape<'a> {
    /// Measures a polygon.
    pub fn of(polygon: &'a [DVec3]) -> Self {
        let centre = centroid(polygon);
        Self {
            polygon,
            edges: Edge::around(polygon),
            normal: unit_normal(polygon),
            area: area(polygon),
            centre,
            radius: polygon.iter().map(|p| p.distance(centre)).fold(0.0, f64::max),
        }
    }

    /// Distance of a point from the polygon.
    fn distance(&self, p: DVec3) -> f64 {
        let outside = |e: &Edge| (p - e.from).dot(self.normal.cross(e.direction)) < 0.0;
        if !self.edges.iter().any(outside) {
            return (p - self.polygon[0]).dot(self.normal).abs();
        }
        let to_edge = |e: &Edge| p.distance(e.at((p - e.from).dot(e.direction).clamp(0.0, e.length)));
        self.edges.iter().map(to_edge).fold(f64::INFINITY, f64::min)
    }

    /// Gauss points of n per axis with their areas, and the degree to which they are exact.
    fn points(&self, n: usize) -> Vec<(DVec3, f64)> {
        let p = self.polygon;
        let pieces = if self.is_parallelogram() { 1 } else { p.len() - 2 };
        let mut out = Vec::with_capacity(pieces * n * n);
        if self.is_parallelogram() {
            let (u, v) = (p[1] - p[0], p[3] - p[0]);
            for ((x, wx), (y, wy)) in pairs(n) {
                out.push((p[0] + u * x + v * y, wx * wy * self.area));
            }
            return out;
        }
        for w in p[1..].windows(2) {
            let (u, v) = (w[0] - p[0], w[1] - p[0]);
            let twice = u.cross(v).dot(self.normal);
            for ((x, wx), (y, wy)) in pairs(n) {
                out.push((p[0] + (u * (1.0 - y) + v * y) * x, wx * wy * x * twice));
            }
        }
        out
    }

    fn is_parallelogram(&self) -> bool {
        let p = self.polygon;
        p.len() == 4 && (p[0] - p[1] + p[2] - p[3]).length() <= 1e-15 * self.radius
    }

    /// Degree to which `points(n)` are exact: triangles lose one power to the collapsed side.
    fn degree(&self, n: usize) -> usize {
        if self.is_parallelogram() { 2 * n - 1 } else { 2 * n - 2 }
    }
}

/// Pairs of Gauss points on the unit square.
fn pairs(n: usize) -> impl Iterator<Item = ((f64, f64), (f64, f64))> {
    let unit = |(x, w): &(f64, f64)| (0.5 + 0.5 * x, 0.5 * w);
    rule(n).iter().flat_map(move |x| rule(n).iter().map(move |y| (unit(x), unit(y))))
}

/// Exchange `A_a F_ab` of two polygons, each wholly in front of the other, if a few points meet the bound.
pub(super) fn exchange(a: &Shape, b: &Shape) -> Option<f64> {
    both_sampled(a, b).or_else(|| exchange_by(a, b, FEW_ONE))
}

/// The same with more points than the contour integral costs: it keeps more digits.
pub(super) fn exchange_slowly(a: &Shape, b: &Shape) -> Option<f64> {
    exchange_by(a, b, MOST_ONE)
}

fn exchange_by(a: &Shape, b: &Shape, most: usize) -> Option<f64> {
    one_sampled(a, b, most).or_else(|| one_sampled(b, a, most))
}

fn both_sampled(a: &Shape, b: &Shape) -> Option<f64> {
    let apart = a.centre.distance(b.centre);
    let enough = |n: usize| {
        let degree = a.degree(n).min(b.degree(n));
        is_enough(a, b, (a.radius + b.radius) / apart, degree, apart)
    };
    let n = (1..=MOST_BOTH).find(|n| enough(*n))?;
    let there = b.points(n);
    let from = |x: DVec3| {
        let kernel = |(y, w): &(DVec3, f64)| {
            let r = *y - x;
            let squared = r.length_squared();
            w * (r.dot(a.normal) * -r.dot(b.normal)).max(0.0) / (squared * squared)
        };
        there.iter().map(kernel).sum::<f64>()
    };
    Some(a.points(n).iter().map(|(x, w)| w * from(*x)).sum::<f64>() / PI)
}

fn one_sampled(a: &Shape, b: &Shape, most: usize) -> Option<f64> {
    let apart = b.distance(a.centre);
    let n = (2..=most).find(|n| is_enough(a, b, a.radius / apart, a.degree(*n), apart))?;
    Some(a.points(n).iter().map(|(x, w)| w * contour_sum(*x, a.normal, &b.edges)).sum::<f64>() / (2.0 * PI))
}

/// Whether the bound of this module is met.
fn is_enough(a: &Shape, b: &Shape, q: f64, degree: usize, apart: f64) -> bool {
    let line = (b.centre - a.centre).normalize_or_zero();
    let cosines = (line.dot(a.normal) * -line.dot(b.normal)).max(LEAST_COSINES);
    let missed = 2.0 * beyond(q, degree);
    let larger = a.area.max(b.area) / (PI * apart * apart);
    missed <= RELATIVE * cosines && missed * larger <= ABSOLUTE
}

/// `sum over k > m of T_k q^k`, from above; infinite where the series does not shrink at once.
fn beyond(q: f64, m: usize) -> f64 {
    let choose = |k: f64| k * (k - 1.0) * (k - 2.0) / 6.0;
    let term = |k: usize| choose(k as f64 + 3.0) + 2.0 * choose(k as f64 + 2.0) + choose(k as f64 + 1.0);
    let ratio = q * term(m + 2) / term(m + 1);
    if ratio < 1.0 { term(m + 1) * q.powi(m as i32 + 1) / (1.0 - ratio) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_covers_the_series_of_the_worst_direction() {
        // Along one line the integrand is (1 + w)^-2: its part beyond degree m against the bound.
        for m in 1..12 {
            for q in [0.02f64, 0.1, 0.2] {
                let series: f64 = (m + 1..200).map(|k| (k + 1) as f64 * q.powi(k as i32)).sum();
                assert!(series <= beyond(q, m), "degree {m}, q {q}");
            }
        }
    }

    #[test]
    fn points_fill_the_area() {
        let p = [[0., 0.], [3., 0.], [4., 1.], [2., 5.], [0., 2.]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let shape = Shape::of(&p);
        let (mut sum, mut moment) = (0.0, DVec3::ZERO);
        for (x, w) in shape.points(3) {
            sum += w;
            moment += x * w;
        }
        assert!((sum - shape.area).abs() < 1e-13);
        assert!((moment / sum).distance(shape.centre) < 1e-14);
    }
}
