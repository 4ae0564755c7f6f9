//! Sums over a matrix or a solution.

use super::record::{At, MatrixError};
use crate::audit::{Cause, Split};
use crate::metrics::{Point, fit_rate};
use crate::scene::Stage;
use crate::stats::Estimate;

/// `sqrt(sum A y^2 / sum A Y^2)`.
pub(super) fn relative(stage: &Stage, y: &dyn Fn(usize) -> f64, reflected: &[f64]) -> f64 {
    let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
        (0..stage.patch_count()).map(|i| stage.patches[i].area * of(i) * of(i)).sum()
    };
    (sum(y) / sum(&|i| reflected[i])).sqrt()
}

/// Errors of the matrix, rows weighted by area.
pub(super) fn matrix_error(stage: &Stage, split: &Split) -> MatrixError {
    let mut sums = [0.0; 6];
    for i in 0..split.len() {
        let weight = stage.patches[i].area.powi(2);
        for (_, p) in split.row(i) {
            let parts = Cause::ALL.map(|c| p.part(c));
            for (sum, x) in sums.iter_mut().zip([p.mean, p.error(), parts[0], parts[1], parts[2], p.mean_error]) {
                *sum += weight * x * x;
            }
        }
    }
    let share = |k: usize| if sums[0] > 0.0 { (sums[k] / sums[0]).sqrt() } else { 0.0 };
    MatrixError { total: share(1), by_cause: [share(2), share(3), share(4)], noise: share(5) }
}

/// Exponent of aliasing against resolution.
pub(super) fn rate(resolutions: &[At], confidence: f64) -> Option<Estimate> {
    let point = |at: &At| Point { x: at.x, error: Estimate::exact(at.aliasing), floor: None };
    fit_rate(&resolutions.iter().map(point).collect::<Vec<_>>(), confidence).map(|r| r.slope)
}
