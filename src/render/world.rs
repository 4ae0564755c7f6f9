//! World projections of a stage: what is seen from one point in all directions [G86 fig. 2].

use crate::math::{DVec3, Frame};
use crate::raycast::{BACK, ESCAPED, RayBatch, TraceScratch, Tracer};
use crate::scene::{NO_FACET, Stage};
use crate::world::{Shape, Spot, WorldMap};
use rayon::prelude::*;
use std::f64::consts::PI;

/// From where the world is looked at, and which way is the front: x to the right, y to the front, z up.
#[derive(Debug, Clone, Copy)]
pub struct Centre {
    /// The world centre, metres.
    pub point: DVec3,
    /// The observer's axes.
    pub frame: Frame,
}

impl Centre {
    /// Looks to the front with `up` up; `front` must not be parallel to it.
    pub fn new(point: DVec3, front: DVec3, up: DVec3) -> Self {
        let z = up.normalize();
        let y = (front - z * front.dot(z)).normalize();
        Self { point, frame: Frame { x: y.cross(z), y, z } }
    }

    /// The same place with the axes of another.
    pub fn moved(&self, point: DVec3) -> Self {
        Self { point, ..*self }
    }
}

/// What is seen from a centre: cast once, for any number of radiosities.
#[derive(Debug, Clone)]
pub struct WorldView {
    /// How directions are laid out.
    pub shape: Shape,
    /// Patch in the middle of each texel: a number, [`BACK`] or [`ESCAPED`].
    pub landings: Vec<u32>,
    /// How far it is, metres; infinite where nothing is.
    pub distances: Vec<f32>,
    /// Texels that show more than one thing, ascending, with the landings of `side * side` samples each.
    mixed: Vec<u32>,
    samples: Vec<u32>,
    side: u32,
    /// Rays that were cast.
    pub rays: u64,
}

impl WorldView {
    /// Casts a ray through the middle of each texel, and `side * side` through each whose neighbours, across edges and
    /// poles too, show another patch. A thing smaller than a texel that no ray through a middle meets is not seen.
    pub fn cast(tracer: &Tracer, centre: &Centre, shape: Shape, side: u32) -> Self {
        let (width, texels) = (shape.width(), shape.texels());
        let rows: Vec<(Vec<u32>, Vec<f32>)> = (0..texels / width)
            .into_par_iter()
            .map(|row| {
                let places: Vec<Option<DVec3>> = (0..width).map(|x| shape.middle(row * width + x)).collect();
                shoot(tracer, centre, &places)
            })
            .collect();
        let (mut landings, mut distances) = (Vec::with_capacity(texels), Vec::with_capacity(texels));
        for (l, d) in rows {
            landings.extend(l);
            distances.extend(d);
        }
        // Texel numbers as values, so that neighbours are found as interpolation finds them.
        let neighbours = WorldMap::new(shape, 1, vec![0.0; texels]);
        let is_mixed = |k: usize| {
            let (panel, x, y) = shape.texel(k);
            let other = |dx: i64, dy: i64| landings[neighbours.wrapped(panel, x as i64 + dx, y as i64 + dy)];
            (-1..=1).any(|dy| (-1..=1).any(|dx| other(dx, dy) != landings[k]))
        };
        let mixed: Vec<u32> = (0..texels as u32)
            .into_par_iter()
            .filter(|k| side > 1 && shape.middle(*k as usize).is_some() && is_mixed(*k as usize))
            .collect();
        let samples: Vec<Vec<u32>> = mixed
            .par_chunks(64)
            .map(|texels| {
                let within = |k: &u32| {
                    let (panel, x, y) = shape.texel(*k as usize);
                    (0..side * side).map(move |s| {
                        let at = |whole: usize, part: u32| whole as f64 + (f64::from(part) + 0.5) / f64::from(side);
                        shape.direction(Spot { panel, x: at(x, s % side), y: at(y, s / side) })
                    })
                };
                let places: Vec<Option<DVec3>> = texels.iter().flat_map(within).collect();
                let mut found = shoot(tracer, centre, &places).0;
                // Samples outside of a fish-eye's circle stand for the middle of their texel.
                let per_texel = (side * side) as usize;
                for (k, landing) in found.iter_mut().enumerate().filter(|(k, _)| places[*k].is_none()) {
                    *landing = landings[texels[k / per_texel] as usize];
                }
                found
            })
            .collect();
        let samples = samples.concat();
        let rays = (landings.len() + samples.len()) as u64;
        Self { shape, landings, distances, mixed, samples, side, rays }
    }

    /// Landings of the samples of a texel: one where it shows one thing.
    pub fn samples(&self, texel: usize) -> &[u32] {
        let n = (self.side * self.side) as usize;
        match self.mixed.binary_search(&(texel as u32)) {
            Ok(k) => &self.samples[k * n..(k + 1) * n],
            Err(_) => std::slice::from_ref(&self.landings[texel]),
        }
    }

    /// Radiances, W/(m^2 sr), of these radiosities (patch-major, W/m^2): B / pi of what is seen, each sample of a texel
    /// alike. Backs and the open are dark.
    pub fn radiances(&self, radiosities: &[f64], bands: usize) -> WorldMap {
        WorldMap::filled(self.shape, bands, |texel, value| {
            let samples = self.samples(texel);
            for (c, v) in value.iter_mut().enumerate() {
                let of = |patch: &u32| if *patch < BACK { radiosities[*patch as usize * bands + c] } else { 0.0 };
                *v = (samples.iter().map(of).sum::<f64>() / samples.len() as f64 / PI) as f32;
            }
        })
    }

    /// Share of each texel that shows a patch.
    pub fn coverage(&self) -> Vec<f32> {
        self.share_of(|landing| landing < BACK)
    }

    /// Share of each texel that shows nothing at all: the open.
    pub fn open(&self) -> Vec<f32> {
        self.share_of(|landing| landing == ESCAPED)
    }

    fn share_of(&self, is_one: impl Fn(u32) -> bool + Sync) -> Vec<f32> {
        let share = |texel: usize| {
            let samples = self.samples(texel);
            samples.iter().filter(|p| is_one(**p)).count() as f32 / samples.len() as f32
        };
        (0..self.shape.texels()).into_par_iter().map(share).collect()
    }

    /// Share of the world, by solid angle, that each patch takes.
    pub fn shares(&self, patches: usize) -> Vec<f64> {
        let mut shares = vec![0.0; patches];
        let mut whole = 0.0;
        for texel in 0..self.shape.texels() {
            let (weight, samples) = (self.shape.solid_angle(texel), self.samples(texel));
            whole += weight;
            for patch in samples.iter().filter(|p| **p < BACK) {
                shares[*patch as usize] += weight / samples.len() as f64;
            }
        }
        shares.iter_mut().for_each(|s| *s /= whole);
        shares
    }
}

/// Landings and distances in these directions of the observer; where there is none, nothing is seen.
fn shoot(tracer: &Tracer, centre: &Centre, directions: &[Option<DVec3>]) -> (Vec<u32>, Vec<f32>) {
    let mut rays = RayBatch::zeroed(directions.len());
    rays.from = NO_FACET;
    for (k, d) in directions.iter().enumerate() {
        // A ray into the front takes the place of one that is not wanted.
        rays.set(k, centre.point, centre.frame.to_world(d.unwrap_or(DVec3::Y)));
    }
    let (mut landings, mut scratch) = (vec![0; directions.len()], TraceScratch::default());
    tracer.trace(&rays, &mut landings, &mut scratch);
    let blank = |(l, d): (&mut u32, &Option<DVec3>)| {
        if d.is_none() {
            *l = ESCAPED;
        }
    };
    landings.iter_mut().zip(directions).for_each(blank);
    let stage = tracer.stage();
    let far = |(k, l): (usize, &u32)| distance(stage, *l, centre.point, rays.direction_of(k)) as f32;
    let distances = landings.iter().enumerate().map(far).collect();
    (landings, distances)
}

/// How far along a unit direction the plane of a landing is; infinite for no patch.
pub fn distance(stage: &Stage, landing: u32, from: DVec3, direction: DVec3) -> f64 {
    let along = |p: &crate::scene::Patch| p.normal.dot(p.corners[0] - from) / p.normal.dot(direction);
    stage.patches.get(landing as usize).map_or(f64::INFINITY, along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formfactor::point_to_polygon;
    use crate::render::testing::{direct_light, room, tracer};
    use crate::world::Layout;

    fn centre() -> Centre {
        Centre::new(DVec3::new(1.9, 1.1, 1.2), DVec3::new(0.3, 1.0, 0.2), DVec3::Z)
    }

    #[test]
    fn texels_show_what_is_there() {
        let stage = room();
        for layout in [Layout::Cube, Layout::LatLong, Layout::SineLatLong, Layout::Fisheye { field: 180.0 }] {
            let view = WorldView::cast(&tracer(&stage), &centre(), Shape { layout, size: 24 }, 3);
            let mut checked = 0;
            for k in 0..view.shape.texels() {
                let Some(d) = view.shape.middle(k) else { continue };
                let p = centre().point + centre().frame.to_world(d) * f64::from(view.distances[k]);
                let patch = &stage.patches[view.landings[k] as usize];
                let n = patch.corners.len();
                for i in 0..n {
                    let (a, b) = (patch.corners[i], patch.corners[(i + 1) % n]);
                    assert!(patch.normal.cross(b - a).dot(p - a) > -1e-5, "{layout:?} {k}");
                }
                checked += 1;
            }
            assert!(checked > 400);
            let closed: f64 = view.shares(stage.patch_count()).iter().sum();
            assert!((closed - 1.0).abs() < 1e-9 || layout == Layout::Fisheye { field: 180.0 }, "{closed}");
        }
    }

    /// The solid angle of a wall's patches from within the room, by the vector form factors of a tiny sphere: the share
    /// of all texels that show them comes to it.
    #[test]
    fn shares_of_the_world_come_to_the_solid_angles() {
        let stage = room();
        let view = WorldView::cast(&tracer(&stage), &centre(), Shape { layout: Layout::Cube, size: 128 }, 4);
        let shares = view.shares(stage.patch_count());
        // Spherical excess of the lamp, from two triangles.
        let lamp: Vec<usize> = (0..stage.patch_count()).filter(|i| stage.emission(*i)[0] > 0.0).collect();
        let seen: f64 = lamp.iter().map(|i| shares[*i]).sum();
        let solid = |c: &[DVec3]| {
            let v: Vec<DVec3> = c.iter().map(|p| (*p - centre().point).normalize()).collect();
            let triangle = |a: DVec3, b: DVec3, c: DVec3| {
                2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
            };
            triangle(v[0], v[1], v[2]) + triangle(v[0], v[2], v[3])
        };
        let exact: f64 = lamp.iter().map(|i| solid(&stage.patches[*i].corners)).sum::<f64>() / (4.0 * PI);
        assert!((seen / exact - 1.0).abs() < 3e-3, "{seen} {exact}");
    }

    #[test]
    fn what_is_taken_away_is_not_seen_and_numbers_stay() {
        let stage = room();
        let gone = stage.without(&stage.surfaces_named("sail"));
        assert_eq!(gone.patch_count(), stage.patch_count());
        let shape = Shape { layout: Layout::Cube, size: 16 };
        let (before, after) = (
            WorldView::cast(&tracer(&stage), &centre(), shape, 1),
            WorldView::cast(&tracer(&gone), &centre(), shape, 1),
        );
        let is_sail = |p: u32| stage.surface_name(p as usize) == "sail";
        assert!(before.landings.iter().any(|p| is_sail(*p)) && !after.landings.iter().any(|p| is_sail(*p)));
        for (b, a) in before.landings.iter().zip(&after.landings) {
            assert!(is_sail(*b) || a == b);
        }
        assert!(stage.surfaces_named("nothing").is_empty());
    }

    /// Irradiance from texels, cosine by cosine, against Lambert's formula of every patch: no occluder in the way.
    #[test]
    fn light_of_the_map_is_that_of_the_polygons() {
        let full = room();
        let stage = full.without(&full.surfaces_named("sail"));
        let b = direct_light(&stage, true);
        let view = WorldView::cast(&tracer(&stage), &centre(), Shape { layout: Layout::Cube, size: 64 }, 8);
        let map = view.radiances(&b.values, b.bands);
        for normal in [DVec3::Z, DVec3::new(0.3, -0.5, 0.2).normalize()] {
            let local = centre().frame.to_local(normal);
            let of_texel = |k: usize| {
                let cosine = map.shape().middle(k).map_or(0.0, |d| d.dot(local).max(0.0));
                f64::from(map.texel(k)[0]) * cosine * map.shape().solid_angle(k)
            };
            let got: f64 = (0..map.shape().texels()).map(of_texel).sum();
            let exact: f64 = (0..stage.patch_count())
                .filter(|i| stage.patches[*i].is_present())
                .map(|i| {
                    let p = &stage.patches[i];
                    let front = p.normal.dot(centre().point - p.corners[0]) > 0.0;
                    let above = crate::math::clip_to_half_space(&p.corners, normal, normal.dot(centre().point));
                    let seen = front && above.len() > 2;
                    if seen { point_to_polygon(centre().point, normal, &above) * b.of(i)[0] } else { 0.0 }
                })
                .sum();
            assert!((got / exact - 1.0).abs() < 2e-3, "{got} {exact}");
        }
    }
}
