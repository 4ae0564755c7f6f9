//! Reflection cones: the directions that a pixel of the picture looks into, by way of a mirror or straight ahead.

use crate::math::DVec3;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// Directions that are averaged for one pixel, in the directions of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cone {
    /// Between four directions, in order around [G86 fig. 3]: sides are great circles, the shorter way round.
    Quad([DVec3; 4]),
    /// The directions `axis + s a + t b`, s^2 + t^2 <= 1 [G86 fig. 5]; a and b stand upright on the axis.
    Ellipse {
        /// The middle, of unit length.
        axis: DVec3,
        /// From the middle to the rim, at unit distance from the apex.
        a: DVec3,
        /// From the middle to the rim elsewhere.
        b: DVec3,
    },
}

/// Half-spaces that no cone made here reaches beyond are 90 degrees off; an ellipse ends here, radians off its axis.
pub(super) const WIDEST: f64 = 85.0 * std::f64::consts::PI / 180.0;

/// Sharpness of the Gaussian over an elliptical cone: exp(-SHARPNESS (s^2 + t^2)). At an ellipse through the corners of
/// a pixel its variance is 1.03 times that of the pixel itself.
pub const SHARPNESS: f64 = 2.0;

/// Variance of the Gaussian cut off at the rim, along one axis, for a radius of 1: (1 - 3 e^-2) / (4 (1 - e^-2)).
pub(super) const VARIANCE: f64 = 0.171_741_178_625_167_16;

/// An elliptical cone with axes that are perpendicular to each other: a the longer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ellipse {
    pub axis: DVec3,
    pub a: DVec3,
    pub b: DVec3,
}

impl Cone {
    /// The elliptical cone about a quadrilateral one: of a pixel, its circle goes through the four corners, so that it is
    /// sqrt(2) times as wide, and the Gaussian over it has the pixel's own variance within 3 percent. Opposite sides are
    /// averaged (a parallelogram); what is further than 85 degrees off the middle is drawn in to there.
    pub fn elliptical(corners: &[DVec3; 4]) -> Self {
        let Some((axis, corners)) = sound(corners).and_then(|c| Some((middle(&c)?, c))) else {
            return Self::Quad(*corners);
        };
        let p = corners.map(|c| tangent(axis, c));
        let a = (p[1] + p[2] - p[0] - p[3]) * (0.25 * SQRT_2);
        let b = (p[2] + p[3] - p[0] - p[1]) * (0.25 * SQRT_2);
        Self::Ellipse { axis, a, b }
    }

    /// A round cone: `half_angle` radians from its axis (of any length but 0) to its rim, 85 degrees at most.
    pub fn round(axis: DVec3, half_angle: f64) -> Self {
        let axis = axis.normalize_or(DVec3::Y);
        let reach = half_angle.clamp(0.0, WIDEST).tan();
        let (a, b) = axis.any_orthonormal_pair();
        Self::Ellipse { axis, a: a * reach, b: b * reach }
    }

    /// The cone between the corners of a pixel some of whose rays may be missing: of three, the parallelogram is
    /// completed; of two, a round cone about the middle with both on its rim; `None` of fewer.
    pub fn given(corners: &[Option<DVec3>; 4]) -> Option<Self> {
        let there = |c: &Option<DVec3>| c.and_then(DVec3::try_normalize);
        let corners: [Option<DVec3>; 4] = [0, 1, 2, 3].map(|i| there(&corners[i]));
        let known: Vec<DVec3> = corners.iter().flatten().copied().collect();
        match known[..] {
            [a, b, c, d] => Some(Self::Quad([a, b, c, d])),
            [_, _, _] => {
                let at = |i: usize| corners[i % 4].unwrap_or(DVec3::ZERO);
                let lost = (0..4).find(|i| corners[*i].is_none())?;
                let mut all = [0, 1, 2, 3].map(at);
                let far = at(lost + 2);
                all[lost] = (at(lost + 1) + at(lost + 3) - far).try_normalize().unwrap_or(far);
                Some(Self::Quad(all))
            }
            [a, b] => Some(Self::round((a + b).try_normalize()?, 0.5 * a.angle_between(b))),
            _ => None,
        }
    }

    /// Unit direction in its middle; `None` of a cone without directions (zeros, not numbers).
    pub fn axis(&self) -> Option<DVec3> {
        match self {
            Self::Quad(corners) => middle(&sound(corners)?),
            Self::Ellipse { axis, .. } => axis.try_normalize(),
        }
    }

    /// Its quadrilateral: of an elliptical cone, the pixel that [`Cone::elliptical`] would make it of.
    pub fn quad(&self) -> [DVec3; 4] {
        match *self {
            Self::Quad(corners) => sound(&corners).unwrap_or(corners),
            Self::Ellipse { axis, a, b } => {
                let (a, b) = (a * FRAC_1_SQRT_2, b * FRAC_1_SQRT_2);
                [axis - a - b, axis + a - b, axis + a + b, axis - a + b].map(|d| d.normalize_or(axis))
            }
        }
    }

    /// Its ellipse, with axes perpendicular to each other.
    pub(super) fn ellipse(&self) -> Option<Ellipse> {
        let (axis, a, b) = match *self {
            Self::Quad(corners) => match Self::elliptical(&corners) {
                Self::Ellipse { axis, a, b } => (axis, a, b),
                Self::Quad(_) => return None,
            },
            Self::Ellipse { axis, a, b } => {
                let axis = axis.try_normalize()?;
                (axis, a - axis * a.dot(axis), b - axis * b.dot(axis))
            }
        };
        let turn = 0.5 * (2.0 * a.dot(b)).atan2(a.length_squared() - b.length_squared());
        let (sine, cosine) = turn.sin_cos();
        let found = Ellipse { axis, a: a * cosine + b * sine, b: b * cosine - a * sine };
        (found.a.is_finite() && found.b.is_finite()).then_some(found)
    }

    /// Solid angle between the sides of its quadrilateral, sr, in closed form; where a folded one overlaps itself, twice.
    pub fn solid_angle(&self) -> f64 {
        let corners = self.quad();
        triangles(&corners).iter().map(|t| triangle(*t).abs()).sum()
    }

    /// What lies between the sides of the quadrilateral as convex parts, each the directions d with n . d >= 0 for all of
    /// its normals. A folded quadrilateral is two triangles, both counted: so is one that goes round a hemisphere.
    pub(super) fn parts(&self) -> Vec<Part> {
        let c = self.quad();
        if sound(&c).is_none() {
            return Vec::new();
        }
        let mut sides = Part::about(&c);
        if sides.holds(&c) {
            return vec![sides];
        }
        sides.normals = sides.normals.map(|n| -n);
        if sides.holds(&c) {
            return vec![sides];
        }
        let part = |t: &[DVec3; 3]| {
            let turn = t[0].dot((t[1] - t[0]).cross(t[2] - t[0]));
            let part = Part::about(&if turn < 0.0 { [t[0], t[2], t[1], t[0]] } else { [t[0], t[1], t[2], t[0]] });
            (turn != 0.0).then_some(part)
        };
        triangles(&c).iter().filter_map(part).collect()
    }
}

/// Inward normals of the sides of a convex cone; zeros hold everything.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub normals: [DVec3; 4],
}

impl Part {
    /// Sides between four directions, inside to the left.
    fn about(c: &[DVec3; 4]) -> Self {
        Self { normals: [0, 1, 2, 3].map(|i| c[i].cross(c[(i + 1) % 4] - c[i]).normalize_or_zero()) }
    }

    /// Whether all corners lie on the inner side of all sides.
    fn holds(&self, c: &[DVec3; 4]) -> bool {
        let sides = self.normals.iter().filter(|n| **n != DVec3::ZERO);
        sides.clone().count() > 2 && sides.clone().all(|n| c.iter().all(|d| n.dot(*d) > -1e-15))
    }
}

/// Unit vectors of four directions that are there, whatever else; `None` of fewer than three.
fn sound(corners: &[DVec3; 4]) -> Option<[DVec3; 4]> {
    let given = corners.map(DVec3::try_normalize);
    match given {
        [Some(a), Some(b), Some(c), Some(d)] => Some([a, b, c, d]),
        _ => match Cone::given(&given)? {
            Cone::Quad(all) => Some(all),
            round => Some(round.quad()),
        },
    }
}

/// Mean direction; of directions that cancel each other, the normal of the diagonals, else the first.
fn middle(corners: &[DVec3; 4]) -> Option<DVec3> {
    let sum: DVec3 = corners.iter().sum();
    let across = || (corners[2] - corners[0]).cross(corners[3] - corners[1]).try_normalize();
    if sum.length() > 1e-9 { sum.try_normalize() } else { across().or(Some(corners[0])) }
}

/// From the axis to a direction, in the plane at unit distance; no further than the widest ellipse reaches.
fn tangent(axis: DVec3, d: DVec3) -> DVec3 {
    let (along, aside) = (d.dot(axis), d - axis * d.dot(axis));
    let limit = WIDEST.tan();
    if along > 0.0 && aside.length() <= limit * along { aside / along } else { aside.normalize_or_zero() * limit }
}

/// Two triangles of a quadrilateral: by the diagonal that leaves both on the same side, else by that of less area.
fn triangles(c: &[DVec3; 4]) -> [[DVec3; 3]; 2] {
    let halves = [[[c[0], c[1], c[2]], [c[0], c[2], c[3]]], [[c[1], c[2], c[3]], [c[1], c[3], c[0]]]];
    let areas = halves.map(|h| h.map(triangle));
    let folded = areas.map(|[a, b]| a * b < 0.0);
    let size = areas.map(|[a, b]| a.abs() + b.abs());
    halves[usize::from(folded[0] && !folded[1] || folded[0] == folded[1] && size[1] < size[0])]
}

/// Solid angle of the triangle between three unit vectors, positive where counter-clockwise seen from the apex's far side
/// (van Oosterom and Strackee 1983; differences keep small ones exact).
pub(super) fn triangle([a, b, c]: [DVec3; 3]) -> f64 {
    let volume = a.dot((b - a).cross(c - a));
    2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
