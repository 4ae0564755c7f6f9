//! The fan of rays a patch shoots along: all of it, or what a change of the scene can have diverted.

use super::change::Change;
use super::counter::Counter;
use super::geometry::Geometry;
use super::shadow::Directions;
use crate::estimate::{BATCH, Emitter, fill, turned_frame};
use crate::raycast::{BACK, ESCAPED, RayBatch, TraceScratch};
use crate::sampling::{Net, Role, Stream};
use crate::scene::Stage;
use rayon::prelude::*;

/// Batches below which one thread does the work.
const FEW_BATCHES: usize = 6;

/// Places behind the elements where power may go.
const ESCAPED_SINK: usize = 0;
const BACK_SINK: usize = 1;
/// What a hemi-cube's table hands out beyond the whole, with its sign turned.
pub(super) const EXCESS_SINK: usize = 2;

/// Number of places where power may end: elements, then escapes, backs, and the excess of a table.
pub(super) fn sinks(stage: &Stage) -> usize {
    stage.elements.len() + 3
}

/// Where what has escaped is booked.
pub(super) fn escaped_sink(stage: &Stage) -> usize {
    stage.elements.len() + ESCAPED_SINK
}

/// Where what fell on backs is booked.
pub(super) fn back_sink(stage: &Stage) -> usize {
    stage.elements.len() + BACK_SINK
}

/// The rays of all patches, shifted and turned for each: of one net, and of a longer one for lamps.
pub(super) struct Fans {
    shifts: Stream,
    common: Quiver,
    /// The net of lamps, where they shoot more rays than others.
    lamps: Option<Quiver>,
    /// Patches that shoot along it.
    is_lamp: Vec<bool>,
}

/// A net, cut into batches.
struct Quiver {
    net: Net,
    /// Local directions of each batch.
    batches: Vec<Directions>,
    /// Rays of one randomisation.
    rays: u64,
}

impl Quiver {
    fn new(stream: Stream, randomisations: u16, rays: u64) -> Self {
        let net = Net::new(stream, randomisations, 0, rays);
        let batch = |first: usize| {
            let range = first..(first + BATCH).min(net.len());
            Directions::of(&range.map(|k| net.direction.each_ref().map(|c| f64::from(c[k]))))
        };
        Self { batches: (0..net.len()).step_by(BATCH).map(batch).collect(), rays, net }
    }

    fn fill(&self, rays: &mut RayBatch, batch: usize, emitter: &Emitter, shift: Stream) {
        rays.resize(BATCH.min(self.net.len() - batch * BATCH));
        fill(rays, &self.net, batch * BATCH, emitter, shift);
    }
}

/// Working memory of one thread.
#[derive(Default)]
struct Scratch {
    rays: RayBatch,
    chosen: RayBatch,
    places: Vec<usize>,
    landings: Vec<u32>,
    trace: TraceScratch,
}

/// A ray that ends elsewhere since the change.
struct Diverted {
    randomisation: u16,
    from: u32,
    to: u32,
}

impl Fans {
    /// The candidate's rays under a seed: `rays` of each randomisation, `boost` times as many for lamps. Which
    /// patches are lamps is settled once, for the rays of a patch must not change with an edit.
    pub fn new(rays: u64, randomisations: u16, seed: u64, boost: u32, is_lamp: Vec<bool>) -> Self {
        let stream = Stream::new(Role::Candidate, seed);
        let quiver = |rays| Quiver::new(stream.child(0), randomisations, rays);
        let lamps = (boost > 1 && is_lamp.contains(&true)).then(|| quiver(rays * u64::from(boost)));
        Self { shifts: stream.child(1), common: quiver(rays), lamps, is_lamp }
    }

    fn of(&self, patch: usize) -> &Quiver {
        self.lamps.as_ref().filter(|_| self.is_lamp[patch]).unwrap_or(&self.common)
    }

    /// Rays of one randomisation of a patch.
    pub fn rays(&self, patch: usize) -> u64 {
        self.of(patch).rays
    }

    /// Counts where all rays of a patch end, `by` each. Returns the number of rays traced.
    pub fn whole(&self, g: &Geometry, patch: usize, by: i8, counter: &mut Counter) -> u64 {
        let Some(emitter) = &g.emitters[patch] else { return 0 };
        let (quiver, shift) = (self.of(patch), self.shifts.child(emitter.key));
        let landed = |s: &mut Scratch, batch: usize| {
            quiver.fill(&mut s.rays, batch, emitter, shift);
            s.landings.resize(s.rays.len(), 0);
            g.tracer.trace(&s.rays, &mut s.landings, &mut s.trace);
            (0..s.rays.len()).map(|k| sink(g, s.landings[k], &s.rays, k)).collect::<Vec<u32>>()
        };
        let ends: Vec<Vec<u32>> =
            (0..quiver.batches.len()).into_par_iter().map_init(Scratch::default, landed).collect();
        for (batch, ends) in ends.iter().enumerate() {
            let randomisation = &quiver.net.randomisation[batch * BATCH..][..ends.len()];
            ends.iter().zip(randomisation).for_each(|(e, r)| counter.add(*e, *r, by));
        }
        quiver.net.len() as u64
    }

    /// Counts the rays of a patch that a change has diverted: -1 where they ended, +1 where they end now. The patch's
    /// own rays must be the same in both versions. Returns the number of rays traced.
    pub fn diverted(&self, [old, new]: [&Geometry; 2], change: &Change, patch: usize, counter: &mut Counter) -> u64 {
        let (Some(from), Some(to)) = (&old.emitters[patch], &new.emitters[patch]) else { return 0 };
        let batches = self.within_shadow(old, change, patch);
        let (quiver, shift) = (self.of(patch), self.shifts.child(from.key));
        let look = |s: &mut Scratch, batch: &usize| {
            quiver.fill(&mut s.rays, *batch, from, shift);
            let randomisation = &quiver.net.randomisation[batch * BATCH..];
            Looking { old, new, change, facets: [from.facet, to.facet] }.look(s, randomisation)
        };
        // Most shadows are small: waking other threads would cost more than the rays.
        let found: Vec<(Vec<Diverted>, u64)> = if batches.len() < FEW_BATCHES {
            let mut scratch = Scratch::default();
            batches.iter().map(|batch| look(&mut scratch, batch)).collect()
        } else {
            batches.par_iter().map_init(Scratch::default, look).collect()
        };
        let mut traced = 0;
        for (diverted, rays) in found {
            traced += rays;
            for d in diverted {
                counter.add(d.from, d.randomisation, -1);
                counter.add(d.to, d.randomisation, 1);
            }
        }
        traced
    }

    /// True if some ray of the patch may be diverted by the change.
    pub fn may_divert(&self, old: &Geometry, change: &Change, patch: usize) -> bool {
        !self.within_shadow(old, change, patch).is_empty()
    }

    /// Batches whose directions meet the shadow volume of what went or of what came.
    fn within_shadow(&self, g: &Geometry, change: &Change, patch: usize) -> Vec<usize> {
        let Some(emitter) = &g.emitters[patch] else { return Vec::new() };
        let frame = turned_frame(emitter, self.shifts.child(emitter.key));
        let corners = &g.stage.patches[patch].corners;
        let towards: Vec<Directions> =
            change.outlines.iter().flatten().filter_map(|o| Directions::towards(o, corners, &frame)).collect();
        let batches = &self.of(patch).batches;
        (0..batches.len()).filter(|k| towards.iter().any(|t| t.meet(&batches[*k]))).collect()
    }
}

/// The place where a ray's power goes.
#[inline]
fn sink(g: &Geometry, landing: u32, rays: &RayBatch, k: usize) -> u32 {
    match landing {
        ESCAPED => escaped_sink(&g.stage) as u32,
        BACK => back_sink(&g.stage) as u32,
        patch => g.elements.element(patch, rays.origin_of(k), rays.direction_of(k)),
    }
}

/// Rays looked at in both versions.
struct Looking<'a> {
    old: &'a Geometry,
    new: &'a Geometry,
    change: &'a Change,
    /// Facet the rays start on, in either version.
    facets: [u32; 2],
}

/// Not traced.
const UNKNOWN: u32 = u32::MAX - 2;

impl Looking<'_> {
    /// A ray is another one only if it ends on what went, in the old version, or on what came, in the new one: so a
    /// ray that can meet but one of the two is traced there first, and in the other version only if it ends on it.
    fn look(&self, s: &mut Scratch, randomisation: &[u16]) -> (Vec<Diverted>, u64) {
        let n = s.rays.len();
        let (mut before, mut after) = (vec![UNKNOWN; n], vec![UNKNOWN; n]);
        let meets = |which: usize, rays: &RayBatch, k: usize| {
            let outline = self.change.outlines[which].as_ref();
            outline.is_some_and(|o| o.meets(rays.origin_of(k), rays.direction_of(k)))
        };
        let old: Vec<bool> = (0..n).map(|k| meets(0, &s.rays, k)).collect();
        let new: Vec<bool> = (0..n).map(|k| meets(1, &s.rays, k)).collect();
        let mut traced = self.trace(s, 1, &mut after, |k, _| new[k]);
        let on_new = |landing: u32| landing == BACK || self.change.came.get(landing as usize) == Some(&true);
        traced += self.trace(s, 0, &mut before, |k, _| old[k] || on_new(after[k]));
        let on_old = |landing: u32| landing == BACK || self.change.gone.get(landing as usize) == Some(&true);
        traced += self.trace(s, 1, &mut after, |k, known| known == UNKNOWN && on_old(before[k]));
        let both = (0..n).filter(|k| before[*k] != UNKNOWN && after[*k] != UNKNOWN);
        let ends = both.map(|k| (k, sink(self.old, before[k], &s.rays, k), sink(self.new, after[k], &s.rays, k)));
        let diverted = ends.filter(|(_, from, to)| from != to);
        (diverted.map(|(k, from, to)| Diverted { randomisation: randomisation[k], from, to }).collect(), traced)
    }

    /// Traces the chosen rays in one version.
    fn trace(&self, s: &mut Scratch, version: usize, landings: &mut [u32], choose: impl Fn(usize, u32) -> bool) -> u64 {
        s.places.clear();
        s.places.extend((0..landings.len()).filter(|k| choose(*k, landings[*k])));
        if s.places.is_empty() {
            return 0;
        }
        s.chosen.resize(s.places.len());
        s.chosen.from = self.facets[version];
        for (slot, k) in s.places.iter().enumerate() {
            s.chosen.set(slot, s.rays.origin_of(*k), s.rays.direction_of(*k));
        }
        s.landings.resize(s.places.len(), 0);
        let g = if version == 0 { self.old } else { self.new };
        g.tracer.trace(&s.chosen, &mut s.landings, &mut s.trace);
        s.places.iter().zip(&s.landings).for_each(|(k, landing)| landings[*k] = *landing);
        s.places.len() as u64
    }
}
