//! Irradiances by paths: the continuous problem, not the patch system.
//!
//! The mean irradiance of a patch is the mean over its points of what arrives there. First rays come from one net of
//! (position x direction) per randomisation; light straight from lamps also from a net of (point on a lamp x position),
//! joined by multiple importance sampling (balance heuristic: Veach and Guibas 1995), which stays finite where a patch
//! touches a lamp. A path goes on from where it lands with the chance of its reflectance, for ever if need be; where it
//! ends, an irradiance known beforehand stands for the rest, and where it goes on, that is taken off again: unbiased
//! whatever that irradiance is.

mod aims;
mod lamps;
mod walk;
mod world;

use super::{Emitter, Plan, Reached, patch_emitters};
use crate::raycast::{Tally, Tracer};
use crate::sampling::{Net, Stream};
use aims::AimNet;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use walk::{Samples, Walker};
use world::World;

/// Samples of one net over all randomisations: bounds memory to some 20 MB.
const NET: u64 = 1 << 18;
/// Paths per patch of the pilot, whose irradiances stand for the rest of paths that end.
const PILOT: u64 = 128;

/// Irradiances of receivers, W/m^2, as sums over paths.
#[derive(Debug, Clone)]
pub struct PathSums {
    /// Receiver x randomisation x band: sums over paths of the irradiance.
    pub sums: Vec<f64>,
    /// Number of bands.
    pub bands: usize,
    /// Randomisations R.
    pub randomisations: u16,
    /// Paths per receiver and randomisation.
    pub paths: u64,
    /// All rays.
    pub tally: Tally,
}

impl PathSums {
    /// Mean irradiance of every receiver in one randomisation, receiver x band.
    pub fn irradiance(&self, randomisation: usize) -> Vec<f64> {
        let width = usize::from(self.randomisations) * self.bands;
        let of = |row: &[f64]| row[randomisation * self.bands..(randomisation + 1) * self.bands].to_vec();
        self.sums.chunks_exact(width).flat_map(of).map(|s| s / self.paths as f64).collect()
    }
}

/// A finished gathering.
#[derive(Debug)]
pub struct Gathering {
    /// Irradiances.
    pub sums: PathSums,
    /// What was reached.
    pub reached: Reached,
    /// Relative error after each wave: (paths per receiver, error in the norm of the plan's target).
    pub waves: Vec<(u64, f64)>,
}

/// Gathers irradiances by paths in one scene.
pub struct PathGatherer<'a> {
    tracer: &'a Tracer<'a>,
    world: World,
    stream: Stream,
}

impl<'a> PathGatherer<'a> {
    /// Ready to gather, after a small pilot with random numbers of its own.
    pub fn new(tracer: &'a Tracer<'a>, stream: Stream) -> Self {
        let stage = tracer.stage();
        let mut gatherer = Self { tracer, world: World::of(stage), stream };
        let emitters = patch_emitters(stage);
        let patches: Vec<u32> = (0..stage.patch_count() as u32).collect();
        let mut sums = gatherer.empty(emitters.len(), 1);
        gatherer.block(&emitters, &patches, stream.child(2), &mut sums, PILOT, &|_| ());
        gatherer.world.expected = sums.irradiance(0);
        gatherer
    }

    /// Follows paths from every emitter until the plan is fulfilled. `patches` names the patch each emitter is a part
    /// of; `error` is the norm that `target_error` bounds, `progress` is told how many paths have been followed.
    pub fn gather(
        &self,
        emitters: &[Option<Emitter>],
        patches: &[u32],
        plan: &Plan,
        error: &dyn Fn(&PathSums) -> f64,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Gathering {
        let begin = Instant::now();
        let mut sums = self.empty(emitters.len(), plan.randomisations);
        let mut waves = Vec::new();
        let most = (NET / u64::from(plan.randomisations)).max(1);
        for paths in plan.waves() {
            while sums.paths < paths {
                let block = (paths - sums.paths).min(most);
                self.block(emitters, patches, self.stream, &mut sums, block, progress);
            }
            let relative = error(&sums);
            waves.push((sums.paths * u64::from(plan.randomisations), relative));
            let reached = plan.target_error.is_some_and(|target| relative <= target);
            // The next wave costs as much as all before it together.
            let out_of_time = plan.max_time.is_some_and(|limit| begin.elapsed() * 2 > limit);
            if reached || out_of_time {
                break;
            }
        }
        let (rays_per_patch, relative_error) = waves[waves.len() - 1];
        let missed_target = plan.target_error.is_some_and(|t| relative_error > t);
        Gathering { sums, reached: Reached { rays_per_patch, relative_error, missed_target }, waves }
    }

    fn empty(&self, receivers: usize, randomisations: u16) -> PathSums {
        let bands = self.world.bands;
        let sums = vec![0.0; receivers * usize::from(randomisations) * bands];
        PathSums { sums, bands, randomisations, paths: 0, tally: Tally::default() }
    }

    /// The next `paths` paths of every emitter and randomisation. Rows are independent and summed in their order.
    fn block(
        &self,
        emitters: &[Option<Emitter>],
        patches: &[u32],
        stream: Stream,
        sums: &mut PathSums,
        paths: u64,
        progress: &(dyn Fn(u64) + Sync),
    ) {
        let (first, r) = (sums.paths, sums.randomisations);
        let aims = if self.world.lamps.is_empty() { 0 } else { paths };
        let samples = Samples {
            net: Net::new(stream.child(0), r, first, paths),
            aims: AimNet::new(stream.child(3), r, first, aims),
            words: stream.child(4).child(first),
            shifts: stream.child(1),
        };
        let idle = Mutex::new(Vec::new());
        let row = |(k, emitter): (usize, &Option<Emitter>)| {
            let emitter = emitter.as_ref()?;
            let waiting = idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let mut walker: Walker = waiting.unwrap_or_else(|| Walker::new(self.tracer, &self.world));
            let done = walker.row(&samples, emitter, patches[k] as usize, r);
            idle.lock().unwrap_or_else(PoisonError::into_inner).push(walker);
            progress(samples.net.len() as u64);
            Some(done)
        };
        let rows: Vec<Option<(Vec<f64>, Tally)>> = emitters.par_iter().enumerate().map(row).collect();
        let width = usize::from(r) * self.world.bands;
        for (total, row) in sums.sums.chunks_exact_mut(width).zip(rows) {
            if let Some((more, tally)) = row {
                total.iter_mut().zip(more).for_each(|(t, m)| *t += m);
                sums.tally += tally;
            }
        }
        sums.paths += paths;
    }
}
