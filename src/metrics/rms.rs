//! Eq. 7 of GSG90 against a truth that is known through replicates only.

use super::sums::Sums;
use crate::stats::{Estimate, two_sided_t};

/// What eq. 7 gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rms {
    /// The error with its interval.
    Known(Estimate),
    /// The reference is dark, or not distinguishable from dark: no relative error is defined.
    Dark,
}

impl Rms {
    /// The estimate, if there is one.
    pub fn estimate(self) -> Option<Estimate> {
        match self {
            Rms::Known(e) => Some(e),
            Rms::Dark => None,
        }
    }
}

/// `sqrt( sum (y_ref - y)^2 A / sum y_ref^2 A )` against the *true* reference, from R independent replicates of it
/// [GSG90 eq. 7]. One row: that solution is taken as the truth and the result is exact.
///
/// `areas`, `solution` and each row of `reference` have one entry per patch; patches of area 0 take no part.
///
/// Numerator and denominator are means over pairs of different replicates, so that neither holds the square of
/// the noise. The interval: see [`interval`].
pub fn relative_rms(areas: &[f64], solution: &[f64], reference: &[Vec<f64>], confidence: f64) -> Rms {
    let rows: Vec<&[f64]> = reference.iter().map(Vec::as_slice).collect();
    let patches = (0..areas.len()).filter(|i| areas[*i] > 0.0);
    interval(&[Sums::over(patches, areas, solution, &rows)], confidence)
}

/// Value and interval from the sums over one or more disjoint sets of replicates, each over its own patches;
/// numerators and denominators are averaged over the sets.
///
/// On the scale of q = value^2, with `n` the number of patches beyond counting:
/// - to first order q moves with the noise along the difference, which replicates show as a scalar each: Student t.
///   That standard error holds the second order once more where noise in many directions dominates;
/// - noise in *one* direction (a brightness common to all patches) can hide a difference along that direction
///   altogether: the difference reads 0 and so does its standard error. The noise norm along the strongest
///   direction bounds what is hidden: q may be up to `(|D| + t s)^2`, which is `q + 2 t s |D| + (t^2 + 1) s^2`.
///   This is exact where there is no other noise, and vanishes against the first order away from zero;
/// - a value below zero that luck gave never makes the interval shorter.
pub(super) fn interval(sets: &[Sums], confidence: f64) -> Rms {
    let q = Ratio::of(sets);
    let t = two_sided_t(confidence, q.freedom);
    if q.denominator <= t * q.denominator_std_err || q.denominator <= 0.0 {
        return Rms::Dark;
    }
    let value = q.value.max(0.0);
    if q.freedom < 1.0 {
        return Rms::Known(Estimate::exact(value.sqrt()));
    }
    let high = |t: f64| (value + t * q.std_err + q.hidden(t)).sqrt();
    let low = (q.value - t * q.std_err).max(0.0).sqrt();
    let std_err = high(1.0) - value.sqrt();
    Rms::Known(Estimate { value: value.sqrt(), std_err: Some(std_err), low, high: high(t) })
}

/// q with its first-order standard error and what a single noise direction may hide.
struct Ratio {
    value: f64,
    std_err: f64,
    denominator: f64,
    denominator_std_err: f64,
    freedom: f64,
    /// Variance of the mean, and of the mean within a set, along the strongest noise direction; relative.
    along: f64,
    along_set: f64,
}

impl Ratio {
    fn of(sets: &[Sums]) -> Self {
        let count = sets.len() as f64;
        let mean = |f: &dyn Fn(&Sums) -> f64| sets.iter().map(f).sum::<f64>() / count;
        let denominator = mean(&Sums::debiased_reference);
        let value = mean(&Sums::debiased_difference) / denominator;
        let q = value.max(0.0);
        let replicates: usize = sets.iter().map(|s| s.replicates).sum();
        // The quadratic part of <d, d> - q <Y, Y> is (1 - q) times the noise norm.
        let curvature = (1.0 - q).abs() / denominator;
        Self {
            value,
            std_err: (mean(&|s| s.variance(q)) / count).sqrt() / denominator,
            denominator,
            denominator_std_err: (mean(&|s| s.reference_variance()) / count).sqrt(),
            freedom: (replicates - sets.len()) as f64,
            along: curvature * mean(&|s| s.top_variance) / replicates as f64,
            along_set: curvature * mean(&|s| s.top_variance / s.replicates as f64),
        }
    }

    fn hidden(&self, t: f64) -> f64 {
        t * t * self.along + self.along_set
    }
}
