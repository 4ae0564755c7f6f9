//! One obstructed form factor: the visible point-to-polygon factor integrated over the sending patch.
//!
//! The patch is swept by parallel lines. On each line the integrand is cut where it may have a kink; across the lines
//! the same is done where those cuts meet the rim of the patch or each other.

use super::body::{Body, Cone, Shadow};
use super::events::{Line, kinks};
use super::geometry::{Vector, along, area, cross, dot, in_front, plane_of, sub, unit};
use super::quadrature::{Integral, integrate};
use super::visible::{Outline, visible};

/// More crossings of kinks than this are left to the adaptive rule.
const MOST_CROSSINGS: usize = 60;

/// The form factor of `sender` to `receiver` with the opaque `bodies` between; error as a part of the same unit.
///
/// Both polygons are convex and one-sided; what lies behind the plane of the other does not count.
pub fn form_factor(sender: &[Vector], receiver: &[Vector], bodies: &[Body], tolerance: f64) -> Integral {
    let (front, facing) = (plane_of(sender), plane_of(receiver));
    let from = in_front(sender, &facing);
    let to = in_front(receiver, &front);
    if from.is_empty() || to.is_empty() {
        return Integral::default();
    }
    let between: Vec<Body> = bodies
        .iter()
        .filter_map(|b| b.in_front(&facing))
        .filter(|b| b.corners.iter().any(|&c| front.height(c) > 1e-12))
        .filter(|b| super::events::in_shaft(&from, &to, b))
        .collect();
    let sweep = Sweep::new(&from, front.normal, &kinks(&from, &to, &between));
    let mut cones: Vec<Cone> = Vec::with_capacity(between.len());
    let mut seen = |x: Vector| {
        cones.clear();
        for body in &between {
            match body.shadow(x) {
                Shadow::None => {}
                Shadow::Everything => return 0.0,
                Shadow::Cone(cone) => cones.push(cone),
            }
        }
        visible(&Outline::new(to.iter().map(|&c| sub(c, x))), &cones, front.normal)
    };
    let whole = area(sender);
    let sum = sweep.integrate(tolerance * whole, &mut seen);
    Integral { value: sum.value / whole, error: sum.error / whole }
}

/// A patch in coordinates (u, v) of its own plane, and the lines u, v on which the integrand may have a kink.
struct Sweep {
    origin: Vector,
    axes: [Vector; 2],
    corners: Vec<[f64; 2]>,
    lines: Vec<[f64; 3]>,
}

impl Sweep {
    fn new(patch: &[Vector], normal: Vector, kinks: &[Line]) -> Self {
        let origin = patch[0];
        let u = unit(sub(patch[1], patch[0]));
        let v = cross(normal, u);
        let corners = patch.iter().map(|&c| [dot(sub(c, origin), u), dot(sub(c, origin), v)]).collect();
        let mut lines: Vec<[f64; 3]> = Vec::new();
        for plane in kinks {
            let (a, b) = (dot(plane.normal, u), dot(plane.normal, v));
            let scale = a.hypot(b).copysign(if a.abs() > 1e-12 * b.abs() { a } else { b });
            let line = [a / scale, b / scale, plane.height(origin) / scale];
            let known = |l: &[f64; 3]| (0..3).all(|k| (l[k] - line[k]).abs() < 1e-10);
            if a.hypot(b) > 1e-10 && !lines.iter().any(known) {
                lines.push(line);
            }
        }
        Self { origin, axes: [u, v], corners, lines }
    }

    fn integrate(&self, tolerance: f64, f: &mut impl FnMut(Vector) -> f64) -> Integral {
        let outer = self.outer_breaks();
        let width = outer[outer.len() - 1] - outer[0];
        let mut inner_error = 0.0f64;
        let mut sum = integrate(&outer, tolerance, &mut |u: f64| {
            let breaks = self.inner_breaks(u);
            let line = integrate(&breaks, 0.05 * tolerance / width, &mut |v: f64| {
                f(along(along(self.origin, u, self.axes[0]), v, self.axes[1]))
            });
            inner_error = inner_error.max(line.error);
            line.value
        });
        sum.error += inner_error * width;
        sum
    }

    /// Where the line u crosses the patch, and the kinks on the way.
    fn inner_breaks(&self, u: f64) -> Vec<f64> {
        let mut rim: Vec<f64> = Vec::new();
        for (a, b) in self.sides() {
            if (a[0] - u) * (b[0] - u) < 0.0 {
                rim.push(a[1] + (u - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
            }
        }
        let low = rim.iter().copied().fold(f64::INFINITY, f64::min);
        let high = rim.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if low >= high {
            return Vec::new();
        }
        let cuts = self.lines.iter().filter(|l| l[1].abs() > 1e-12).map(|l| -(l[0] * u + l[2]) / l[1]);
        between(low, high, cuts)
    }

    /// The corners of the patch, where kinks meet its rim, and, unless there are too many, where kinks meet.
    fn outer_breaks(&self) -> Vec<f64> {
        let mut cuts: Vec<f64> = self.corners.iter().map(|c| c[0]).collect();
        let (low, high) = cuts.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |m, &c| (m.0.min(c), m.1.max(c)));
        for l in &self.lines {
            let height = |c: [f64; 2]| l[0] * c[0] + l[1] * c[1] + l[2];
            for (a, b) in self.sides().filter(|&(a, b)| height(a) * height(b) < 0.0) {
                cuts.push(a[0] + height(a) / (height(a) - height(b)) * (b[0] - a[0]));
            }
        }
        let crossings = self.crossings();
        if crossings.len() <= MOST_CROSSINGS {
            cuts.extend(crossings);
        }
        between(low, high, cuts.into_iter())
    }

    fn crossings(&self) -> Vec<f64> {
        let mut found = Vec::new();
        for (k, l) in self.lines.iter().enumerate() {
            for m in &self.lines[..k] {
                let d = l[0] * m[1] - l[1] * m[0];
                if d.abs() > 1e-9 {
                    let at = [(l[1] * m[2] - l[2] * m[1]) / d, (l[2] * m[0] - l[0] * m[2]) / d];
                    if self.holds(at) {
                        found.push(at[0]);
                    }
                }
            }
        }
        found.sort_by(f64::total_cmp);
        found.dedup_by(|a, b| (*a - *b).abs() < 1e-10);
        found
    }

    fn holds(&self, c: [f64; 2]) -> bool {
        self.sides().all(|(a, b)| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) >= 0.0)
    }

    fn sides(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let n = self.corners.len();
        (0..n).map(move |k| (self.corners[k], self.corners[(k + 1) % n]))
    }
}

/// `low`, the cuts strictly between in ascending order, each once, and `high`.
fn between(low: f64, high: f64, cuts: impl Iterator<Item = f64>) -> Vec<f64> {
    let gap = 1e-12 * (high - low).max(1e-3);
    let mut all: Vec<f64> = cuts.filter(|&c| c > low + gap && c < high - gap).collect();
    all.extend([low, high]);
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < gap);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [Vector; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    const CEILING: [Vector; 4] = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    const WALL: [Vector; 4] = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]];

    #[test]
    fn the_faces_of_a_cube_are_the_published_values() {
        let opposed = form_factor(&FLOOR, &CEILING, &[], 1e-13);
        assert!((opposed.value - 0.199_824_895_698_387_38).abs() < 1e-13, "{opposed:?}");
        let touching = form_factor(&FLOOR, &WALL, &[], 1e-13);
        assert!((touching.value - (1.0 - 0.199_824_895_698_387_38) / 4.0).abs() < 1e-12, "{touching:?}");
    }

    #[test]
    fn a_tilted_plate_hides_as_much_from_either_side() {
        let plate = Body::plate(&[[0.2, 0.3, 0.3], [0.8, 0.2, 0.5], [0.7, 0.8, 0.7]].map(|c| c));
        let there = form_factor(&FLOOR, &CEILING, std::slice::from_ref(&plate), 1e-11);
        let back = form_factor(&CEILING, &FLOOR, &[plate], 1e-11);
        assert!((there.value - back.value).abs() < 1e-10, "{there:?} {back:?}");
        assert!(there.value < 0.19 && there.value > 0.05);
    }
}
