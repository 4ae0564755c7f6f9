//! Pairs never hit that have to be given something, because their row cannot be closed otherwise.

use super::exchanges::Pair;
use super::{Surroundings, polygon_to_polygon};

/// Defect of a row sum above which a row counts as not closed.
pub(super) const UNMET: f64 = 1e-9;

/// Adds the missing pairs of rows that could not be filled; true if there were any.
///
/// Each starts at 0 with an error as large as what it would exchange if nothing stood between. Needs the patches.
pub(super) fn open_pairs(pairs: &mut Vec<Pair>, defects: &[f64], around: &Surroundings, known: bool) -> bool {
    let wanting: Vec<usize> = (0..defects.len()).filter(|i| defects[*i] < -UNMET).collect();
    if !around.closed || around.patches.is_empty() || wanting.is_empty() {
        return false;
    }
    let stored = pairs.len();
    for &i in &wanting {
        for j in (0..around.len()).filter(|j| *j != i && (*j > i || defects[*j] >= -UNMET)) {
            let (low, high) = (i.min(j), i.max(j));
            let here = (low as u32, high as u32);
            let is_new = pairs[..stored].binary_search_by_key(&here, |p| (p.i, p.j)).is_err();
            if is_new && around.forbids(i, j).is_none() {
                let exchange = unobstructed(around, low, high);
                let variance = if known { exchange * exchange } else { exchange };
                pairs.extend((variance > 0.0).then_some(Pair { i: here.0, j: here.1, value: 0.0, variance }));
            }
        }
    }
    pairs.sort_unstable_by_key(|p| (p.i, p.j));
    pairs.len() > stored
}

/// `A_i F_ij` with nothing in between, m^2.
fn unobstructed(around: &Surroundings, i: usize, j: usize) -> f64 {
    around.areas[i] * polygon_to_polygon(&around.patches[i].corners, &around.patches[j].corners)
}
