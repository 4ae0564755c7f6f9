//! Looking again with a better reference until a verdict comes, with intervals that hold although one stops at will.

use super::judge::{JudgeError, Judgement};
use crate::metrics::Verdict;
use serde::{Deserialize, Serialize};

/// A better reference costs at most so many times the last one: more looks, but none that runs away.
const LARGEST_STEP: f64 = 16.0;

/// So many looks at most: the last one has a risk of a thousandth of the first's.
const MOST: u32 = 10;

/// One look at a solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Look {
    /// Rays per patch of the reference it was judged by.
    pub rays_per_patch: u64,
    /// One-sigma relative error of that reference, in the norm of eq. 7.
    pub relative_error: f64,
    /// Confidence of this look over all limits.
    pub confidence: f64,
    /// What it said.
    pub verdict: Verdict,
}

/// Confidence of look number `k` (from 1): of the risk 1 - confidence the first look may use a half, the second a
/// quarter, and so on. Whatever makes one stop, the risk of all looks together is no larger than promised (Bonferroni),
/// also where they share data.
pub fn confidence_of_look(confidence: f64, k: u32) -> f64 {
    1.0 - (1.0 - confidence) * 0.5f64.powi(k.min(1000) as i32)
}

/// What came of all looks.
#[derive(Debug, Clone)]
pub struct Decided {
    /// The last judgement.
    pub judgement: Judgement,
    /// Every look, in order.
    pub looks: Vec<Look>,
}

/// A judgement with the reference it rests on.
pub struct Seen {
    /// The judgement.
    pub judgement: Judgement,
    /// Rays per patch of the reference.
    pub rays_per_patch: u64,
    /// Relative error of the reference.
    pub relative_error: f64,
}

/// Looks until the verdict is pass or fail, no more time is left, or more rays would not help. `look(k, confidence, factor)`
/// judges with the stored reference for k = 1, and after that with one of about `factor` times the rays of the last;
/// `None` if there is no time for it.
///
/// # Errors
/// Those of `look`.
pub fn until_decided<E: From<JudgeError>>(
    confidence: f64,
    mut look: impl FnMut(u32, f64, f64) -> Result<Option<Seen>, E>,
) -> Result<Option<Decided>, E> {
    let mut decided: Option<Decided> = None;
    let mut factor = 1.0;
    for k in 1..=MOST {
        let confidence = confidence_of_look(confidence, k);
        let Some(seen) = look(k, confidence, factor)? else { break };
        let verdict = seen.judgement.decision.as_ref().map_or(Verdict::Inconclusive, |d| d.verdict);
        let one =
            Look { rays_per_patch: seen.rays_per_patch, relative_error: seen.relative_error, confidence, verdict };
        let mut looks = decided.map_or(Vec::new(), |d| d.looks);
        looks.push(one);
        let next = step(&seen.judgement);
        decided = Some(Decided { judgement: seen.judgement, looks });
        match next {
            Some(f) if verdict == Verdict::Inconclusive => factor = f,
            _ => break,
        }
    }
    Ok(decided)
}

/// How many times the rays the limit needs that asks for most; `None` where no open limit says that rays would help.
fn step(judgement: &Judgement) -> Option<f64> {
    let limits = judgement.decision.iter().flat_map(|d| &d.limits);
    let asked = limits.filter_map(|l| l.rays_factor).reduce(f64::max);
    asked.map(|f| f.clamp(2.0, LARGEST_STEP))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_risks_of_all_looks_add_to_what_was_promised() {
        let total: f64 = (1..=40).map(|k| 1.0 - confidence_of_look(0.95, k)).sum();
        assert!((total - 0.05).abs() < 1e-12, "{total}");
        assert!((confidence_of_look(0.95, 1) - 0.975).abs() < 1e-15);
    }
}
