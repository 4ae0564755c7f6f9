//! The casters that rise above both horizons of a point, as cones of directions.

use super::dome::HalfPlane;
use super::sky::Lune;
use super::volumes::{Volume, Volumes};
use crate::math::DVec3;

/// Half a turn, in the measure of [`turn`].
const HALF: f64 = 2.0;

/// Turns nearer to half a turn than this may be more or less.
const UNSURE: f64 = 1e-9;

/// Cones that reach over more turns than this are broad.
const BROAD: f64 = 0.25;

/// A measure of the angle of a direction, -2 to 2: grows with it, and is 2 for half a turn wherever that begins.
pub(super) fn turn(level: f64, up: f64) -> f64 {
    let sum = level.abs() + up.abs();
    let share = if sum > 0.0 { level / sum } else { 1.0 };
    if up >= 0.0 { 1.0 - share } else { share - 1.0 }
}

/// The angle, 0 to pi, of a turn of 0 to 2.
fn angle(turn: f64) -> f64 {
    let share = 1.0 - turn;
    (1.0 - share.abs()).atan2(share)
}

/// What a caster hides: which half planes may meet it, and its sides.
pub(super) struct Cone {
    pub from: f64,
    pub to: f64,
    start: u32,
    /// First come sides that bound x from below, then those from above, then those that x does not matter to.
    below: u32,
    above: u32,
    end: u32,
}

/// The cones of one point; room used again and again.
#[derive(Default)]
pub(super) struct Cones {
    cones: Vec<Cone>,
    /// Of a side with the normal (n_axis, n_level, n_up): what bounds x is `self.0 cos phi + self.1 sin phi`.
    sides: Vec<(f64, f64)>,
    corner_turns: Vec<f64>,
    placed: Vec<DVec3>,
    normals: Vec<DVec3>,
}

impl Cone {
    /// True if many half planes meet it.
    pub fn is_broad(&self) -> bool {
        self.to - self.from > BROAD
    }
}

impl Cones {
    pub fn is_empty(&self) -> bool {
        self.cones.is_empty()
    }

    pub fn iter(&self) -> std::slice::Iter<'_, Cone> {
        self.cones.iter()
    }

    /// How many corners stand above both horizons.
    pub fn corners(&self) -> usize {
        self.corner_turns.len()
    }

    /// The half planes that these corners lie in, rad.
    pub fn corner_angles(&self) -> impl Iterator<Item = f64> + '_ {
        self.corner_turns.iter().map(|t| angle(*t))
    }

    /// Finds the casters that matter.
    pub fn gather(&mut self, lune: &Lune, point: DVec3, normal: DVec3, own: u32, volumes: &Volumes) {
        self.sides.clear();
        self.cones.clear();
        self.corner_turns.clear();
        let slack = volumes.slack;
        let last = turn(-lune.tilt.cos(), lune.tilt.sin());
        volumes.crowd.any(
            |ball| {
                let way = ball.centre - point;
                way.dot(lune.up) + ball.radius > slack && way.dot(normal) + ball.radius > slack
            },
            |k| {
                let volume = &volumes.volumes[k];
                if volume.caster != own {
                    self.add(volume, lune, last, point, normal, volumes);
                }
                false
            },
        );
    }

    fn add(&mut self, volume: &Volume, lune: &Lune, last: f64, point: DVec3, normal: DVec3, volumes: &Volumes) {
        let (height, slack) = (volume.plane.height(point), volumes.slack);
        if height.is_nan() || height.abs() <= slack {
            return;
        }
        let (mut top, mut front) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        self.placed.clear();
        let corners_before = self.corner_turns.len();
        let (mut lo, mut hi, mut lowest_above) = (f64::INFINITY, f64::NEG_INFINITY, HALF);
        for corner in volumes.corners(volume) {
            let way = *corner - point;
            front = front.max(way.dot(normal));
            let placed = lune.place(way);
            top = top.max(placed.z);
            self.placed.push(placed);
            let t = turn(placed.y, placed.z);
            (lo, hi) = (lo.min(t), hi.max(t));
            if t > 0.0 {
                lowest_above = lowest_above.min(t);
                if t < last {
                    self.corner_turns.push(t);
                }
            }
        }
        let sign = -height.signum();
        self.normals.clear();
        let mut before = self.placed[self.placed.len() - 1];
        // The axis runs through the caster where all its sides face one end of it.
        let (mut ahead, mut behind) = (true, true);
        for next in &self.placed {
            let side = before.cross(*next) * sign;
            ahead &= side.x >= 0.0;
            behind &= side.x <= 0.0;
            self.normals.push(side);
            before = *next;
        }
        let (from, to) = if ahead || behind || (hi - lo - HALF).abs() < UNSURE {
            (0.0, HALF)
        } else if hi - lo < HALF {
            (lo, hi)
        } else {
            // Across the level direction backwards: up to it from the lowest of those above.
            (lowest_above, HALF)
        };
        if !(top > slack && front > slack && from < last && to > 0.0) {
            self.corner_turns.truncate(corners_before);
            return;
        }
        let start = self.sides.len() as u32;
        // Of neighbours, one bounds from below exactly where the other does from above: signs alone differ.
        let bound = |n: &DVec3| {
            let inverse = -1.0 / n.x;
            (n.y * inverse, n.z * inverse)
        };
        self.sides.extend(self.normals.iter().filter(|n| n.x > 0.0).map(bound));
        let below = self.sides.len() as u32;
        self.sides.extend(self.normals.iter().filter(|n| n.x < 0.0).map(bound));
        let above = self.sides.len() as u32;
        self.sides.extend(self.normals.iter().filter(|n| n.x == 0.0).map(|n| (n.y, n.z)));
        self.cones.push(Cone { from, to, start, below, above, end: self.sides.len() as u32 });
    }

    /// What a cone hides of a half plane. With x = cot(psi) its directions are a line, and the hidden part a stretch.
    #[inline]
    pub fn arc(&self, cone: &Cone, plane: &HalfPlane) -> Option<(f64, f64)> {
        let at = |s: &(f64, f64)| s.0 * plane.cosine + s.1 * plane.sine;
        let part = |from: u32, to: u32| &self.sides[from as usize..to as usize];
        let from = part(cone.start, cone.below).iter().map(at).fold(f64::NEG_INFINITY, f64::max);
        let to = part(cone.below, cone.above).iter().map(at).fold(f64::INFINITY, f64::min);
        (from < to && part(cone.above, cone.end).iter().all(|s| at(s) >= 0.0)).then_some((from, to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn turns_grow_with_angles_and_halves_are_alike() {
        let mut last = -HALF;
        for k in -179..=180 {
            let a = f64::from(k) * PI / 180.0;
            let t = turn(a.cos(), a.sin());
            assert!(t > last, "{k}");
            last = t;
            if k > 0 {
                assert!((angle(t) - a).abs() < 1e-15 * 8.0);
                assert!((t - turn(-a.cos(), -a.sin()) - HALF).abs() < 1e-15 || k == 180);
            }
        }
    }
}
