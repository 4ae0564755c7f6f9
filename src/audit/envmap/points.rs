//! Where a map is put to the test: over the surface of an object, and in the open around its centre.

use crate::math::DVec3;
use crate::raycast::{RayBatch, Tracer};
use crate::render::distance;
use crate::sampling::{PointMap, Stream, owen_scrambled, sobol};
use crate::scene::{NO_FACET, Stage};
use std::f64::consts::TAU;

/// A place of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Its patch.
    pub patch: u32,
    /// Its facet in the stage it was chosen in.
    pub facet: u32,
    /// Where, metres.
    pub place: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

/// `count` points over these surfaces, evenly by area: each stands for the same area. Empty where nothing of them takes
/// part.
pub fn over(stage: &Stage, surfaces: &[u32], count: usize, stream: Stream) -> Vec<Point> {
    let patches: Vec<usize> = (0..stage.patch_count())
        .filter(|i| stage.patches[*i].is_present() && surfaces.contains(&stage.patches[*i].surface))
        .collect();
    let total: f64 = patches.iter().map(|i| stage.patches[*i].area).sum();
    let mut points = Vec::with_capacity(count);
    let mut before = 0.0;
    let start = stream.unit(0);
    for i in patches {
        let patch = &stage.patches[i];
        let Some(map) = PointMap::new(&patch.region.pieces) else { continue };
        // The k-th point lies where (k + start) / count of the area has gone by.
        while points.len() < count && (points.len() as f64 + start) / count as f64 * total < before + patch.area {
            let k = points.len() as u64;
            let place = map.at(unit(stream, k, 0), unit(stream, k, 1));
            points.push(Point { patch: i as u32, facet: patch.facet, place, normal: patch.normal });
        }
        before += patch.area;
    }
    points
}

/// `count` places at this distance from a centre, in all directions, each with a normal of any direction; those that
/// the centre does not see are left out.
pub fn within_reach(tracer: &Tracer, centre: DVec3, reach: f64, count: usize, stream: Stream) -> Vec<(DVec3, DVec3)> {
    let mut rays = RayBatch::zeroed(count);
    rays.from = NO_FACET;
    let on_sphere = |k: u64, d: usize| {
        let (z, turn) = (1.0 - 2.0 * unit(stream, k, d), TAU * unit(stream, k, d + 1));
        let r = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    };
    (0..count).for_each(|k| rays.set(k, centre, on_sphere(k as u64, 0)));
    let (mut landings, mut scratch) = (vec![0; count], crate::raycast::TraceScratch::default());
    tracer.trace(&rays, &mut landings, &mut scratch);
    let free = |k: usize| distance(tracer.stage(), landings[k], centre, rays.direction_of(k));
    let place = |k: usize| (centre + rays.direction_of(k) * reach, on_sphere(k as u64, 2));
    (0..count).filter(|k| landings[*k] != crate::raycast::BACK && free(*k) > reach).map(place).collect()
}

fn unit(stream: Stream, k: u64, d: usize) -> f64 {
    ((owen_scrambled(sobol(k, d), stream.child(d as u64)) >> 11) as f64 + 0.5) * f64::powi(2.0, -53)
}
