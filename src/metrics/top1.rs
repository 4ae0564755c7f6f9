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
