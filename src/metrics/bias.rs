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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::mean_interval;

    #[test]
    fn signed_and_weighted_by_area() {
        let e = relative_bias(&[1.0, 3.0], &[2.0, 1.0], &[vec![1.0, 2.0]], 0.95);
        assert_eq!(e, Some(Estimate::exact((1.0 - 3.0) / 7.0)));
    }

    #[test]
    fn the_interval_is_that_of_the_total() {
        let rows: Vec<Vec<f64>> = [98.0, 101.0, 99.0, 103.0, 97.0, 102.0].iter().map(|x| vec![*x]).collect();
        let e = relative_bias(&[2.0], &[110.0], &rows, 0.95).unwrap();
        let total = mean_interval(&[98.0, 101.0, 99.0, 103.0, 97.0, 102.0], 0.95);
        assert!((e.value - 0.1).abs() < 1e-12);
        // 110 over the ends of the interval of the mean, to first order.
        assert!((e.high - (110.0 / total.low - 1.0)).abs() < 2e-3, "{e:?}");
        assert!((e.low - (110.0 / total.high - 1.0)).abs() < 2e-3, "{e:?}");
    }

    #[test]
    fn nothing_is_relative_to_no_light() {
        assert_eq!(relative_bias(&[1.0], &[1.0], &[vec![0.0]], 0.95), None);
        assert_eq!(relative_bias(&[1.0], &[1.0], &vec![vec![0.0]; 4], 0.95), None);
    }
}
