//! Differences against the noise of the reference: which of them are evidence of an error.

use super::histogram::{Histogram, reach};
use crate::stats::{sidak_level, t_upper_tail, two_sided_t};
use serde::{Deserialize, Serialize};

/// A standard error below this share of the luminance is the rounding of a solver, not noise.
const ROUNDING: f64 = 1e-9;
/// A difference below this share of the luminance is the rounding of single precision, not an error.
const EQUAL: f64 = 1e-6;
/// The histogram reaches as far as the bulk of the area, but within these: chance shows at the one end, a bias that
/// dwarfs the noise does not flatten everything at the other.
const REACH: (f64, f64) = (5.0, 20.0);
/// The bulk of the area.
const BULK: f64 = 0.98;

/// Differences in standard errors, held against what chance alone would bring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NoiseTest {
    /// Degrees of freedom of Student's t: replicates less one.
    pub freedom: f64,
    /// Receivers whose difference can be tested: present, and with a standard error.
    pub tested: usize,
    /// Present receivers that the reference knows without noise and the solution has right.
    pub exact_and_equal: usize,
    /// Present receivers that the reference knows without noise and the solution has otherwise: errors for sure.
    pub exact_and_different: usize,
    /// Tested area by difference in standard errors.
    pub shares: Histogram,
    /// The same for differences that are nothing but noise.
    pub expected: Histogram,
    /// Beyond what one test allows.
    pub single: Beyond,
    /// Beyond what all tests together allow (Sidak).
    pub family: Beyond,
    /// Difference in standard errors of both sides, per receiver; 0 where the reference has no noise and the solution
    /// is right, `None` where it is wrong or absent.
    pub scores: Vec<Option<f64>>,
}

/// How many receivers lie beyond a threshold.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Beyond {
    /// Two-sided threshold in standard errors.
    pub threshold: f64,
    /// Receivers beyond it.
    pub count: usize,
    /// How many chance alone would bring, on average.
    pub expected: f64,
}

/// What is known of one receiver.
#[derive(Debug, Clone, Copy)]
pub(super) struct Against {
    pub area: f64,
    pub reference: f64,
    pub difference: f64,
    /// Standard errors of reference and solution.
    pub std_err: f64,
    pub own_std_err: f64,
}

enum Score {
    Tested(f64),
    Equal,
    Different,
}

impl Against {
    fn score(&self) -> Score {
        let error = self.std_err.hypot(self.own_std_err);
        if error > ROUNDING * self.reference.abs() {
            Score::Tested(self.difference / error)
        } else if self.difference.abs() <= EQUAL * self.reference.abs() {
            Score::Equal
        } else {
            Score::Different
        }
    }
}

/// Tests every receiver of `all` (absent ones are `None`) at a two-sided `level`.
pub(super) fn noise_test(all: &[Option<Against>], freedom: f64, level: f64) -> NoiseTest {
    let (mut equal, mut different, mut pairs) = (0, 0, Vec::new());
    let score = |a: &Option<Against>| match a.as_ref()?.score() {
        Score::Tested(t) => {
            pairs.push((t, a.as_ref()?.area));
            Some(t)
        }
        Score::Equal => {
            equal += 1;
            Some(0.0)
        }
        Score::Different => {
            different += 1;
            None
        }
    };
    let scores: Vec<Option<f64>> = all.iter().map(score).collect();
    let axis = Histogram::empty(reach(&pairs, BULK).unwrap_or(0.0).clamp(REACH.0, REACH.1));
    NoiseTest {
        freedom,
        tested: pairs.len(),
        exact_and_equal: equal,
        exact_and_different: different,
        shares: axis.clone().fill(&pairs),
        expected: axis.expect(|x| t_upper_tail(x, freedom)),
        single: beyond(&pairs, freedom, level),
        family: beyond(&pairs, freedom, sidak_level(level, pairs.len())),
        scores,
    }
}

fn beyond(pairs: &[(f64, f64)], freedom: f64, level: f64) -> Beyond {
    let threshold = two_sided_t(1.0 - level, freedom);
    let count = pairs.iter().filter(|(t, _)| t.abs() > threshold).count();
    Beyond { threshold, count, expected: level * pairs.len() as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Moments;
    use crate::stats::test_random::Random;

    fn against(difference: f64, std_err: f64) -> Option<Against> {
        Some(Against { area: 1.0, reference: 2.0, difference, std_err, own_std_err: 0.0 })
    }

    #[test]
    fn what_has_no_noise_is_counted_apart() {
        let own = Against { own_std_err: 0.04, ..against(0.1, 0.03).expect("some") };
        let all = [against(0.1, 0.05), None, against(1e-15, 1e-16), against(0.1, 0.0), against(-0.3, 0.01), Some(own)];
        let t = noise_test(&all, 15.0, 0.05);
        assert_eq!((t.tested, t.exact_and_equal, t.exact_and_different), (3, 1, 1));
        let scores: Vec<Option<f64>> = t.scores.iter().map(|s| s.map(|s| s.round())).collect();
        assert_eq!(scores, [Some(2.0), None, Some(0.0), None, Some(-30.0), Some(2.0)]);
        assert!((t.shares.below - 1.0 / 3.0).abs() < 1e-15 && t.shares.above == 0.0);
        // Thresholds of t with 15 degrees: 2.1314 alone; for three tests the level is 0.016952.
        assert!((t.single.threshold - 2.13144954555978).abs() < 1e-9);
        assert_eq!((t.single.count, t.family.count), (1, 1));
        assert!((t.single.expected - 0.15).abs() < 1e-12);
        assert!((t.family.expected - 3.0 * 0.016_952_427_508_441_4).abs() < 1e-9, "{}", t.family.expected);
    }

    /// An exact solution before 400 references of 500 patches: as many beyond as promised, and the histogram is t's.
    #[test]
    fn noise_alone_looks_like_noise() {
        let mut random = Random(11);
        let (mut single, mut family, mut middle, mut expected) = (0, 0, 0.0, 0.0);
        for _ in 0..400 {
            let patch = |random: &mut Random| {
                let m: Moments = (0..16).map(|_| 1.0 + 0.01 * random.normal()).collect();
                let std_err = m.std_err().expect("sixteen");
                Some(Against { area: 1.0, reference: m.mean, difference: 1.0 - m.mean, std_err, own_std_err: 0.0 })
            };
            let all: Vec<_> = (0..500).map(|_| patch(&mut random)).collect();
            let t = noise_test(&all, 15.0, 0.05);
            single += t.single.count;
            family += usize::from(t.family.count > 0);
            let half = t.shares.bins.len() / 2;
            middle += t.shares.bins[half - 4..=half + 4].iter().sum::<f64>() / 400.0;
            expected = t.expected.bins[half - 4..=half + 4].iter().sum::<f64>();
        }
        // 10,000 expected, sd 97; 20 of 400 families, sd 4.4; the share within 1.125, sd 0.001.
        assert!((9600..10_400).contains(&single), "{single}");
        assert!((6..36).contains(&family), "{family}");
        assert!((middle - expected).abs() < 0.005, "{middle} {expected}");
    }
}
