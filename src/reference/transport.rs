//! All leave-one-out matrices at once, without storing any of them.

use crate::estimate::{Entry, HitCounts};
use crate::solver::Transport;
use rayon::prelude::*;

/// The R matrices that leave out one randomisation each, side by side: with b bands of radiosity, "band"
/// `r * b + c` of a vector is band c as the matrix without randomisation r sees it.
pub(super) struct LeaveOneOut<'a> {
    pub counts: &'a HitCounts,
}

impl Transport for LeaveOneOut<'_> {
    fn len(&self) -> usize {
        self.counts.rows.len()
    }

    fn sources(&self) -> usize {
        self.counts.patches
    }

    fn apply(&self, x: &[f64], width: usize, y: &mut [f64]) {
        let bands = width / usize::from(self.counts.randomisations);
        let rays = (f64::from(self.counts.randomisations) - 1.0) * self.counts.rays as f64;
        y.par_chunks_mut(width).enumerate().for_each(|(i, out)| {
            out.fill(0.0);
            for (j, run) in self.counts.by_patch(i) {
                gather(run, &x[j * width..(j + 1) * width], bands, out);
            }
            out.iter_mut().for_each(|v| *v /= rays);
        });
    }
}

/// Adds `(total - count of r) x` for every randomisation r.
fn gather(run: &[Entry], x: &[f64], bands: usize, out: &mut [f64]) {
    let total = run.iter().map(|e| e.count()).sum::<u64>() as f64;
    out.iter_mut().zip(x).for_each(|(o, x)| *o += total * x);
    for e in run {
        let (first, count) = (e.randomisation() * bands, e.count() as f64);
        for c in first..first + bands {
            out[c] -= count * x[c];
        }
    }
}

/// The single-randomisation rows: `y[i][r * b + c] = sum_j F^r_ij x[j][r * b + c]`. Receivers may be elements.
pub(super) fn gather_each(counts: &HitCounts, x: &[f64], bands: usize) -> Vec<f64> {
    let width = usize::from(counts.randomisations) * bands;
    let mut y = vec![0.0; counts.rows.len() * width];
    y.par_chunks_mut(width).zip(&counts.rows).for_each(|(out, row)| {
        for e in row {
            let first = e.randomisation() * bands;
            let source = &x[e.patch() * width..];
            for c in first..first + bands {
                out[c] += e.count() as f64 * source[c];
            }
        }
        out.iter_mut().for_each(|v| *v /= counts.rays as f64);
    });
    y
}

/// Each receiver's values repeated for every randomisation.
pub(super) fn repeated(values: &[f64], bands: usize, randomisations: u16) -> Vec<f64> {
    values.chunks(bands).flat_map(|v| std::iter::repeat_n(v, usize::from(randomisations)).flatten().copied()).collect()
}
