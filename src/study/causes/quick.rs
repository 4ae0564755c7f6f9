//! One quick matrix of the judge's own making: how a change spreads.
//!
//! It computes differences only, so its noise is a share of what a hypothesis changes, not of the light.

use super::CauseOptions;
use super::case::Case;
use crate::estimate::{
    Blend, Coverage, HitCounts, PairFactors, PairPlan, Plan, cast, pair_form_factors, patch_emitters,
};
use crate::raycast::Tracer;
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::solution::FormFactors;
use crate::solver::{System, Transport, krylov};
use crate::study::Session;

/// Rays per patch, at least and at most: powers of two.
const RAYS: (u64, u64) = (128, 512);
/// Direct light from pairs without rays: pairs with a lamp, sides times facets times facets to sort, up to which it is
/// settled, and its accuracy. Lamps are small, and few rays find them.
const LAMP_PAIRS: usize = 300_000;
const LAMP_SORTING: f64 = 3e7;
const LAMP_PLAN: PairPlan = PairPlan {
    target_error: Some(2e-2),
    points: u64::MAX,
    max_time: None,
    points_per_pair: 64,
    arranged_bodies: 1,
    most_bodies: 16,
    coverage: Coverage::Emitters,
};
/// Relative residual to which changes are solved.
const RESIDUAL: f64 = 1e-5;

/// The quick matrix, and all that makes others like it.
pub(super) struct Quick<'a> {
    pub case: &'a Case<'a>,
    pub session: &'a Session<'a>,
    pub matrix: FormFactors,
    pub most_objects: usize,
    plan: Plan,
    stream: Stream,
}

impl<'a> Quick<'a> {
    /// `None` in scenes too large for it.
    pub fn new(case: &'a Case<'a>, session: &'a Session<'a>, options: &CauseOptions) -> Option<Self> {
        let stage = session.stage();
        let present = case.areas.iter().filter(|a| **a > 0.0).count();
        if present > options.most_patches {
            return None;
        }
        // All rays meet some object, and are traced again without it.
        let rays = (options.rays / (2 * present.max(1) as u64)).clamp(RAYS.0, RAYS.1);
        let rays = 1 << rays.ilog2();
        let plan = Plan { rays, randomisations: 2, ..Plan::default() };
        let stream = Stream::new(Role::Witness, options.seed);
        let counts = cast(&session.tracer(), &patch_emitters(stage), stream, &plan, &|_| 0.0, &|_| ()).counts;
        let matrix = blended(direct_light(stage).as_ref(), &counts);
        Some(Self { case, session, matrix, most_objects: options.most_objects, plan, stream })
    }

    /// The matrix of another stage of as many patches, with the same rays; only the rows asked for.
    pub fn matrix_in(&self, tracer: &Tracer, rows: impl Fn(usize) -> bool) -> FormFactors {
        let stage = tracer.stage();
        let mut emitters = patch_emitters(stage);
        emitters.iter_mut().enumerate().filter(|(i, _)| !rows(*i)).for_each(|(_, e)| *e = None);
        let counts = cast(tracer, &emitters, self.stream, &self.plan, &|_| 0.0, &|_| ()).counts;
        blended(direct_light(stage).as_ref(), &counts)
    }

    /// What becomes of a source that is added to the scene: `(I - diag(rho) F) d = source`.
    pub fn spread(&self, source: &[f64]) -> Option<Vec<f64>> {
        spread_in(&self.matrix, source, &self.case.reflectance, self.case.bands)
    }

    /// The same with other reflectances.
    pub fn spread_with(&self, source: &[f64], reflectance: &[f64]) -> Option<Vec<f64>> {
        spread_in(&self.matrix, source, reflectance, self.case.bands)
    }

    /// What arrives of a radiosity.
    pub fn arriving(&self, radiosity: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; radiosity.len()];
        self.matrix.apply(radiosity, self.case.bands, &mut out);
        out
    }

    /// What is reflected of a radiosity.
    pub fn reflected(&self, radiosity: &[f64]) -> Vec<f64> {
        let mut out = self.arriving(radiosity);
        out.iter_mut().zip(&self.case.reflectance).for_each(|(x, rho)| *x *= rho);
        out
    }

    /// What arrives in truth: from the reference itself where it reflects, by the matrix where it does not.
    pub fn irradiance(&self) -> Vec<f64> {
        let case = self.case;
        let cast = self.arriving(&case.truth);
        let of = |(k, cast): (usize, &f64)| {
            let rho = case.reflectance[k];
            if rho > 1e-3 { (case.truth[k] - case.emission[k]) / rho } else { *cast }
        };
        cast.iter().enumerate().map(of).collect()
    }
}

/// `(I - diag(rho) F) d = source`; `None` where that does not converge.
pub(super) fn spread_in(f: &FormFactors, source: &[f64], reflectance: &[f64], bands: usize) -> Option<Vec<f64>> {
    let system = System { emission: source, reflectance, bands };
    let params = krylov::Params { tolerance: RESIDUAL, max_iterations: 200, ..krylov::Params::default() };
    krylov::solve(&system, f, None, &params, |_, _| {}).ok().map(|(d, _)| d)
}

/// Pairs with a lamp, settled without rays where that is cheap.
fn direct_light(stage: &Stage) -> Option<PairFactors> {
    let emits = |i: &usize| stage.patches[*i].is_present() && stage.emission(*i).iter().any(|e| *e > 0.0);
    let lamps: Vec<usize> = (0..stage.patch_count()).filter(emits).collect();
    let facets = stage.facets.len() as f64;
    let mut sides: Vec<u32> = lamps.iter().map(|i| stage.patches[*i].facet).collect();
    sides.dedup();
    let cheap = lamps.len() * stage.patch_count() <= LAMP_PAIRS && sides.len() as f64 * facets * facets <= LAMP_SORTING;
    (cheap && !lamps.is_empty()).then(|| pair_form_factors(stage, &LAMP_PLAN, &|_| ()))
}

fn blended(settled: Option<&PairFactors>, counts: &HitCounts) -> FormFactors {
    settled.map_or_else(|| Blend::of_rays(counts), |s| Blend::new(s, counts)).form_factors()
}
