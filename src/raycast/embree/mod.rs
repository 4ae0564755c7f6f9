//! The Embree kernel: packets of eight in single precision, delicate rays in double precision.
//!
//! Single precision knows places to about 1e-7 of the scene's size. Three kinds of rays need more, and go to
//! the built-in kernel instead:
//!
//! - those that *start* within [`REACH`] of something they do not stand on: rounding, and the step off their own
//!   plane, may put them on its other side;
//! - those that meet something within [`NEAR_HIT`], or a facet of their own plane after all;
//! - those that meet a facet with another one less than [`REACH`] before or behind it: Embree may name the wrong
//!   one of the two.
//!
//! All other rays start one small step ([`STEP`]) off their own plane, which is how that plane is not met:
//! no minimum distance, and no light lost in proportion to the step.

mod library;
mod near;
mod stacked;

use super::builtin::BuiltinKernel;
use super::{KernelError, KernelInfo, RayBatch, RayKernel};
use crate::math::DVec3;
use crate::scene::{NO_FACET, Stage};
use embree4_sys::{RTC_INVALID_GEOMETRY_ID, RTCRayHit8, Valid8};
use near::{Checks, Surroundings};
use std::path::Path;
use std::sync::Arc;

pub(super) use library::load;

/// Step off the own plane, in scene diagonals: eight times the rounding of a coordinate, which covers origin,
/// corners and the arithmetic of an intersection.
const STEP: f64 = 5e-7;

/// Origins this near to something, in diagonals, are not trusted to single precision: four steps.
const REACH: f64 = 4.0 * STEP;

/// Hits this near, in diagonals, are decided again.
const NEAR_HIT: f64 = 1e-5;

/// Top bit of a facet number in the triangle table: hits on it are decided again.
const DELICATE: u32 = 1 << 31;

/// Embree 4 on a stage.
pub struct EmbreeKernel {
    info: KernelInfo,
    scene: library::Scene,
    /// Facet of each triangle, with the mark of delicate ones.
    facet_of: Vec<u32>,
    surroundings: Surroundings,
    exact: Arc<BuiltinKernel>,
}

impl EmbreeKernel {
    /// Loads the library and prepares a stage. `exact` decides what is too fine for single precision; it must
    /// have been made from the same stage.
    ///
    /// # Errors
    /// [`KernelError::Unusable`] if the library is refused, [`KernelError::Failed`] if it reports an error.
    pub fn new(library: &Path, stage: &Stage, exact: Arc<BuiltinKernel>) -> Result<Self, KernelError> {
        let library =
            load(library).map_err(|e| KernelError::Unusable { path: library.to_owned(), why: e.to_string() })?;
        let device = library::Device::new()?;
        let info = device.info(library);
        let (corners, triangles, mut facet_of) = triangulate(stage, exact.polygons().centre());
        let reach = REACH * exact.polygons().diagonal();
        let delicate = stacked::closely_stacked(stage, &exact, reach);
        facet_of.iter_mut().filter(|f| delicate[**f as usize]).for_each(|f| *f |= DELICATE);
        Ok(Self {
            info,
            scene: library::Scene::new(device, &corners, &triangles)?,
            facet_of,
            surroundings: Surroundings::new(stage, &exact, reach),
            exact,
        })
    }

    /// The arbiter this kernel asks.
    pub fn exact(&self) -> &Arc<BuiltinKernel> {
        &self.exact
    }

    /// Reads what a packet met. Bits of `again` mark the rays to be decided again, also in the result.
    #[inline]
    fn read(&self, packet: &RTCRayHit8, own: u32, near_hit: f32, facets: &mut [u32; 8]) -> u32 {
        let groups = self.exact.polygons().groups();
        let mut again = 0;
        for k in 0..8 {
            if packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID {
                facets[k] = NO_FACET;
                continue;
            }
            let marked = self.facet_of[packet.hit.primID[k] as usize];
            facets[k] = marked & !DELICATE;
            let doubtful = marked & DELICATE != 0 || packet.ray.tfar[k] < near_hit || groups[facets[k] as usize] == own;
            again |= u32::from(doubtful) << k;
        }
        again
    }
}

impl RayKernel for EmbreeKernel {
    fn info(&self) -> &KernelInfo {
        &self.info
    }

    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        let Some(near) = brought_near(rays, &self.exact) else { return self.trace(rays, facets) };
        self.trace(&near, facets);
    }
}

impl EmbreeKernel {
    fn trace(&self, rays: &RayBatch, facets: &mut [u32]) {
        let polygons = self.exact.polygons();
        let diagonal = polygons.diagonal();
        let (reach, near_hit) = ((REACH * diagonal) as f32, (NEAR_HIT * diagonal) as f32);
        let start = Start { centre: polygons.centre(), step: polygons.normal_of(rays.from) * (STEP * diagonal) };
        let mut local = Checks::default();
        let checks = self.surroundings.checks_for(&self.exact, rays.from, || bounds_of(rays), &mut local);
        let own = polygons.own_group(rays.from);
        let mut packet = RTCRayHit8::default();
        let mut found = [NO_FACET; 8];
        for first in (0..rays.len()).step_by(8) {
            let count = (rays.len() - first).min(8);
            start.fill(rays, first, count, &mut packet);
            self.scene.intersect(&mut packet, &FIRST[count]);
            let mut again = self.read(&packet, own, near_hit, &mut found);
            if !checks.is_empty() {
                let r = &packet.ray;
                again |= checks.near(polygons, &r.org_x, &r.org_y, &r.org_z, reach);
            }
            facets[first..first + count].copy_from_slice(&found[..count]);
            again &= (1 << count) - 1;
            while again != 0 {
                let k = first + again.trailing_zeros() as usize;
                again &= again - 1;
                facets[k] = self.exact.intersect_one(rays.origin_of(k), rays.direction_of(k), rays.from);
            }
        }
    }
}

/// Masks for the first so many rays of a packet.
const FIRST: [Valid8; 9] = {
    let mut masks = [Valid8([0; 8]); 9];
    let mut n = 0;
    while n < 9 {
        let mut k = 0;
        while k < n {
            masks[n].0[k] = -1;
            k += 1;
        }
        n += 1;
    }
    masks
};

/// Where rays are taken from.
struct Start {
    centre: DVec3,
    /// Step off the own plane on its front; zero for a camera.
    step: DVec3,
}

impl Start {
    /// Fills a packet with `count` rays, each off its own plane on the side it leaves by.
    #[inline]
    fn fill(&self, rays: &RayBatch, first: usize, count: usize, packet: &mut RTCRayHit8) {
        if let (Some(o), Some(d)) = (eight(&rays.origin, first), eight(&rays.direction, first)) {
            self.fill_lanes(o, d, packet);
        } else {
            let part = |columns: &[Vec<f64>; 3]| {
                std::array::from_fn(|c| std::array::from_fn(|k| columns[c][first + k.min(count - 1)]))
            };
            let (o, d): ([[f64; 8]; 3], [[f64; 8]; 3]) = (part(&rays.origin), part(&rays.direction));
            self.fill_lanes(o.each_ref(), d.each_ref(), packet);
        }
        packet.ray.tfar = [f32::INFINITY; 8];
        packet.hit.geomID = [RTC_INVALID_GEOMETRY_ID; 8];
    }

    #[inline]
    fn fill_lanes(&self, o: [&[f64; 8]; 3], d: [&[f64; 8]; 3], packet: &mut RTCRayHit8) {
        let (c, s, r) = (self.centre, self.step, &mut packet.ray);
        for k in 0..8 {
            let side = 1f64.copysign(d[0][k] * s.x + d[1][k] * s.y + d[2][k] * s.z);
            r.org_x[k] = (o[0][k] - c.x + side * s.x) as f32;
            r.org_y[k] = (o[1][k] - c.y + side * s.y) as f32;
            r.org_z[k] = (o[2][k] - c.z + side * s.z) as f32;
            r.dir_x[k] = d[0][k] as f32;
            r.dir_y[k] = d[1][k] as f32;
            r.dir_z[k] = d[2][k] as f32;
        }
    }
}

/// Eight entries of each column, if there are so many.
#[inline]
fn eight(columns: &[Vec<f64>; 3], first: usize) -> Option<[&[f64; 8]; 3]> {
    let [x, y, z] = columns.each_ref().map(|c| c.get(first..first + 8).and_then(|s| s.try_into().ok()));
    Some([x?, y?, z?])
}

/// Box around the origins of a batch.
fn bounds_of(rays: &RayBatch) -> [DVec3; 2] {
    let over = |f: fn(f64, f64) -> f64, start| {
        DVec3::from_array(rays.origin.each_ref().map(|c| c.iter().copied().fold(start, f)))
    };
    [over(f64::min, f64::INFINITY), over(f64::max, f64::NEG_INFINITY)]
}

/// Rays of a distant camera, moved to the edge of the scene; `None` if there is no need.
fn brought_near(rays: &RayBatch, exact: &BuiltinKernel) -> Option<RayBatch> {
    if rays.from != NO_FACET || rays.is_empty() {
        return None;
    }
    let reach = exact.polygons().diagonal();
    let far = bounds_of(rays).iter().any(|p| (*p - exact.polygons().centre()).abs().max_element() > reach);
    far.then(|| {
        let mut near = rays.clone();
        for k in 0..rays.len() {
            let direction = rays.direction_of(k);
            near.set(k, exact.advanced(rays.origin_of(k), direction), direction);
        }
        near
    })
}

/// Corners of every facet from the centre, triangles of their fans, and the facet of each triangle.
fn triangulate(stage: &Stage, centre: DVec3) -> (Vec<[f32; 3]>, Vec<[u32; 3]>, Vec<u32>) {
    let (mut corners, mut triangles, mut facet_of) = (Vec::new(), Vec::new(), Vec::new());
    for (facet, number) in stage.facets.iter().zip(0..) {
        let first = corners.len() as u32;
        corners.extend(facet.vertices.iter().map(|v| (*v - centre).as_vec3().to_array()));
        for k in 1..facet.vertices.len() as u32 - 1 {
            triangles.push([first, first + k, first + k + 1]);
            facet_of.push(number);
        }
    }
    (corners, triangles, facet_of)
}
