//! Area lights and bodies of them: the exact form factor of what a point sees.
//!
//! The shadow volume of a caster cuts a convex polygon out of the lamp. Such polygons, cut out of one another so that
//! nothing counts twice, are taken from the open factor by Lambert's formula.

use super::crowd::{Ball, Shaft};
use super::cut::{Lies, Loops, cut, lambert, lies};
use super::volumes::{Volume, Volumes};
use crate::formfactor::point_to_polygon;
use crate::math::{DVec3, Plane};
use std::cell::RefCell;
use std::f64::consts::PI;

/// Heights below this share of the distance are rounding.
const ON_PLANE: f64 = 1e-12;
/// And so are distances between corners.
const ROUNDING: f64 = 1e-12;

/// A polygon that shines to its front.
pub(super) struct Panel {
    pub corners: Vec<DVec3>,
    plane: Plane,
}

impl Panel {
    pub fn new(corners: &[DVec3]) -> Option<Self> {
        let sound = corners.len() >= 3 && corners.iter().all(|p| p.is_finite());
        let panel = sound.then(|| Self { corners: corners.to_vec(), plane: Plane::of(corners) })?;
        (panel.plane.normal != DVec3::ZERO).then_some(panel)
    }

    pub fn open(&self, point: DVec3, normal: DVec3) -> f64 {
        point_to_polygon(point, normal, &self.corners)
    }
}

thread_local! {
    static ROOM: RefCell<Room> = RefCell::default();
}

/// The factor of what a point sees of all panels.
pub(super) fn seen(panels: &[Panel], ball: Ball, point: DVec3, normal: DVec3, own: u32, volumes: &Volumes) -> f64 {
    ROOM.with_borrow_mut(|room| {
        room.gather(ball, point, own, volumes);
        if room.sides.is_empty() {
            return panels.iter().map(|p| p.open(point, normal)).sum();
        }
        panels.iter().map(|p| room.seen(p, point, normal)).sum::<f64>()
    })
}

/// Room for the polygons of one point, used again and again. All are relative to the point.
#[derive(Default)]
struct Room {
    /// Sides of the volumes of casters that may stand between, and where those of each end.
    sides: Vec<Plane>,
    ends: Vec<usize>,
    whole: Vec<DVec3>,
    part: Vec<DVec3>,
    spare: Vec<DVec3>,
    cuts: Loops,
    /// Of each cut: its volume, its box, its size.
    cast: Vec<Cast>,
    order: Vec<u32>,
    pieces: Loops,
    next: Loops,
}

struct Cast {
    volume: usize,
    lo: DVec3,
    hi: DVec3,
}

impl Room {
    /// Finds what may stand between a point and the lamp.
    fn gather(&mut self, ball: Ball, point: DVec3, own: u32, volumes: &Volumes) {
        self.sides.clear();
        self.ends.clear();
        let shaft = Shaft::to(point, ball);
        volumes.crowd.any(
            |b| shaft.meets(b),
            |k| {
                let volume = &volumes.volumes[k];
                if volume.caster != own {
                    self.add(volume, point, ball, volumes);
                }
                false
            },
        );
    }

    fn add(&mut self, volume: &Volume, point: DVec3, ball: Ball, volumes: &Volumes) {
        let height = volume.plane.height(point);
        let sign = -height.signum();
        // Edge-on, or with the lamp on the point's side of it.
        if height.abs() <= volumes.slack || sign * volume.plane.height(ball.centre) + ball.radius <= volumes.slack {
            return;
        }
        let start = self.sides.len();
        // What touches the lamp does not hide it.
        self.sides.push(Plane { normal: volume.plane.normal * sign, offset: sign * -height + volumes.slack });
        let corners = volumes.corners(volume);
        let to_lamp = ball.centre - point;
        let mut last = corners[corners.len() - 1] - point;
        for corner in corners {
            let next = *corner - point;
            let normal = last.cross(next) * sign;
            // All of the ball outside of a side: aside of the lamp.
            let inward = normal.dot(to_lamp);
            if inward < 0.0 && inward * inward > ball.radius * ball.radius * normal.length_squared() {
                self.sides.truncate(start);
                return;
            }
            self.sides.push(Plane { normal, offset: 0.0 });
            last = next;
        }
        self.ends.push(self.sides.len());
    }

    fn of(&self, volume: usize) -> &[Plane] {
        &self.sides[if volume == 0 { 0 } else { self.ends[volume - 1] }..self.ends[volume]]
    }

    /// The factor of what is seen of one panel.
    fn seen(&mut self, panel: &Panel, point: DVec3, normal: DVec3) -> f64 {
        self.whole.clear();
        self.whole.extend(panel.corners.iter().map(|p| *p - point));
        let reach = self.whole.iter().map(|p| p.length_squared()).fold(0.0, f64::max).sqrt();
        let height = panel.plane.height(point);
        if height.is_nan() || height <= ON_PLANE * reach {
            return 0.0;
        }
        let horizon = Plane { normal, offset: 0.0 };
        match lies(&self.whole, &horizon) {
            Lies::Outside => return 0.0,
            Lies::Across => {
                cut(&self.whole, &horizon, 1.0, &mut self.spare);
                std::mem::swap(&mut self.whole, &mut self.spare);
            }
            Lies::Inside => {}
        }
        let open = lambert(&self.whole, normal);
        if self.cast_shadows(reach) {
            return 0.0;
        }
        let hidden = self.hidden(normal);
        ((open - hidden) / (2.0 * PI)).clamp(0.0, 1.0)
    }

    /// Cuts the shadows out of the panel; true where one of them hides all of it.
    fn cast_shadows(&mut self, reach: f64) -> bool {
        self.cuts.clear();
        self.cast.clear();
        for volume in 0..self.ends.len() {
            let sides = &self.sides[if volume == 0 { 0 } else { self.ends[volume - 1] }..self.ends[volume]];
            // That of the caster itself comes first: one in the panel's plane ends here, however it is rounded.
            if sides.iter().any(|s| lies(&self.whole, s) == Lies::Outside) {
                continue;
            }
            self.part.clear();
            self.part.extend_from_slice(&self.whole);
            let mut all = true;
            for side in sides {
                if lies(&self.part, side) == Lies::Inside {
                    continue;
                }
                all = false;
                cut(&self.part, side, 1.0, &mut self.spare);
                std::mem::swap(&mut self.part, &mut self.spare);
                if self.part.len() < 3 {
                    break;
                }
            }
            if all {
                return true;
            }
            if self.part.len() >= 3 {
                let (lo, hi) = self
                    .part
                    .iter()
                    .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
                // The lamp is flat: along an axis at right angles to it boxes have no depth, and rounding would part them.
                let pad = DVec3::splat(ROUNDING * reach);
                self.cuts.push(&self.part);
                self.cast.push(Cast { volume, lo: lo - pad, hi: hi + pad });
            }
        }
        false
    }

    /// 2 pi times the form factor of all that is cut out.
    fn hidden(&mut self, normal: DVec3) -> f64 {
        // Large ones first: the small ones within them are gone at once.
        self.order.clear();
        self.order.extend(0..self.cast.len() as u32);
        let size = |k: &u32| (self.cast[*k as usize].hi - self.cast[*k as usize].lo).length_squared();
        self.order.sort_unstable_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        let mut sum = 0.0;
        for n in 0..self.order.len() {
            let k = self.order[n] as usize;
            self.pieces.clear();
            self.pieces.push(self.cuts.get(k));
            for earlier in 0..n {
                let other = self.order[earlier] as usize;
                let (a, b) = (&self.cast[k], &self.cast[other]);
                if !(a.lo.cmple(b.hi).all() && b.lo.cmple(a.hi).all()) {
                    continue;
                }
                self.take_away(b.volume);
                if self.pieces.count() == 0 {
                    break;
                }
            }
            sum += (0..self.pieces.count()).map(|p| lambert(self.pieces.get(p), normal)).sum::<f64>();
        }
        sum
    }

    /// Takes the shadow of a volume out of all pieces.
    fn take_away(&mut self, volume: usize) {
        self.next.clear();
        for piece in 0..self.pieces.count() {
            let polygon = self.pieces.get(piece);
            if self.of(volume).iter().any(|s| lies(polygon, s) == Lies::Outside) {
                self.next.push(polygon);
                continue;
            }
            self.part.clear();
            self.part.extend_from_slice(self.pieces.get(piece));
            for k in 0..self.of(volume).len() {
                let side = self.of(volume)[k];
                if lies(&self.part, &side) == Lies::Inside {
                    continue;
                }
                cut(&self.part, &side, -1.0, &mut self.spare);
                if self.spare.len() >= 3 {
                    self.next.push(&self.spare);
                }
                cut(&self.part, &side, 1.0, &mut self.spare);
                std::mem::swap(&mut self.part, &mut self.spare);
                if self.part.len() < 3 {
                    break;
                }
            }
        }
        std::mem::swap(&mut self.pieces, &mut self.next);
    }
}
