//! A matrix judged by physics: row sums, reciprocity, impossible entries, in units of its own errors.

use super::exchanges::{Both, both_directions, errors_are_known};
use super::impossible::{Impossible, impossible};
use super::mistake::{Mistake, mistake};
use super::residue::{Residue, residue};
use super::{Surroundings, enforce::sums_off};
use crate::solution::FormFactors;
use crate::stats::{bonferroni_level, t_quantile};
use serde::{Deserialize, Serialize};

/// So many of the worst are told.
const WORST: usize = 10;

/// What counts as broken.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rule {
    /// Defects of a form factor or of a row sum up to this are never held against a matrix.
    pub tolerance: f64,
    /// Chance that a sound matrix with honest standard errors is called broken, over all its tests together.
    pub false_alarm: f64,
    /// Degrees of freedom behind each standard error: randomisations - 1.
    pub degrees_of_freedom: f64,
}

impl Rule {
    /// The usual rule. With standard errors: beyond rounding (1e-9) and beyond chance (one false alarm in a million
    /// matrices, standard errors from 16 randomisations). Without: 1e-3.
    pub fn usual(f: &FormFactors) -> Self {
        let tolerance = if errors_are_known(f) { 1e-9 } else { 1e-3 };
        Self { tolerance, false_alarm: 1e-6, degrees_of_freedom: 15.0 }
    }
}

/// A row sum that is off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RowDefect {
    /// Patch.
    pub row: usize,
    /// `sum_j F_ij - 1`.
    pub defect: f64,
    /// Its standard error, entries taken as independent; `None` where errors are unknown.
    pub std_err: Option<f64>,
    /// The defect in standard errors.
    pub sigmas: Option<f64>,
    /// Beyond the rule.
    pub broken: bool,
}

/// A pair whose two directions disagree.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PairDefect {
    /// The patches.
    pub pair: (usize, usize),
    /// `A_i F_ij - A_j F_ji`, m^2.
    pub defect: f64,
    /// `|defect| / (A_i + A_j)`: at least one of the two factors is wrong by as much.
    pub relative: f64,
    /// Standard error of the defect, m^2, directions taken as independent; `None` where errors are unknown.
    pub std_err: Option<f64>,
    /// The defect in standard errors.
    pub sigmas: Option<f64>,
    /// Beyond the rule.
    pub broken: bool,
}

/// Tests of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tested<T> {
    /// How many were tested.
    pub tested: usize,
    /// How many are wrong for sure.
    pub broken: usize,
    /// Root mean square in standard errors: about 1 for honest errors. `None` where errors are unknown.
    pub rms_sigmas: Option<f64>,
    /// The worst ten: by sigmas, without errors by size.
    pub worst: Vec<T>,
}

/// The judgement on a matrix.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Physics {
    /// Stored entries.
    pub stored: usize,
    /// Patches that take part.
    pub present: usize,
    /// Light cannot escape: row sums are 1. Otherwise 1 at most.
    pub closed: bool,
    /// The matrix comes with standard errors.
    pub errors_known: bool,
    /// What counted as broken.
    pub rule: Rule,
    /// Standard errors beyond which a single test is broken: the false-alarm rate shared out over all tests.
    pub threshold: Option<f64>,
    /// Defects in plain numbers.
    pub residue: Residue,
    /// Row sums.
    pub closure: Tested<RowDefect>,
    /// Pairs.
    pub reciprocity: Tested<PairDefect>,
    /// Entries that cannot be, by reason.
    pub impossible: Vec<Impossible>,
    /// The mistake that explains it all, if one does.
    pub mistake: Option<Mistake>,
    /// True if the matrix breaks physics for sure.
    pub broken: bool,
}

/// Judges a matrix.
///
/// Broken is: a row sum or a pair beyond tolerance and, where errors are known, beyond the threshold; an impossible
/// entry beyond both; without errors also a one-sided share of all exchange above the tolerance, because single
/// entries of a fine matrix are all smaller than it.
///
/// Panics if the matrix and `around` differ in size.
pub fn examine(f: &FormFactors, around: &Surroundings, rule: Rule) -> Physics {
    assert_eq!(f.n, around.len(), "one area per row");
    let known = errors_are_known(f);
    let present = around.areas.iter().filter(|a| **a > 0.0).count();
    let pairs = both_directions(f, around);
    let level = bonferroni_level(rule.false_alarm, present + pairs.len() + f.stored());
    let threshold = known.then(|| t_quantile(0.5 * level, rule.degrees_of_freedom));
    let judge = Judge { rule, threshold };
    let closure = judge.rows(f, around);
    let reciprocity = judge.pairs(&pairs, &around.areas);
    let impossible = impossible(f, around, rule.tolerance, threshold);
    let residue = residue(f, around);
    let one_sided = !known && residue.one_sided > rule.tolerance;
    let broken = closure.broken + reciprocity.broken > 0 || impossible.iter().any(|i| i.broken > 0) || one_sided;
    Physics {
        stored: f.stored(),
        present,
        closed: around.closed,
        errors_known: known,
        rule,
        threshold,
        residue,
        closure,
        reciprocity,
        impossible,
        mistake: if broken { mistake(f, around) } else { None },
        broken,
    }
}

struct Judge {
    rule: Rule,
    threshold: Option<f64>,
}

impl Judge {
    /// Beyond tolerance, and beyond chance where that is known.
    fn breaks(&self, size: f64, sigmas: Option<f64>) -> bool {
        let chance = self.threshold.zip(sigmas).is_none_or(|(t, s)| s.abs() > t);
        size.abs() > self.rule.tolerance && chance
    }

    fn rows(&self, f: &FormFactors, around: &Surroundings) -> Tested<RowDefect> {
        let off = sums_off(f, around);
        let row = |row: usize| {
            let defect = off[row];
            let errors = f.std_err.as_ref().filter(|_| self.threshold.is_some());
            let std_err =
                errors.map(|e| e[f.row_starts[row]..f.row_starts[row + 1]].iter().map(|e| e * e).sum::<f64>().sqrt());
            // An error of 0 is rounding in truth.
            let sigmas = std_err.map(|e| defect / e.hypot(1e-15));
            RowDefect { row, defect, std_err, sigmas, broken: self.breaks(defect, sigmas) }
        };
        let rows = (0..f.n).filter(|i| around.areas[*i] > 0.0).map(row);
        tested(rows, |r| (r.broken, r.sigmas, r.defect))
    }

    fn pairs(&self, pairs: &[Both], areas: &[f64]) -> Tested<PairDefect> {
        let judged = pairs.iter().map(|b| {
            let defect = b.there - b.back;
            let relative = defect.abs() / (areas[b.i] + areas[b.j]);
            let std_err = self.threshold.map(|_| b.defect_std_err());
            let sigmas = std_err.map(|e| if defect == 0.0 { 0.0 } else { defect / e });
            let broken = self.breaks(relative, sigmas);
            PairDefect { pair: (b.i, b.j), defect, relative, std_err, sigmas, broken }
        });
        tested(judged, |p| (p.broken, p.sigmas, p.relative))
    }
}

/// Counts, and keeps the worst. `look` gives (broken, sigmas, size).
fn tested<T: Copy>(all: impl Iterator<Item = T>, look: impl Fn(&T) -> (bool, Option<f64>, f64)) -> Tested<T> {
    let mut out = Tested { tested: 0, broken: 0, rms_sigmas: None, worst: Vec::new() };
    let mut squares = 0.0;
    let badness = |x: &T| look(x).1.unwrap_or(look(x).2).abs();
    for x in all {
        let (broken, sigmas, size) = look(&x);
        out.tested += 1;
        out.broken += usize::from(broken);
        if let Some(s) = sigmas {
            squares += s * s;
            out.rms_sigmas = Some((squares / out.tested as f64).sqrt());
        }
        let place = out.worst.partition_point(|w| badness(w) >= badness(&x));
        if place < WORST && size != 0.0 {
            out.worst.insert(place, x);
            out.worst.truncate(WORST);
        }
    }
    out
}

#[cfg(test)]
mod tests;
