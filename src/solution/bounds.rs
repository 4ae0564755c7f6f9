//! Form factors that are known between bounds: data only.

use super::FormFactors;

/// What is known for sure, or at a stated confidence, of a form-factor matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct FormFactorBounds {
    /// Lower bounds; pairs that are not stored are at least 0.
    pub low: FormFactors,
    /// Upper bounds of the stored pairs, in the order of `low.values`.
    pub high: Vec<f64>,
    /// Upper bound of each pair of a row that is not stored, one per row; patches do not see themselves.
    pub unseen: Vec<f64>,
    /// Every row sums to at least this: 1 in an enclosure, 0 where light may leave.
    pub least_row_sum: f64,
    /// Every row sums to at most this: 1.
    pub most_row_sum: f64,
}

impl FormFactorBounds {
    /// (column, lower, upper) of the stored pairs of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let start = self.low.row_starts[i];
        self.low.row(i).zip(&self.high[start..]).map(|((j, low), high)| (j, low, *high))
    }
}
