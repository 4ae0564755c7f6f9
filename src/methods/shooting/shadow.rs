//! The shadow volume of a changed object as a shooter sees it: which of its rays can meet the object.
//!
//! The volume is the hull of the shooting patch and the object, prolonged behind the object. It is held as the
//! directions in which the object may lie from anywhere on the patch, an arc in each of the three planes of the
//! patch's frame, and as a box about the object that a ray has to pass through.

use crate::math::{DVec3, Frame};
use std::f64::consts::{PI, TAU};

/// Margin about the box of an object, relative to its size: rounding must not exclude a ray that touches it.
const MARGIN: f64 = 1e-6;
/// Margin of arcs, radians: directions of a net are single precision.
const ARC_MARGIN: f64 = 1e-5;
/// Corners above which an object is taken as its box.
const MOST_POINTS: usize = 64;

/// What a changed object looks like from afar.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    low: DVec3,
    high: DVec3,
    /// Points whose hull holds the object.
    points: Vec<DVec3>,
}

impl Outline {
    /// The outline of some corners; `None` if there are none.
    pub fn of(corners: &[DVec3]) -> Option<Self> {
        let first = *corners.first()?;
        let (low, high) = corners.iter().fold((first, first), |(l, h), p| (l.min(*p), h.max(*p)));
        let margin =
            DVec3::splat(MARGIN * low.distance(high).max(low.abs().max_element()).max(high.abs().max_element()));
        let (low, high) = (low - margin, high + margin);
        let points = if corners.len() > MOST_POINTS {
            let at = |k: usize| {
                let side = |c: usize| if k >> c & 1 == 0 { low[c] } else { high[c] };
                DVec3::new(side(0), side(1), side(2))
            };
            (0..8).map(at).collect()
        } else {
            corners.to_vec()
        };
        Some(Self { low, high, points })
    }

    /// True if a ray passes through the box.
    #[inline]
    pub fn meets(&self, origin: DVec3, direction: DVec3) -> bool {
        let inverse = direction.recip();
        let (a, b) = ((self.low - origin) * inverse, (self.high - origin) * inverse);
        // A direction within a slab's plane gives an infinity or, on its border, no number at all: `min` and `max` of
        // f64 leave the latter out.
        let near = a.x.min(b.x).max(a.y.min(b.y)).max(a.z.min(b.z));
        let far = a.x.max(b.x).min(a.y.max(b.y)).min(a.z.max(b.z));
        near <= far && far >= 0.0
    }

    /// Middle of the box.
    pub fn centre(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }
}

/// Angles from `centre - half` to `centre + half`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    centre: f64,
    half: f64,
}

impl Arc {
    const ALL: Self = Self { centre: 0.0, half: PI };

    /// An arc that holds some vectors of a plane.
    pub fn of(vectors: impl Iterator<Item = [f64; 2]> + Clone) -> Self {
        let sum = vectors.clone().fold([0.0; 2], |s, v| [s[0] + v[0], s[1] + v[1]]);
        if sum == [0.0; 2] {
            return Self::ALL;
        }
        let centre = sum[1].atan2(sum[0]);
        let half = vectors.map(|v| turn(v[1].atan2(v[0]) - centre).abs()).fold(0.0, f64::max);
        Self { centre, half }
    }

    /// The arc in which a rectangle is seen from the origin.
    fn of_rectangle(low: [f64; 2], high: [f64; 2]) -> Self {
        if (0..2).all(|c| low[c] <= 0.0 && high[c] >= 0.0) {
            return Self::ALL;
        }
        let corner =
            move |k: usize| [if k & 1 == 0 { low[0] } else { high[0] }, if k & 2 == 0 { low[1] } else { high[1] }];
        Self::of((0..4).map(corner))
    }

    fn meets(self, other: Self) -> bool {
        turn(self.centre - other.centre).abs() <= self.half + other.half + ARC_MARGIN
    }
}

/// An angle brought to -pi .. pi.
fn turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Directions as seen in the planes (x, y), (x, z) and (y, z).
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions([Arc; 3]);

const PLANES: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

impl Directions {
    /// Directions that hold the given ones.
    pub fn of(directions: &(impl Iterator<Item = [f64; 3]> + Clone)) -> Self {
        Self(PLANES.map(|[a, b]| Arc::of(directions.clone().map(|d| [d[a], d[b]]))))
    }

    /// Directions in which an object may lie from a patch, in the patch's frame; `None` if it lies behind.
    pub fn towards(outline: &Outline, patch: &[DVec3], frame: &Frame) -> Option<Self> {
        let bounds = |points: &[DVec3]| {
            let fold = |(l, h): (DVec3, DVec3), p: &DVec3| {
                let q = frame.to_local(*p);
                (l.min(q), h.max(q))
            };
            points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), fold)
        };
        let ((low, high), (from, to)) = (bounds(&outline.points), bounds(patch));
        let margin = DVec3::splat(MARGIN * outline.low.distance(outline.high));
        let (mut low, high) = (low - to - margin, high - from + margin);
        if high.z <= 0.0 {
            return None;
        }
        // Rays leave on the front alone.
        low.z = low.z.max(0.0);
        Some(Self(PLANES.map(|[a, b]| Arc::of_rectangle([low[a], low[b]], [high[a], high[b]]))))
    }

    pub fn meet(&self, other: &Self) -> bool {
        (0..3).all(|k| self.0[k].meets(other.0[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raycast::specimen::Numbers;

    /// Any direction that leads from a patch to an object is within the directions towards it.
    #[test]
    fn no_direction_to_the_object_is_left_out() {
        let mut n = Numbers::new(7);
        let mut excluded = 0;
        for _ in 0..2000 {
            let cube = DVec3::ONE * 3.0;
            let corners: Vec<DVec3> = {
                let (middle, half) = (n.point(-cube, cube), n.point(DVec3::splat(0.01), DVec3::splat(0.5)));
                (0..8)
                    .map(|k| {
                        middle + half * DVec3::new([-1.0, 1.0][k & 1], [-1.0, 1.0][k >> 1 & 1], [-1.0, 1.0][k >> 2])
                    })
                    .collect()
            };
            let outline = Outline::of(&corners).unwrap();
            let frame = Frame::with_x_axis(n.direction(), n.direction());
            let patch: Vec<DVec3> =
                [(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)].map(|(a, b)| frame.x * a + frame.y * b).to_vec();
            let towards = Directions::towards(&outline, &patch, &frame);
            let from = frame.x * n.between(0.0, 0.4) + frame.y * n.between(0.0, 0.3);
            let to = corners[0].lerp(corners[7], n.unit());
            let d = frame.to_local(to - from);
            let one = Directions::of(&std::iter::once(d.to_array()));
            assert!(d.z <= 0.0 || towards.is_some_and(|t| t.meet(&one)), "{d}");
            assert!(outline.meets(from, (to - from).normalize()));
            let any = frame.to_local(n.direction());
            let other = Directions::of(&std::iter::once(any.to_array()));
            excluded += usize::from(any.z > 0.0 && towards.is_some_and(|t| !t.meet(&other)));
        }
        assert!(excluded > 300, "the volume excludes nothing: {excluded}");
    }
}
