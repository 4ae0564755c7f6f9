//! Irradiance at points: straight from point lights, and from the radiosities of all patches by hemisphere rays.

use super::shadow::lit;
use crate::math::{DVec3, Frame};
use crate::raycast::{BACK, RayBatch, TraceScratch, Tracer};
use crate::sampling::{Stream, cosine_hemisphere, owen_scrambled, sobol};
use crate::scene::{NO_FACET, Receiver, Stage};
use crate::solution::Replicates;
use rayon::prelude::*;

/// Rays of one batch.
const BATCH: u64 = 256;

/// A receiver lies on a facet if it is as near to its plane as this share of the scene's diagonal, and as parallel.
const ON_FACET: f64 = 1e-9;

/// Irradiance at every receiver of the stage, W/m^2 per band (lx where the bands are photometric): one replicate per
/// replicate of the radiosities, each from its own `rays` cosine-distributed rays.
///
/// Light of a patch is its radiosity wherever on it a ray lands; point lights shine straight, by one shadow ray each.
/// Backs and the open send nothing.
pub fn irradiance(tracer: &Tracer, radiosities: &Replicates, stream: Stream, rays: u64) -> Replicates {
    let stage = tracer.stage();
    let bands = radiosities.bands;
    let straight: Vec<Vec<f64>> = stage.receivers.iter().map(|r| from_lights(tracer, r)).collect();
    let one = |(r, values): (usize, &Vec<f64>)| -> Vec<f64> {
        let of = |(k, receiver): (usize, &Receiver)| {
            let stream = stream.child(k as u64).child(r as u64);
            let sum = gathered(tracer, receiver, values, bands, stream, rays);
            sum.into_iter().zip(&straight[k]).map(|(s, d)| s + d).collect::<Vec<f64>>()
        };
        stage.receivers.par_iter().enumerate().flat_map_iter(of).collect()
    };
    Replicates { bands, replicates: radiosities.replicates.iter().enumerate().map(one).collect() }
}

/// The facet that a receiver lies on or in the plane of, if it looks along that facet's normal.
fn facet_under(stage: &Stage, receiver: &Receiver) -> u32 {
    let (lo, hi) = stage.bounds();
    let near = ON_FACET * (hi - lo).length();
    let under = |f: &crate::scene::Facet| {
        let height = f.normal.dot(receiver.position - f.vertices[0]).abs();
        height <= near && f.normal.cross(receiver.normal).length() <= ON_FACET
    };
    stage.facets.iter().position(under).map_or(NO_FACET, |i| i as u32)
}

/// `I cos / d^2` of every light that the receiver sees, per band. A light at the receiver itself brings nothing.
fn from_lights(tracer: &Tracer, receiver: &Receiver) -> Vec<f64> {
    let stage = tracer.stage();
    let from = facet_under(stage, receiver);
    let mut sum = vec![0.0; stage.band_count()];
    for light in &stage.lights {
        let to = light.position - receiver.position;
        let cosine = to.normalize_or_zero().dot(receiver.normal);
        if cosine <= 0.0 || !lit(tracer, from, &[receiver.position], light.position)[0] {
            continue;
        }
        let share = light.share_towards(receiver.position) * cosine / to.length_squared();
        sum.iter_mut().zip(&light.intensity).for_each(|(s, i)| *s += i * share);
    }
    sum
}

/// Mean radiosity that the rays of one randomisation land on, per band: the irradiance, since they are spread by cosine.
fn gathered(
    tracer: &Tracer,
    receiver: &Receiver,
    radiosity: &[f64],
    bands: usize,
    stream: Stream,
    rays: u64,
) -> Vec<f64> {
    let frame = Frame::with_x_axis(receiver.normal, receiver.normal.any_orthonormal_vector());
    let digits = [stream.child(0), stream.child(1)];
    let unit = |k: u64, d: usize| ((owen_scrambled(sobol(k, d), digits[d]) >> 11) as f64 + 0.5) * f64::powi(2.0, -53);
    let direction = |k: u64| -> DVec3 { frame.to_world(cosine_hemisphere(unit(k, 0), unit(k, 1))).normalize() };
    let (mut batch, mut scratch) = (RayBatch::default(), TraceScratch::default());
    batch.from = facet_under(tracer.stage(), receiver);
    let mut landings = vec![0; BATCH as usize];
    let mut sum = vec![0.0; bands];
    for first in (0..rays).step_by(BATCH as usize) {
        let count = (rays - first).min(BATCH) as usize;
        batch.resize(count);
        (0..count).for_each(|k| batch.set(k, receiver.position, direction(first + k as u64)));
        tracer.trace(&batch, &mut landings[..count], &mut scratch);
        for patch in landings[..count].iter().filter(|p| **p < BACK) {
            let at = *patch as usize * bands;
            sum.iter_mut().zip(&radiosity[at..at + bands]).for_each(|(s, b)| *s += b);
        }
    }
    sum.iter_mut().for_each(|s| *s /= rays as f64);
    sum
}
