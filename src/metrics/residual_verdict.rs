//! Pass, fail or not known from the bounds of a residual, and what would decide an open case.

use super::residual::ResidualMetrics;
use super::residual_bounds::ErrorBounds;
use super::types::Verdict;
use serde::Serialize;

/// Rays that are worth being asked for: so many times what was cast.
const MOST_RAYS: f64 = 1024.0;
/// Twice the rays that would just do: the value itself moves from run to run.
const MARGIN: f64 = 2.0;
/// Bounces that are worth being asked for.
pub const MOST_BOUNCES: u32 = 64;

/// The verdict of a residual.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ResidualDecision {
    /// Pass, fail or inconclusive.
    pub verdict: Verdict,
    /// Limit on eq. 7, a fraction.
    pub limit: f64,
    /// For an open case: what would decide it.
    pub remedy: Option<Remedy>,
}

/// What would decide an open case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Remedy {
    /// About so many times the rays.
    MoreRays(f64),
    /// So many bounces: the noise is small, the bounds are too far apart.
    MoreBounces(u32),
    /// The error is at the limit, or the walls are too bright: only a reference can tell.
    Reference,
}

/// Holds the bounds of a residual against a limit on eq. 7: failed if the error is surely above it, passed if it is
/// surely not, else open.
pub fn decide_residual(metrics: &ResidualMetrics, limit: f64) -> ResidualDecision {
    let verdict = verdict(&metrics.error_bounds, limit);
    let remedy = (verdict == Verdict::Inconclusive).then(|| remedy(metrics, limit));
    ResidualDecision { verdict, limit, remedy }
}

fn verdict(bounds: &ErrorBounds, limit: f64) -> Verdict {
    if bounds.low > limit {
        Verdict::Fail
    } else if bounds.high.is_some_and(|h| h <= limit) {
        Verdict::Pass
    } else {
        Verdict::Inconclusive
    }
}

fn remedy(metrics: &ResidualMetrics, limit: f64) -> Remedy {
    let norms = &metrics.norms;
    let decided = |bounds: ErrorBounds| verdict(&bounds, limit) != Verdict::Inconclusive;
    let rays = std::iter::successors(Some(2.0), |f| Some(2.0 * f)).take_while(|f| *f <= MOST_RAYS);
    if let Some(factor) = rays.map(|f: f64| (f, norms.with_rays(f))).find(|(_, n)| decided(n.bounds())) {
        return Remedy::MoreRays(MARGIN * factor.0);
    }
    let quiet = norms.with_rays(MOST_RAYS);
    let more = std::iter::successors(Some(metrics.bounces + 1), |n| Some(n + n.div_ceil(4)));
    let enough = more.take_while(|n| *n <= MOST_BOUNCES).find(|n| decided(quiet.with_bounces(*n).bounds()));
    enough.map_or(Remedy::Reference, Remedy::MoreBounces)
}

#[cfg(test)]
mod tests {
    use super::super::residual_bounds::{Group, Norms};
    use super::*;
    use crate::stats::Estimate;

    fn metrics(low: f64, value: f64, high: f64, rho_max: f64, bounces: u32) -> ResidualMetrics {
        let e = Estimate { value, std_err: Some(0.5 * (high - value)), low, high };
        let groups = vec![Group { norm: e, rho_max, apart: vec![0.0] }];
        let norms = Norms { series: e, groups, corrected: Estimate::exact(1.0), solution: 1.0, bounces };
        ResidualMetrics {
            confidence: 0.95,
            residual: Some(e),
            error_bounds: norms.bounds(),
            rho_max,
            bounces,
            left_over: rho_max.powi(bounces as i32),
            per_band: vec![],
            emitter_share: 0.0,
            patches: 1,
            worst: vec![],
            surfaces: vec![],
            norms,
        }
    }

    #[test]
    fn sure_cases_are_decided() {
        let m = metrics(0.009, 0.01, 0.011, 0.5, 1);
        // Between 0.009 / 1.5 and 0.011 / 0.5 of the solution's own norm, and a little more of the truth's.
        assert_eq!(decide_residual(&m, 0.005).verdict, Verdict::Fail);
        assert_eq!(decide_residual(&m, 0.03).verdict, Verdict::Pass);
        assert_eq!(decide_residual(&m, 0.03).remedy, None);
    }

    #[test]
    fn an_open_case_says_what_would_decide() {
        let gap = decide_residual(&metrics(0.009, 0.01, 0.011, 0.5, 1), 0.013);
        assert!(matches!(gap.remedy, Some(Remedy::MoreBounces(2..=10))), "{gap:?}");
        let noise = decide_residual(&metrics(0.0, 0.01, 0.05, 0.5, 8), 0.03);
        assert!(matches!(noise.remedy, Some(Remedy::MoreRays(f)) if (4.0..=16.0).contains(&f)), "{noise:?}");
        let at_the_limit = decide_residual(&metrics(0.0099, 0.01, 0.0101, 0.5, 8), 0.01);
        assert_eq!((at_the_limit.verdict, at_the_limit.remedy), (Verdict::Inconclusive, Some(Remedy::Reference)));
    }
}
