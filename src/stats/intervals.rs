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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    fn close(got: f64, known: f64) {
        assert!((got / known - 1.0).abs() < 1e-7, "{got:e} is not {known:e}");
    }

    #[test]
    fn mean_of_a_textbook_sample() {
        // Mean 5, sd sqrt(32/7), n = 8, t(0.975, 7) = 2.36462.
        let e = mean_interval(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0], 0.95);
        close(e.value, 5.0);
        close(e.std_err.unwrap(), (32.0f64 / 56.0).sqrt());
        close(e.high - e.value, 2.36462425159279 * (32.0f64 / 56.0).sqrt());
        close(e.value - e.low, e.high - e.value);
    }

    #[test]
    fn one_replicate_says_nothing_of_its_error() {
        let e = mean_interval(&[3.0], 0.95);
        assert_eq!((e.value, e.std_err, e.low, e.high), (3.0, None, f64::NEG_INFINITY, f64::INFINITY));
    }

    #[test]
    fn the_jackknife_of_a_mean_is_the_mean_and_of_the_plug_in_variance_the_unbiased_one() {
        let x = [1.0, 4.0, 6.0, 13.0];
        let n = x.len() as f64;
        let without = |f: &dyn Fn(&[f64]) -> f64| -> Vec<f64> {
            (0..x.len()).map(|k| f(&[&x[..k], &x[k + 1..]].concat())).collect()
        };
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        assert_eq!(jackknife_interval(mean(&x), &without(&mean), 0.95), mean_interval(&x, 0.95));
        let plug_in = |v: &[f64]| v.iter().map(|a| (a - mean(v)).powi(2)).sum::<f64>() / v.len() as f64;
        close(mean(&pseudo_values(plug_in(&x), &without(&plug_in))), plug_in(&x) * n / (n - 1.0));
    }

    /// Digits from sums of binomial terms in 40-digit arithmetic; 5 of 20 is the textbook's (0.0866, 0.4910).
    #[test]
    fn known_binomial_intervals() {
        let known = [
            (5, 20, 0.95, 0.0865714691014345, 0.491045871707958),
            (1, 65536, 0.95, 3.86319016935947e-07, 8.50135660124633e-05),
            (45, 2097152, 0.9993, 1.22460275131892e-05, 3.45879195243276e-05),
            (3, 1048576, 0.99999999, 2.96559507243525e-09, 2.60930982878405e-05),
            (19, 20, 0.95, 0.751267237227972, 0.99873491050205),
        ];
        for (hits, trials, confidence, low, high) in known {
            let (l, h) = binomial_interval(hits, trials, confidence);
            close(l, low);
            close(h, high);
        }
        let (l, h) = binomial_interval(0, 65536, 0.95);
        assert_eq!(l, 0.0);
        close(h, 5.6286249336939e-05);
        let (l, h) = binomial_interval(20, 20, 0.95);
        close(l, 0.831566529016915);
        assert_eq!(h, 1.0);
        assert_eq!(binomial_interval(0, 0, 0.95), (0.0, 1.0));
    }

    /// t intervals miss a normal mean in 5 % of cases, each side alike.
    #[test]
    fn t_intervals_cover_as_they_say() {
        let mut random = Random(1);
        for r in [8, 16, 32] {
            let (mut above, mut below) = (0, 0);
            for _ in 0..10_000 {
                let x: Vec<f64> = (0..r).map(|_| 3.0 + random.normal()).collect();
                let e = mean_interval(&x, 0.95);
                above += usize::from(e.low > 3.0);
                below += usize::from(e.high < 3.0);
            }
            // 250 expected, sd 16.
            assert!((200..300).contains(&above) && (200..300).contains(&below), "R {r}: {above} {below}");
        }
    }
}
