//! Pass, fail or not known: the only place that decides.

use super::limits::{Limits, Metric};
use super::measure::Measured;
use super::types::{Decision, LimitOutcome, Verdict};
use crate::stats::{Estimate, bonferroni_level};

/// Twice the rays that would just do: the value itself moves from run to run by half of what its interval spans.
const MARGIN: f64 = 2.0;

/// A limit closer to the value than this share of the interval's half-width is beyond what rays can settle.
const TOO_CLOSE: f64 = 0.05;

/// Confidence for each interval such that all limits given hold together (Bonferroni): `1 - (1 - confidence) / k`.
/// For no limits or one it is `confidence` itself.
pub fn shared_confidence(confidence: f64, limits: &Limits) -> f64 {
    let given = limits.list().len();
    if given < 2 { confidence } else { 1.0 - bonferroni_level(1.0 - confidence, given) }
}

/// Holds what was measured against its limits. A limit is failed if the interval lies above it, passed if the interval
/// does not reach beyond it, else open (or passed, where it is kept unless surely exceeded). One failure fails; all passed
/// pass.
///
/// A limit on a metric that could not be had (no state before, or a dark one) is open.
pub fn decide(measured: &[Measured]) -> Decision {
    let limits: Vec<LimitOutcome> = measured.iter().map(of_measured).collect();
    Decision { verdict: overall(&limits), limits }
}

pub(super) fn overall(limits: &[LimitOutcome]) -> Verdict {
    let any = |v: Verdict| limits.iter().any(|l| l.verdict == v);
    if any(Verdict::Fail) {
        Verdict::Fail
    } else if any(Verdict::Inconclusive) {
        Verdict::Inconclusive
    } else {
        Verdict::Pass
    }
}

/// One limit of a comparison.
fn of_measured(measured: &Measured) -> LimitOutcome {
    let Measured { limit, estimate, smallest_caught, rays_factor } = measured;
    let mut one = outcome(&limit.key(), limit.max, *estimate);
    if limit.unless_sure && estimate.is_some() && one.verdict == Verdict::Inconclusive {
        (one.verdict, one.rays_factor) = (Verdict::Pass, None);
    }
    if limit.metric == Metric::Visible && one.verdict == Verdict::Inconclusive {
        // A share is settled patch by patch; its half-width does not shrink like noise.
        one.rays_factor = rays_factor.map(|f| whole(MARGIN * f).max(2.0));
    }
    LimitOutcome { smallest_caught: *smallest_caught, ..one }
}

/// Holds one estimate against one limit.
pub(super) fn outcome(metric: &str, limit: f64, estimate: Option<Estimate>) -> LimitOutcome {
    let known = estimate.unwrap_or(Estimate { value: 0.0, std_err: None, low: 0.0, high: f64::MAX });
    let verdict = if known.low > limit {
        Verdict::Fail
    } else if known.high <= limit {
        Verdict::Pass
    } else {
        Verdict::Inconclusive
    };
    let open = verdict == Verdict::Inconclusive && estimate.is_some();
    let rays_factor = if open { rays_factor(&known, limit) } else { None };
    LimitOutcome { metric: metric.to_string(), limit, estimate: known, verdict, rays_factor, smallest_caught: None }
}

/// About how many times the rays would decide an open limit, if the value stays where it is: half-widths shrink
/// like 1 / sqrt(rays) (low-discrepancy points do better). Rounded up to a whole number.
fn rays_factor(e: &Estimate, limit: f64) -> Option<f64> {
    let (half_width, gap) =
        if e.value < limit { (e.high - e.value, limit - e.value) } else { (e.value - e.low, e.value - limit) };
    let shrink = half_width / gap;
    (shrink < 1.0 / TOO_CLOSE).then(|| whole(MARGIN * shrink * shrink).max(2.0))
}

/// Rounded up, but not for rounding's sake.
fn whole(x: f64) -> f64 {
    (x * (1.0 - 1e-9)).ceil()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Limit;

    fn estimate(low: f64, value: f64, high: f64) -> Estimate {
        Estimate { value, std_err: Some(0.5 * (high - value)), low, high }
    }

    fn of(metric: Metric, max: f64, estimate: Option<Estimate>) -> Measured {
        Measured { limit: Limit::new(metric, max), estimate, smallest_caught: None, rays_factor: None }
    }

    fn of_rms(e: Estimate, limit: f64) -> LimitOutcome {
        decide(&[of(Metric::Rms, limit, Some(e))]).limits.remove(0)
    }

    #[test]
    fn above_below_and_across() {
        let e = estimate(0.03, 0.04, 0.05);
        assert_eq!(of_rms(e, 0.029).verdict, Verdict::Fail);
        assert_eq!(of_rms(e, 0.03).verdict, Verdict::Inconclusive);
        assert_eq!(of_rms(e, 0.049).verdict, Verdict::Inconclusive);
        assert_eq!(of_rms(e, 0.05).verdict, Verdict::Pass);
        assert_eq!(of_rms(Estimate::exact(0.05), 0.05).verdict, Verdict::Pass);
        assert_eq!(of_rms(Estimate::exact(0.051), 0.05).verdict, Verdict::Fail);
    }

    #[test]
    fn one_sure_failure_fails_and_one_open_limit_leaves_it_open() {
        let (good, bad, open) = (estimate(0.01, 0.02, 0.03), estimate(0.06, 0.07, 0.08), estimate(0.04, 0.05, 0.06));
        let of = |rms, top1| decide(&[of(Metric::Rms, 0.05, Some(rms)), of(Metric::Top1, 0.05, Some(top1))]).verdict;
        assert_eq!(of(good, good), Verdict::Pass);
        assert_eq!(of(good, bad), Verdict::Fail);
        assert_eq!(of(open, bad), Verdict::Fail);
        assert_eq!(of(bad, open), Verdict::Fail);
        assert_eq!(of(open, good), Verdict::Inconclusive);
        assert_eq!(of(good, open), Verdict::Inconclusive);
    }

    #[test]
    fn a_metric_that_is_missing_is_open_and_rays_do_not_help() {
        let d = decide(&[of(Metric::Top1, 0.5, None)]);
        assert_eq!((d.verdict, d.limits[0].rays_factor), (Verdict::Inconclusive, None));
    }

    #[test]
    fn kept_unless_surely_exceeded() {
        let of = |e: Estimate| {
            let limit = Limit { unless_sure: true, ..Limit::new(Metric::Worse, 0.0) };
            decide(&[Measured { limit, estimate: Some(e), smallest_caught: None, rays_factor: None }]).verdict
        };
        assert_eq!(of(estimate(-0.01, 0.001, 0.02)), Verdict::Pass);
        assert_eq!(of(estimate(0.001, 0.01, 0.02)), Verdict::Fail);
    }

    #[test]
    fn rays_that_would_decide() {
        // Half-width 0.01 has to become 0.005: four times the rays, twice that for the value's own scatter.
        assert_eq!(of_rms(estimate(0.03, 0.04, 0.05), 0.045).rays_factor, Some(8.0));
        assert_eq!(of_rms(estimate(0.02, 0.04, 0.05), 0.03).rays_factor, Some(8.0));
        // Never less than twice; never where the limit is the value.
        assert_eq!(of_rms(estimate(0.03, 0.04, 0.05), 0.0499).rays_factor, Some(3.0));
        assert_eq!(of_rms(estimate(0.03, 0.04, 0.05), 0.04).rays_factor, None);
        assert_eq!(of_rms(estimate(0.03, 0.04, 0.05), 0.0401).rays_factor, None);
        assert_eq!(of_rms(estimate(0.0, 0.0, 0.05), 0.04).rays_factor, Some(4.0));
        assert_eq!(of_rms(estimate(0.03, 0.04, 0.05), 0.06).rays_factor, None);
    }

    #[test]
    fn error_is_shared_among_the_limits() {
        let both = Limits::rms(0.1).and_top1(0.1);
        assert!((shared_confidence(0.95, &both) - 0.975).abs() < 1e-15);
        assert_eq!(shared_confidence(0.95, &Limits::rms(0.1)), 0.95);
        assert_eq!(shared_confidence(0.95, &Limits::default()), 0.95);
    }
}
