//! Matt radiance of surfaces and trees: emission, and beams that bring light from lamps.

use super::grove::{Leaf, NO_TREE};
use super::lamp::Lamp;
use super::net::Pair;
use super::setting::Spot;
use super::shadow::beam;
use super::wave::{DEEPEST, Look, Wave};
use crate::math::DVec3;
use crate::scene::NO_FACET;
use std::f64::consts::PI;

impl Wave<'_> {
    /// Radiance of a tree: matt, lit from wherever the light is; by soft light, as the mean of a leaf that looks up and
    /// one that looks at the viewer.
    pub(super) fn leaf(&mut self, look: &Look, leaf: &Leaf) {
        let setting = self.setting;
        let point = look.origin + look.direction * leaf.distance;
        let distance = point.distance(look.viewer);
        let opacity = leaf.texel[3];
        let weight = self.fog(look.slot, look.weight * opacity, distance) / opacity;
        let mut colour = std::mem::take(&mut self.buffer);
        setting.in_bands([leaf.texel[0], leaf.texel[1], leaf.texel[2]], &mut colour);
        for (k, lamp) in setting.lamps.iter().enumerate() {
            match lamp.towards(point) {
                Some(to) => self.light(look, k, lamp, (point, NO_FACET, leaf.tree), to, 0, weight, &colour),
                None => {
                    for (which, normal) in [setting.grove.up(leaf.tree), leaf.facing].into_iter().enumerate() {
                        let half = 0.5 * weight;
                        self.light(look, k, lamp, (point, NO_FACET, leaf.tree), normal, which as u64, half, &colour);
                    }
                }
            }
        }
        self.buffer = colour;
    }

    /// Sends one beam of a lamp to a point on a facet or a tree with a normal: `weight * colour * E / pi`.
    fn light(
        &mut self,
        look: &Look,
        number: usize,
        lamp: &Lamp,
        (point, from, tree): (DVec3, u32, u32),
        normal: DVec3,
        which: u64,
        weight: f64,
        colour: &[f64],
    ) {
        let (pixel, r) = (look.slot / self.randomisations, look.slot % self.randomisations);
        let purpose = 1 + which + 2 * (u64::from(look.depth) + u64::from(DEEPEST + 1) * (number as u64));
        // Trees met on one way are at different places: each draws anew.
        let purpose = purpose | (u64::from(tree.wrapping_add(1)) << 32);
        let shift = self.net.shift(self.first_pixel + u64::from(pixel), u64::from(r), purpose);
        let sample = self.net.at(look.sample as usize, Pair::Second, shift);
        let Some(aim) = lamp.aim(point, normal, sample) else { return };
        // A tilted normal may see light that lies below the face: it does not arrive.
        if from != NO_FACET {
            let front = self.setting.stage.facets[from as usize].normal;
            if front.dot(aim.direction) * front.dot(look.direction) >= 0.0 {
                return;
            }
        }
        let mut beam = beam(look.slot, from, point, aim.direction, aim.distance);
        beam.tree = tree;
        let strength = &self.setting.appearance.lights[number].strength;
        let share = weight * aim.factor / PI;
        self.beams.push(beam, colour.iter().zip(strength).map(|(c, s)| share * c * s));
    }

    /// Emission and diffuse reflection of the side that is seen; black backs have neither.
    pub(super) fn matt(&mut self, look: &Look, spot: &Spot, weight: f64) {
        let (Some(patch), true) = (spot.patch, weight > 0.0) else { return };
        let setting = self.setting;
        let mut colour = std::mem::take(&mut self.buffer);
        if let Some(diffuse) = setting.options.diffuse
            && diffuse(patch, spot.point, &mut colour)
        {
            let beyond: Vec<f64> = colour.iter().zip(&spot.material.emission).map(|(b, e)| (b - e).max(0.0)).collect();
            setting.colour(spot, &mut colour);
            self.add(look.slot, beyond.iter().zip(&colour).map(|(b, c)| weight * b * c / PI));
        }
        self.add(look.slot, spot.material.emission.iter().map(|e| weight * e / PI));
        setting.colour(spot, &mut colour);
        colour.iter_mut().zip(&spot.material.reflectance).for_each(|(c, rho)| *c *= rho);
        for (k, lamp) in setting.lamps.iter().enumerate() {
            let on = (spot.point, spot.facet, NO_TREE);
            self.light(look, k, lamp, on, spot.normal, 0, weight, &colour);
        }
        self.buffer = colour;
    }
}
