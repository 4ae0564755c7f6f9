//! How far a matrix is from closure and reciprocity, in plain numbers.

use super::Surroundings;
use super::enforce::sums_off;
use crate::math::{Compensated, compensated_sum};
use crate::solution::FormFactors;
use serde::{Deserialize, Serialize};

/// The defects of a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Residue {
    /// Largest `|sum_j F_ij - 1|`; in the open only of sums above 1.
    pub largest_closure: f64,
    /// Root mean square of the same over the patches that take part.
    pub rms_closure: f64,
    /// Largest `|A_i F_ij - A_j F_ji| / (A_i + A_j)`: at least one of the two factors is wrong by as much.
    pub largest_reciprocity: f64,
    /// `sum |A_i F_ij - A_j F_ji| / sum (A_i F_ij + A_j F_ji)`: the share of the exchange that is one-sided.
    pub one_sided: f64,
}

/// Measures a matrix.
pub fn residue(f: &FormFactors, around: &Surroundings) -> Residue {
    let off = sums_off(f, around);
    let present = around.areas.iter().filter(|a| **a > 0.0).count().max(1) as f64;
    let (mut largest, mut apart, mut all) = (0.0f64, Compensated::default(), Compensated::default());
    for_pairs(f, |i, j, there, back| {
        let (a, b) = (around.areas[i], around.areas[j]);
        let defect = (a * there - b * back).abs();
        if a + b > 0.0 {
            largest = largest.max(defect / (a + b));
        }
        apart.add(defect);
        all.add(a * there.abs() + b * back.abs());
    });
    Residue {
        largest_closure: off.iter().map(|d| d.abs()).fold(0.0, f64::max),
        rms_closure: (compensated_sum(off.iter().map(|d| d * d)) / present).sqrt(),
        largest_reciprocity: largest,
        one_sided: if all.value() > 0.0 { apart.value() / all.value() } else { 0.0 },
    }
}

/// Calls with each unordered pair of which at least one direction is stored, and both its values, i < j.
pub(super) fn for_pairs(f: &FormFactors, mut call: impl FnMut(usize, usize, f64, f64)) {
    for i in 0..f.n {
        for (j, value) in f.row(i) {
            if j > i {
                call(i, j, value, f.get(j, i));
            } else if j < i && !f.holds(j, i) {
                call(j, i, 0.0, value);
            }
        }
    }
}
