//! The interval of one form factor from the hit counts of its replicates.

use super::Estimate;
use super::distributions::normal_quantile;
use super::intervals::{binomial_interval, mean_interval};

/// Below so many hits (or misses) in all, a Student t interval alone is not to be trusted at 95 %.
pub const FEW_HITS: u64 = 50;

/// The same at any confidence: counts are skewed, and further out in the tails it takes more of them to look normal.
/// Measured on independent rays: 50 at every confidence lets 99.93 % intervals miss 0.12 % at 100 hits.
fn few_hits(confidence: f64) -> u64 {
    let z = normal_quantile(0.5 * (1.0 - confidence)).min(1e3);
    (FEW_HITS as f64 * (z / 1.96).powi(2).max(1.0)) as u64
}

/// Interval of one form factor from `hits[r]` of `rays` rays in each of R independent randomisations.
///
/// Student t over the replicates. The points of one replicate are not independent, so the spread between
/// replicates is the only honest error; but with few hits it lies (a pair hit once in all has hardly a spread),
/// and the hull with the exact count interval is taken: that one holds for independent rays, and points spread
/// more evenly than independent ones scatter less. With few misses likewise.
///
/// `at_most`: a known upper bound (the closed form without occlusion). It cuts the interval, not the value: the
/// value of a pair that is all but unoccluded may lie above it by chance. A pair never hit has value 0, no
/// standard error, and an interval from 0 to the smaller of count bound and `at_most`.
pub fn form_factor_interval(hits: &[u64], rays: u64, confidence: f64, at_most: Option<f64>) -> Estimate {
    let (total, all) = (hits.iter().sum::<u64>(), rays * hits.len() as u64);
    let shares: Vec<f64> = hits.iter().map(|h| *h as f64 / rays as f64).collect();
    let mut e = mean_interval(&shares, confidence);
    e.value = total as f64 / all as f64;
    let few = few_hits(confidence);
    if total < few || all - total < few {
        let (low, high) = binomial_interval(total, all, confidence);
        e.low = e.low.min(low);
        e.high = e.high.max(high);
    }
    if total == 0 || total == all {
        e.std_err = None;
    }
    e.high = e.high.min(at_most.unwrap_or(1.0)).clamp(0.0, 1.0);
    e.low = e.low.clamp(0.0, e.high);
    e
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    #[test]
    fn by_hand() {
        // Shares 0.2, 0.4, 0.3, 0.3: mean 0.3, se sqrt(0.02 / 12), t(0.975, 3) = 3.18245.
        let e = form_factor_interval(&[200, 400, 300, 300], 1000, 0.95, None);
        let se = (0.02f64 / 12.0).sqrt();
        assert!((e.value - 0.3).abs() < 1e-15 && (e.std_err.unwrap() - se).abs() < 1e-15);
        assert!((e.high - 0.3 - 3.18244630528426 * se).abs() < 1e-9);
        assert!((0.3 - e.low - 3.18244630528426 * se).abs() < 1e-9);
    }

    #[test]
    fn never_hit_is_not_zero() {
        let e = form_factor_interval(&[0; 16], 4096, 0.95, None);
        assert_eq!((e.value, e.std_err, e.low), (0.0, None, 0.0));
        assert!((e.high - 5.6286249336939e-05).abs() < 1e-15, "{e:?}");
        assert_eq!(form_factor_interval(&[0; 16], 4096, 0.95, Some(1e-7)).high, 1e-7);
        assert_eq!(form_factor_interval(&[0; 16], 4096, 0.95, Some(0.1)).high, e.high);
    }

    #[test]
    fn always_hit_is_not_certain() {
        let e = form_factor_interval(&[64; 8], 64, 0.95, None);
        assert_eq!((e.value, e.std_err, e.high), (1.0, None, 1.0));
        assert!(e.low < 1.0 && e.low > 0.99);
    }

    #[test]
    fn hits_spread_alike_do_not_fool_it() {
        // One hit in each replicate: no spread at all, and still not certain.
        let e = form_factor_interval(&[1; 16], 4096, 0.95, None);
        assert!(e.low < 0.6 * e.value && e.high > 1.6 * e.value, "{e:?}");
    }

    #[test]
    fn an_upper_bound_cuts_the_interval_only() {
        let e = form_factor_interval(&[200, 400, 300, 300], 1000, 0.95, Some(0.25));
        assert_eq!((e.value, e.high), (0.3, 0.25));
        assert!(e.low < 0.25);
    }

    /// Independent rays: no expected count is missed more often than 1 - confidence plus four deviations; t alone
    /// misses 60 % at half an expected hit.
    #[test]
    fn coverage_from_half_a_hit_to_hundreds() {
        for (confidence, trials) in [(0.95, 2000), (0.9993, 8000)] {
            let allowed = 1.0 - confidence;
            let bound = allowed + 4.0 * (allowed * confidence / f64::from(trials)).sqrt();
            for replicates in [8, 16, 32] {
                for expected in [0.5, 2.0, 10.0, 45.0, 60.0, 100.0, 300.0] {
                    let missed = missed(replicates, expected, confidence, trials);
                    println!(
                        "{confidence}, R {replicates:2}, {expected:5} hits expected: missed, t alone {missed:.5?}"
                    );
                    assert!(missed[0] <= bound, "{confidence} {replicates} {expected} {missed:?}");
                }
            }
        }
    }

    /// Shares of intervals that miss the truth: ours, and Student t alone.
    fn missed(replicates: u64, expected: f64, confidence: f64, trials: u32) -> [f64; 2] {
        let rays = 1024;
        let f = expected / (rays * replicates) as f64;
        let mut random = Random(2);
        let mut missed = [0.0; 2];
        for _ in 0..trials {
            let hits: Vec<u64> = (0..replicates).map(|_| random.binomial(rays, f)).collect();
            let shares: Vec<f64> = hits.iter().map(|h| *h as f64 / rays as f64).collect();
            let intervals = [form_factor_interval(&hits, rays, confidence, None), mean_interval(&shares, confidence)];
            for (m, e) in missed.iter_mut().zip(intervals) {
                *m += f64::from(u8::from(f < e.low || f > e.high)) / f64::from(trials);
            }
        }
        missed
    }
}
