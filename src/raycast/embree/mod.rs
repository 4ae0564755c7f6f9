//! The Embree kernel: packets of eight in single precision, delicate rays in double precision.
//!
//! Single precision knows places to about 1e-7 of the scene's size. Three kinds of rays need more, and go to
//! the built-in kernel instead:
//!
//! - those that *start* within [`REACH`] of something they do not stand on: rounding, and the step off their own
//!   plane, may put them on its other side;
//! - those that meet something within [`NEAR_HIT`], or a facet of their own plane after all;
//! - those that end where another facet lies less than [`REACH`] before or behind: Embree may name the wrong one
//!   of the two.
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
use embree4_sys::{Library, RTC_INVALID_GEOMETRY_ID, RTCRay8, RTCRayHit8, Valid8};
use near::{Checks, Surroundings};
use stacked::Stacks;
use std::sync::Arc;

pub(super) use library::load;

/// Step off the own plane, in scene diagonals: eight times the rounding of a coordinate, which covers origin,
/// corners and the arithmetic of an intersection.
const STEP: f64 = 5e-7;

/// Origins this near to something, in diagonals, are not trusted to single precision: four steps.
const REACH: f64 = 4.0 * STEP;

/// Hits this near, in diagonals, are decided again.
const NEAR_HIT: f64 = 1e-5;

/// Top bit of a facet number in the triangle table: something is stacked on it.
const DELICATE: u32 = 1 << 31;

/// Traces packets of rays in single precision.
pub trait TracePacket: Send + Sync {
    /// Traces the rays of a packet that are marked valid. Triangles are numbered as they were handed over.
    fn trace(&self, packet: &mut RTCRayHit8, valid: &Valid8);
}

/// A triangle mesh for single precision.
pub(super) struct Mesh {
    /// From the scene's centre.
    pub(super) corners: Vec<[f32; 3]>,
    /// Numbers of three corners each.
    pub(super) triangles: Vec<[u32; 3]>,
    facet_of: Vec<u32>,
}

/// What a triangle belongs to.
struct Triangle {
    /// Facet, with the mark of those that have something stacked on them.
    facet: u32,
    /// Its plane group.
    group: u32,
}

/// Embree 4 on a stage; `T` is the way to reach it.
pub struct EmbreeKernel<T = library::Scene> {
    info: KernelInfo,
    scene: T,
    triangles: Vec<Triangle>,
    surroundings: Surroundings,
    stacks: Stacks,
    exact: Arc<BuiltinKernel>,
}

impl EmbreeKernel {
    /// Prepares a stage on a library that is in use. `exact` decides what is too fine for single precision; it
    /// must have been made from the same stage.
    ///
    /// # Errors
    /// [`KernelError::Failed`] if the library reports an error.
    pub fn new(library: &Library, stage: &Stage, exact: Arc<BuiltinKernel>) -> Result<Self, KernelError> {
        let device = library::Device::new()?;
        let info = device.info(library);
        let mesh = Mesh::new(stage, &exact);
        let scene = library::Scene::new(device, &mesh)?;
        Ok(Self::around(scene, mesh, info, stage, exact))
    }
}

impl<T: TracePacket> EmbreeKernel<T> {
    /// The kernel around a scene that was made from `mesh`.
    pub(super) fn around(scene: T, mesh: Mesh, info: KernelInfo, stage: &Stage, exact: Arc<BuiltinKernel>) -> Self {
        let reach = REACH * exact.polygons().diagonal();
        let stacks = Stacks::new(stage, &exact, reach);
        let triangles = mesh.facet_of.iter().map(|&f| Triangle {
            facet: if stacks.any(f) { f | DELICATE } else { f },
            group: exact.polygons().own_group(f),
        });
        let (triangles, surroundings) = (triangles.collect(), Surroundings::new(stage, &exact, reach));
        Self { info, scene, triangles, surroundings, stacks, exact }
    }

    /// Reads what a packet met. Bits of `again` mark the rays to be decided again, also in the result.
    #[inline]
    fn read(&self, packet: &RTCRayHit8, own: u32, near_hit: f32, facets: &mut [u32; 8]) -> u32 {
        let mut again = 0;
        for k in 0..8 {
            if packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID {
                facets[k] = NO_FACET;
                continue;
            }
            let met = &self.triangles[packet.hit.primID[k] as usize];
            facets[k] = met.facet & !DELICATE;
            let delicate = met.facet & DELICATE != 0 && self.is_stacked(facets[k], &packet.ray, k);
            again |= u32::from(delicate || packet.ray.tfar[k] < near_hit || met.group == own) << k;
        }
        again
    }

    /// True if something lies closely before or behind the point where ray k ends.
    #[cold]
    fn is_stacked(&self, facet: u32, r: &RTCRay8, k: usize) -> bool {
        let t = r.tfar[k];
        let end = [r.org_x[k] + t * r.dir_x[k], r.org_y[k] + t * r.dir_y[k], r.org_z[k] + t * r.dir_z[k]];
        self.stacks.near(facet, end, (2.0 * REACH * self.exact.polygons().diagonal()) as f32)
    }
}

impl<T: TracePacket> RayKernel for EmbreeKernel<T> {
    fn info(&self) -> &KernelInfo {
        &self.info
    }

    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        let Some(near) = brought_near(rays, &self.exact) else { return self.trace(rays, facets) };
        self.trace(&near, facets);
    }
}

impl<T: TracePacket> EmbreeKernel<T> {
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
            self.scene.trace(&mut packet, &FIRST[count]);
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

/// Rays made ready for Embree: what the benchmark compares the kernel with.
#[derive(Debug, Clone)]
pub struct Packets(Vec<RTCRay8>);

impl EmbreeKernel {
    /// Converts whole packets of rays; what is left over is dropped.
    pub fn packets(&self, rays: &RayBatch) -> Packets {
        let polygons = self.exact.polygons();
        let step = polygons.normal_of(rays.from) * (STEP * polygons.diagonal());
        let start = Start { centre: polygons.centre(), step };
        let mut packet = RTCRayHit8::default();
        let whole = (0..rays.len() / 8).map(|p| {
            start.fill(rays, 8 * p, 8, &mut packet);
            packet.ray
        });
        Packets(whole.collect())
    }

    /// Nothing but Embree: traces packets and counts the hits.
    pub fn trace_raw(&self, packets: &Packets) -> usize {
        let mut packet = RTCRayHit8::default();
        let mut hits = 0;
        for rays in &packets.0 {
            packet.ray = *rays;
            packet.hit.geomID = [RTC_INVALID_GEOMETRY_ID; 8];
            self.scene.trace(&mut packet, &FIRST[8]);
            hits += packet.hit.geomID.iter().filter(|g| **g != RTC_INVALID_GEOMETRY_ID).count();
        }
        hits
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

impl Mesh {
    /// Every facet as a fan of triangles.
    pub(super) fn new(stage: &Stage, exact: &BuiltinKernel) -> Self {
        let centre = exact.polygons().centre();
        let mut mesh = Self { corners: Vec::new(), triangles: Vec::new(), facet_of: Vec::new() };
        for (facet, number) in stage.facets.iter().zip(0..) {
            let first = mesh.corners.len() as u32;
            mesh.corners.extend(facet.vertices.iter().map(|v| (*v - centre).as_vec3().to_array()));
            for k in 1..facet.vertices.len() as u32 - 1 {
                mesh.triangles.push([first, first + k, first + k + 1]);
                mesh.facet_of.push(number);
            }
        }
        mesh
    }
}
