//! Where the view from a patch changes its structure: planes through a corner and an edge of what is seen.

use super::body::Body;
use super::geometry::{Plane, Vector, cross, length, plane_of, sub};

/// The trace of such a plane on the sending patch.
pub type Line = Plane;

/// An end point pair of an edge.
type Edge = (Vector, Vector);

/// False only where a plane proves that no segment from `from` to `to` meets the body.
pub fn in_shaft(from: &[Vector], to: &[Vector], body: &Body) -> bool {
    let ends = || from.iter().chain(to);
    let beyond = |p: &Plane| ends().all(|&c| p.height(c) >= -1e-13);
    if body.planes.iter().any(beyond) {
        return false;
    }
    let separates =
        |p: &Plane| ends().all(|&c| p.height(c) >= -1e-13) && body.corners.iter().all(|&c| p.height(c) <= 1e-13);
    for (polygon, other) in [(from, to), (to, from)] {
        for (a, b) in sides(polygon) {
            for &c in other {
                if let Some(plane) = through(c, (a, b))
                    && (separates(&plane) || separates(&plane.turned()))
                {
                    return false;
                }
            }
        }
    }
    ![plane_of(from), plane_of(to)].iter().any(separates)
}

/// All planes on whose trace in the sender the visible part of the receiver may have a kink, but for the curves on
/// which three skew edges meet: there the second derivative jumps, and the adaptive rule finds it.
pub fn kinks(from: &[Vector], to: &[Vector], bodies: &[Body]) -> Vec<Line> {
    let shaft = Shaft::new(from, to);
    let mut lines = Vec::new();
    let mut add = |corner: Vector, edge: Edge| {
        if let Some(plane) = through(corner, edge)
            && crosses(&plane, from)
            && shaft.admits(corner, edge)
        {
            lines.push(plane);
        }
    };
    for (k, body) in bodies.iter().enumerate() {
        for e in &body.edges {
            to.iter().for_each(|&c| add(c, (e.from, e.to)));
            for other in bodies.iter().enumerate().filter(|(m, _)| *m != k).map(|(_, b)| b) {
                other.corners.iter().for_each(|&c| add(c, (e.from, e.to)));
            }
        }
        for &c in &body.corners {
            sides(to).for_each(|side| add(c, side));
        }
    }
    lines.extend(bodies.iter().flat_map(|b| &b.planes).filter(|p| crosses(p, from)));
    lines
}

fn sides(polygon: &[Vector]) -> impl Iterator<Item = Edge> {
    (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]))
}

fn through(c: Vector, (a, b): Edge) -> Option<Plane> {
    let normal = cross(sub(a, c), sub(b, c));
    (length(normal) > 1e-12).then(|| plane_of(&[c, a, b]))
}

fn crosses(plane: &Plane, polygon: &[Vector]) -> bool {
    let heights = || polygon.iter().map(|&c| plane.height(c));
    heights().any(|h| h > 1e-11) && heights().any(|h| h < -1e-11)
}

/// The two polygons as their planes and, for each, the planes through its sides that bound it.
struct Shaft {
    ends: [(Plane, Vec<Plane>); 2],
}

impl Shaft {
    fn new(from: &[Vector], to: &[Vector]) -> Self {
        let bounded = |polygon: &[Vector]| {
            let plane = plane_of(polygon);
            let bound = |(a, b): Edge| {
                let normal = super::geometry::unit(cross(plane.normal, sub(b, a)));
                Plane { normal, offset: super::geometry::dot(normal, a) }
            };
            (plane, sides(polygon).map(bound).collect())
        };
        Self { ends: [bounded(from), bounded(to)] }
    }

    /// Whether some line through `c` and a point a + s (b - a) of the edge meets both polygons (never a false no).
    ///
    /// The point where it meets a plane with heights h has the heights (g(c) h(e) - g(e) h(c)) / (h(e) - h(c)) above a
    /// bounding plane g: numerator and denominator are linear in s.
    fn admits(&self, c: Vector, (a, b): Edge) -> bool {
        [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].iter().any(|signs| {
            let mut range = (0.0f64, 1.0f64);
            for ((plane, bounds), sign) in self.ends.iter().zip(signs) {
                let (hc, ha, hb) = (plane.height(c), plane.height(a), plane.height(b));
                keep(&mut range, sign * (ha - hc), sign * (hb - hc));
                for g in bounds {
                    let (gc, ga, gb) = (g.height(c), g.height(a), g.height(b));
                    keep(&mut range, sign * (gc * ha - ga * hc), sign * (gc * hb - gb * hc));
                }
            }
            range.0 <= range.1
        })
    }
}

/// Keeps those s for which the linear function with the given ends at 0 and 1 is not negative, with some room.
fn keep(range: &mut (f64, f64), at_0: f64, at_1: f64) {
    let (at_0, at_1) = (at_0 + 1e-10, at_1 + 1e-10);
    if at_0 < 0.0 && at_1 < 0.0 {
        *range = (1.0, 0.0);
    } else if at_0 < 0.0 {
        range.0 = range.0.max(at_0 / (at_0 - at_1));
    } else if at_1 < 0.0 {
        range.1 = range.1.min(at_0 / (at_0 - at_1));
    }
}
