//! Pictures: the three spheres of [G86 fig. 8] and the object in its scene, shaded `dc D + sc S` by the map, by the
//! hybrid, and by rays.

use super::irradiance::nearest;
use crate::audit::envmap::{Lobe, Station, mean_in, mean_near};
use crate::math::DVec3;
use crate::raycast::{BACK, RayBatch, Tracer};
use crate::render::Centre;
use crate::sampling::{Role, Stream};
use crate::scene::NO_FACET;
use crate::view::Camera;
use crate::world::{Cone, DiffuseMap, Pyramid};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Rays for the diffuse light of a pixel.
const RAYS: u64 = 1024;

/// A map in all bands.
pub(super) struct Coloured {
    pub centre: Centre,
    pub pyramid: Pyramid,
    pub table: DiffuseMap,
}

/// How a pixel of the object is come by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum By {
    /// Looked up in the map.
    Map,
    /// Rays near by, the map beyond.
    Hybrid,
    /// Rays.
    Rays,
}

/// A picture of radiances; not a number where nothing is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Stem of its file.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Bands.
    pub bands: usize,
    /// Radiances, W/(m^2 sr), row-major, bands side by side.
    pub values: Vec<f32>,
}

/// What a pixel shows of the object.
#[derive(Debug, Clone, Copy)]
struct Pixel {
    place: DVec3,
    facet: u32,
    normal: DVec3,
    /// Mirror directions of its four corners, in order around; `None` where a corner misses the object.
    corners: [Option<DVec3>; 4],
    /// Of its middle.
    mirror: DVec3,
}

/// Shades pixels.
pub(super) struct Shader<'a> {
    pub maps: &'a [Coloured],
    pub radiosities: &'a [f64],
    pub bands: usize,
    pub dc: f64,
    pub sc: f64,
    /// How far the rays of the hybrid go, metres.
    pub reach: f64,
    pub seed: u64,
}

fn mirrored(d: DVec3, n: DVec3) -> DVec3 {
    (d - n * (2.0 * d.dot(n))).normalize()
}

impl Shader<'_> {
    fn map(&self, place: DVec3) -> &Coloured {
        &self.maps[nearest(place, self.maps.iter().map(|m| m.centre.point))]
    }

    fn shade(&self, tracer: &Tracer, pixel: &Pixel, by: By, number: u64) -> Vec<f64> {
        let map = self.map(pixel.place);
        let local = |d: DVec3| map.centre.frame.to_local(d);
        let cone = Cone::given(&pixel.corners.map(|c| c.map(local))).unwrap_or(Cone::round(local(pixel.mirror), 1e-3));
        let looked_up = || map.pyramid.ewa(&cone);
        let (diffuse, mirror) = match by {
            By::Map => {
                let d = map.table.lookup(local(pixel.normal)).iter().map(|e| e / PI).collect();
                (d, looked_up())
            }
            By::Rays | By::Hybrid => {
                let reach = if by == By::Rays { f64::INFINITY } else { self.reach };
                (self.diffuse(tracer, pixel, map, reach, number), self.traced(tracer, pixel, reach, looked_up))
            }
        };
        diffuse.iter().zip(&mirror).map(|(d, s): (&f64, &f64)| self.dc * d + self.sc * s).collect()
    }

    /// Mean radiance over the hemisphere, by cosine.
    fn diffuse(&self, tracer: &Tracer, pixel: &Pixel, map: &Coloured, reach: f64, number: u64) -> Vec<f64> {
        if self.dc == 0.0 {
            return vec![0.0; self.bands];
        }
        let stream = Stream::new(Role::Witness, self.seed).child(number);
        let station =
            Station { place: pixel.place, axis: pixel.normal, horizon: Some(pixel.normal), facet: pixel.facet };
        if reach.is_infinite() {
            let mean = mean_in(tracer, &station, Lobe::Cosine, self.radiosities, self.bands, stream, RAYS);
            return mean.iter().map(|b| b / PI).collect();
        }
        let far = |d: DVec3| map.pyramid.base().nearest(map.centre.frame.to_local(d));
        mean_near(
            tracer,
            &station,
            reach,
            &|landing, d, sum: &mut [f64]| match landing {
                Some(patch) => self.add_radiance(patch, sum),
                None => far(d).into_iter().flatten().zip(sum).for_each(|(l, s)| *s += f64::from(*l)),
            },
            self.bands,
            stream,
            RAYS,
        )
    }

    fn add_radiance(&self, patch: u32, sum: &mut [f64]) {
        let at = patch as usize * self.bands;
        // The back of something has no number: dark.
        let of = self.radiosities.get(at..at + self.bands).unwrap_or(&[]);
        sum.iter_mut().zip(of).for_each(|(s, b)| *s += b / PI);
    }

    /// Mean radiance of the mirror directions of middle and corners; of the map where they go beyond the reach.
    fn traced(&self, tracer: &Tracer, pixel: &Pixel, reach: f64, map: impl Fn() -> Vec<f64>) -> Vec<f64> {
        let directions: Vec<DVec3> = pixel.corners.iter().flatten().copied().chain([pixel.mirror]).collect();
        let mut rays = RayBatch::zeroed(directions.len());
        rays.from = pixel.facet;
        directions.iter().enumerate().for_each(|(k, d)| rays.set(k, pixel.place, *d));
        let mut sum = vec![0.0; self.bands];
        let mut beyond = 0.0;
        for hit in tracer.look(&rays) {
            let near = hit.filter(|(_, point, _)| point.distance(pixel.place) <= reach);
            match near {
                // Backs are dark.
                Some((_, _, landing)) => self.add_radiance(landing, &mut sum),
                None => beyond += if reach.is_finite() { 1.0 } else { 0.0 },
            }
        }
        if beyond > 0.0 {
            map().iter().zip(&mut sum).for_each(|(l, s)| *s += beyond * l);
        }
        sum.iter().map(|s| s / directions.len() as f64).collect()
    }

    fn picture(&self, tracer: &Tracer, [width, height]: [u32; 2], pixels: &[Option<Pixel>], by: By) -> Vec<f32> {
        let of = |(k, p): (usize, &Option<Pixel>)| -> Vec<f32> {
            p.as_ref().map_or(vec![f32::NAN; self.bands], |p| {
                self.shade(tracer, p, by, k as u64).into_iter().map(|l| l as f32).collect()
            })
        };
        debug_assert_eq!(pixels.len(), width as usize * height as usize);
        pixels.par_iter().enumerate().flat_map_iter(of).collect()
    }

    /// Spheres about the first centre, seen from `eye` in parallel light of sight: diffuse, half and half, mirror; by the
    /// map and by rays from where the sphere is.
    pub(super) fn spheres(&mut self, bare: &Tracer, eye: DVec3, radius: f64, size: u32) -> Vec<Picture> {
        let centre = self.maps[0].centre;
        let pixels = sphere(&centre, eye, radius, size);
        let mut pictures = Vec::new();
        let kept = (self.dc, self.sc);
        for (name, dc, sc) in [("diffuse", 1.0, 0.0), ("half", 0.5, 0.5), ("mirror", 0.0, 1.0)] {
            (self.dc, self.sc) = (dc, sc);
            for (by, how) in [(By::Map, "map"), (By::Rays, "rays")] {
                pictures.push(Picture {
                    name: format!("sphere-{name}-{how}"),
                    title: format!("{dc} D + {sc} S by {}", if by == By::Map { "the map" } else { "rays" }),
                    width: size,
                    height: size,
                    bands: self.bands,
                    values: self.picture(bare, [size, size], &pixels, by),
                });
            }
        }
        (self.dc, self.sc) = kept;
        pictures
    }

    /// The object in its scene, by map, hybrid and rays; what is no object is as it was solved.
    pub(super) fn in_scene(&self, full: &Tracer, camera: &Camera, surfaces: &[u32]) -> Vec<Picture> {
        let [width, height] = camera.size;
        let (pixels, around) = self.seen(full, camera, surfaces);
        let one = |(by, name, title): (By, &str, &str)| {
            let mut values = self.picture(full, camera.size, &pixels, by);
            for (v, a) in values.iter_mut().zip(&around).filter(|(v, _)| v.is_nan()) {
                *v = *a;
            }
            Picture { name: name.into(), title: title.into(), width, height, bands: self.bands, values }
        };
        let all = [
            (By::Map, "object-map", "shaded by the map"),
            (By::Hybrid, "object-hybrid", "rays near by, the map beyond"),
            (By::Rays, "object-rays", "by rays"),
        ];
        all.into_iter().map(one).collect()
    }

    /// Pixels of the object, and radiances of everything else.
    fn seen(&self, full: &Tracer, camera: &Camera, surfaces: &[u32]) -> (Vec<Option<Pixel>>, Vec<f32>) {
        let [width, height] = camera.size;
        let row = |y: u32| {
            let mut rays = RayBatch::zeroed(width as usize);
            rays.from = NO_FACET;
            (0..width).for_each(|x| {
                rays.set(x as usize, camera.eye, camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5));
            });
            let pixel = |(x, hit): (usize, Option<(u32, DVec3, u32)>)| {
                let mut around = vec![0.0; self.bands];
                let (facet, place, patch) = hit.filter(|(_, _, l)| *l < BACK)?;
                self.add_radiance(patch, &mut around);
                let around: Vec<f32> = around.into_iter().map(|l| l as f32).collect();
                let stage = full.stage();
                if !surfaces.contains(&stage.facets[facet as usize].surface) {
                    return Some((None, around));
                }
                let n = stage.patches[patch as usize].normal;
                let at = |dx: f64, dy: f64| mirrored(camera.direction(x as f64 + dx, f64::from(y) + dy), n);
                let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(dx, dy)| Some(at(dx, dy)));
                Some((Some(Pixel { place, facet, normal: n, corners, mirror: at(0.5, 0.5) }), around))
            };
            let blank = || (None, vec![0.0; self.bands]);
            let seen = full.look(&rays).into_iter().enumerate().map(|h| pixel(h).unwrap_or_else(blank));
            seen.collect::<Vec<(Option<Pixel>, Vec<f32>)>>()
        };
        let rows: Vec<(Option<Pixel>, Vec<f32>)> = (0..height).into_par_iter().flat_map_iter(row).collect();
        let (pixels, around): (Vec<_>, Vec<Vec<f32>>) = rows.into_iter().unzip();
        (pixels, around.concat())
    }
}

/// Pixels of a sphere in parallel projection.
fn sphere(centre: &Centre, eye: DVec3, radius: f64, size: u32) -> Vec<Option<Pixel>> {
    let along = (centre.point - eye).try_normalize().unwrap_or(centre.frame.y);
    let up = if along.dot(centre.frame.z).abs() < 0.99 { centre.frame.z } else { centre.frame.y };
    let right = along.cross(up).normalize();
    let up = right.cross(along);
    let normal = |x: f64, y: f64| {
        let (u, v) = (2.0 * x / f64::from(size) - 1.0, 1.0 - 2.0 * y / f64::from(size));
        let rest = 1.0 - u * u - v * v;
        (rest >= 0.0).then(|| right * u + up * v - along * rest.sqrt())
    };
    let pixel = |k: u32| {
        let (x, y) = (f64::from(k % size), f64::from(k / size));
        let n = normal(x + 0.5, y + 0.5)?;
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(dx, dy)| normal(x + dx, y + dy).map(|n| mirrored(along, n)));
        let place = centre.point + n * radius;
        Some(Pixel { place, facet: NO_FACET, normal: n, corners, mirror: mirrored(along, n) })
    };
    (0..size * size).map(pixel).collect()
}
