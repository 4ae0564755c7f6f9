//! Looks in waves: all rays of the same depth at once, those that start on the same facet in one batch.

use super::net::Net;
use super::setting::{Setting, Spot};
use super::shadow::Beams;
use crate::math::DVec3;
use crate::raycast::{RayBatch, Tracer};

/// Rays of one batch.
const BATCH: usize = 2048;

/// Looks thrown back or let through more often than this bring nothing.
pub(super) const DEEPEST: u32 = 8;

/// A look on its way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Where its radiance is added.
    pub slot: u32,
    /// Number of its point in the net.
    pub sample: u32,
    /// What its radiance counts.
    pub weight: f64,
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Facet it starts on.
    pub from: u32,
    /// Where it began before panes that do not bend it: fog is measured from there, trees turn to it.
    pub viewer: DVec3,
    /// Place in the view, 0 to 1, while it has not been bent.
    pub at: Option<[f64; 2]>,
    pub depth: u32,
}

/// Calls `each` with every item and what its ray meets. Items have to be sorted by the facet they start on.
pub(super) fn in_groups<T>(
    tracer: &Tracer,
    items: &[T],
    ray: impl Fn(&T) -> (u32, DVec3, DVec3),
    mut each: impl FnMut(&T, Option<(u32, DVec3, u32)>),
) {
    let mut rays = RayBatch::default();
    for part in items.chunk_by(|a, b| ray(a).0 == ray(b).0).flat_map(|g| g.chunks(BATCH)) {
        rays.resize(part.len());
        for (k, item) in part.iter().enumerate() {
            let (from, origin, direction) = ray(item);
            rays.from = from;
            rays.set(k, origin, direction);
        }
        part.iter().zip(tracer.look(&rays)).for_each(|(item, hit)| each(item, hit));
    }
}

/// A wave: where its looks add to, and what they draw their samples from.
pub(super) struct Wave<'a> {
    pub setting: &'a Setting<'a>,
    pub net: &'a Net,
    /// Number of the row's first pixel.
    pub first_pixel: u64,
    /// Randomisations per pixel.
    pub randomisations: u32,
    /// Slots (pixel by randomisation) x bands.
    pub sums: Vec<f64>,
    /// Rays cast.
    pub rays: u64,
    pub beams: Beams,
    pub buffer: Vec<f64>,
}

impl<'a> Wave<'a> {
    /// Follows looks to their ends.
    pub fn follow(&mut self, mut looks: Vec<Look>) {
        let tracer = self.setting.tracer;
        while !looks.is_empty() {
            self.rays += looks.len() as u64;
            looks.sort_by_key(|l| l.from);
            let mut next = Vec::new();
            in_groups(tracer, &looks, |l| (l.from, l.origin, l.direction), |l, hit| self.meet(l, hit, &mut next));
            self.rays += self.setting.arrive(&mut self.beams, &mut self.sums);
            looks = next;
        }
    }

    fn meet(&mut self, look: &Look, hit: Option<(u32, DVec3, u32)>, next: &mut Vec<Look>) {
        let end = hit.map_or(f64::INFINITY, |(_, at, _)| at.distance(look.origin));
        let mut rest = *look;
        for leaf in self.setting.grove.met(look.origin, look.direction, end, look.viewer) {
            self.leaf(&rest, &leaf);
            rest.weight *= 1.0 - leaf.texel[3];
        }
        if rest.weight <= 0.0 {
            return;
        }
        match hit {
            None => self.background(&rest),
            Some(hit) => self.surface(&rest, self.setting.spot(hit, rest.direction), next),
        }
    }

    pub(super) fn add(&mut self, slot: u32, values: impl Iterator<Item = f64>) {
        let at = slot as usize * self.setting.bands;
        self.sums[at..at + self.setting.bands].iter_mut().zip(values).for_each(|(s, v)| *s += v);
    }

    /// Adds the fog's own radiance over a distance; returns what is left of the weight.
    pub(super) fn fog(&mut self, slot: u32, weight: f64, distance: f64) -> f64 {
        let Some(fog) = &self.setting.appearance.fog else { return weight };
        let clear = self.setting.clear(distance);
        self.add(slot, fog.radiance.iter().map(|l| weight * (1.0 - clear) * l));
        weight * clear
    }

    fn background(&mut self, look: &Look) {
        let mut out = std::mem::take(&mut self.buffer);
        let setting = self.setting;
        setting.backdrop.radiance(&setting.lamps, look.origin, look.direction, look.at, &mut out);
        let at = setting.appearance.fog.as_ref().and_then(|f| f.background_at);
        let weight = at.map_or(look.weight, |d| self.fog(look.slot, look.weight, d));
        self.add(look.slot, out.iter().map(|l| weight * l));
        self.buffer = out;
    }

    fn surface(&mut self, look: &Look, spot: Spot, next: &mut Vec<Look>) {
        let setting = self.setting;
        let distance = spot.point.distance(look.viewer);
        if let Some(flat) = setting.options.flat {
            let weight = self.fog(look.slot, look.weight, distance);
            let at = spot.facet as usize * setting.bands;
            self.add(look.slot, flat[at..at + setting.bands].iter().map(|l| weight * l));
            return;
        }
        let (mirrored, through) = setting.shares(&spot);
        let index = spot.finish.map_or(1.0, |f| f.refraction);
        let straight = index == 1.0 || index <= 0.0;
        // What goes straight on has its fog from the eye to what is behind, all at once.
        let stays = if straight { look.weight * (1.0 - through) } else { look.weight };
        let clear = if stays > 0.0 { self.fog(look.slot, stays, distance) / stays } else { 0.0 };
        let weight = look.weight * clear;
        self.matt(look, &spot, weight * (1.0 - mirrored - through));
        if look.depth >= DEEPEST {
            return;
        }
        let on = Look { origin: spot.point, from: spot.facet, depth: look.depth + 1, ..*look };
        let bent = |direction: DVec3, weight: f64| Look { viewer: spot.point, at: None, direction, weight, ..on };
        let back = bent(mirror(look.direction, spot.normal), weight * mirrored);
        let mut send = |l: Look| {
            if l.weight > 0.0 {
                next.push(l);
            }
        };
        if straight {
            send(back);
            // Straight on: the eye sees what is behind as if the pane were not there.
            send(Look { weight: look.weight * through, ..on });
            return;
        }
        let ratio = if spot.at_front { 1.0 / index } else { index };
        match refract(look.direction, spot.normal, ratio) {
            Some(direction) => {
                send(back);
                send(bent(direction, weight * through));
            }
            None => send(Look { weight: weight * (mirrored + through), ..back }),
        }
    }
}

/// Where a mirror throws a look.
fn mirror(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// Snell's law: `ratio` is the index on the near side over that on the far side; `None` where nothing goes through.
fn refract(direction: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let level = (direction - direction.dot(normal) * normal) * ratio;
    let rest = 1.0 - level.length_squared();
    (rest >= 0.0).then(|| (level - rest.sqrt() * normal).normalize())
}
