//! Linear lights: a thin tube that shines by Lambert's law about its axis.

use super::crowd::{Ball, Shaft};
use super::stretch::{Stretch, join};
use super::volumes::Volumes;
use crate::math::DVec3;
use std::cell::RefCell;

/// Below this angle to the tube, rad, differences are taken from a series: both ends look alike.
const NARROW: f64 = 0.3;

thread_local! {
    static HIDDEN: RefCell<Vec<(f64, f64)>> = const { RefCell::new(Vec::new()) };
}

/// The factor of a whole tube.
pub(super) fn open(from: DVec3, to: DVec3, point: DVec3, normal: DVec3) -> f64 {
    risen([from, to], point, normal).map_or(0.0, |part| Seen::of([from, to], point, normal).between(part.from, part.to))
}

/// The factor of what a point sees of the tube: its hidden stretches are found exactly.
pub(super) fn seen(ends: [DVec3; 2], ball: Ball, point: DVec3, normal: DVec3, own: u32, volumes: &Volumes) -> f64 {
    let Some(whole) = risen(ends, point, normal) else { return 0.0 };
    HIDDEN.with_borrow_mut(|hidden| {
        hidden.clear();
        let shaft = Shaft::to(point, ball);
        let dark = volumes.crowd.any(
            |b| shaft.meets(b),
            |k| {
                let volume = &volumes.volumes[k];
                if volume.caster == own {
                    return false;
                }
                let height = volume.plane.height(point);
                if height.abs() <= volumes.slack {
                    return false;
                }
                let sign = -height.signum();
                let beyond = ends.map(|e| sign * volume.plane.height(e));
                if beyond[0].max(beyond[1]) <= volumes.slack {
                    return false;
                }
                let mut part = whole;
                part.keep(beyond[0], beyond[1] - beyond[0]);
                let [a, b] = ends.map(|e| (e - point) * sign);
                let corners = volumes.corners(volume);
                let mut last = corners[corners.len() - 1] - point;
                for corner in corners {
                    let next = *corner - point;
                    let side = last.cross(next);
                    let (ha, hb) = (side.dot(a), side.dot(b));
                    part.keep(ha, hb - ha);
                    if part.is_empty() {
                        return false;
                    }
                    last = next;
                }
                hidden.push((part.from, part.to));
                part.from <= whole.from && part.to >= whole.to
            },
        );
        if dark {
            return 0.0;
        }
        join(hidden);
        let tube = Seen::of(ends, point, normal);
        let (mut at, mut sum) = (whole.from, 0.0);
        for (from, to) in hidden.iter() {
            if *from > at {
                sum += tube.between(at, *from);
            }
            at = at.max(*to);
        }
        if at < whole.to { sum + tube.between(at, whole.to) } else { sum }
    })
}

/// The part of a tube above a horizon.
fn risen(ends: [DVec3; 2], point: DVec3, normal: DVec3) -> Option<Stretch> {
    let [a, b] = ends.map(|e| normal.dot(e - point));
    let mut part = Stretch::SEGMENT;
    part.keep(a, b - a);
    // A tube in the horizon brings nothing.
    (!part.is_empty() && a.max(b) > 0.0).then_some(part)
}

/// A tube as a point sees it.
struct Seen {
    /// Distance from the line of the tube, m.
    off: f64,
    /// Where along the tube, from the foot of the point, it begins, m.
    start: f64,
    length: f64,
    /// Cosines of the normal to the direction of the foot, and to the tube.
    to_foot: f64,
    along: f64,
}

impl Seen {
    fn of([from, to]: [DVec3; 2], point: DVec3, normal: DVec3) -> Self {
        let length = from.distance(to);
        let axis = (to - from) / length.max(f64::MIN_POSITIVE);
        let way = from - point;
        let start = way.dot(axis);
        let foot = way - axis * start;
        let off = foot.length();
        let to_foot = if off > 0.0 { foot.dot(normal) / off } else { 0.0 };
        Self { off, start, length, to_foot, along: normal.dot(axis) }
    }

    /// Integral of sin(t) cos(theta) / d^2 over a stretch, by the angle f of its points at the observer from the foot:
    /// `((to_foot) (f + sin f cos f) + (along) sin^2 f) / (2 off)` between the ends.
    fn between(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (self.start + self.length * from, self.start + self.length * to);
        // On its line, from outside, it is seen end-on.
        if self.off.is_nan() || self.off <= 1e-12 * (a.abs() + b.abs()) {
            return 0.0;
        }
        let (fa, fb) = (a.atan2(self.off), b.atan2(self.off));
        let (ga, gb) = (self.off.atan2(a.abs()), self.off.atan2(b.abs()));
        let turned = if a * b > 0.0 && ga.max(gb) < NARROW {
            (rest(ga) - rest(gb)) * a.signum()
        } else {
            fb - fa + 0.5 * ((2.0 * fb).sin() - (2.0 * fa).sin())
        };
        // sin^2 f is 1 - cos^2 f, and the cosine is what is small where digits are short.
        let (ca, cb) = (ga.sin(), gb.sin());
        let sum = self.to_foot * turned + self.along * (ca - cb) * (ca + cb);
        (sum / (2.0 * self.off)).max(0.0)
    }
}

/// `g - sin g cos g` of a small angle, with all its digits.
fn rest(g: f64) -> f64 {
    let x = 4.0 * g * g;
    let series = 1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0 * (1.0 - x / 110.0 * (1.0 - x / 156.0))));
    2.0 / 3.0 * g * g * g * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_the_function() {
        for g in [0.05f64, 0.1, 0.2, 0.29] {
            assert!((rest(g) / (g - g.sin() * g.cos()) - 1.0).abs() < 1e-12 / (g * g * g), "{g}");
        }
    }

    #[test]
    fn a_tube_over_the_point_follows_the_formula_of_the_books() {
        // Parallel to the floor, its end straight above: I / (2 h) (f + sin f cos f), f = atan(l / h).
        for (h, l) in [(1.0f64, 2.0f64), (3.0, 0.5), (0.2, 10.0)] {
            let f = (l / h).atan();
            let expected = (f + f.sin() * f.cos()) / (2.0 * h);
            let value = open(DVec3::new(0.0, 0.0, h), DVec3::new(l, 0.0, h), DVec3::ZERO, DVec3::Z);
            assert!((value - expected).abs() < 1e-13 * expected.max(1.0), "{value} {expected}");
        }
    }
}
