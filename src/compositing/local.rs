//! Local ray tracing: only from faces that mirror or refract, and only for them.

use super::mapping::Finished;
use super::rays::{reflected, refracted};
use super::shader::{Bands, Place, Shader, Sight};
use crate::math::DVec3;

/// Rays thrown back more often than this bring nothing.
const DEEPEST: u32 = 8;

impl Shader<'_> {
    /// Turns the matt radiance in `out` into that with a mirrored and a refracted share; true if there is any. `index`:
    /// refractive index of what is behind the front.
    pub(super) fn shine(&self, place: Place, sight: &Sight, finished: &Finished, index: f64, out: &mut [f64]) -> bool {
        let mirrored = finished.reflection;
        let through = finished.transparency.min(1.0 - mirrored);
        if mirrored <= 0.0 && through <= 0.0 {
            return false;
        }
        out.iter_mut().for_each(|v| *v *= 1.0 - mirrored - through);
        if sight.depth >= DEEPEST {
            return true;
        }
        let mut add = |direction: DVec3, share: f64| {
            if share > 0.0 {
                let mut seen = Bands::new(out.len());
                let on = Sight { origin: place.point, direction: direction.normalize(), depth: sight.depth + 1 };
                self.look(&on, place.face, seen.get());
                out.iter_mut().zip(seen.get()).for_each(|(o, s)| *o += share * *s);
            }
        };
        let front = self.image().faces[place.face as usize].normal();
        let normal = if front.dot(place.normal) >= 0.0 { place.normal } else { -place.normal };
        let plain = self.plain(&place);
        let back = reflected(sight.direction, normal);
        // A bump must not throw a look through the face; bending keeps to the face itself.
        let back = if back.dot(plain) > 0.0 { back } else { reflected(sight.direction, plain) };
        match refracted(sight.direction, front, index) {
            Some(onward) => {
                add(back, mirrored);
                add(onward, through);
            }
            None => add(back, mirrored + through),
        }
        true
    }

    /// Radiance along a ray that leaves a face: the nearest face, trees before it, or the background.
    fn look(&self, sight: &Sight, own: u32, out: &mut [f64]) {
        let hit = self.rays.closest(sight.origin, sight.direction, Some(own), |_, _| true);
        let grove = self.grove(sight.origin);
        let mut trees = Vec::new();
        grove.hits(sight.origin, sight.direction, hit.map_or(f64::INFINITY, |h| h.distance), &mut trees);
        let mut part = Bands::new(out.len());
        let part = part.get();
        out.fill(0.0);
        let mut clear = 1.0;
        for tree in &trees {
            let facing = grove.get(tree.tree).map_or(-sight.direction, |t| t.normal);
            let opacity = self.met_tree(tree, facing, sight, part);
            out.iter_mut().zip(&*part).for_each(|(s, p)| *s += clear * opacity * p);
            clear *= 1.0 - opacity;
        }
        match hit {
            Some(hit) => self.met(hit.face, sight.origin + sight.direction * hit.distance, sight, part),
            None => self.background(sight, None, part),
        }
        out.iter_mut().zip(&*part).for_each(|(o, p)| *o += clear * p);
    }
}
