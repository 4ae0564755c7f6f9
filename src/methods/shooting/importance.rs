//! How much of a patch's power a change diverts, estimated at sample points of the object.

use super::change::Change;
use super::geometry::Geometry;
use crate::math::DVec3;
use crate::methods::hemicube::centre;
use crate::raycast::RayBatch;

/// Rays to sample points from all patches: the estimate's cost.
pub(super) struct Estimate {
    /// Share of each patch's power that meets the changed object.
    pub share: Vec<f64>,
    pub rays: u64,
}

/// For every patch: the form factor from a differential area at the sample point that always faces the patch, taken
/// as a disc, times the object's mean projected area per area of the patch, means over the sample points that the
/// patch's centre sees. Sums of what went and what came. 1 for patches whose own rays are others.
pub(super) fn estimate([old, new]: [&Geometry; 2], change: &Change) -> Estimate {
    let patches = old.stage.patch_count();
    let mut share = vec![0.0; patches];
    let mut rays = 0;
    for (g, which, standing) in [(old, 0, &change.gone), (new, 1, &change.came)] {
        let count = change.samples[which].len().max(1) as f64;
        for sample in &change.samples[which] {
            rays += towards(g, *sample, standing, change.shown / count, &mut share);
        }
    }
    for (share, own) in share.iter_mut().zip(&change.own) {
        *share = if *own { 1.0 } else { share.min(1.0) };
    }
    Estimate { share, rays }
}

/// Adds the estimate at one sample point. A patch sees it if the first thing between is the object or nothing.
fn towards(g: &Geometry, sample: DVec3, object: &[bool], shown: f64, share: &mut [f64]) -> u64 {
    let stage = &g.stage;
    let mut traced = 0;
    let mut batch = RayBatch::zeroed(1);
    for (i, patch) in stage.patches.iter().enumerate() {
        let Some(eye) = centre(patch) else { continue };
        let (path, distance) = (sample - eye, sample.distance(eye));
        let cosine = path.dot(patch.normal) / distance;
        // What lies in the patch's plane or behind it sees nothing of it; not so where it is near: the object has size.
        if cosine.is_nan() || cosine <= 0.0 {
            continue;
        }
        batch.from = patch.facet;
        batch.set(0, eye, path / distance);
        traced += 1;
        let free = g.tracer.look(&batch)[0].is_none_or(|(_, point, landing)| {
            object.get(landing as usize) == Some(&true) || point.distance(eye) >= distance * (1.0 - 1e-9)
        });
        if free {
            let disc = patch.area * cosine / (std::f64::consts::PI * distance * distance + patch.area);
            share[i] += disc * shown / patch.area;
        }
    }
    traced
}
