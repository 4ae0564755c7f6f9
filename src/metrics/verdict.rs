//! Pass, fail or not known: the only place that decides.

use super::types::{Comparison, Decision, LimitOutcome, Limits, Verdict};
use crate::stats::{Estimate, bonferroni_level};

/// Twice the rays that would just do: the value itself moves from run to run by half of what its interval spans.
const MARGIN: f64 = 2.0;

/// A limit closer to the value than this share of the interval's half-width is beyond what rays can settle.
const TOO_CLOSE: f64 = 0.05;

/// Confidence for each interval such that all limits given hold together (Bonferroni): `1 - (1 - confidence) / k`.
/// For no limits or one it is `confidence` itself.
pub fn shared_confidence(confidence: f64, limits: &Limits) -> f64 {
    let given = [limits.max_rms, limits.max_top1].iter().flatten().count();
    if given < 2 { confidence } else { 1.0 - bonferroni_level(1.0 - confidence, given) }
}

/// Holds a comparison against limits. A limit is failed if the interval lies above it, passed if the interval
/// does not reach beyond it, else open. One failure fails; all passed pass.
///
/// A limit on a metric that the comparison does not have (no state before, or a dark one) is open.
pub fn decide(comparison: &Comparison, limits: &Limits) -> Decision {
    let asked = [("rms", limits.max_rms, Some(comparison.rms)), ("top1", limits.max_top1, comparison.top1)];
    let limits: Vec<LimitOutcome> =
        asked.into_iter().filter_map(|(metric, limit, e)| limit.map(|limit| outcome(metric, limit, e))).collect();
    Decision { verdict: overall(&limits), limits }
}

fn overall(limits: &[LimitOutcome]) -> Verdict {
    let any = |v: Verdict| limits.iter().any(|l| l.verdict == v);
    if any(Verdict::Fail) {
        Verdict::Fail
    } else if any(Verdict::Inconclusive) {
        Verdict::Inconclusive
    } else {
        Verdict::Pass
    }
}

fn outcome(metric: &str, limit: f64, estimate: Option<Estimate>) -> LimitOutcome {
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
    LimitOutcome { metric: metric.to_string(), limit, estimate: known, verdict, rays_factor }
}

/// About how many times the rays would decide an open limit, if the value stays where it is: half-widths shrink
/// like 1 / sqrt(rays) (low-discrepancy points do better). Rounded up to a whole number.
fn rays_factor(e: &Estimate, limit: f64) -> Option<f64> {
    let (half_width, gap) =
        if e.value < limit { (e.high - e.value, limit - e.value) } else { (e.value - e.low, e.value - limit) };
    let shrink = half_width / gap;
    (shrink < 1.0 / TOO_CLOSE).then(|| (MARGIN * shrink * shrink).ceil().max(2.0))
}
