//! Shares of the area by value, in equal bins about 0.

use serde::{Deserialize, Serialize};

/// At most so many bins.
const MOST_BINS: f64 = 41.0;

/// Shares in equal bins; the middle bin is centred on 0. Bins and both ends add to 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// Lower edge of the first bin.
    pub first: f64,
    /// Width of a bin.
    pub width: f64,
    /// Share of the weight in each bin; a bin holds its lower edge.
    pub bins: Vec<f64>,
    /// Share below the first bin.
    pub below: f64,
    /// Share above the last bin.
    pub above: f64,
}

impl Histogram {
    /// Bins that reach from `-reach` to `reach` at least, their width a round number; all empty.
    pub(super) fn empty(reach: f64) -> Self {
        let width = round_up(2.0 * reach / MOST_BINS);
        let half = (reach / width - 0.5).ceil().max(1.0);
        let bins = vec![0.0; 2 * half as usize + 1];
        Self { first: -(half + 0.5) * width, width, bins, below: 0.0, above: 0.0 }
    }

    /// Shares of (value, weight) pairs.
    pub(super) fn fill(mut self, pairs: &[(f64, f64)]) -> Self {
        let total: f64 = pairs.iter().map(|(_, w)| w).sum();
        let half = (self.bins.len() / 2) as f64;
        for (x, weight) in pairs {
            let (share, bin) = (weight / total, (x / self.width + 0.5).floor() + half);
            if bin < 0.0 {
                self.below += share;
            } else if bin >= self.bins.len() as f64 {
                self.above += share;
            } else {
                self.bins[bin as usize] += share;
            }
        }
        self
    }

    /// Shares of a symmetric distribution, from its upper tail.
    pub(super) fn expect(mut self, upper_tail: impl Fn(f64) -> f64) -> Self {
        let (first, width) = (self.first, self.width);
        let edge = |k: usize| first + width * k as f64;
        // From the side of the smaller tail, which keeps its digits.
        let between =
            |a: f64, b: f64| if a >= 0.0 { upper_tail(a) - upper_tail(b) } else { upper_tail(-b) - upper_tail(-a) };
        self.bins.iter_mut().enumerate().for_each(|(k, share)| *share = between(edge(k), edge(k + 1)));
        self.below = upper_tail(-self.first);
        self.above = upper_tail(edge(self.bins.len()));
        self
    }

    /// Lower edges of all bins, and the upper edge of the last.
    pub fn edges(&self) -> Vec<f64> {
        (0..=self.bins.len()).map(|k| self.first + self.width * k as f64).collect()
    }
}

/// The next of 1, 2, 2.5, 5, 10 times a power of ten.
fn round_up(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let series = [1.0, 2.0, 2.5, 5.0, 10.0];
    power * series.into_iter().find(|m| x <= m * power * (1.0 + 1e-9)).unwrap_or(10.0)
}

/// What a share `p` of the weight does not exceed in absolute value; the largest where that is 0. `None` where all
/// are 0 or nothing weighs.
pub(super) fn reach(pairs: &[(f64, f64)], p: f64) -> Option<f64> {
    let mut sorted: Vec<(f64, f64)> = pairs.iter().map(|(x, w)| (x.abs(), *w)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = sorted.iter().map(|(_, w)| w).sum();
    let mut sum = 0.0;
    let within = sorted.iter().find(|(_, w)| {
        sum += w;
        sum >= p * total
    });
    let largest = sorted.last().map(|(x, _)| *x);
    within.map(|(x, _)| *x).filter(|x| *x > 0.0).or(largest).filter(|x| *x > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::t_upper_tail;

    #[test]
    fn values_fall_into_their_bins_by_weight() {
        let h = Histogram::empty(0.02).fill(&[(0.0, 1.0), (0.0004, 1.0), (0.00051, 2.0), (-0.0201, 3.0), (0.5, 1.0)]);
        // 41 bins of 0.001: the middle one from -0.0005 to 0.0005.
        assert_eq!((h.bins.len(), h.width), (41, 0.001));
        assert!((h.first + 0.0205).abs() < 1e-15);
        assert_eq!((h.bins[20], h.bins[21], h.bins[0]), (0.25, 0.25, 0.375));
        assert_eq!((h.below, h.above), (0.0, 0.125));
        let total: f64 = h.bins.iter().sum::<f64>() + h.below + h.above;
        assert!((total - 1.0).abs() < 1e-15);
    }

    #[test]
    fn what_is_expected_adds_to_one_and_has_known_middles() {
        let e = Histogram::empty(5.0).expect(|x| t_upper_tail(x, 15.0));
        let total: f64 = e.bins.iter().sum::<f64>() + e.below + e.above;
        assert!((total - 1.0).abs() < 1e-12, "{total}");
        assert_eq!((e.width, e.bins.len()), (0.25, 41));
        // 1 - 2 P(t15 > 0.125), and P(t15 > 5.125), of the definition by numerical integration of the density.
        let density = |x: f64| 0.392_354_947_169_063_4 * (1.0 + x * x / 15.0).powi(-8);
        let simpson = |a: f64, b: f64| (b - a) / 6.0 * (density(a) + 4.0 * density(0.5 * (a + b)) + density(b));
        assert!((e.bins[20] - simpson(-0.125, 0.125)).abs() < 1e-6, "{} {}", e.bins[20], simpson(-0.125, 0.125));
        assert!((e.bins[28] / simpson(1.875, 2.125) - 1.0).abs() < 1e-4);
        assert!((e.bins[12] / e.bins[28] - 1.0).abs() < 1e-9 && e.below == e.above);
    }

    #[test]
    fn the_range_is_round_and_wild_values_do_not_stretch_it() {
        let mut pairs = vec![(0.013, 1.0); 99];
        pairs.push((7.0, 1.0));
        assert_eq!(reach(&pairs, 0.98), Some(0.013));
        let h = Histogram::empty(0.013);
        assert_eq!((h.width, h.bins.len()), (0.001, 27));
        assert_eq!(reach(&[(0.0, 99.0), (-2.0, 1.0)], 0.98), Some(2.0));
        assert_eq!(reach(&[(0.0, 1.0)], 0.98), None);
        assert_eq!(reach(&[], 0.98), None);
    }
}
