//! The doctor's own rays: where the light of each patch ends.

use super::opening::{Opening, left_through};
use crate::estimate::{Emitter, patch_emitters};
use crate::raycast::{BACK, BuiltinKernel, RayBatch, Tracer};
use crate::sampling::{Role, Stream, cosine_hemisphere, owen_scrambled, sobol};
use crate::scene::Stage;
use crate::stats::Moments;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Independent randomisations: what standard errors come from.
pub(super) const RANDOMISATIONS: usize = 8;
/// Rays over all patches.
const RAYS: usize = 1 << 20;
/// Most rays of one patch and randomisation.
const MOST: usize = 1 << 12;

/// Hits by randomisation.
pub(super) type Hits = [u32; RANDOMISATIONS];

/// Where the rays of one patch ended.
#[derive(Debug, Clone, Default)]
pub(super) struct Sent {
    pub escapes: Hits,
    /// On black backs, by facet.
    pub backs: BTreeMap<u32, Hits>,
    /// Escapes by the opening they left through.
    pub openings: BTreeMap<usize, Hits>,
}

/// Rays from all patches, traced in double precision.
pub(super) struct Probe {
    kernel: Arc<BuiltinKernel>,
    /// Rays per patch and randomisation.
    pub rays: usize,
    /// By patch; nothing for those that take no part.
    pub sent: Vec<Option<Sent>>,
}

impl Probe {
    pub(super) fn cast(stage: &Stage, openings: &[Opening]) -> Self {
        let kernel = Arc::new(BuiltinKernel::new(stage));
        let tracer = Tracer::new(stage, kernel.clone(), kernel.clone(), false);
        let emitters = patch_emitters(stage);
        let active = emitters.iter().flatten().count().max(1);
        let rays = (RAYS / RANDOMISATIONS / active).clamp(1, MOST).next_power_of_two();
        let points = Points::new(rays);
        let sent = emitters.par_iter().map(|e| e.as_ref().map(|e| send(&tracer, e, &points, openings))).collect();
        Self { kernel, rays, sent }
    }

    /// A tracer on the kernel that was used.
    pub(super) fn tracer<'a>(&self, stage: &'a Stage) -> Tracer<'a> {
        Tracer::new(stage, self.kernel.clone(), self.kernel.clone(), false)
    }

    /// Share of the light of some patches, all equally bright, that ends as `count` says.
    pub(super) fn share(&self, stage: &Stage, patches: &[usize], count: impl Fn(&Sent) -> Hits) -> Moments {
        let mut ended = [0.0; RANDOMISATIONS];
        let mut area = 0.0;
        for i in patches {
            let Some(sent) = &self.sent[*i] else { continue };
            let a = stage.patches[*i].area;
            area += a;
            let hits = count(sent);
            (0..RANDOMISATIONS).for_each(|r| ended[r] += a * f64::from(hits[r]) / self.rays as f64);
        }
        ended.iter().map(|e| if area > 0.0 { e / area } else { 0.0 }).collect()
    }

    /// Rays that were cast from some patches.
    pub(super) fn rays_of(&self, patches: &[usize]) -> u64 {
        let sending = patches.iter().filter(|i| self.sent[**i].is_some()).count();
        (sending * self.rays * RANDOMISATIONS) as u64
    }
}

/// Low-discrepancy points over position and direction, one scrambling each randomisation.
pub(super) struct Points {
    /// By randomisation: (u, v, s, t).
    nets: Vec<Vec<[u64; 4]>>,
}

impl Points {
    pub(super) fn new(rays: usize) -> Self {
        let net = |r: usize| {
            let stream = Stream::new(Role::Witness, 0).child(r as u64);
            let point = |k: usize| std::array::from_fn(|d| owen_scrambled(sobol(k as u64, d), stream.child(d as u64)));
            (0..rays).map(point).collect()
        };
        Self { nets: (0..RANDOMISATIONS).map(net).collect() }
    }

    /// Rays of an emitter in one randomisation, shifted by its own key.
    pub(super) fn fill(&self, rays: &mut RayBatch, emitter: &Emitter, randomisation: usize) {
        let shift = Stream::new(Role::Witness, 1).child(emitter.key).child(randomisation as u64);
        let shift: [u64; 4] = std::array::from_fn(|d| shift.at(d as u64));
        let net = &self.nets[randomisation];
        rays.resize(net.len());
        rays.from = emitter.facet;
        for (k, point) in net.iter().enumerate() {
            let [u, v, s, t] = std::array::from_fn(|d| fraction(point[d], shift[d]));
            rays.set(k, emitter.map.at(u, v), emitter.frame.to_world(cosine_hemisphere(s, t)));
        }
    }
}

/// A number inside (0, 1).
pub(super) fn fraction(bits: u64, shift: u64) -> f64 {
    (((bits ^ shift) >> 11) as f64 + 0.5) * f64::powi(2.0, -53)
}

fn send(tracer: &Tracer, emitter: &Emitter, points: &Points, openings: &[Opening]) -> Sent {
    let mut sent = Sent::default();
    let mut rays = RayBatch::default();
    for r in 0..RANDOMISATIONS {
        points.fill(&mut rays, emitter, r);
        for (k, met) in tracer.look(&rays).iter().enumerate() {
            match met {
                None => {
                    sent.escapes[r] += 1;
                    if let Some(o) = left_through(openings, rays.origin_of(k), rays.direction_of(k)) {
                        sent.openings.entry(o).or_default()[r] += 1;
                    }
                }
                Some((facet, _, BACK)) => sent.backs.entry(*facet).or_default()[r] += 1,
                Some(_) => {}
            }
        }
    }
    sent
}

/// Sum of hits, randomisation by randomisation.
pub(super) fn add(a: Hits, b: &Hits) -> Hits {
    std::array::from_fn(|r| a[r] + b[r])
}

/// All randomisations together.
pub(super) fn total(hits: &Hits) -> u64 {
    hits.iter().map(|h| u64::from(*h)).sum()
}
