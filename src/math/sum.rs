//! Compensated (Neumaier) summation: sums that do not depend on luck.

/// A running sum with the rounding it has lost so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Compensated {
    sum: f64,
    lost: f64,
}

impl Compensated {
    /// Adds one term.
    pub fn add(&mut self, x: f64) {
        let t = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - t) + x } else { (x - t) + self.sum };
        self.sum = t;
    }

    /// The sum of what was added.
    pub fn value(self) -> f64 {
        self.sum + self.lost
    }
}

/// Sums in the order given, compensated.
pub fn compensated_sum(terms: impl IntoIterator<Item = f64>) -> f64 {
    let mut s = Compensated::default();
    terms.into_iter().for_each(|x| s.add(x));
    s.value()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_is_not_lost() {
        assert_eq!(compensated_sum([1.0, 1e100, 1.0, -1e100]), 2.0);
    }
}
