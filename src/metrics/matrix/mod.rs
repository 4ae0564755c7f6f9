//! A form-factor matrix held against the judge's, entry by entry.

mod entries;
mod rounding;
mod verdict;

use crate::math::Compensated;
use crate::solution::FormFactors;
use crate::stats::{
    Estimate, bonferroni_level, jackknife_interval, normal_quantile, t_quantile, t_upper_tail, two_sided_t,
};
use entries::{Entry, entries};
pub use rounding::Rounding;
use serde::{Deserialize, Serialize};
pub use verdict::{MatrixLimits, decide_matrix};

/// So many of the worst are told.
const WORST: usize = 10;
/// Chance that any entry of a right matrix with honest standard errors is said to differ beyond them.
pub const MATRIX_FALSE_ALARM: f64 = 1e-3;

/// How sure one wants to be, and how well errors are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixRequest {
    /// Two-sided confidence of each interval.
    pub confidence: f64,
    /// Degrees of freedom behind the judge's standard errors.
    pub judge_freedom: f64,
    /// Degrees of freedom behind theirs.
    pub their_freedom: f64,
}

/// An entry on which the two differ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EntryDifference {
    /// From this patch.
    pub row: usize,
    /// To this patch.
    pub column: usize,
    /// Their form factor.
    pub theirs: f64,
    /// The judge's.
    pub judge: f64,
    /// Theirs - the judge's.
    pub difference: f64,
    /// Standard error that they state; `None` where they state none.
    pub their_std_err: Option<f64>,
    /// Standard error of the judge; `None` where nobody knows it.
    pub judge_std_err: Option<f64>,
    /// The difference, less what rounding may do, in standard errors of both; `None` where both are exact.
    pub sigmas: Option<f64>,
}

/// How far one row is off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RowDifference {
    /// Patch.
    pub row: usize,
    /// Root of the sum of squared differences of the row.
    pub norm: f64,
    /// Sum of their row.
    pub their_sum: f64,
    /// Sum of the judge's.
    pub judge_sum: f64,
}

/// What separates two matrices. Rows and columns of area 0 take no part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MatrixComparison {
    /// Two-sided confidence of each interval.
    pub confidence: f64,
    /// Patches that take part.
    pub present: usize,
    /// Entries that at least one of the two states.
    pub compared: usize,
    /// Root mean square difference over all entries, zeros included; the judge's own errors are taken out of the
    /// value, and the interval holds whatever their correlations (triangle inequality).
    pub rms: Estimate,
    /// The same relative to the norm of the judge's matrix: `sqrt(sum d^2) / sqrt(sum F^2)`.
    pub relative: Estimate,
    /// Largest difference of an entry; the interval holds for all entries at once.
    pub largest: Estimate,
    /// The judge's own error, as `rms`; `None` where nobody knows it.
    pub judge_noise: Option<f64>,
    /// The error that they state, as `rms`.
    pub stated_noise: Option<f64>,
    /// Difference, the judge's part taken out, over the error that they state: about 1 for honest errors. Its interval
    /// is a jackknife over rows: those of a ray caster are independent.
    pub honesty: Option<Estimate>,
    /// How their numbers were rounded, where that shows.
    pub rounding: Option<Rounding>,
    /// Root mean square of that rounding.
    pub rounding_noise: Option<f64>,
    /// Entries that differ by more than rounding and the errors of both, at a false-alarm rate for the whole matrix.
    pub beyond: usize,
    /// That false-alarm rate.
    pub false_alarm: f64,
    /// Up to ten entries with the largest differences.
    pub worst: Vec<EntryDifference>,
    /// Up to ten rows with the largest norms of differences.
    pub worst_rows: Vec<RowDifference>,
}

/// Compares `theirs` with the `judge`'s; `areas` in m^2, 0 for patches that take no part.
///
/// A count of rays has a variance that grows with what is counted. Where one matrix counted less than the other says,
/// its error is taken at the size of the other: else a pair that few rays met would differ by many of its own too
/// small errors.
///
/// Panics if sizes differ.
pub fn compare_matrices(
    theirs: &FormFactors,
    judge: &FormFactors,
    areas: &[f64],
    request: MatrixRequest,
) -> MatrixComparison {
    assert!(theirs.n == judge.n && judge.n == areas.len(), "two matrices of one scene");
    let rounding = if theirs.std_err.is_none() { Rounding::of(&theirs.values) } else { None };
    let all = entries(theirs, judge, areas);
    let present = areas.iter().filter(|a| **a > 0.0).count();
    let norms = Norms::of(&all);
    let cells = (present as f64).max(1.0);
    let (rms, relative) = norms.estimates(request, cells);
    let level = bonferroni_level(MATRIX_FALSE_ALARM, all.len().max(1));
    let beyond = all.iter().filter(|e| is_beyond(e, rounding, request, level)).count();
    let known = |f: &FormFactors| f.std_err.is_some();
    let their_square = norms.stated.value();
    let rounded = rounding.map(|r| {
        let square: f64 = theirs.values.iter().map(|v| r.step(*v).powi(2) / 12.0).sum();
        square.sqrt() / cells
    });
    MatrixComparison {
        confidence: request.confidence,
        present,
        compared: all.len(),
        rms,
        relative,
        largest: largest(&all, request),
        judge_noise: known(judge).then(|| norms.own.value().sqrt() / cells),
        stated_noise: known(theirs).then(|| their_square.sqrt() / cells),
        honesty: if known(theirs) { honesty(&all, request.confidence) } else { None },
        rounding,
        rounding_noise: rounded,
        beyond,
        false_alarm: MATRIX_FALSE_ALARM,
        worst: worst_entries(&all, rounding),
        worst_rows: worst_rows(&all, theirs, judge),
    }
}

/// Sums of squares over the entries.
#[derive(Default)]
struct Norms {
    /// Of the differences.
    square: Compensated,
    /// Of the judge's form factors.
    judge: Compensated,
    /// Of the judge's standard errors.
    own: Compensated,
    /// Of the standard errors that they state.
    stated: Compensated,
}

impl Norms {
    fn of(all: &[Entry]) -> Self {
        let mut n = Self::default();
        for e in all {
            n.square.add(e.difference().powi(2));
            n.judge.add(e.judge * e.judge);
            n.own.add(e.judge_std_err.unwrap_or(0.0).powi(2));
            n.stated.add(e.their_std_err.unwrap_or(0.0).powi(2));
        }
        n
    }

    /// Per entry, and relative to the judge's matrix.
    ///
    /// The norm of the judge's error is at most t times its root mean square, with confidence: of all correlations the
    /// one that makes all errors one is the worst, and for that Student's t says so.
    fn estimates(&self, request: MatrixRequest, cells: f64) -> (Estimate, Estimate) {
        let noise = self.own.value().max(0.0).sqrt();
        let most = if noise > 0.0 { two_sided_t(request.confidence, request.judge_freedom) * noise } else { 0.0 };
        let norm = self.square.value().sqrt();
        let value = (self.square.value() - self.own.value()).max(0.0).sqrt();
        let (low, high) = ((norm - most).max(0.0), norm + most);
        let value = value.max(low);
        let scaled = |a: f64, b: f64, c: f64| Estimate { value: b, std_err: None, low: a, high: c };
        let rms = scaled(low / cells, value / cells, high / cells);
        let size = self.judge.value().sqrt();
        let part = |x: f64, by: f64| {
            if by > 0.0 {
                x / by
            } else if x > 0.0 {
                f64::MAX
            } else {
                0.0
            }
        };
        (rms, scaled(part(low, size + most), part(value, size), part(high, size - most)))
    }
}

/// The size of differences in units of the errors that they state.
fn honesty(all: &[Entry], confidence: f64) -> Option<Estimate> {
    let of = |row: &[Entry]| {
        let n = Norms::of(row);
        (n.square.value() - n.own.value(), n.stated.value())
    };
    let (found, stated) = of(all);
    let ratio = |found: f64, stated: f64| (found.max(0.0) / stated).sqrt();
    let rows: Vec<(f64, f64)> = all.chunk_by(|a, b| a.row == b.row).map(of).collect();
    let left_out: Vec<f64> = rows.iter().map(|(f, s)| ratio(found - f, stated - s)).collect();
    let known = stated > 0.0 && left_out.len() > 1 && left_out.iter().all(|x| x.is_finite());
    known.then(|| jackknife_interval(ratio(found, stated), &left_out, confidence))
}

/// The largest difference; its interval holds for all entries at once.
fn largest(all: &[Entry], request: MatrixRequest) -> Estimate {
    let level = bonferroni_level(1.0 - request.confidence, all.len().max(1));
    let width = t_quantile(0.5 * level, request.judge_freedom);
    let mut out = Estimate { value: 0.0, std_err: None, low: 0.0, high: 0.0 };
    for e in all {
        let (size, error) = (e.difference().abs(), width * e.judge_variance.sqrt());
        if size > out.value {
            (out.value, out.std_err) = (size, e.judge_std_err);
        }
        out.low = out.low.max(size - error);
        out.high = out.high.max(size + error);
    }
    out
}

/// True if no rounding and no chance explain the difference.
fn is_beyond(e: &Entry, rounding: Option<Rounding>, request: MatrixRequest, level: f64) -> bool {
    let excess = excess(e, rounding);
    let (a, b) = (e.judge_variance, e.their_variance);
    let Some(sigmas) = sigmas(e, rounding) else { return excess > 0.0 };
    // Tails of Student's t are never thinner than normal ones.
    if sigmas.abs() <= normal_quantile(0.5 * level) {
        return false;
    }
    let freedom = (a + b).powi(2) / (a * a / request.judge_freedom + b * b / request.their_freedom);
    2.0 * t_upper_tail(sigmas.abs(), freedom) < level
}

/// The difference less what rounding may do, of theirs and of double precision.
fn excess(e: &Entry, rounding: Option<Rounding>) -> f64 {
    let half = rounding.map_or(0.0, |r| 0.5 * r.step(e.theirs));
    (e.difference().abs() - half - 1e-15).max(0.0)
}

fn sigmas(e: &Entry, rounding: Option<Rounding>) -> Option<f64> {
    let variance = e.judge_variance + e.their_variance;
    (variance > 0.0).then(|| (excess(e, rounding) / variance.sqrt()).copysign(e.difference()))
}

fn worst_entries(all: &[Entry], rounding: Option<Rounding>) -> Vec<EntryDifference> {
    let told = |e: &Entry| EntryDifference {
        row: e.row,
        column: e.column,
        theirs: e.theirs,
        judge: e.judge,
        difference: e.difference(),
        their_std_err: e.their_std_err,
        judge_std_err: e.judge_std_err,
        sigmas: sigmas(e, rounding),
    };
    most(all.iter().filter(|e| e.difference() != 0.0), |e| e.difference().abs()).into_iter().map(told).collect()
}

fn worst_rows(all: &[Entry], theirs: &FormFactors, judge: &FormFactors) -> Vec<RowDifference> {
    let rows = all.chunk_by(|a, b| a.row == b.row).map(|row| RowDifference {
        row: row[0].row,
        norm: row.iter().map(|e| e.difference().powi(2)).sum::<f64>().sqrt(),
        their_sum: theirs.row_sum(row[0].row),
        judge_sum: judge.row_sum(row[0].row),
    });
    most(rows.filter(|r| r.norm > 0.0), |r| r.norm)
}

/// The ten that are largest, in order.
fn most<T>(all: impl Iterator<Item = T>, size: impl Fn(&T) -> f64) -> Vec<T> {
    let mut out: Vec<T> = Vec::new();
    for x in all {
        let place = out.partition_point(|w| size(w) >= size(&x));
        if place < WORST {
            out.insert(place, x);
            out.truncate(WORST);
        }
    }
    out
}

#[cfg(test)]
mod tests;
