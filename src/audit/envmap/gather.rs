//! What arrives at places, by rays: over the hemisphere of a normal, or in a cone about a mirror direction.

use crate::math::{DVec3, Frame};
use crate::raycast::{BACK, RayBatch, TraceScratch, Tracer};
use crate::sampling::{Stream, concentric_disk, cosine_hemisphere, owen_scrambled, sobol};
use crate::world::SHARPNESS;
use rayon::prelude::*;

/// Rays of one batch.
const BATCH: u64 = 256;

/// From which directions light is gathered, about an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lobe {
    /// All of the hemisphere, by cosine: what makes the irradiance.
    Cosine,
    /// A round cone: half its opening angle, radians, below a right angle. Directions count as the Gaussian of elliptical
    /// cones has it: `exp(-SHARPNESS r^2)`, r from 0 on the axis to 1 at the rim, on a plane across the axis.
    Cone(f64),
}

impl Lobe {
    /// What a direction at this cosine to the axis counts.
    pub(super) fn weight(self, cosine: f64) -> f64 {
        match self {
            Self::Cosine => 1.0,
            Self::Cone(half) => {
                let square = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
                (-SHARPNESS * square / half.tan().powi(2)).exp()
            }
        }
    }

    /// Direction about +z for a point of the unit square.
    pub(super) fn direction(self, s: f64, t: f64) -> DVec3 {
        match self {
            Self::Cosine => cosine_hemisphere(s, t),
            Self::Cone(half) => {
                // Even on the cap: 1 - cos grows evenly with the area of the disk.
                let (x, y) = concentric_disk(s, t);
                let r2 = x * x + y * y;
                let low = r2 * 2.0 * (0.5 * half).sin().powi(2);
                let out = (low * (2.0 - low)).max(0.0).sqrt();
                let scale = if r2 > 0.0 { out / r2.sqrt() } else { 0.0 };
                DVec3::new(x * scale, y * scale, 1.0 - low)
            }
        }
    }
}

/// Where light is gathered, and about which direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// The place, metres.
    pub place: DVec3,
    /// Unit direction in the middle of the lobe: the normal, or the mirror direction.
    pub axis: DVec3,
    /// Unit normal of the surface there: nothing arrives from below it. `None` in the open.
    pub horizon: Option<DVec3>,
    /// Facet of the tracer's stage it lies on; [`crate::scene::NO_FACET`] in the open.
    pub facet: u32,
}

/// Mean luminance (weighted by band, of B, W/m^2) of what the rays of each station meet, one number per replicate of the
/// luminances (`luminances[r][patch]`), each from its own `rays` rays: station-major, `stations.len() * R`.
///
/// Rays of one number leave every station in the same directions about its axis, whatever the stage: differences
/// between stages and places have less noise than each. Backs and the open are dark; directions below the horizon do
/// not count.
pub fn gather(
    tracer: &Tracer,
    stations: &[Station],
    lobe: Lobe,
    luminances: &[Vec<f64>],
    stream: Stream,
    rays: u64,
) -> Vec<Vec<f64>> {
    let of = |(k, station): (usize, &Station)| {
        let mean = |(r, y): (usize, &Vec<f64>)| {
            mean_in(tracer, station, lobe, y, 1, stream.child(k as u64).child(r as u64), rays)[0]
        };
        luminances.iter().enumerate().map(mean).collect()
    };
    stations.par_iter().enumerate().map(of).collect()
}

/// Mean B per band of what `rays` rays of a station meet, radiosities patch-major with `bands` each.
pub fn mean_in(
    tracer: &Tracer,
    station: &Station,
    lobe: Lobe,
    radiosities: &[f64],
    bands: usize,
    stream: Stream,
    rays: u64,
) -> Vec<f64> {
    let (mut landings, mut scratch) = (vec![0; BATCH as usize], TraceScratch::default());
    let (mut sum, mut all) = (vec![0.0; bands], 0.0);
    for_batches(station, lobe, stream, rays, |batch| {
        let landings = &mut landings[..batch.len()];
        tracer.trace(batch, landings, &mut scratch);
        for (k, patch) in landings.iter().enumerate() {
            let weight = lobe.weight(batch.direction_of(k).dot(station.axis));
            all += weight;
            if *patch < BACK {
                let at = *patch as usize * bands;
                sum.iter_mut().zip(&radiosities[at..at + bands]).for_each(|(s, b)| *s += weight * b);
            }
        }
    });
    sum.iter_mut().for_each(|s| *s /= if all > 0.0 { all } else { 1.0 });
    sum
}

/// The rays of a station, batch by batch.
pub(super) fn for_batches(station: &Station, lobe: Lobe, stream: Stream, rays: u64, mut each: impl FnMut(&RayBatch)) {
    let frame = Frame::with_x_axis(station.axis, station.axis.any_orthonormal_vector());
    let digits = [stream.child(0), stream.child(1)];
    let unit = |k: u64, d: usize| ((owen_scrambled(sobol(k, d), digits[d]) >> 11) as f64 + 0.5) * f64::powi(2.0, -53);
    let mut batch = RayBatch { from: station.facet, ..RayBatch::default() };
    for first in (0..rays).step_by(BATCH as usize) {
        let directions: Vec<DVec3> = (first..(first + BATCH).min(rays))
            .map(|k| frame.to_world(lobe.direction(unit(k, 0), unit(k, 1))).normalize())
            .filter(|d| station.horizon.is_none_or(|n| d.dot(n) > 0.0))
            .collect();
        batch.resize(directions.len());
        directions.iter().enumerate().for_each(|(k, d)| batch.set(k, station.place, *d));
        if !batch.is_empty() {
            each(&batch);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_3;

    #[test]
    fn cones_are_even_and_as_wide_as_asked() {
        let half = FRAC_PI_3;
        let n = 256;
        let points = (0..n * n).map(|k| (((k % n) as f64 + 0.5) / n as f64, ((k / n) as f64 + 0.5) / n as f64));
        let (mut z, mut least) = (0.0, 1.0f64);
        for (s, t) in points {
            let d = Lobe::Cone(half).direction(s, t);
            assert!((d.length() - 1.0).abs() < 1e-12);
            z += d.z;
            least = least.min(d.z);
        }
        // The mean cosine of a cap is (1 + cos) / 2.
        assert!((z / f64::from(n * n) - 0.75).abs() < 1e-5 && (least - 0.5).abs() < 0.01, "{z} {least}");
        assert!((Lobe::Cosine.direction(0.5, 0.5).z - 1.0).abs() < 1e-12);
    }
}
