//! Intervals of a mean, of a function of replicates, and of a probability.

use super::distributions::two_sided_t;
use super::{Estimate, Moments};
use statrs::distribution::{Beta, ContinuousCDF};

/// Mean of independent replicates with its Student t interval. A single replicate knows nothing of its error:
/// the interval is infinite.
pub fn mean_interval(replicates: &[f64], confidence: f64) -> Estimate {
    let m: Moments = replicates.iter().copied().collect();
    around(m.mean, m.std_err(), confidence, replicates.len())
}

/// Pseudo-values `R f - (R - 1) f_(-r)` of a statistic `f` of R replicates, from its value and its values with
/// one replicate left out. Their mean is f without its bias of order 1/R, their spread its error.
pub fn pseudo_values(full: f64, left_out: &[f64]) -> Vec<f64> {
    let r = left_out.len() as f64;
    left_out.iter().map(|f| r * full - (r - 1.0) * f).collect()
}

/// The statistic `full` with the Student t interval of its pseudo-values, centred on `full` itself.
pub fn jackknife_interval(full: f64, left_out: &[f64], confidence: f64) -> Estimate {
    let m: Moments = pseudo_values(full, left_out).into_iter().collect();
    around(full, m.std_err(), confidence, left_out.len())
}

fn around(value: f64, std_err: Option<f64>, confidence: f64, count: usize) -> Estimate {
    let half = std_err.map_or(f64::INFINITY, |se| two_sided_t(confidence, count as f64 - 1.0) * se);
    Estimate { value, std_err, low: value - half, high: value + half }
}

/// Exact (Clopper-Pearson) two-sided interval of the probability behind `hits` in `trials` independent trials.
/// The whole of [0, 1] for no trials.
pub fn binomial_interval(hits: u64, trials: u64, confidence: f64) -> (f64, f64) {
    if trials == 0 {
        return (0.0, 1.0);
    }
    let tail = 0.5 * (1.0 - confidence);
    let misses = trials - hits.min(trials);
    // Upper end for `k` hits as one minus the lower end for the misses: the small side keeps its digits.
    let low = lower_bound(hits, misses, tail);
    let high = upper_bound(hits, misses, tail);
    (low, high)
}

/// p with P(X >= hits | p) = tail.
fn lower_bound(hits: u64, misses: u64, tail: f64) -> f64 {
    if hits == 0 {
        return 0.0;
    }
    if misses == 0 {
        return (tail.ln() / hits as f64).exp();
    }
    beta_quantile(hits as f64, misses as f64 + 1.0, tail)
}

/// p with P(X <= hits | p) = tail.
fn upper_bound(hits: u64, misses: u64, tail: f64) -> f64 {
    if misses == 0 {
        return 1.0;
    }
    if hits == 0 {
        return -(tail.ln() / misses as f64).exp_m1();
    }
    beta_quantile(hits as f64 + 1.0, misses as f64, 1.0 - tail)
}

fn beta_quantile(a: f64, b: f64, p: f64) -> f64 {
    Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(p))
}
