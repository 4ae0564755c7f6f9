//! Eq. 7 over the 1 % of patches whose luminance changes most [GSG90 top 1 %].

use super::quantity::{mean_of, mean_of_some};
use super::rms::{Rms, interval};
use super::sums::Sums;

/// Number of patches in the top 1 % of `present`: `ceil(0.01 N)`, in integers.
pub fn top1_count(present: usize) -> usize {
    present.div_ceil(100)
}

/// The `ceil(0.01 N)` present patches with the largest |after - before|, ties to the lower number; ascending.
/// Not weighted by area.
pub fn top1_set(areas: &[f64], after: &[f64], before: &[f64]) -> Vec<usize> {
    let mut present: Vec<usize> = (0..areas.len()).filter(|i| areas[*i] > 0.0).collect();
    let count = top1_count(present.len());
    let change = |i: usize| (after[i] - before[i]).abs();
    // A stable sort keeps the lower number first among equals.
    present.sort_by(|a, b| change(*b).total_cmp(&change(*a)));
    present.truncate(count);
    present.sort_unstable();
    present
}

/// Eq. 7 over the patches that change most between `before` and `after` [GSG90 top 1 %]. Rows are replicates; a single row
/// is taken as it is. `judged` holds the reference the sums run over: `after` itself, or its reflected part.
///
/// Choosing and judging on the same noise reads several per cent for a perfect solution: the even replicates
/// choose for the odd ones and the other way round. Replicates go by parity, not first and second half: the
/// replicates of two references made with one seed share their random numbers number by number, whatever their
/// counts, and one half must know nothing of the other.
pub fn top1_rms(
    areas: &[f64],
    solution: &[f64],
    judged: &[Vec<f64>],
    after: &[Vec<f64>],
    before: &[Vec<f64>],
    confidence: f64,
) -> Rms {
    let over = |set: Vec<usize>, rows: Vec<&[f64]>| Sums::over(set.into_iter(), areas, solution, &rows);
    if judged.is_empty() || after.is_empty() || before.is_empty() {
        return Rms::Dark;
    }
    if judged.len() == 1 {
        let set = top1_set(areas, &after[0], &mean_of(before));
        return interval(&[over(set, vec![judged[0].as_slice()])], confidence);
    }
    let halves = [0, 1].map(|parity| {
        let before = if before.len() == 1 { before[0].clone() } else { half_mean(before, parity) };
        let set = top1_set(areas, &half_mean(after, parity), &before);
        let rows = judged.iter().skip(1 - parity).step_by(2).map(Vec::as_slice).collect();
        over(set, rows)
    });
    interval(&halves, confidence)
}

fn half_mean(rows: &[Vec<f64>], parity: usize) -> Vec<f64> {
    mean_of_some(rows, |r| r % 2 == parity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Estimate;

    #[test]
    fn one_per_cent_rounded_up() {
        let known = [(1, 1), (99, 1), (100, 1), (101, 2), (700, 7), (12_700, 127), (0, 0)];
        for (present, count) in known {
            assert_eq!(top1_count(present), count, "{present}");
        }
    }

    #[test]
    fn the_largest_change_wins_and_ties_go_to_the_lower_number() {
        let mut after = vec![1.0; 201];
        let before = vec![1.0; 201];
        let areas = [vec![1.0; 200], vec![0.0]].concat();
        assert_eq!(top1_set(&areas, &after, &before), [0, 1]);
        after[150] = 0.5;
        after[20] = 1.5;
        after[7] = 1.5;
        assert_eq!(top1_set(&areas, &after, &before), [7, 20]);
        after[30] = 3.0;
        assert_eq!(top1_set(&areas, &after, &before), [7, 30]);
        // Absent, however much it changed.
        after[200] = 100.0;
        assert_eq!(top1_set(&areas, &after, &before), [7, 30]);
    }

    #[test]
    fn area_counts_in_the_sums_but_not_in_the_choice() {
        let mut areas = vec![1.0; 150];
        areas[3] = 1e-3;
        let mut after = vec![1.0; 150];
        after[3] = 2.0;
        after[9] = 1.9;
        let mut solution = after.clone();
        solution[3] = 1.0;
        solution[9] = 1.8;
        let rms = top1_rms(&areas, &solution, &[after.clone()], &[after], &[vec![1.0; 150]], 0.95);
        let known: f64 = (1e-3 + 0.01) / (4e-3 + 1.9 * 1.9);
        assert!((rms.estimate().unwrap().value - known.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn a_patch_that_did_not_exist_before_counts_with_zero() {
        let areas = vec![1.0; 100];
        let (mut before, mut after) = (vec![1.0; 100], vec![1.2; 100]);
        before[42] = 0.0;
        after[42] = 1.0;
        assert_eq!(top1_set(&areas, &after, &before), [42]);
    }

    #[test]
    fn even_replicates_choose_for_odd_ones_and_the_other_way_round() {
        // Even replicates see patch 0 change, odd ones patch 1.
        let (even, odd) = (vec![3.0, 1.0], vec![1.0, 5.0]);
        let after: Vec<Vec<f64>> = (0..8).map(|r| if r % 2 == 0 { even.clone() } else { odd.clone() }).collect();
        let solution = [2.0, 4.0];
        let rms = top1_rms(&[1.0, 1.0], &solution, &after, &after, &[vec![1.0, 1.0]], 0.95);
        // Patch 0 judged on odd replicates: 2 against 1; patch 1 on even ones: 4 against 1.
        let known = Estimate { std_err: Some(0.0), ..Estimate::exact((10.0f64 / 2.0).sqrt()) };
        assert_eq!(rms, Rms::Known(known));
    }

    #[test]
    fn a_dark_set_has_no_relative_error() {
        let dark = vec![vec![0.0, 1.0]; 8];
        assert_eq!(top1_rms(&[1.0, 1.0], &[0.5, 1.0], &dark, &dark, &[vec![5.0, 1.0]], 0.95), Rms::Dark);
    }
}
