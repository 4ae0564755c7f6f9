//! The hybrid that Greene (1986) recommends: rays find what is near, the map stands for what is far.

use super::gather::{Lobe, Station, for_batches};
use crate::math::DVec3;
use crate::raycast::{BACK, Tracer};
use crate::sampling::Stream;
use rayon::prelude::*;

/// Mean luminance of B, W/m^2, at each station when rays are followed up to each of the `reaches` (metres, ascending) and
/// beyond that the map's luminance of B in their direction counts, `map`: station-major, then by reach, then by
/// replicate `r`, whose patches have `luminances[r]`.
pub fn gather_near(
    tracer: &Tracer,
    stations: &[Station],
    lobe: Lobe,
    reaches: &[f64],
    luminances: &[Vec<f64>],
    map: impl Fn(DVec3) -> f64 + Sync,
    stream: Stream,
    rays: u64,
) -> Vec<Vec<Vec<f64>>> {
    let of = |(k, station): (usize, &Station)| {
        let mut means = vec![vec![0.0; luminances.len()]; reaches.len()];
        for (r, luminance) in luminances.iter().enumerate() {
            let mut count = 0u64;
            for_batches(station, lobe, stream.child(k as u64).child(r as u64), rays, |batch| {
                count += batch.len() as u64;
                for (k, hit) in tracer.look(batch).into_iter().enumerate() {
                    let far = map(batch.direction_of(k));
                    let (distance, near) = match hit {
                        Some((_, point, landing)) if landing < BACK => {
                            ((point - station.place).length(), luminance[landing as usize])
                        }
                        // The back of something is something: dark.
                        Some((_, point, _)) => ((point - station.place).length(), 0.0),
                        None => (f64::INFINITY, 0.0),
                    };
                    for (mean, reach) in means.iter_mut().zip(reaches) {
                        // Of an endless reach, the open is the open.
                        mean[r] += if distance <= *reach { near } else { far };
                    }
                }
            });
            means.iter_mut().for_each(|m| m[r] /= count.max(1) as f64);
        }
        means
    };
    stations.par_iter().enumerate().map(of).collect()
}

/// Adds what a ray brings to the sums of the bands.
pub type Add<'a> = &'a dyn Fn(Option<u32>, DVec3, &mut [f64]);

/// Mean over a station's cosine-weighted rays of whatever `add` adds for each: it is told the patch that the ray meets
/// within `reach` (metres; `Some(u32::MAX)` where that is the back of something), or `None` and the direction.
pub fn mean_near(
    tracer: &Tracer,
    station: &Station,
    reach: f64,
    add: Add,
    bands: usize,
    stream: Stream,
    rays: u64,
) -> Vec<f64> {
    let (mut sum, mut count) = (vec![0.0; bands], 0u64);
    for_batches(station, Lobe::Cosine, stream, rays, |batch| {
        count += batch.len() as u64;
        for (k, hit) in tracer.look(batch).into_iter().enumerate() {
            let near = hit.filter(|(_, point, _)| (*point - station.place).length() <= reach);
            let landing = near.map(|(_, _, landing)| if landing < BACK { landing } else { u32::MAX });
            add(landing, batch.direction_of(k), &mut sum);
        }
    });
    sum.iter_mut().for_each(|s| *s /= count.max(1) as f64);
    sum
}
