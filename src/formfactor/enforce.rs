//! Closure and reciprocity enforced: the most likely matrix that obeys both.

use super::Surroundings;
use super::exchanges::{Pair, combine, errors_are_known};
use super::leftover::variances;
use super::moves::{Moves, moves};
use super::multipliers::{Problem, Solved};
use super::opening::{UNMET, open_pairs};
use super::residue::{Residue, residue};
use crate::solution::FormFactors;
use serde::{Deserialize, Serialize};

/// A matrix that obeys, and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Enforced {
    /// The new matrix; its standard errors where the old one had them.
    pub form_factors: FormFactors,
    /// What was done to the old one.
    pub info: Enforcement,
}

/// What weighs how much.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// The inverse of each value's variance.
    StandardErrors,
    /// No errors are stated: variances are taken to be proportional to the exchange.
    ProportionalToExchange,
}

/// What is known of the errors of the new matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorsAfter {
    /// Propagated through all constraints together (linear).
    Propagated,
    /// An upper bound: one constraint at a time, because there are too many rows for more.
    Bound,
    /// Unknown, like those of the old matrix.
    Unknown,
}

/// A row whose sum could not be made to fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UnmetRow {
    /// Patch.
    pub row: usize,
    /// Row sum - 1 that remains.
    pub defect: f64,
}

/// What enforcement did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Enforcement {
    /// What the changes were weighed by.
    pub weights: Weights,
    /// What the standard errors of the result are.
    pub errors: ErrorsAfter,
    /// Newton steps.
    pub steps: usize,
    /// Defects of the matrix given.
    pub before: Residue,
    /// Defects of the result.
    pub after: Residue,
    /// How far values moved.
    pub moves: Moves,
    /// Entries taken out because geometry forbids them.
    pub forbidden: usize,
    /// Pairs pressed to 0 because they would have become negative.
    pub pressed_to_zero: usize,
    /// Pairs never hit that had to be given something, since their rows could not be closed otherwise.
    pub opened: usize,
    /// Rows that could not be closed: nothing in them is free to move.
    pub unmet: Vec<UnmetRow>,
}

/// The matrix nearest to `f` that is reciprocal (`A_i F_ij = A_j F_ji`), closed (`sum_j F_ij = 1`; at most 1 where
/// `around` is open) and nowhere negative: weighted least squares on the symmetric exchanges `A_i F_ij`, weights
/// 1/variance, entries taken as independent.
///
/// Values keep their zeros: a pair that neither direction has hit stays 0 unless a row cannot be closed without it, and
/// entries between patches that cannot see each other are taken out. Deterministic, on one thread but for the errors.
///
/// Panics if the matrix and `around` differ in size.
pub fn enforce(f: &FormFactors, around: &Surroundings) -> Enforced {
    assert_eq!(f.n, around.len(), "one area per row");
    let known = errors_are_known(f);
    let mut pairs = combine(f, around);
    let mut solved = solve(&pairs, around);
    let found = pairs.len();
    if open_pairs(&mut pairs, &solved.defects, around, known) {
        solved = solve(&pairs, around);
    }
    let at = |p: &Pair| Problem::exchange(p, &solved.multipliers);
    let holds: Vec<bool> = pairs.iter().map(|p| at(p) > 0.0).collect();
    let binds: Vec<bool> = solved.multipliers.iter().map(|l| around.closed || *l < 0.0).collect();
    let (left, exact) = if known { variances(&pairs, &holds, &binds) } else { (vec![], false) };
    let values: Vec<f64> = pairs.iter().map(at).collect();
    let form_factors = matrix(&pairs, &values, known.then_some(&left), around);
    let (before, after) = (residue(f, around), residue(&form_factors, around));
    let unmet = |(row, defect): (usize, &f64)| (defect.abs() > UNMET).then_some(UnmetRow { row, defect: *defect });
    let info = Enforcement {
        weights: if known { Weights::StandardErrors } else { Weights::ProportionalToExchange },
        errors: match (known, exact) {
            (false, _) => ErrorsAfter::Unknown,
            (true, true) => ErrorsAfter::Propagated,
            (true, false) => ErrorsAfter::Bound,
        },
        steps: solved.steps,
        before,
        after,
        moves: moves(f, &form_factors, known),
        forbidden: forbidden(f, around),
        pressed_to_zero: holds.iter().zip(&pairs).filter(|(h, p)| !**h && p.value > 0.0).count(),
        opened: pairs.len() - found,
        unmet: sums_off(&form_factors, around).iter().enumerate().filter_map(unmet).collect(),
    };
    Enforced { form_factors, info }
}

fn solve(pairs: &[Pair], around: &Surroundings) -> Solved {
    Problem { pairs, areas: &around.areas, closed: around.closed }.solve()
}

/// Stored entries that geometry forbids.
fn forbidden(f: &FormFactors, around: &Surroundings) -> usize {
    (0..f.n).map(|i| f.row(i).filter(|(j, v)| *v != 0.0 && around.forbids(i, *j).is_some()).count()).sum()
}

/// Row sum - 1 of the rows that take part; in the open only what is above 0.
pub(super) fn sums_off(f: &FormFactors, around: &Surroundings) -> Vec<f64> {
    let off = |i: usize| {
        let defect = f.row_sum(i) - 1.0;
        if around.areas[i] <= 0.0 || (!around.closed && defect < 0.0) { 0.0 } else { defect }
    };
    (0..f.n).map(off).collect()
}

/// Both directions of every exchange above 0.
fn matrix(pairs: &[Pair], values: &[f64], variances: Option<&Vec<f64>>, around: &Surroundings) -> FormFactors {
    let mut rows: Vec<Vec<(u32, f64, f64)>> = vec![Vec::new(); around.len()];
    for (k, p) in pairs.iter().enumerate().filter(|(k, _)| values[*k] > 0.0) {
        let std_err = variances.map_or(0.0, |v| v[k].sqrt());
        for (i, j) in [(p.i, p.j), (p.j, p.i)] {
            let area = around.areas[i as usize];
            rows[i as usize].push((j, values[k] / area, std_err / area));
        }
    }
    rows.iter_mut().for_each(|row| row.sort_unstable_by_key(|e| e.0));
    let mut f = FormFactors::from_rows(rows);
    if variances.is_none() {
        f.std_err = None;
    }
    f
}

#[cfg(test)]
mod tests;
