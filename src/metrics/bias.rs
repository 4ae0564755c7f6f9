//! Signed error of the area-weighted luminance.

use crate::math::compensated_sum;
use crate::stats::{Estimate, jackknife_interval};

/// `sum A (Y - Y_ref) / sum A Y_ref` with its interval by jackknife over replicates; exact for one row.
/// `None` where the reference's sum is not positive.
pub fn relative_bias(areas: &[f64], solution: &[f64], reference: &[Vec<f64>], confidence: f64) -> Option<Estimate> {
    let total = |y: &[f64]| compensated_sum(areas.iter().zip(y).map(|(a, y)| a * y));
    let ours = total(solution);
    let theirs: Vec<f64> = reference.iter().map(|row| total(row)).collect();
    let sum = compensated_sum(theirs.iter().copied());
    let mean = sum / theirs.len() as f64;
    let left_out: Vec<f64> = theirs.iter().map(|t| (sum - t) / (theirs.len() as f64 - 1.0)).collect();
    if mean <= 0.0 {
        return None;
    }
    if reference.len() == 1 {
        return Some(Estimate::exact((ours - mean) / mean));
    }
    if left_out.iter().any(|m| *m <= 0.0) {
        return None;
    }
    let without: Vec<f64> = left_out.iter().map(|m| (ours - m) / m).collect();
    Some(jackknife_interval((ours - mean) / mean, &without, confidence))
}
