//! The built-in kernel: pure Rust, double precision, no library needed.

use super::hierarchy::{BoxRay, Hierarchy};
use super::polygons::{Nearest, Polygons, Ray};
use super::{KernelInfo, RayBatch, RayKernel};
use crate::math::DVec3;
use crate::scene::Stage;

/// Finds hits in double precision. Fallback where there is no Embree, witness and arbiter where there is.
///
/// Ties go to fronts, then to lower facet numbers. "Equal" means within rounding, 1e-12 of the scene's diagonal.
pub struct BuiltinKernel {
    info: KernelInfo,
    polygons: Polygons,
    hierarchy: Hierarchy,
}

impl BuiltinKernel {
    /// Prepares a stage; an empty one is met by no ray.
    pub fn new(stage: &Stage) -> Self {
        let (mut polygons, boxes) = Polygons::new(stage);
        let (hierarchy, order) = Hierarchy::new(&boxes);
        polygons.reorder(&order);
        Self { info: info(), polygons, hierarchy }
    }

    /// The facet that one ray meets first; `from` as in [`RayBatch::from`].
    pub fn intersect_one(&self, origin: DVec3, direction: DVec3, from: u32) -> u32 {
        let own = self.polygons.own_group(from);
        self.nearest(origin, direction, own, &mut Vec::with_capacity(64)).facet
    }

    /// As [`RayKernel::intersect`], by testing every facet: what the hierarchy is tested against.
    pub fn intersect_all(&self, rays: &RayBatch, facets: &mut [u32]) {
        let own = self.polygons.own_group(rays.from);
        for (k, facet) in facets.iter_mut().enumerate() {
            let ray = self.near_ray(rays.origin_of(k), rays.direction_of(k), own);
            let mut nearest = Nearest::NONE;
            (0..self.polygons.len()).for_each(|p| {
                self.polygons.test(p, &ray, &mut nearest);
            });
            *facet = nearest.facet;
        }
    }

    /// A ray from the scene's centre; one that starts far away is first brought to the scene's edge, where
    /// single precision does for the boxes.
    #[inline]
    fn near_ray(&self, origin: DVec3, direction: DVec3, own: u32) -> Ray {
        let origin = origin - self.polygons.centre();
        let reach = self.polygons.diagonal();
        // Everything lies within half a diagonal of the centre.
        let skipped = if origin.length_squared() > reach * reach { origin.length() - reach } else { 0.0 };
        Ray { origin: origin + direction * skipped, direction, own }
    }

    /// The origin of a ray, moved along it to the scene's edge if it starts far away.
    pub(super) fn advanced(&self, origin: DVec3, direction: DVec3) -> DVec3 {
        self.near_ray(origin, direction, 0).origin + self.polygons.centre()
    }

    pub(super) fn polygons(&self) -> &Polygons {
        &self.polygons
    }

    /// Polygons whose boxes meet a box (scene coordinates), and perhaps a few more.
    pub(super) fn polygons_in_box(&self, low: DVec3, high: DVec3, found: &mut Vec<u32>) {
        let scaled = |p: DVec3| (p - self.polygons.centre()) / self.polygons.diagonal();
        self.hierarchy.in_box(scaled(low), scaled(high), found);
    }

    #[inline]
    fn nearest(&self, origin: DVec3, direction: DVec3, own: u32, stack: &mut Vec<(f32, u32)>) -> Nearest {
        let ray = self.near_ray(origin, direction, own);
        let scale = 1.0 / self.polygons.diagonal();
        let boxes = BoxRay::new(ray.origin * scale, direction);
        let mut nearest = Nearest::NONE;
        let mut limit = f32::INFINITY;
        self.hierarchy.walk(&boxes, stack, |polygons| {
            for p in polygons {
                if self.polygons.test(p, &ray, &mut nearest) {
                    // A little further, so that what is equally near is looked at as well.
                    limit = (nearest.distance * scale * (1.0 + 1e-6) + 1e-6) as f32;
                }
            }
            limit
        });
        nearest
    }
}

impl RayKernel for BuiltinKernel {
    fn info(&self) -> &KernelInfo {
        &self.info
    }

    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        let own = self.polygons.own_group(rays.from);
        let mut stack = Vec::with_capacity(64);
        for (k, facet) in facets.iter_mut().enumerate() {
            *facet = self.nearest(rays.origin_of(k), rays.direction_of(k), own, &mut stack).facet;
        }
    }
}

/// No instruction set: the same numbers come out on every machine.
fn info() -> KernelInfo {
    KernelInfo {
        name: "builtin".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        path: None,
        instruction_set: None,
    }
}
