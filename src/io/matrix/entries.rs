//! Entries that were read, checked and sorted into rows.

use crate::io::FileError;
use crate::solution::FormFactors;
use std::path::Path;

/// Row, column, form factor, standard error (NaN where unknown).
pub(super) type Triplet = (usize, usize, f64, f64);

/// What a file holds.
pub(super) struct Entries {
    pub list: Vec<Triplet>,
    /// True if every entry has a standard error.
    pub has_errors: bool,
}

impl Entries {
    /// Entries of a format without standard errors.
    pub(super) fn exact(list: Vec<Triplet>) -> Self {
        Self { list, has_errors: false }
    }
}

/// True for 0, 1, 2, ...
pub(super) fn is_index(x: f64) -> bool {
    x >= 0.0 && x.fract() == 0.0
}

/// A file that is read as an N x N matrix.
pub(super) struct Reader<'a> {
    pub path: &'a Path,
    pub n: usize,
}

impl Reader<'_> {
    pub(super) fn wrong(&self, problem: impl Into<String>) -> FileError {
        FileError::new(self.path, problem)
    }

    pub(super) fn check_shape(&self, rows: f64, columns: f64) -> Result<(), FileError> {
        let n = self.n as f64;
        if rows == n && columns == n {
            return Ok(());
        }
        Err(self
            .wrong(format!("is {rows} x {columns}, but the scene has {} patches", self.n))
            .mend("was it computed for another scene, state or --max-edge?"))
    }

    /// The text of a file that has to be text.
    pub(super) fn text<'b>(&self, bytes: &'b [u8]) -> Result<&'b str, FileError> {
        std::str::from_utf8(bytes).map_err(|e| {
            let line = bytes[..e.valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
            self.wrong("is not text").at(format!("line {line}")).mend("save it as plain text")
        })
    }

    /// Sorts entries into rows and checks each.
    pub(super) fn build(&self, entries: Entries) -> Result<FormFactors, FileError> {
        let mut rows = vec![Vec::new(); self.n];
        for (i, j, f, se) in entries.list {
            let entry = format!("entry ({i}, {j})");
            if i >= self.n || j >= self.n {
                return Err(self
                    .wrong(format!("lies outside a {0} x {0} matrix", self.n))
                    .at(entry)
                    .mend("is it the matrix of another scene? numbers count from 0 in .csv and .npz, from 1 in .mtx"));
            }
            if !f.is_finite() || f < 0.0 {
                return Err(self.wrong(format!("form factor {f} is not a number >= 0")).at(entry));
            }
            if se < 0.0 {
                return Err(self.wrong(format!("standard error {se} is below 0")).at(entry));
            }
            if f != 0.0 {
                rows[i].push((j as u32, f, se));
            }
        }
        for (i, row) in rows.iter_mut().enumerate() {
            row.sort_unstable_by_key(|e| e.0);
            if let Some(w) = row.windows(2).find(|w| w[0].0 == w[1].0) {
                return Err(self
                    .wrong("stands twice")
                    .at(format!("entry ({i}, {})", w[0].0))
                    .mend("give each pair once: add the parts up, or drop one"));
            }
        }
        let mut f = FormFactors::from_rows(rows);
        if !entries.has_errors {
            f.std_err = None;
        }
        Ok(f)
    }
}
