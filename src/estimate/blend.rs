//! One matrix from two sources: pairs settled without rays, and hit counts for those that are left.

use super::{Entry, HitCounts, PairFactors};
use crate::solution::{FormFactorBounds, FormFactors};
use rayon::prelude::*;

/// Of stated errors, in bounds. Errors of settled pairs are estimates, in tests exceeded some 25-fold at most.
const MARGIN: f64 = 50.0;

/// Settled pairs beside the ray counts of the others.
#[derive(Debug)]
pub struct Blend<'a> {
    settled: Option<&'a PairFactors>,
    counts: std::borrow::Cow<'a, HitCounts>,
}

impl<'a> Blend<'a> {
    /// Counts alone.
    pub fn of_rays(counts: &'a HitCounts) -> Self {
        Self { settled: None, counts: std::borrow::Cow::Borrowed(counts) }
    }

    /// Settled pairs and, of the counts, those of the pairs that are left.
    pub fn new(settled: &'a PairFactors, counts: &HitCounts) -> Self {
        let left = &settled.left;
        let keep = |(i, row): (usize, &Vec<Entry>)| -> Vec<Entry> {
            let is_left = |e: &&Entry| left.holds(i, e.patch());
            if left.is_settled(i) { Vec::new() } else { row.iter().filter(is_left).copied().collect() }
        };
        let rows = counts.rows.par_iter().enumerate().map(keep).collect();
        let kept = HitCounts { rows, active: counts.active.clone(), ..*counts };
        Self { settled: Some(settled), counts: std::borrow::Cow::Owned(kept) }
    }

    /// The counts of the pairs left to rays.
    pub fn counts(&self) -> &HitCounts {
        &self.counts
    }

    /// Mean form factors with standard errors.
    pub fn form_factors(&self) -> FormFactors {
        let Some(settled) = self.settled.map(|s| &s.form_factors) else { return self.counts.form_factors() };
        if self.counts.rows.iter().all(Vec::is_empty) {
            return settled.clone();
        }
        let by_rays = self.counts.form_factors();
        let row = |i: usize| {
            let entries = |f: &FormFactors| -> Vec<(u32, f64, f64)> {
                let span = f.row_starts[i]..f.row_starts[i + 1];
                let error = |k: usize| f.std_err.as_ref().map_or(0.0, |e| e[k]);
                span.map(|k| (f.columns[k], f.values[k], error(k))).collect()
            };
            let mut row = entries(settled);
            let rays = entries(&by_rays);
            if !rays.is_empty() {
                row.extend(rays);
                row.sort_unstable_by_key(|e| e.0);
            }
            row
        };
        FormFactors::from_rows((0..self.counts.rows.len()).into_par_iter().map(row).collect())
    }

    /// Bounds of all form factors that hold together at this confidence: of hit counts their intervals, of settled
    /// pairs 50 times the stated error. `closed`: rows sum to one.
    pub fn bounds(&self, confidence: f64, closed: bool) -> FormFactorBounds {
        let by_rays = self.counts.bounds(confidence, closed);
        let Some(pairs) = self.settled else { return by_rays };
        let settled = &pairs.form_factors;
        let errors = settled.std_err.as_deref().unwrap_or_default();
        let (mut rows, mut high) = (Vec::with_capacity(settled.n), Vec::new());
        for i in 0..settled.n {
            let span = settled.row_starts[i]..settled.row_starts[i + 1];
            let known = span.map(|k| {
                let (value, error) = (settled.values[k], MARGIN * errors[k]);
                (settled.columns[k], (value - error).max(0.0), (value + error).min(1.0))
            });
            let mut row: Vec<(u32, f64, f64)> = known.collect();
            row.extend(by_rays.row(i).map(|(j, low, high)| (j as u32, low, high)));
            row.sort_unstable_by_key(|e| e.0);
            high.extend(row.iter().map(|e| e.2));
            rows.push(row.into_iter().map(|(j, low, _)| (j, low)).collect());
        }
        // Where every pair of a row is settled, those that are not stored are proved to be nothing.
        let unseen = (0..settled.n).map(|i| if pairs.left.is_settled(i) { 0.0 } else { by_rays.unseen[i] });
        FormFactorBounds { low: FormFactors::from_exact_rows(rows), high, unseen: unseen.collect(), ..by_rays }
    }

    /// sqrt(sum se^2) / sqrt(sum F^2) over the matrix.
    pub fn relative_error(&self) -> f64 {
        if self.settled.is_none() {
            return self.counts.relative_error();
        }
        let all = self.counts.rows.iter().all(Vec::is_empty);
        let f = match self.settled {
            Some(s) if all => std::borrow::Cow::Borrowed(&s.form_factors),
            _ => std::borrow::Cow::Owned(self.form_factors()),
        };
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let signal = norm(&f.values);
        if signal == 0.0 { 0.0 } else { norm(f.std_err.as_deref().unwrap_or_default()) / signal }
    }

    /// `y = F x` with, for each r, the matrix that leaves out randomisation r. `width` is R times bands.
    pub fn apply_leave_one_out(&self, x: &[f64], width: usize, y: &mut [f64]) {
        self.counts.apply_leave_one_out(x, width, y);
        let Some(settled) = self.settled.map(|s| &s.form_factors) else { return };
        y.par_chunks_mut(width).enumerate().for_each(|(i, out)| {
            for (j, f) in settled.row(i) {
                out.iter_mut().zip(&x[j * width..]).for_each(|(o, x)| *o += f * x);
            }
        });
    }

    /// For every row `sqrt(sum_j se_ij^2 x_j^2)` over the settled pairs: what their numerical errors do to `F x`.
    pub fn settled_noise(&self, x: &[f64], bands: usize) -> Vec<f64> {
        let mut noise = vec![0.0; self.counts.rows.len() * bands];
        let Some(f) = self.settled.map(|s| &s.form_factors) else { return noise };
        let Some(errors) = &f.std_err else { return noise };
        noise.par_chunks_mut(bands).enumerate().for_each(|(i, out)| {
            for k in f.row_starts[i]..f.row_starts[i + 1] {
                let source = &x[f.columns[k] as usize * bands..];
                out.iter_mut().zip(source).for_each(|(o, x)| *o += (errors[k] * x).powi(2));
            }
            out.iter_mut().for_each(|o| *o = o.sqrt());
        });
        noise
    }
}
