//! Paths of one row, walked side by side: all first rays, then all second rays, until none goes on.

use super::aims::AimNet;
use super::lamps::Aim;
use super::world::World;
use crate::estimate::Emitter;
use crate::estimate::aim::{BATCH, fill, unit};
use crate::math::DVec3;
use crate::raycast::{BACK, ESCAPED, RayBatch, Tally, TraceScratch, Tracer};
use crate::sampling::{Net, Stream, cosine_hemisphere};
use std::f64::consts::FRAC_1_PI;

/// Paths walked side by side.
const WAVE: usize = 4096;
/// Share of the distance to a lamp from which on something met is the lamp itself, or behind it.
const BEYOND: f64 = 1.0 - 1e-9;
/// Random words a vertex of a path may use.
const WORDS: u64 = 8;

/// The samples of one block, and where their random words come from.
pub(super) struct Samples {
    pub net: Net,
    pub aims: AimNet,
    /// Of this net: no two blocks share words.
    pub words: Stream,
    /// Shifts of patches.
    pub shifts: Stream,
}

/// Points of paths that wait for their next rays.
#[derive(Default)]
struct Vertices {
    patch: Vec<u32>,
    point: Vec<DVec3>,
    randomisation: Vec<u16>,
    words: Vec<Stream>,
    /// What is handed on from here, per band.
    throughput: Vec<f64>,
}

impl Vertices {
    fn clear(&mut self) {
        self.patch.clear();
        self.point.clear();
        self.randomisation.clear();
        self.words.clear();
        self.throughput.clear();
    }
}

/// A ray of the hemisphere about to be followed: where it comes from and what it carries.
struct Ray<'a> {
    from: usize,
    origin: DVec3,
    direction: DVec3,
    randomisation: u16,
    words: Stream,
    /// `None`: 1 in every band.
    throughput: Option<&'a [f64]>,
}

/// A ray to a lamp: what it brings if nothing stands between.
struct Shot {
    lamp: u32,
    weight: f64,
    /// Vertex it starts from; for first rays its randomisation.
    owner: u32,
    /// How far the lamp is, m.
    distance: f64,
}

/// Working memory of one thread.
pub(super) struct Walker<'a> {
    tracer: &'a Tracer<'a>,
    world: &'a World,
    rays: RayBatch,
    landings: Vec<u32>,
    scratch: TraceScratch,
    shots: Vec<Shot>,
    waiting: Vertices,
    order: Vec<u64>,
    carried: Vec<f64>,
    /// Sums of irradiance: randomisation x band.
    sums: Vec<f64>,
    tally: Tally,
}

impl<'a> Walker<'a> {
    pub fn new(tracer: &'a Tracer<'a>, world: &'a World) -> Self {
        Self {
            tracer,
            world,
            rays: RayBatch::zeroed(BATCH),
            landings: vec![0; BATCH],
            scratch: TraceScratch::default(),
            shots: Vec::new(),
            waiting: Vertices::default(),
            order: Vec::new(),
            carried: vec![0.0; world.bands],
            sums: Vec::new(),
            tally: Tally::default(),
        }
    }

    /// All paths of one row: sums over samples of the irradiance at points of the emitter, randomisation x band.
    pub fn row(
        &mut self,
        samples: &Samples,
        emitter: &Emitter,
        patch: usize,
        randomisations: u16,
    ) -> (Vec<f64>, Tally) {
        self.tally = Tally::default();
        self.sums = vec![0.0; usize::from(randomisations) * self.world.bands];
        let shift = samples.shifts.child(emitter.key);
        let words = samples.words.child(emitter.key);
        for first in (0..samples.net.len()).step_by(WAVE) {
            let end = (first + WAVE).min(samples.net.len());
            for k in (first..end).step_by(BATCH) {
                self.first_rays(samples, k, BATCH.min(end - k), emitter, patch, shift, words);
                if !self.world.lamps.is_empty() {
                    self.first_shots(samples, k, BATCH.min(end - k), emitter, patch, shift);
                }
            }
            while !self.waiting.patch.is_empty() {
                self.go_on();
            }
        }
        (std::mem::take(&mut self.sums), self.tally)
    }

    fn trace(&mut self) {
        let n = self.rays.len();
        self.landings.resize(n.max(BATCH), 0);
        self.tally += self.tracer.trace(&self.rays, &mut self.landings[..n], &mut self.scratch);
    }

    #[allow(clippy::too_many_arguments)] // One address of samples, in parts.
    fn first_rays(
        &mut self,
        samples: &Samples,
        first: usize,
        n: usize,
        emitter: &Emitter,
        patch: usize,
        shift: Stream,
        words: Stream,
    ) {
        self.rays.resize(n);
        fill(&mut self.rays, &samples.net, first, emitter, shift);
        self.trace();
        for k in 0..n {
            let ray = Ray {
                from: patch,
                origin: self.rays.origin_of(k),
                direction: self.rays.direction_of(k),
                randomisation: samples.net.randomisation[first + k],
                words: words.child((first + k) as u64),
                throughput: None,
            };
            self.arrive(self.landings[k], &ray);
        }
    }

    /// Rays from points of the emitter to points of lamps.
    fn first_shots(
        &mut self,
        samples: &Samples,
        first: usize,
        n: usize,
        emitter: &Emitter,
        patch: usize,
        shift: Stream,
    ) {
        let key = [3, 4, 5, 6].map(|k| (shift.at(k) >> 33) as i32);
        self.begin_shots(emitter.facet);
        for k in first..first + n {
            let [s, t, u, v]: [f64; 4] = std::array::from_fn(|d| unit(samples.aims.samples[k][d] ^ key[d]));
            let point = emitter.map.at(u, v);
            if let Some(aim) = self.world.lamps.aim(patch, s, t) {
                self.shoot(patch, point, aim, u32::from(samples.aims.randomisation[k]));
            }
        }
        self.trace();
        for k in 0..self.shots.len() {
            let shot = &self.shots[k];
            if self.gets_there(k) {
                let at = shot.owner as usize * self.world.bands;
                let emission = self.world.emission_of(shot.lamp as usize);
                for (sum, e) in self.sums[at..].iter_mut().zip(emission) {
                    *sum += shot.weight * e;
                }
            }
        }
    }

    fn begin_shots(&mut self, facet: u32) {
        self.shots.clear();
        self.rays.resize(0);
        self.rays.from = facet;
    }

    /// Prepares a ray to a lamp, if the two sides face each other.
    fn shoot(&mut self, patch: usize, point: DVec3, aim: Aim, owner: u32) {
        let way = aim.point - point;
        let distance_squared = way.length_squared();
        if distance_squared == 0.0 {
            return;
        }
        let distance = distance_squared.sqrt();
        let direction = way / distance;
        let hemisphere = self.world.places[patch].frame.z.dot(direction) * FRAC_1_PI;
        let aimed = self.world.lamps.density(patch, aim.patch as usize, distance_squared, direction);
        if hemisphere <= 0.0 || aimed <= 0.0 {
            return;
        }
        let k = self.shots.len();
        self.rays.resize(k + 1);
        self.rays.set(k, point, direction);
        self.shots.push(Shot { lamp: aim.patch, weight: hemisphere / (hemisphere + aimed), owner, distance });
    }

    /// True if nothing stands before the lamp. What lies behind it does not count: kernels in single precision miss the
    /// rims of lamps, and light must not be lost to that.
    fn gets_there(&self, k: usize) -> bool {
        let (shot, landing) = (&self.shots[k], self.landings[k]);
        let beyond = || {
            let met = self.world.distance(landing as usize, self.rays.origin_of(k), self.rays.direction_of(k));
            met >= shot.distance * BEYOND
        };
        landing == shot.lamp || landing == ESCAPED || (landing < BACK && beyond())
    }

    /// What a ray of the hemisphere brings from where it lands, and whether the path goes on from there.
    fn arrive(&mut self, landing: u32, ray: &Ray) {
        if landing >= BACK {
            return;
        }
        let (world, patch) = (self.world, landing as usize);
        let at = usize::from(ray.randomisation) * world.bands;
        let carries = |c: usize| ray.throughput.map_or(1.0, |t| t[c]);
        let distance = world.distance(patch, ray.origin, ray.direction);
        if world.is_lamp(patch) {
            let weight = self.weight_of_hit(ray, patch, distance);
            for (c, e) in world.emission_of(patch).iter().enumerate() {
                self.sums[at + c] += carries(c) * weight * e;
            }
        }
        let mut survival: f64 = 0.0;
        for (c, rho) in world.reflectance_of(patch).iter().enumerate() {
            self.carried[c] = carries(c) * rho;
            survival = survival.max(self.carried[c]);
        }
        if survival == 0.0 {
            return;
        }
        // The rest of the path is what is expected, plus a correction that is followed now and then: unbiased
        // whatever is expected, and with little noise where that is near the truth.
        let goes_on = ray.words.unit(0) < survival;
        let share = if goes_on { 1.0 - 1.0 / survival } else { 1.0 };
        for (c, expected) in world.expected_of(patch).iter().enumerate() {
            self.sums[at + c] += self.carried[c] * share * expected;
        }
        if goes_on {
            self.waiting.patch.push(landing);
            self.waiting.point.push(ray.origin + ray.direction * distance);
            self.waiting.randomisation.push(ray.randomisation);
            self.waiting.words.push(ray.words.child(1));
            self.waiting.throughput.extend(self.carried.iter().map(|t| t / survival));
        }
    }

    /// Weight of a lamp met by chance, where it could have been aimed at too: the balance heuristic.
    fn weight_of_hit(&self, ray: &Ray, patch: usize, distance: f64) -> f64 {
        if self.world.lamps.is_empty() {
            return 1.0;
        }
        let hemisphere = self.world.places[ray.from].frame.z.dot(ray.direction) * FRAC_1_PI;
        let aimed = self.world.lamps.density(ray.from, patch, distance * distance, ray.direction);
        if aimed > 0.0 { hemisphere / (hemisphere + aimed) } else { 1.0 }
    }

    /// The next rays of all paths that wait, facet by facet: rays of a batch leave one plane.
    fn go_on(&mut self) {
        let mut now = std::mem::take(&mut self.waiting);
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        let facet = |k: usize| u64::from(self.world.places[now.patch[k] as usize].facet);
        order.extend((0..now.patch.len()).map(|k| facet(k) << 32 | k as u64));
        order.sort_unstable();
        for one_facet in order.chunk_by(|a, b| a >> 32 == b >> 32) {
            for batch in one_facet.chunks(BATCH) {
                self.next_rays(&now, batch);
                if !self.world.lamps.is_empty() {
                    self.next_shots(&now, batch);
                }
            }
        }
        now.clear();
        // The larger buffer lives on only if nothing waits in the other.
        if self.waiting.patch.is_empty() {
            self.waiting = now;
        }
        self.order = order;
    }

    fn next_rays(&mut self, now: &Vertices, batch: &[u64]) {
        self.rays.resize(batch.len());
        self.rays.from = (batch[0] >> 32) as u32;
        for (slot, key) in batch.iter().enumerate() {
            let k = (key & 0xffff_ffff) as usize;
            let local = cosine_hemisphere(now.words[k].unit(WORDS), now.words[k].unit(WORDS + 1));
            let direction = self.world.places[now.patch[k] as usize].frame.to_world(local);
            self.rays.set(slot, now.point[k], direction);
        }
        self.trace();
        let bands = self.world.bands;
        for (slot, key) in batch.iter().enumerate() {
            let k = (key & 0xffff_ffff) as usize;
            let ray = Ray {
                from: now.patch[k] as usize,
                origin: now.point[k],
                direction: self.rays.direction_of(slot),
                randomisation: now.randomisation[k],
                words: now.words[k],
                throughput: Some(&now.throughput[k * bands..(k + 1) * bands]),
            };
            self.arrive(self.landings[slot], &ray);
        }
    }

    fn next_shots(&mut self, now: &Vertices, batch: &[u64]) {
        self.begin_shots((batch[0] >> 32) as u32);
        for key in batch {
            let k = (key & 0xffff_ffff) as usize;
            let (patch, words) = (now.patch[k] as usize, now.words[k]);
            if let Some(aim) = self.world.lamps.aim(patch, words.unit(WORDS + 2), words.unit(WORDS + 3)) {
                self.shoot(patch, now.point[k], aim, k as u32);
            }
        }
        self.trace();
        let bands = self.world.bands;
        for (slot, shot) in self.shots.iter().enumerate() {
            if self.gets_there(slot) {
                let k = shot.owner as usize;
                let at = usize::from(now.randomisation[k]) * bands;
                let emission = self.world.emission_of(shot.lamp as usize);
                for c in 0..bands {
                    self.sums[at + c] += now.throughput[k * bands + c] * shot.weight * emission[c];
                }
            }
        }
    }
}
