//! The residual of a solution by rays: what each patch would radiate in the light of the others, less what it does.
//!
//! No system is solved and no matrix is kept: rows are cast, applied to the solution, and forgotten, so memory grows
//! with the patches alone. Further bounces cast anew, with rays of their own: replicate r of bounce k is
//! `K_kr ... K_2r K_1r (E + K_0r B - B)`, a product of independent unbiased matrices, hence unbiased itself.

use super::Session;
use crate::estimate::{Emitter, Entry, HitCounts, Plan, cast, patch_emitters};
use crate::raycast::{Tally, Tracer};
use crate::reference::{Progress, ReferenceError, check_size};
use crate::sampling::{Role, Stream};
use crate::solution::{Radiosity, Replicates};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// Rays of one bounce over all patches, where nobody asks for another number.
const RAYS: u64 = 1 << 22;
/// The default keeps each patch between these.
const RAYS_PER_PATCH: (u64, u64) = (64, 16_384);
/// Later bounces carry the residual alone, which is small: a part of the rays does.
const LATER: u64 = 4;
/// The default goes on bouncing until so much of the error is left, but not for ever.
const LEFT_OVER: f64 = 0.1;
const DEFAULT_BOUNCES: u32 = 16;
/// Hit counts of the rows that are cast at a time: some 64 MB.
const ENTRIES: u64 = 1 << 23;
/// Share of the time allowed that the plan fills.
const FILL: f64 = 0.7;
/// Streams of this conduct, apart from those of references, whose directory may be the solution judged.
const FIRST_BOUNCE: u64 = 0x5245_5349;
const TRIAL: u64 = 0x5452_4941;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualRequest {
    /// Rays per patch of the first bounce over all randomisations; `None`: some four million in all.
    pub rays: Option<u64>,
    /// Independent randomisations R, at least 8.
    pub randomisations: u16,
    /// Bounces; `None`: until a tenth of the error is left, at most 16.
    pub bounces: Option<u32>,
    /// Seed.
    pub seed: u64,
    /// Cast fewer rays where all would not fit into this time.
    pub max_time: Option<Duration>,
}

impl Default for ResidualRequest {
    fn default() -> Self {
        Self { rays: None, randomisations: 16, bounces: None, seed: 0, max_time: None }
    }
}

/// What came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualRun {
    /// `E + rho F B - B` of each randomisation, W/m^2.
    pub residual: Replicates,
    /// The residual and its further bounces, added up.
    pub series: Replicates,
    /// Bounces.
    pub bounces: u32,
    /// Rays per patch of the first bounce.
    pub rays_per_patch: u64,
    /// What became of all rays.
    pub tally: Tally,
    /// True if the time allowed made the rays fewer.
    pub shortened: bool,
}

/// Casts the residual of a solution: one value per patch and band, absent ones 0.
///
/// # Errors
/// More patches or rays than can be counted.
pub fn residual(
    session: &Session,
    solution: &Radiosity,
    request: &ResidualRequest,
    progress: &dyn Progress,
) -> Result<ResidualRun, ReferenceError> {
    let begin = Instant::now();
    let stage = session.stage();
    let (emission, reflectance) = (stage.emissions(), stage.reflectances());
    let emitters = patch_emitters(stage);
    let present = emitters.iter().flatten().count() as u64;
    let wanted = Plan {
        rays: request.rays.unwrap_or((RAYS / present.max(1)).clamp(RAYS_PER_PATCH.0, RAYS_PER_PATCH.1)),
        randomisations: request.randomisations,
        ..Plan::default()
    };
    check_size(stage, &wanted)?;
    let bounces = request.bounces.unwrap_or_else(|| default_bounces(&reflectance)).max(1);
    let mut caster = Caster {
        tracer: session.tracer(),
        emitters: &emitters,
        reflectance: &reflectance,
        bands: solution.bands,
        stream: Stream::new(Role::Judge, request.seed),
        progress,
        tally: Tally::default(),
    };
    let (plan, shortened) = match request.max_time {
        None => (wanted, false),
        Some(limit) => caster.fit(&wanted, bounces, solution, begin, limit),
    };
    let later = Plan { rays: plan.rays_per_randomisation().div_ceil(LATER) * u64::from(plan.randomisations), ..plan };
    let all = |p: &Plan| p.rays_per_randomisation() * u64::from(p.randomisations) * present;
    progress.begin("casting rays", Some(all(&plan) + u64::from(bounces - 1) * all(&later)));

    let same: Vec<&[f64]> = vec![&solution.values; usize::from(plan.randomisations)];
    let mut term = caster.bounce(&same, &plan, FIRST_BOUNCE);
    for row in &mut term {
        row.iter_mut().zip(&emission).zip(&solution.values).for_each(|((r, e), b)| *r += e - b);
    }
    let residual = term.clone();
    let mut series = term.clone();
    for k in 1..bounces {
        let sources: Vec<&[f64]> = term.iter().map(Vec::as_slice).collect();
        term = caster.bounce(&sources, &later, FIRST_BOUNCE + u64::from(k));
        for (sum, row) in series.iter_mut().zip(&term) {
            sum.iter_mut().zip(row).for_each(|(s, x)| *s += x);
        }
    }
    let replicates = |replicates| Replicates { bands: solution.bands, replicates };
    Ok(ResidualRun {
        residual: replicates(residual),
        series: replicates(series),
        bounces,
        rays_per_patch: plan.rays_per_randomisation() * u64::from(plan.randomisations),
        tally: caster.tally,
        shortened,
    })
}

/// Bounces after which a tenth of any error is left.
fn default_bounces(reflectance: &[f64]) -> u32 {
    let rho_max = reflectance.iter().copied().fold(0.0, f64::max);
    (1..DEFAULT_BOUNCES).find(|n| rho_max.powi(*n as i32) <= LEFT_OVER).unwrap_or(DEFAULT_BOUNCES)
}

/// Casts bounces.
struct Caster<'a> {
    tracer: Tracer<'a>,
    emitters: &'a [Option<Emitter>],
    reflectance: &'a [f64],
    bands: usize,
    stream: Stream,
    progress: &'a dyn Progress,
    tally: Tally,
}

impl Caster<'_> {
    /// `rho F_r x_r` for every randomisation r, with rays of this bounce alone.
    fn bounce(&mut self, sources: &[&[f64]], plan: &Plan, key: u64) -> Vec<Vec<f64>> {
        let (bands, n) = (self.bands, self.emitters.len());
        let mut out = vec![vec![0.0; n * bands]; sources.len()];
        let per_row = (plan.rays_per_randomisation().min(n as u64) * u64::from(plan.randomisations)).max(1);
        let chunk = (ENTRIES / per_row).clamp(64, n.max(64) as u64) as usize;
        for (k, emitters) in self.emitters.chunks(chunk).enumerate() {
            let tell = |rays| self.progress.advance(rays);
            let counts = cast(&self.tracer, emitters, self.stream.child(key), plan, &|_| 0.0, &tell).counts;
            self.tally += counts.tally;
            let rows: Vec<Vec<f64>> =
                (0..emitters.len()).into_par_iter().map(|i| gather(&counts, i, sources, bands)).collect();
            for (i, row) in (k * chunk..).zip(&rows) {
                for (r, values) in row.chunks_exact(bands).enumerate() {
                    for (c, x) in values.iter().enumerate() {
                        out[r][i * bands + c] = self.reflectance[i * bands + c] * x;
                    }
                }
            }
        }
        out
    }

    /// The largest plan not above `wanted` whose rays fit into the time that is left, from the time that a trial
    /// with rays of its own takes. The choice depends on the clock and on nothing that is measured.
    fn fit(
        &mut self,
        wanted: &Plan,
        bounces: u32,
        solution: &Radiosity,
        begin: Instant,
        limit: Duration,
    ) -> (Plan, bool) {
        let randomisations = u64::from(wanted.randomisations);
        let of = |rays: u64| Plan { rays: rays * randomisations, ..*wanted };
        let same: Vec<&[f64]> = vec![&solution.values; usize::from(wanted.randomisations)];
        let (start, before) = (Instant::now(), self.tally);
        self.bounce(&same, &of(1), TRIAL);
        self.tally = before;
        let one = start.elapsed().as_secs_f64();
        let left = FILL * limit.as_secs_f64() - begin.elapsed().as_secs_f64();
        let cost = |rays: u64| one * (rays as f64 + f64::from(bounces - 1) * rays.div_ceil(LATER) as f64);
        let most = wanted.rays_per_randomisation();
        let mut rays = most;
        while rays > 1 && cost(rays) > left {
            rays /= 2;
        }
        (of(rays), rays < most)
    }
}

/// `sum_j F_ij x_j` as each randomisation sees it: R x bands.
fn gather(counts: &HitCounts, i: usize, sources: &[&[f64]], bands: usize) -> Vec<f64> {
    let mut out = vec![0.0; sources.len() * bands];
    let add = |e: &Entry, out: &mut [f64]| {
        let source = &sources[e.randomisation()][e.patch() * bands..];
        let own = &mut out[e.randomisation() * bands..][..bands];
        own.iter_mut().zip(source).for_each(|(o, x)| *o += e.count() as f64 * x);
    };
    counts.rows[i].iter().for_each(|e| add(e, &mut out));
    out.iter_mut().for_each(|x| *x /= counts.rays as f64);
    out
}
