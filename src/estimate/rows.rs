//! Casting the rays of all rows: net by net, row by row, in parallel.

use super::aim::{BATCH, fill};
use super::{Block, Checkpoint, Emitter, Entry, FinishedRow, HitCounts, NoCheckpoint, Plan, Reached};
use crate::raycast::{BACK, RayBatch, Tally, TraceScratch, Tracer};
use crate::sampling::{Net, Stream};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Samples of one net over all randomisations: bounds memory to some 10 MB.
const NET: u64 = 1 << 18;
/// Samples of one randomisation in one net: what a 16-bit counter holds.
const MOST_PER_RANDOMISATION: u64 = 1 << 15;

/// A finished casting.
#[derive(Debug)]
pub struct Casting {
    /// Hits of every row.
    pub counts: HitCounts,
    /// What was reached, and whether a target was missed.
    pub reached: Reached,
    /// Relative error after each wave: (rays per patch, error in the norm of the plan's target).
    pub waves: Vec<(u64, f64)>,
}

/// Casts rays from every emitter until the plan is fulfilled.
///
/// `error` is the norm that `target_error` bounds, `progress` is told how many rays have been cast.
pub fn cast(
    tracer: &Tracer,
    emitters: &[Option<Emitter>],
    stream: Stream,
    plan: &Plan,
    error: &dyn Fn(&HitCounts) -> f64,
    progress: &(dyn Fn(u64) + Sync),
) -> Casting {
    cast_on(tracer, emitters, stream, plan, error, progress, &NoCheckpoint)
}

/// The same, going on from the rows that an earlier run has kept: the counts do not depend on how many those are.
pub fn cast_on(
    tracer: &Tracer,
    emitters: &[Option<Emitter>],
    stream: Stream,
    plan: &Plan,
    error: &dyn Fn(&HitCounts) -> f64,
    progress: &(dyn Fn(u64) + Sync),
    kept: &dyn Checkpoint,
) -> Casting {
    let begin = Instant::now();
    let active = emitters.iter().map(Option::is_some).collect();
    let mut counts = HitCounts::empty(tracer.stage().patch_count(), plan.randomisations, active);
    let mut waves = Vec::new();
    for rays in plan.waves() {
        while counts.rays < rays {
            let block = (rays - counts.rays).min(most_per_block(plan));
            cast_block(tracer, emitters, stream, &mut counts, block, progress, kept);
        }
        let relative = error(&counts);
        waves.push((counts.rays * u64::from(plan.randomisations), relative));
        let reached = plan.target_error.is_some_and(|target| relative <= target);
        // The next wave costs as much as all before it together.
        let out_of_time = plan.max_time.is_some_and(|limit| begin.elapsed() * 2 > limit);
        if reached || out_of_time {
            break;
        }
    }
    let (rays_per_patch, relative_error) = waves[waves.len() - 1];
    let missed_target = plan.target_error.is_some_and(|t| relative_error > t);
    Casting { counts, reached: Reached { rays_per_patch, relative_error, missed_target }, waves }
}

/// Samples of one randomisation that one net holds.
fn most_per_block(plan: &Plan) -> u64 {
    (NET / u64::from(plan.randomisations)).clamp(1, MOST_PER_RANDOMISATION)
}

impl Plan {
    /// Blocks of samples in which a run without early stop is cast.
    pub fn blocks(&self) -> u64 {
        let mut start = 0;
        let count = |rays: u64| (rays - std::mem::replace(&mut start, rays)).div_ceil(most_per_block(self));
        self.waves().into_iter().map(count).sum()
    }
}

/// Casts the next `rays` samples of every randomisation, for the rows that are not kept already.
fn cast_block(
    tracer: &Tracer,
    emitters: &[Option<Emitter>],
    stream: Stream,
    counts: &mut HitCounts,
    rays: u64,
    progress: &(dyn Fn(u64) + Sync),
    kept: &dyn Checkpoint,
) {
    let (patches, randomisations) = (counts.patches, counts.randomisations);
    let block = Block { start: counts.rays, rays, patches, randomisations };
    let mut due: Vec<Option<&Emitter>> = emitters.iter().map(Option::as_ref).collect();
    kept.restore(block, &mut |row| {
        // Each row once, whatever the checkpoint brings.
        if due.get_mut(row.row).and_then(Option::take).is_some() {
            progress(row.tally.rays);
            counts.add(row);
        }
    });
    if due.iter().any(Option::is_some) {
        let net = Net::new(stream.child(0), randomisations, block.start, rays);
        let shifts = stream.child(1);
        let workers = Workers { idle: Mutex::default(), patches, randomisations };
        let cast_row = |(row, emitter): (usize, &Emitter)| {
            let (entries, tally) = workers.lend(|w| w.row(tracer, &net, emitter, shifts.child(emitter.key)));
            let row = FinishedRow { row, entries, tally };
            kept.keep(block, &row);
            progress(net.len() as u64);
            row
        };
        let rows: Vec<FinishedRow> =
            due.par_iter().enumerate().filter_map(|(i, e)| e.map(|e| (i, e))).map(cast_row).collect();
        rows.into_iter().for_each(|row| counts.add(row));
    }
    counts.rays += rays;
}

/// About `rays` of the rays that [`cast`] begins with, spread over all emitters: for a second look at them.
pub fn sample_batches(emitters: &[Option<Emitter>], stream: Stream, rays: usize) -> Vec<RayBatch> {
    let active: Vec<&Emitter> = emitters.iter().flatten().collect();
    let each = (rays / active.len().max(1)).clamp(1, BATCH);
    let step = (active.len() / rays.max(1)).max(1);
    let net = Net::new(stream.child(0), 1, 0, each.next_power_of_two() as u64);
    let batch = |e: &&Emitter| {
        let mut rays = RayBatch::zeroed(each);
        fill(&mut rays, &net, 0, e, stream.child(1).child(e.key));
        rays
    };
    active.iter().step_by(step).map(batch).collect()
}

/// All rays that [`cast`] traces for these emitters under a plan of one wave, in its order: for benchmarks.
pub fn row_batches(emitters: &[Option<Emitter>], stream: Stream, plan: &Plan) -> Vec<RayBatch> {
    let net = Net::new(stream.child(0), plan.randomisations, 0, plan.rays_per_randomisation());
    let row = |e: &Emitter| {
        let shift = stream.child(1).child(e.key);
        let batch = |first: usize| {
            let mut rays = RayBatch::zeroed(BATCH.min(net.len() - first));
            fill(&mut rays, &net, first, e, shift);
            rays
        };
        (0..net.len()).step_by(BATCH).map(batch).collect::<Vec<_>>()
    };
    emitters.iter().flatten().flat_map(row).collect()
}

/// Workers that wait for a row: as many as threads, since their counters are large.
struct Workers {
    idle: Mutex<Vec<Worker>>,
    patches: usize,
    randomisations: u16,
}

impl Workers {
    fn lend<R>(&self, work: impl FnOnce(&mut Worker) -> R) -> R {
        let waiting = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut worker = waiting.unwrap_or_else(|| Worker::new(self.patches, self.randomisations));
        let result = work(&mut worker);
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
        result
    }
}

/// Working memory of one thread.
struct Worker {
    /// Counters of a patch: R rounded up to 2^shift, so that no address takes a division.
    shift: u32,
    rays: RayBatch,
    landings: Vec<u32>,
    scratch: TraceScratch,
    /// Hits by `patch << shift | randomisation`: small numbers, to stay near the processor.
    hits: Vec<u16>,
    /// One bit for each of `hits` that is not zero.
    touched: Vec<u64>,
}

impl Worker {
    fn new(patches: usize, randomisations: u16) -> Self {
        let shift = usize::from(randomisations).next_power_of_two().ilog2();
        let slots = patches << shift;
        Self {
            shift,
            rays: RayBatch::zeroed(BATCH),
            landings: vec![0; BATCH],
            scratch: TraceScratch::default(),
            hits: vec![0; slots],
            touched: vec![0; slots.div_ceil(64)],
        }
    }

    /// All rays of one row.
    fn row(&mut self, tracer: &Tracer, net: &Net, emitter: &Emitter, shift: Stream) -> (Vec<Entry>, Tally) {
        let mut tally = Tally::default();
        for first in (0..net.len()).step_by(BATCH) {
            let n = BATCH.min(net.len() - first);
            self.rays.resize(n);
            fill(&mut self.rays, net, first, emitter, shift);
            tally += tracer.trace(&self.rays, &mut self.landings[..n], &mut self.scratch);
            self.count(&net.randomisation[first..first + n]);
        }
        (self.take_entries(), tally)
    }

    fn count(&mut self, randomisation: &[u16]) {
        for (landing, r) in self.landings.iter().zip(randomisation) {
            if *landing < BACK {
                let slot = (*landing as usize) << self.shift | usize::from(*r);
                self.hits[slot] += 1;
                self.touched[slot >> 6] |= 1 << (slot & 63);
            }
        }
    }

    /// Entries of the row in ascending order; leaves the counters zero.
    fn take_entries(&mut self) -> Vec<Entry> {
        let used: u32 = self.touched.iter().map(|bits| bits.count_ones()).sum();
        let mut out = Vec::with_capacity(used as usize);
        for (word, bits) in self.touched.iter_mut().enumerate() {
            while *bits != 0 {
                let slot = word << 6 | bits.trailing_zeros() as usize;
                *bits &= *bits - 1;
                let (patch, randomisation) = (slot >> self.shift, slot & ((1 << self.shift) - 1));
                let hits = std::mem::take(&mut self.hits[slot]);
                out.push(Entry::new(patch as u32, randomisation as u16, u64::from(hits)));
            }
        }
        out
    }
}
