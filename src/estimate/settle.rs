//! Which pairs of a scene are worth settling without rays, and how far.

use super::{Coverage, Estimator, PairFactors, PairPlan, Plan, pair_form_factors};
use crate::scene::Stage;
use std::collections::HashSet;
use std::time::Duration;

/// Patches up to which all pairs are settled: their number grows with the square.
const MOST_PATCHES: usize = 3_000;

/// Sides times sides times facets up to which all pairs are sorted: some ten seconds.
const MOST_SORTING: f64 = 1e9;

/// Pairs with an emitter up to which those are settled.
const MOST_EMITTER_PAIRS: f64 = 1e7;

/// What a pair takes on one core, seconds, and the share of a limited time that may go into pairs: where it would not
/// do, rays have all of it.
const SECONDS_PER_PAIR: f64 = 1e-5;
const SHARE_OF_TIME: f64 = 0.3;

/// A point of exact visibility costs about as much as so many rays.
const RAYS_PER_POINT: u64 = 8;

/// Settles what the plan's estimator allows, within about the cost of its rays; `None` where that is nothing.
/// `progress` is told how many patches are done.
pub fn settle(stage: &Stage, plan: &Plan, progress: &(dyn Fn(u64) + Sync)) -> Option<PairFactors> {
    if plan.estimator == Estimator::Rays {
        return None;
    }
    let present = stage.patches.iter().filter(|p| p.is_present()).count();
    let pairs = PairPlan {
        target_error: plan.target_error,
        points: plan.rays.saturating_mul(present as u64) / RAYS_PER_POINT,
        max_time: plan.max_time,
        coverage: coverage(stage, present, plan.max_time)?,
        ..PairPlan::default()
    };
    Some(pair_form_factors(stage, &pairs, progress))
}

fn coverage(stage: &Stage, present: usize, limit: Option<Duration>) -> Option<Coverage> {
    let facets = stage.facets.len() as f64;
    let pairs = (present * present / 2) as f64;
    let in_time = limit.is_none_or(|t| pairs * SECONDS_PER_PAIR < SHARE_OF_TIME * t.as_secs_f64());
    if in_time && present <= MOST_PATCHES && facets.powi(3) <= MOST_SORTING {
        return Some(Coverage::All);
    }
    let emits = |i: &usize| stage.patches[*i].is_present() && stage.emission(*i).iter().any(|e| *e > 0.0);
    let emitters: Vec<usize> = (0..stage.patch_count()).filter(emits).collect();
    let sides: HashSet<u32> = emitters.iter().map(|i| stage.patches[*i].facet).collect();
    let sorting = sides.len() as f64 * facets * facets;
    let affordable = (emitters.len() * present) as f64 <= MOST_EMITTER_PAIRS && sorting <= MOST_SORTING;
    (affordable && !emitters.is_empty()).then_some(Coverage::Emitters)
}
