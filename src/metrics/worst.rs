//! The worst patch, relative to the light that is there.

use super::quantity::mean_of;
use crate::stats::{Estimate, Moments, two_sided_t};

/// Largest `|y - y_ref| / y_ref` over the patches present, with an interval that holds for all of them at once (Student t
/// over replicates, Bonferroni over patches). One row: that solution is the truth, and the result exact. `None` where
/// nothing is present.
///
/// A patch that is dark in the reference and in the solution counts with 0; one that is dark in the reference alone is
/// wrong beyond any limit, and one whose reference cannot be told from dark may be (`f64::MAX`).
pub fn worst_patch(areas: &[f64], solution: &[f64], reference: &[Vec<f64>], confidence: f64) -> Option<Estimate> {
    let present: Vec<usize> = (0..areas.len()).filter(|i| areas[*i] > 0.0).collect();
    let mean = mean_of(reference);
    let freedom = reference.len() as f64 - 1.0;
    let t = if reference.len() > 1 {
        two_sided_t(1.0 - (1.0 - confidence) / present.len().max(1) as f64, freedom)
    } else {
        0.0
    };
    let mut worst: Option<Estimate> = None;
    for i in present {
        let std_err = reference.iter().map(|row| row[i]).collect::<Moments>().std_err();
        let one = relative(solution[i], mean[i], std_err, t);
        worst = Some(worst.map_or(one, |w| {
            let std_err = if one.value > w.value { one.std_err } else { w.std_err };
            Estimate { value: w.value.max(one.value), std_err, low: w.low.max(one.low), high: w.high.max(one.high) }
        }));
    }
    worst
}

/// `|y - y_ref| / y_ref` of one patch, the reference known within t standard errors.
fn relative(y: f64, reference: f64, std_err: Option<f64>, t: f64) -> Estimate {
    let off = |r: f64| match r {
        _ if r > 0.0 => ((y - r) / r).abs(),
        _ if y == r => 0.0,
        _ => f64::MAX,
    };
    let value = off(reference);
    let Some(se) = std_err else { return Estimate::exact(value) };
    let (below, above) = (reference - t * se, reference + t * se);
    let (a, b) = (off(below), off(above));
    // The relative error is 0 where the reference may be the solution itself.
    let low = if below <= y && y <= above { 0.0 } else { a.min(b) };
    Estimate { value, std_err: (reference > 0.0).then(|| y.abs() * se / (reference * reference)), low, high: a.max(b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    #[test]
    fn by_hand() {
        let exact = |e| Some(Estimate::exact(e));
        assert_eq!(worst_patch(&[1.0, 2.0], &[1.1, 4.0], &[vec![1.0, 5.0]], 0.95), exact(0.2));
        // Absent patches do not count, and what is dark on both sides is right.
        assert_eq!(worst_patch(&[1.0, 0.0, 1.0], &[1.5, 9.0, 0.0], &[vec![1.0, 1.0, 0.0]], 0.95), exact(0.5));
        assert_eq!(worst_patch(&[1.0], &[1e-9], &[vec![0.0]], 0.95), exact(f64::MAX));
        assert_eq!(worst_patch(&[0.0], &[1.0], &[vec![1.0]], 0.95), None);
    }

    /// 300 patches, all right but one that is 5 % off: the interval misses the 5 % in at most 5 % of the runs.
    #[test]
    fn the_interval_holds_for_all_patches_at_once() {
        let (n, runs) = (300, 400);
        let mut random = Random(4);
        let (mut missed, mut false_alarms) = (0, 0);
        for _ in 0..runs {
            let rows: Vec<Vec<f64>> = (0..16).map(|_| (0..n).map(|_| 1.0 + 0.02 * random.normal()).collect()).collect();
            let mut solution = vec![1.0; n];
            false_alarms += usize::from(worst_patch(&vec![1.0; n], &solution, &rows, 0.95).unwrap().low > 0.0);
            solution[17] = 1.05;
            let e = worst_patch(&vec![1.0; n], &solution, &rows, 0.95).unwrap();
            missed += usize::from(e.low > 0.05 || e.high < 0.05);
        }
        // 5 % promised: 20 of 400 expected at most, sd 4.4; above 38 with probability 1e-4.
        assert!(false_alarms <= 38 && missed <= 38, "{false_alarms} {missed}");
    }
}
