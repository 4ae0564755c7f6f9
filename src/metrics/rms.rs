//! Eq. 7 of GSG90 against a truth that is known through replicates only.

use super::sums::{Spread, Sums};
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

/// Value and interval from the sums over one or more sets of replicates that have none in common, each over its
/// own patches; numerators and denominators are averaged over the sets.
///
/// On the scale of q = value^2, with `s^2` the variance of the mean along the strongest direction of the noise:
/// - to first order q moves with the noise along the difference and along the reference, which every replicate
///   shows as two numbers: Student t for their ratio (Fieller). Where noise in many directions dominates, that
///   spread holds the second order twice over;
/// - noise in *one* direction (a brightness common to all patches) may cancel a difference along it: the difference
///   reads 0, and its spread with it. What can be hidden is bounded by the noise norm in that direction: q is at
///   most `(|D| + t s)^2 = (q + s^2) + 2 t s |D| + t^2 s^2`. Exact if there is no other noise, and small
///   against the first order away from zero;
/// - a q below zero, had by luck, never makes the interval shorter than q = 0 does.
pub(super) fn interval(sets: &[Sums], confidence: f64) -> Rms {
    let ratio = Ratio::of(sets);
    let t = two_sided_t(confidence, ratio.freedom);
    if ratio.freedom < 1.0 {
        return if ratio.denominator > 0.0 { Rms::Known(Estimate::exact(ratio.value.sqrt())) } else { Rms::Dark };
    }
    match (ratio.reach(t), ratio.reach(1.0)) {
        (Some(reach), Some(one)) => {
            let value = ratio.value.sqrt();
            Rms::Known(Estimate {
                value,
                std_err: Some(ratio.high(one, 1.0) - value),
                low: (ratio.value + reach.0).max(0.0).sqrt(),
                high: ratio.high(reach, t),
            })
        }
        _ => Rms::Dark,
    }
}

/// q with what its interval is made of.
struct Ratio {
    /// q, not below 0.
    value: f64,
    denominator: f64,
    spread: Spread,
    freedom: f64,
    /// Variance along the strongest noise direction relative to the denominator: of the mean over all replicates,
    /// and of the mean within a set.
    strongest: f64,
    strongest_in_set: f64,
}

impl Ratio {
    fn of(sets: &[Sums]) -> Self {
        let mean = |f: &dyn Fn(&Sums) -> f64| sets.iter().map(f).sum::<f64>() / sets.len() as f64;
        let denominator = mean(&Sums::debiased_reference);
        let value = (mean(&Sums::debiased_difference) / denominator).max(0.0);
        let replicates: usize = sets.iter().map(|s| s.replicates).sum();
        // The part of <D, D> - q <Y, Y> that is quadratic in the noise is (1 - q) times the noise norm.
        let curvature = (1.0 - value).abs() / denominator;
        Self {
            value,
            denominator,
            spread: Spread::of_mean(&sets.iter().map(|s| s.spread(value)).collect::<Vec<_>>()),
            freedom: (replicates - sets.len()) as f64,
            strongest: curvature * mean(&|s| s.top_variance / replicates as f64),
            strongest_in_set: curvature * mean(&|s| s.top_variance / s.replicates as f64),
        }
    }

    /// How far q may be below and above its value: the h for which <D, D> - (q + h) <Y, Y> is t standard errors
    /// from 0 (Fieller). `None` if the denominator is within t standard errors of 0.
    fn reach(&self, t: f64) -> Option<(f64, f64)> {
        let t2 = t * t;
        let a = self.denominator * self.denominator - t2 * self.spread.reference;
        if self.denominator <= 0.0 || a <= 0.0 {
            return None;
        }
        let b = t2 * self.spread.both;
        let root = (b * b + a * t2 * self.spread.residual).sqrt();
        Some(((-b - root) / a, (-b + root) / a))
    }

    fn high(&self, reach: (f64, f64), t: f64) -> f64 {
        (self.value + reach.1 + t * t * self.strongest + self.strongest_in_set).sqrt()
    }
}
