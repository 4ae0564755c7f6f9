//! Count, mean and squared deviations: mergeable.

use serde::{Deserialize, Serialize};

/// Count, mean and sum of squared deviations of what was pushed; two of them merge into that of the union.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Moments {
    /// Number of values.
    pub count: u64,
    /// Their mean; 0 before the first.
    pub mean: f64,
    /// Sum of squared deviations from the mean.
    pub squares: f64,
}

impl Moments {
    /// Takes in one value.
    pub fn push(&mut self, x: f64) {
        self.count += 1;
        let before = x - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (x - self.mean);
    }

    /// Takes in everything the other has seen.
    pub fn merge(&mut self, other: &Moments) {
        if other.count == 0 {
            return;
        }
        let (n, m) = (self.count as f64, other.count as f64);
        let apart = other.mean - self.mean;
        self.count += other.count;
        self.mean += apart * m / (n + m);
        self.squares += other.squares + apart * apart * n * m / (n + m);
    }

    /// Variance of one value (divided by count - 1); `None` below two values.
    pub fn variance(&self) -> Option<f64> {
        (self.count > 1).then(|| self.squares / (self.count - 1) as f64)
    }

    /// Standard error of the mean; `None` below two values.
    pub fn std_err(&self) -> Option<f64> {
        self.variance().map(|v| (v / self.count as f64).sqrt())
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut m = Moments::default();
        values.into_iter().for_each(|x| m.push(x));
        m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_mean_and_variance() {
        // 2, 4, 4, 4, 5, 5, 7, 9: mean 5, squared deviations 32.
        let m: Moments = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().collect();
        assert_eq!((m.count, m.mean), (8, 5.0));
        assert!((m.variance().unwrap() - 32.0 / 7.0).abs() < 1e-14);
        assert!((m.std_err().unwrap() - (32.0f64 / 56.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn nothing_is_known_of_one_value() {
        assert_eq!(Moments::from_iter([3.0]).variance(), None);
        assert_eq!(Moments::default().std_err(), None);
    }

    #[test]
    fn a_large_offset_does_not_drown_the_spread() {
        let m: Moments = [1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0].into_iter().collect();
        assert_eq!(m.variance(), Some(30.0));
    }

    proptest! {
        #[test]
        fn merging_is_pushing(values in prop::collection::vec(-1e3..1e3f64, 0..40), cut in 0usize..40) {
            let cut = cut.min(values.len());
            let mut left: Moments = values[..cut].iter().copied().collect();
            left.merge(&values[cut..].iter().copied().collect());
            let all: Moments = values.iter().copied().collect();
            prop_assert_eq!(left.count, all.count);
            prop_assert!((left.mean - all.mean).abs() < 1e-10);
            prop_assert!((left.squares - all.squares).abs() < 1e-6);
        }
    }
}
