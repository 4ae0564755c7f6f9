//! The interval of one form factor from the hit counts of its replicates.

use super::Estimate;
use super::intervals::{binomial_interval, mean_interval};

/// Below so many hits (or misses) in all, a Student t interval alone is not to be trusted.
pub const FEW_HITS: u64 = 50;

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
    if total < FEW_HITS || all - total < FEW_HITS {
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
