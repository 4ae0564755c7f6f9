//! Edges of polygons as oriented segments, and where the distance to them is singular along a line.

use super::gauss::Singularity;
use crate::math::DVec3;

/// Sine of the angle below which two edges count as parallel: a few roundings of a direction.
const PARALLEL: f64 = 4e-15;

/// Sine of the angle from which on the crossing of two lines is known to the digits it is used with. Edges clipped
/// along one line differ by rounding and cross anywhere.
const CLEARLY_CROSSING: f64 = 1e-3;

/// Distance of two lines below which they cross, for an extent near 1.
const TOUCHING: f64 = 1e-15;

/// Crossings further away than this many lengths of the shorter edge cost digits.
const FURTHEST_CROSSING: f64 = 8.0;

/// An oriented edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    /// First vertex.
    pub from: DVec3,
    /// Last vertex.
    pub to: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Length, m.
    pub length: f64,
}

impl Edge {
    /// The edge between two different points.
    pub fn between(from: DVec3, to: DVec3) -> Option<Self> {
        let length = from.distance(to);
        (length > 0.0).then(|| Self { from, to, direction: (to - from) / length, length })
    }

    /// Edges of a loop; coinciding neighbours have none.
    pub fn around(polygon: &[DVec3]) -> Vec<Self> {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).filter_map(|(a, b)| Self::between(*a, *b)).collect()
    }

    /// The point at length s.
    pub fn at(&self, s: f64) -> DVec3 {
        self.from + self.direction * s
    }

    /// Whether the two edges have one direction, up to sign and rounding.
    pub fn is_parallel_to(&self, other: &Self) -> bool {
        self.direction.cross(other.direction).length() <= PARALLEL
    }

    /// Distance of a point from the line of this edge, measured from the nearer end.
    pub fn line_distance(&self, p: DVec3) -> f64 {
        let (a, b) = (p - self.from, p - self.to);
        let w = if a.length_squared() < b.length_squared() { a } else { b };
        (w - self.direction * w.dot(self.direction)).length()
    }

    /// Where, along this edge's line, integrals of functions of the distance to `other` are singular: beside its two
    /// ends, and beside the crossing of the lines if `other` reaches it.
    pub fn singularities(&self, other: &Self) -> ([Singularity; 3], usize) {
        let beside = |p: DVec3| Singularity { at: self.abscissa(p), off: self.line_distance(p) };
        let (first, last) = (beside(other.from), beside(other.to));
        match self.crossing(other) {
            Some(crossing) => ([first, last, crossing], 3),
            None => ([first, last, last], 2),
        }
    }

    /// Length along this edge of the foot of p, measured from the nearer end.
    fn abscissa(&self, p: DVec3) -> f64 {
        let (a, b) = (p - self.from, p - self.to);
        if a.length_squared() < b.length_squared() {
            a.dot(self.direction)
        } else {
            self.length + b.dot(self.direction)
        }
    }

    /// Where the lines of two edges cross, as abscissae of the first vertices from there, if they do to rounding and
    /// not too far away for the digits.
    pub fn lines_cross(&self, other: &Self) -> Option<(f64, f64)> {
        let normal = self.direction.cross(other.direction);
        let squared = normal.length_squared();
        let ends = [(self.from, other.from), (self.from, other.to), (self.to, other.from), (self.to, other.to)];
        let offset =
            ends.map(|(p, q)| q - p).into_iter().min_by(|v, w| v.length_squared().total_cmp(&w.length_squared()))?;
        if squared < CLEARLY_CROSSING * CLEARLY_CROSSING || offset.dot(normal).powi(2) > TOUCHING * TOUCHING * squared {
            return None;
        }
        // From the nearest ends: a common vertex is found exactly.
        let nearest = ends.iter().position(|(p, q)| *q - *p == offset)?;
        let s = if nearest < 2 { 0.0 } else { self.length } + offset.cross(other.direction).dot(normal) / squared;
        let t = if nearest % 2 == 0 { 0.0 } else { other.length } + offset.cross(self.direction).dot(normal) / squared;
        let arm = FURTHEST_CROSSING * self.length.min(other.length);
        (s.abs() <= arm + self.length && t.abs() <= arm + other.length).then_some((-s, -t))
    }

    /// The squared distance to the line of `other` is `gap^2 + sine^2 (s - at)^2`: its complex zeros.
    fn crossing(&self, other: &Self) -> Option<Singularity> {
        let normal = self.direction.cross(other.direction);
        let sine = normal.length();
        if sine <= PARALLEL {
            return None;
        }
        let offset = other.from - self.from;
        let squared = sine * sine;
        let there = offset.cross(self.direction).dot(normal) / squared;
        let at = offset.cross(other.direction).dot(normal) / squared;
        let off = offset.dot(normal).abs() / squared;
        (there >= 0.0 && there <= other.length).then_some(Singularity { at, off })
    }
}
