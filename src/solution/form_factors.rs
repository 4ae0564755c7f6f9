//! A sparse form-factor matrix with its standard errors.

/// `F[i][j]`: the fraction of what leaves patch i that reaches patch j. Compressed rows; zero entries not stored.
#[derive(Debug, Clone, PartialEq)]
pub struct FormFactors {
    /// Rows and columns.
    pub n: usize,
    /// Row i holds entries `row_starts[i] .. row_starts[i + 1]`.
    pub row_starts: Vec<usize>,
    /// Column of each entry, ascending within a row.
    pub columns: Vec<u32>,
    /// Form factor of each entry.
    pub values: Vec<f64>,
    /// Standard error of each entry; `None` where nobody knows it.
    pub std_err: Option<Vec<f64>>,
}

impl FormFactors {
    /// Builds the matrix from rows of (column, form factor, standard error).
    pub fn from_rows(rows: Vec<Vec<(u32, f64, f64)>>) -> Self {
        let mut f = Self::empty(rows.len());
        let mut errors = Vec::new();
        for row in rows {
            for (j, value, se) in row {
                f.columns.push(j);
                f.values.push(value);
                errors.push(se);
            }
            f.row_starts.push(f.columns.len());
        }
        f.std_err = Some(errors);
        f
    }

    /// Builds the matrix from rows of (column, form factor), standard errors unknown.
    pub fn from_exact_rows(rows: Vec<Vec<(u32, f64)>>) -> Self {
        let mut f = Self::empty(rows.len());
        for row in rows {
            for (j, value) in row {
                f.columns.push(j);
                f.values.push(value);
            }
            f.row_starts.push(f.columns.len());
        }
        f
    }

    fn empty(n: usize) -> Self {
        Self { n, row_starts: vec![0], columns: Vec::new(), values: Vec::new(), std_err: None }
    }

    /// Number of stored entries.
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// (column, form factor) of the stored entries of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.row_starts[i]..self.row_starts[i + 1];
        self.columns[range.clone()].iter().zip(&self.values[range]).map(|(j, v)| (*j as usize, *v))
    }

    /// Index of an entry among the stored ones.
    fn find(&self, i: usize, j: usize) -> Option<usize> {
        let range = self.row_starts[i]..self.row_starts[i + 1];
        self.columns[range.clone()].binary_search(&(j as u32)).ok().map(|k| k + range.start)
    }

    /// True if the pair is stored.
    pub fn holds(&self, i: usize, j: usize) -> bool {
        self.find(i, j).is_some()
    }

    /// Form factor of a pair; 0 where none is stored.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.find(i, j).map_or(0.0, |k| self.values[k])
    }

    /// Standard error of a stored pair; `None` where it is unknown or the pair was never hit.
    pub fn std_err_of(&self, i: usize, j: usize) -> Option<f64> {
        Some(self.std_err.as_ref()?[self.find(i, j)?])
    }

    /// Sum of a row.
    pub fn row_sum(&self, i: usize) -> f64 {
        crate::math::compensated_sum(self.row(i).map(|(_, v)| v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_found_and_missing_is_not_zero() {
        let f = FormFactors::from_rows(vec![vec![(1, 0.25, 0.01), (2, 0.75, 0.02)], vec![], vec![(0, 1.0, 0.0)]]);
        assert_eq!((f.get(0, 2), f.get(0, 0), f.get(1, 1)), (0.75, 0.0, 0.0));
        assert_eq!((f.std_err_of(0, 1), f.std_err_of(0, 0)), (Some(0.01), None));
        assert_eq!((f.row_sum(0), f.row_sum(1), f.stored()), (1.0, 0.0, 3));
    }
}
