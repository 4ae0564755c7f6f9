//! Form factors pair by pair, without a ray: closed forms where nothing stands between (proved), zero where nothing
//! can be seen (proved), the exactly computed shadow of the bodies between elsewhere.

mod congruent;
mod left;
mod sides;
mod sort;

pub use left::Left;
pub(super) use sides::{Side, sides};

use crate::formfactor::{Effort, Hidden, hidden_exchange};
use crate::math::Polytope;
use crate::scene::Stage;
use crate::solution::FormFactors;
use rayon::prelude::*;
use sort::{Pair, Sorted, sort};
use std::time::{Duration, Instant};

/// Error of the closed forms, relative and absolute: what they are tested to.
const CLOSED_RELATIVE: f64 = 5e-12;
const CLOSED_ABSOLUTE: f64 = 3e-14;

/// Each wave asks for an error smaller by this factor.
const STEP: f64 = 0.01;

/// The first wave asks for this share of the mean form factor, the last for this error.
const FIRST: f64 = 1e-2;
const LAST: f64 = 1e-13;

/// Form factors below their error, and that below this, count as zero.
const NOTHING: f64 = 1e-12;

/// What a wave costs more than the one before, at most, in scenes seen so far.
const GROWTH: u64 = 4;

/// Which pairs are settled without rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coverage {
    /// All of them.
    All,
    /// Those of which one emits: direct light without noise, in scenes too large for all pairs.
    Emitters,
}

/// How accurate, and how hard to try.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairPlan {
    /// Stop at this relative error of the matrix, `sqrt(sum se^2) / sqrt(sum F^2)`, rather than at `points`.
    pub target_error: Option<f64>,
    /// Points of exact visibility, all pairs together, beyond which no further wave is begun.
    pub points: u64,
    /// No further wave is begun that would not fit into this time.
    pub max_time: Option<Duration>,
    /// Points per pair and wave at most.
    pub points_per_pair: usize,
    /// Bodies in a shaft up to which the integral is cut also where two bodies line up, after the first wave.
    pub arranged_bodies: usize,
    /// Pairs with more bodies in their shaft are left to rays.
    pub most_bodies: usize,
    /// Which pairs are settled here; the others are left to rays.
    pub coverage: Coverage,
}

impl Default for PairPlan {
    fn default() -> Self {
        Self {
            target_error: None,
            points: u64::MAX,
            max_time: None,
            points_per_pair: 20_000,
            arranged_bodies: 2,
            most_bodies: 16,
            coverage: Coverage::All,
        }
    }
}

/// How many pairs of patches (each counted once) were settled in which way.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct PairTally {
    /// Proved to see each other wholly: closed form.
    pub visible: u64,
    /// Proved not to see each other: facing away, in one plane, or one body before all.
    pub unseen: u64,
    /// Bodies may hide a part: computed exactly where they do.
    pub partial: u64,
    /// Left to rays: too much stands between, or not covered.
    pub left: u64,
    /// Points at which visibility was evaluated.
    pub points: u64,
}

/// Form factors of all pairs, and how they were come by.
#[derive(Debug)]
pub struct PairFactors {
    /// The matrix of the settled pairs; the standard errors are the estimated bounds of the numerical error.
    pub form_factors: FormFactors,
    /// Pairs left to rays. All others are settled, also where no entry is stored.
    pub left: Left,
    /// How.
    pub tally: PairTally,
    /// After each wave: points of visibility evaluated, and the relative error reached.
    pub waves: Vec<(u64, f64)>,
}

impl PairFactors {
    /// Relative error of the settled part, `sqrt(sum se^2) / sqrt(sum F^2)`.
    pub fn relative_error(&self) -> f64 {
        self.waves.last().map_or(0.0, |w| w.1)
    }
}

/// A pair's exchange as far as it is known.
struct Settled {
    pair: Pair,
    hidden: Hidden,
    /// Error of the exchange, m^2.
    error: f64,
}

/// Computes the form factors of the pairs of patches of a stage. `progress` is told how many patches are done.
pub fn pair_form_factors(stage: &Stage, plan: &PairPlan, progress: &(dyn Fn(u64) + Sync)) -> PairFactors {
    let begin = Instant::now();
    let Sorted { bodies, pairs, left, covered, uncovered, unseen } = sort(stage, plan, progress);
    let smaller = |p: &Pair| stage.patches[p.from as usize].area.min(stage.patches[p.to as usize].area);
    let begun = |pair: Pair| {
        let error = CLOSED_RELATIVE * pair.open + CLOSED_ABSOLUTE * smaller(&pair);
        // Before the first wave nothing is known of what bodies hide.
        let error = if pair.between.is_empty() { error } else { pair.open };
        Settled { pair, hidden: Hidden::default(), error }
    };
    let mut settled: Vec<Settled> = pairs.into_par_iter().map(begun).collect();
    let mut tally = PairTally { unseen, left: left.len() as u64 + uncovered, ..PairTally::default() };
    tally.partial = settled.iter().filter(|s| !s.pair.between.is_empty()).count() as u64;
    tally.visible = settled.len() as u64 - tally.partial;

    let present = stage.patches.iter().filter(|p| p.is_present()).count().max(1);
    let mut tolerance = FIRST / present as f64;
    let mut waves = Vec::new();
    loop {
        // The lines where two bodies line up are many, and pay only once the error is small.
        let arranged_bodies = if waves.is_empty() { 1 } else { plan.arranged_bodies };
        let points = wave(stage, &PairPlan { arranged_bodies, ..*plan }, &bodies, &mut settled, tolerance);
        tally.points += points;
        let relative = relative_error(stage, &settled);
        waves.push((tally.points, relative));
        let enough = match plan.target_error {
            Some(target) => relative <= target,
            None => tally.points + GROWTH * points > plan.points,
        };
        let late = plan.max_time.is_some_and(|limit| begin.elapsed() * 3 > limit);
        // Not where a wave found nothing to do: small exchanges wait for a smaller tolerance.
        if tally.partial == 0 || enough || late || tolerance <= LAST {
            break;
        }
        tolerance *= STEP;
    }
    let left = Left::new(stage.patch_count(), &left, covered);
    PairFactors { form_factors: assembled(stage, &settled), left, tally, waves }
}

/// Brings every pair to the tolerance (an error of a form factor) or to its most points. Returns the points evaluated.
fn wave(stage: &Stage, plan: &PairPlan, bodies: &[Polytope], settled: &mut [Settled], tolerance: f64) -> u64 {
    let refine = |s: &mut Settled| {
        let (p, q) = (&stage.patches[s.pair.from as usize], &stage.patches[s.pair.to as usize]);
        let goal = tolerance * p.area.min(q.area);
        if s.pair.between.is_empty() || s.error <= goal || s.hidden.points >= plan.points_per_pair {
            return 0;
        }
        let few: Vec<&Polytope> = s.pair.between.iter().map(|k| &bodies[*k as usize]).collect();
        let pieces = p.region.pieces.len() * q.region.pieces.len();
        let effort = Effort {
            tolerance: goal / pieces as f64,
            points: plan.points_per_pair / pieces,
            arranged_bodies: plan.arranged_bodies,
        };
        let mut hidden = Hidden::default();
        for a in &p.region.pieces {
            for b in &q.region.pieces {
                let part = hidden_exchange(a, b, &few, &effort);
                hidden.exchange += part.exchange;
                hidden.error += part.error;
                hidden.points += part.points;
            }
        }
        let rounding = CLOSED_RELATIVE * s.pair.open + CLOSED_ABSOLUTE * p.area.min(q.area);
        // A run that ended for want of points may know less than the one before.
        if hidden.error + rounding < s.error {
            (s.hidden, s.error) = (hidden, hidden.error + rounding);
        } else {
            s.hidden.points = plan.points_per_pair;
        }
        hidden.points as u64
    };
    settled.par_iter_mut().map(refine).sum()
}

impl Settled {
    /// What is left of the open exchange. Within the error of nothing it is nothing, with that error.
    fn exchange(&self) -> f64 {
        (self.pair.open - self.hidden.exchange).max(0.0)
    }
}

fn relative_error(stage: &Stage, settled: &[Settled]) -> f64 {
    let (mut noise, mut signal) = (0.0, 0.0);
    for s in settled {
        let of = |i: u32| stage.patches[i as usize].area.powi(-2);
        let both = of(s.pair.from) + of(s.pair.to);
        noise += s.error * s.error * both;
        signal += s.exchange().powi(2) * both;
    }
    if signal == 0.0 { 0.0 } else { (noise / signal).sqrt() }
}

/// Both directions of every exchange, in rows.
fn assembled(stage: &Stage, settled: &[Settled]) -> FormFactors {
    let mut rows: Vec<Vec<(u32, f64, f64)>> = vec![Vec::new(); stage.patch_count()];
    for s in settled {
        let exchange = s.exchange();
        let smaller = stage.patches[s.pair.from as usize].area.min(stage.patches[s.pair.to as usize].area);
        // What cannot be told from nothing, by more digits than anybody asks for, is not stored.
        if exchange <= s.error && s.error <= NOTHING * smaller {
            continue;
        }
        for (i, j) in [(s.pair.from, s.pair.to), (s.pair.to, s.pair.from)] {
            let area = stage.patches[i as usize].area;
            rows[i as usize].push((j, exchange / area, s.error / area));
        }
    }
    rows.par_iter_mut().for_each(|row| row.sort_unstable_by_key(|e| e.0));
    FormFactors::from_rows(rows)
}
