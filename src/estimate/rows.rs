//! Casting the rays of all rows: net by net, row by row, in parallel.

use super::{Emitter, Entry, HitCounts, Plan, Reached};
use crate::math::{DVec3, Frame};
use crate::raycast::{BACK, RayBatch, Tally, TraceScratch, Tracer};
use crate::sampling::{Net, PointMap, Stream};
use rayon::prelude::*;
use std::time::Instant;

/// Rays of one batch: enough to feed packets, small enough for the first-level cache.
const BATCH: usize = 256;
/// Samples of one net over all randomisations: bounds memory to some 10 MB.
const NET: u64 = 1 << 18;

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
    let begin = Instant::now();
    let active = emitters.iter().map(Option::is_some).collect();
    let mut counts = HitCounts::empty(tracer.stage().patch_count(), plan.randomisations, active);
    let mut waves = Vec::new();
    for rays in plan.waves() {
        while counts.rays < rays {
            let block = (rays - counts.rays).min((NET / u64::from(plan.randomisations)).max(1));
            cast_block(tracer, emitters, stream, &mut counts, block, progress);
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

/// Casts the next `block` samples of every randomisation.
fn cast_block(
    tracer: &Tracer,
    emitters: &[Option<Emitter>],
    stream: Stream,
    counts: &mut HitCounts,
    block: u64,
    progress: &(dyn Fn(u64) + Sync),
) {
    let net = Net::new(stream.child(0), counts.randomisations, counts.rays, block);
    let shifts = stream.child(1);
    let work = || Worker::new(counts.patches, counts.randomisations);
    let rows: Vec<(usize, Vec<Entry>, Tally)> = emitters
        .par_iter()
        .enumerate()
        .filter_map(|(i, e)| e.as_ref().map(|e| (i, e)))
        .map_init(work, |worker, (i, emitter)| {
            let (row, tally) = worker.row(tracer, &net, emitter, shifts.child(emitter.key));
            progress(net.len() as u64);
            (i, row, tally)
        })
        .collect();
    for (i, row, tally) in rows {
        counts.merge_row(i, row);
        counts.tally += tally;
    }
    counts.rays += block;
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

/// Makes the rays of an emitter from samples `first ..` of a net.
fn fill(rays: &mut RayBatch, net: &Net, first: usize, emitter: &Emitter, shift: Stream) {
    let frame = emitter.frame.turned(shift.unit(0) * std::f64::consts::TAU);
    rays.from = emitter.facet;
    make_positions(rays, net, first, &emitter.map, [(shift.at(1) >> 33) as i32, (shift.at(2) >> 33) as i32]);
    make_directions(rays, net, first, &frame);
}

/// Working memory of one thread.
struct Worker {
    randomisations: usize,
    rays: RayBatch,
    landings: Vec<u32>,
    scratch: TraceScratch,
    /// Hits by `patch * R + randomisation`.
    hits: Vec<u32>,
    /// One bit for each 64 of `hits` that is not all zero.
    touched: Vec<u64>,
}

impl Worker {
    fn new(patches: usize, randomisations: u16) -> Self {
        let slots = patches * usize::from(randomisations);
        Self {
            randomisations: usize::from(randomisations),
            rays: RayBatch::zeroed(BATCH),
            landings: vec![0; BATCH],
            scratch: TraceScratch::default(),
            hits: vec![0; slots.next_multiple_of(64)],
            touched: vec![0; slots.div_ceil(64 * 64)],
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
                let slot = *landing as usize * self.randomisations + usize::from(*r);
                self.hits[slot] += 1;
                self.touched[slot >> 12] |= 1 << (slot >> 6 & 63);
            }
        }
    }

    /// Entries of the row in ascending order; leaves the counters zero.
    fn take_entries(&mut self) -> Vec<Entry> {
        let mut out = Vec::new();
        for (word, bits) in self.touched.iter_mut().enumerate() {
            while *bits != 0 {
                let block = (word << 6 | bits.trailing_zeros() as usize) << 6;
                *bits &= *bits - 1;
                for (slot, hits) in self.hits[block..block + 64].iter_mut().enumerate().filter(|(_, h)| **h != 0) {
                    let slot = block + slot;
                    let patch = (slot / self.randomisations) as u32;
                    out.push(Entry::new(patch, (slot % self.randomisations) as u16, u64::from(*hits)));
                    *hits = 0;
                }
            }
        }
        out
    }
}

/// Middle of a 31-bit cell.
#[inline]
fn unit(x: i32) -> f64 {
    (f64::from(x) + 0.5) * f64::powi(2.0, -31)
}

fn make_positions(rays: &mut RayBatch, net: &Net, first: usize, map: &PointMap, shift: [i32; 2]) {
    let n = rays.len();
    let (u, v) = (&net.u[first..first + n], &net.v[first..first + n]);
    match map {
        PointMap::Parallelogram { origin, e1, e2 } => {
            for c in 0..3 {
                let (o, a, b) = (origin[c], e1[c], e2[c]);
                for (x, (u, v)) in rays.origin[c].iter_mut().zip(u.iter().zip(v)) {
                    *x = o + a * unit(u ^ shift[0]) + b * unit(v ^ shift[1]);
                }
            }
        }
        PointMap::Triangles(_) => {
            for k in 0..n {
                let p: DVec3 = map.at(unit(u[k] ^ shift[0]), unit(v[k] ^ shift[1]));
                (rays.origin[0][k], rays.origin[1][k], rays.origin[2][k]) = (p.x, p.y, p.z);
            }
        }
    }
}

fn make_directions(rays: &mut RayBatch, net: &Net, first: usize, frame: &Frame) {
    let n = rays.len();
    let [lx, ly, lz] = std::array::from_fn(|c| &net.direction[c][first..first + n]);
    for c in 0..3 {
        let (x, y, z) = (frame.x[c], frame.y[c], frame.z[c]);
        let out = &mut rays.direction[c][..n];
        for k in 0..n {
            out[k] = lx[k] * x + ly[k] * y + lz[k] * z;
        }
    }
}
