//! The form factor from a point to what several convex bodies leave visible of a convex polygon.

use super::body::Cone;
use super::geometry::{Vector, cross, dot, length};
use std::f64::consts::TAU;

const MOST_CORNERS: usize = 40;

/// A convex polygon seen from a point: corners relative to the point.
#[derive(Clone, Copy)]
pub struct Outline {
    n: usize,
    corners: [Vector; MOST_CORNERS],
}

impl Outline {
    pub fn new(corners: impl Iterator<Item = Vector>) -> Self {
        let mut outline = Self { n: 0, corners: [[0.0; 3]; MOST_CORNERS] };
        corners.for_each(|c| outline.push(c));
        outline
    }

    fn push(&mut self, corner: Vector) {
        self.corners[self.n] = corner;
        self.n += 1;
    }

    fn corners(&self) -> &[Vector] {
        &self.corners[..self.n]
    }
}

/// What a cone covers of an outline. It lives on the stack for a moment: a box would cost more than the space.
#[allow(clippy::large_enum_variant)]
enum Cover {
    Nothing,
    Everything,
    Part(Outline),
}

/// The point-to-polygon form factor of what no cone covers, from a point with the normal `normal`.
///
/// Each hidden direction is counted at the last cone that covers it, so that shadows may overlap in any way.
pub fn visible(outline: &Outline, cones: &[Cone], normal: Vector) -> f64 {
    let mut rest = lambert(outline.corners(), normal);
    for (k, cone) in cones.iter().enumerate() {
        match covered(outline, cone) {
            Cover::Nothing => {}
            Cover::Everything => return 0.0,
            Cover::Part(part) => rest -= visible(&part, &cones[k + 1..], normal),
        }
    }
    rest
}

/// Lambert's formula: the sum over the edges of the angle they span times the slope of their plane, over 2 pi.
fn lambert(corners: &[Vector], normal: Vector) -> f64 {
    let mut sum = 0.0;
    for k in 0..corners.len() {
        let (a, b) = (corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]);
        let across = cross(b, a);
        let sine = length(across);
        if sine > 0.0 {
            sum += sine.atan2(dot(a, b)) * dot(normal, across) / sine;
        }
    }
    sum / TAU
}

fn covered(outline: &Outline, cone: &Cone) -> Cover {
    // A side that sees the whole outline outside settles the matter before anything is cut.
    let outside = |n: &Vector| outline.corners().iter().all(|&c| dot(*n, c) <= 0.0);
    if cone.normals.iter().any(outside) {
        return Cover::Nothing;
    }
    let mut part = *outline;
    let mut cut = false;
    for &n in &cone.normals {
        if part.corners().iter().all(|&c| dot(n, c) >= 0.0) {
            continue;
        }
        cut = true;
        part = inside(&part, n);
        if part.n < 3 {
            return Cover::Nothing;
        }
    }
    if cut { Cover::Part(part) } else { Cover::Everything }
}

fn inside(outline: &Outline, n: Vector) -> Outline {
    let mut kept = Outline { n: 0, corners: outline.corners };
    let corners = outline.corners();
    for k in 0..corners.len() {
        let (a, b) = (corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]);
        let (s, t) = (dot(n, a), dot(n, b));
        if s >= 0.0 {
            kept.push(a);
        }
        if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
            let u = s / (s - t);
            kept.push([a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of half-width 1 at height 1, seen from the origin: counter-clockwise from below.
    fn square() -> Outline {
        Outline::new([[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]].into_iter())
    }

    fn half_space(n: Vector) -> Cone {
        Cone { normals: vec![n] }
    }

    #[test]
    fn centred_square_is_the_known_value() {
        // Four times 1/(2 pi) (2 / sqrt 2 atan(1 / sqrt 2)) of the quarter at a corner.
        let quarter = 2.0 / 2f64.sqrt() * (1.0 / 2f64.sqrt()).atan() / TAU;
        assert!((visible(&square(), &[], [0.0, 0.0, 1.0]) - 4.0 * quarter).abs() < 1e-15);
    }

    #[test]
    fn overlapping_shadows_are_taken_off_once() {
        let whole = visible(&square(), &[], [0.0, 0.0, 1.0]);
        let halves = [half_space([1.0, 0.0, 0.0]), half_space([0.0, 1.0, 0.0])];
        assert!((visible(&square(), &halves, [0.0, 0.0, 1.0]) - whole / 4.0).abs() < 1e-15);
        let twice = [half_space([1.0, 0.0, 0.0]), half_space([1.0, 0.0, 0.0])];
        assert!((visible(&square(), &twice, [0.0, 0.0, 1.0]) - whole / 2.0).abs() < 1e-15);
    }
}
