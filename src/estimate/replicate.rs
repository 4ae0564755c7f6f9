//! The matrices of single randomisations, and of all but one, applied side by side without being stored.
//!
//! With b bands and R randomisations a vector has `R b` values per receiver: value `r * b + c` is band c as
//! matrix r sees it.

use super::{Entry, HitCounts};
use rayon::prelude::*;

impl HitCounts {
    /// `y = F x` with, for each r, the matrix that leaves out randomisation r. `width` is R times bands.
    pub fn apply_leave_one_out(&self, x: &[f64], width: usize, y: &mut [f64]) {
        let bands = width / usize::from(self.randomisations);
        let rays = (f64::from(self.randomisations) - 1.0) * self.rays as f64;
        y.par_chunks_mut(width).enumerate().for_each(|(i, out)| {
            out.fill(0.0);
            for (j, run) in self.by_patch(i) {
                gather_all_but_one(run, &x[j * width..(j + 1) * width], bands, out);
            }
            out.iter_mut().for_each(|v| *v /= rays);
        });
    }

    /// `F x` with, for each r, the matrix of randomisation r alone. Receivers may be elements.
    pub fn apply_each(&self, x: &[f64], bands: usize) -> Vec<f64> {
        let width = usize::from(self.randomisations) * bands;
        let mut y = vec![0.0; self.rows.len() * width];
        y.par_chunks_mut(width).zip(&self.rows).for_each(|(out, row)| {
            for e in row {
                let first = e.randomisation() * bands;
                let source = &x[e.patch() * width..];
                for c in first..first + bands {
                    out[c] += e.count() as f64 * source[c];
                }
            }
            out.iter_mut().for_each(|v| *v /= self.rays as f64);
        });
        y
    }

    /// Each receiver's values repeated for every randomisation.
    pub fn repeated(&self, values: &[f64], bands: usize) -> Vec<f64> {
        let times = usize::from(self.randomisations);
        values.chunks(bands).flat_map(|v| std::iter::repeat_n(v, times).flatten().copied()).collect()
    }
}

/// Adds `(total - count of r) x` for every randomisation r.
fn gather_all_but_one(run: &[Entry], x: &[f64], bands: usize, out: &mut [f64]) {
    let total = run.iter().map(|e| e.count()).sum::<u64>() as f64;
    out.iter_mut().zip(x).for_each(|(o, x)| *o += total * x);
    for e in run {
        let (first, count) = (e.randomisation() * bands, e.count() as f64);
        for c in first..first + bands {
            out[c] -= count * x[c];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaving_out_and_alone_by_hand() {
        // One receiver, two sources, R = 2, 4 rays each: F^0 = (1/4, 0), F^1 = (2/4, 1/4).
        let mut c = HitCounts::empty(2, 2, vec![true]);
        c.rays = 4;
        c.rows[0] = vec![Entry::new(0, 0, 1), Entry::new(0, 1, 2), Entry::new(1, 1, 1)];
        let x = c.repeated(&[8.0, 4.0], 1);
        assert_eq!(x, [8.0, 8.0, 4.0, 4.0]);
        assert_eq!(c.apply_each(&x, 1), [2.0, 5.0]);
        let mut y = [0.0; 2];
        c.apply_leave_one_out(&x, 2, &mut y);
        assert_eq!(y, [5.0, 2.0]);
    }
}
