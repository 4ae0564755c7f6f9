//! The entries of two matrices side by side, each with the errors it has to be weighed by.

use crate::solution::FormFactors;

/// One entry that at least one of the two states.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub row: usize,
    pub column: usize,
    pub theirs: f64,
    pub judge: f64,
    /// As stated.
    pub their_std_err: Option<f64>,
    pub judge_std_err: Option<f64>,
    /// At the size that the larger of the two says.
    pub their_variance: f64,
    pub judge_variance: f64,
}

impl Entry {
    pub fn difference(&self) -> f64 {
        self.theirs - self.judge
    }
}

/// All entries of the patches that take part, by row and column.
pub(super) fn entries(theirs: &FormFactors, judge: &FormFactors, areas: &[f64]) -> Vec<Entry> {
    let mut out = Vec::with_capacity(theirs.stored().max(judge.stored()));
    for row in (0..theirs.n).filter(|i| areas[*i] > 0.0) {
        let (a, b) = (Side::of(theirs, row), Side::of(judge, row));
        for column in united(a.columns(), b.columns()).filter(|j| areas[*j] > 0.0) {
            let ((x, ex), (y, ey)) = (a.get(column), b.get(column));
            let size = x.abs().max(y.abs());
            out.push(Entry {
                row,
                column,
                theirs: x,
                judge: y,
                their_std_err: ex,
                judge_std_err: ey,
                their_variance: a.variance(x, ex, size),
                judge_variance: b.variance(y, ey, size),
            });
        }
    }
    out
}

/// Two ascending lists in one, without repeats.
fn united<'a>(a: &'a [u32], b: &'a [u32]) -> impl Iterator<Item = usize> + 'a {
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    std::iter::from_fn(move || {
        let next = match (a.peek(), b.peek()) {
            (Some(x), Some(y)) => **x.min(y),
            (Some(x), None) | (None, Some(x)) => **x,
            (None, None) => return None,
        };
        a.next_if(|x| **x == next);
        b.next_if(|x| **x == next);
        Some(next as usize)
    })
}

/// A row of one matrix.
struct Side<'a> {
    f: &'a FormFactors,
    row: usize,
    /// Variance per unit of form factor that is typical of the row: 1 / N of a count of N rays.
    grain: f64,
}

impl<'a> Side<'a> {
    fn of(f: &'a FormFactors, row: usize) -> Self {
        let range = f.row_starts[row]..f.row_starts[row + 1];
        let grain = |k: usize| {
            let (value, std_err) = (f.values[k].abs(), f.std_err.as_ref()?[k]);
            (value > 0.0 && std_err > 0.0 && std_err.is_finite()).then(|| std_err * std_err / value)
        };
        let mut grains: Vec<f64> = range.filter_map(grain).collect();
        grains.sort_unstable_by(f64::total_cmp);
        Self { f, row, grain: grains.get(grains.len() / 2).copied().unwrap_or(0.0) }
    }

    fn columns(&self) -> &'a [u32] {
        &self.f.columns[self.f.row_starts[self.row]..self.f.row_starts[self.row + 1]]
    }

    /// Value, and standard error where one is stated.
    fn get(&self, column: usize) -> (f64, Option<f64>) {
        let stated = self.f.std_err_of(self.row, column);
        (self.f.get(self.row, column), stated.filter(|e| e.is_finite()))
    }

    /// The variance at a `size` that is at least the value. No error, or one of 0, has the typical grain of the row.
    fn variance(&self, value: f64, std_err: Option<f64>, size: f64) -> f64 {
        match std_err {
            Some(e) if e > 0.0 && value != 0.0 => e * e * (size / value.abs()),
            Some(e) if e > 0.0 => e * e,
            _ => self.grain * size,
        }
    }
}
