//! Somebody's form factors against the judge's: what separates them, what was misread, and who breaks physics where.

use crate::formfactor::{Layout, Mistake, Physics, Reason, Rule, Surroundings, examine, undo};
use crate::metrics::{EntryDifference, MatrixComparison, MatrixRequest, compare_matrices};
use crate::solution::FormFactors;
use serde::{Deserialize, Serialize};

/// A layout or a factor is named if taking it out leaves less than this share of the difference.
const EXPLAINED: f64 = 0.5;
/// A factor within this of 1 is no mistake that has a name.
const NOTABLE: f64 = 0.005;

/// What explains most of a difference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    /// How their matrix is laid out, and by which factor it is too large; `None` where only its rows are scaled.
    pub mistake: Option<Mistake>,
    /// Smallest and largest factor by which rows are too large, each row by its own.
    pub row_factors: Option<(f64, f64)>,
    /// Relative norm of the difference that is left without it.
    pub relative_after: f64,
}

/// What physics says of one pair on which the two differ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Witness {
    /// The pair.
    #[serde(flatten)]
    pub entry: EntryDifference,
    /// `F_ij - A_j F_ji / A_i` of theirs: by how much its two directions disagree.
    pub their_reciprocity: f64,
    /// The same of the judge's.
    pub judge_reciprocity: f64,
    /// Their row sum - 1; `None` in the open.
    pub their_closure: Option<f64>,
    /// The judge's row sum - 1; `None` in the open.
    pub judge_closure: Option<f64>,
}

impl Witness {
    /// True if physics alone shows that theirs is off by a notable part of the difference, and the judge's is not.
    pub fn speaks_against_them(&self) -> bool {
        self.defect(true) > 0.1 * self.entry.difference.abs() && self.defect(true) > 10.0 * self.defect(false)
    }

    /// The other way round.
    pub fn speaks_against_the_judge(&self) -> bool {
        self.defect(false) > 0.1 * self.entry.difference.abs() && self.defect(false) > 10.0 * self.defect(true)
    }

    fn defect(&self, theirs: bool) -> f64 {
        let (pair, row) = match theirs {
            true => (self.their_reciprocity, self.their_closure),
            false => (self.judge_reciprocity, self.judge_closure),
        };
        pair.abs().max(row.unwrap_or(0.0).abs())
    }
}

/// What came of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MatrixRun {
    /// Their matrix against the judge's, as it came.
    pub comparison: MatrixComparison,
    /// The mistake that explains most of it, if one does.
    pub explanation: Option<Explanation>,
    /// Physics on the worst entries of the comparison.
    pub witnesses: Vec<Witness>,
    /// Physics on all of theirs.
    pub theirs: Physics,
    /// Physics on all of the judge's.
    pub judge: Physics,
}

/// Compares. `around` holds area 0 for patches that take no part.
pub fn compare_matrix(
    theirs: &FormFactors,
    judge: &FormFactors,
    around: &Surroundings,
    request: MatrixRequest,
) -> MatrixRun {
    let comparison = compare_matrices(theirs, judge, &around.areas, request);
    let rule = |f: &FormFactors, freedom: f64| Rule { degrees_of_freedom: freedom, ..Rule::usual(f) };
    let witness = |e: &EntryDifference| witness(theirs, judge, around, *e);
    MatrixRun {
        explanation: explanation(theirs, judge, around, &comparison, request),
        witnesses: comparison.worst.iter().map(witness).collect(),
        theirs: physics(theirs, around, rule(theirs, request.their_freedom)),
        judge: physics(judge, around, rule(judge, request.judge_freedom)),
        comparison,
    }
}

/// Physics; rows of more than one patch may see themselves.
fn physics(f: &FormFactors, around: &Surroundings, rule: Rule) -> Physics {
    let mut p = examine(f, around, rule);
    if around.patches.is_empty() {
        let innocent = p.impossible.iter().any(|i| i.reason == Reason::SeesItself && i.broken > 0);
        p.impossible.retain(|i| i.reason != Reason::SeesItself);
        let one_sided = !p.errors_known && p.residue.one_sided > rule.tolerance;
        let rest = p.closure.broken + p.reciprocity.broken > 0 || p.impossible.iter().any(|i| i.broken > 0);
        p.broken &= !innocent || rest || one_sided;
    }
    p
}

fn witness(theirs: &FormFactors, judge: &FormFactors, around: &Surroundings, entry: EntryDifference) -> Witness {
    let (i, j) = (entry.row, entry.column);
    let both_ways = |f: &FormFactors| f.get(i, j) - around.areas[j] * f.get(j, i) / around.areas[i];
    let closure = |f: &FormFactors| around.closed.then(|| f.row_sum(i) - 1.0);
    Witness {
        entry,
        their_reciprocity: both_ways(theirs),
        judge_reciprocity: both_ways(judge),
        their_closure: closure(theirs),
        judge_closure: closure(judge),
    }
}

/// The layout, factor, or scaling of rows that brings theirs nearest to the judge's, if it is much nearer.
fn explanation(
    theirs: &FormFactors,
    judge: &FormFactors,
    around: &Surroundings,
    plain: &MatrixComparison,
    request: MatrixRequest,
) -> Option<Explanation> {
    // What the judge's own error or rounding may have done needs no other explanation.
    let finite = theirs.values.iter().all(|v| v.is_finite());
    if plain.relative.low <= 0.0 || plain.beyond == 0 || !finite {
        return None;
    }
    let left = |f: &FormFactors| compare_matrices(f, judge, &around.areas, request).relative.value;
    let layouts = [Layout::AsIs, Layout::Transposed, Layout::ExchangeAreas, Layout::OneTriangle];
    let by_layout = layouts.into_iter().filter_map(|layout| {
        let straight = undo(theirs, around, &Mistake { layout, scale: 1.0, constant: None });
        let scale = factor(&straight, judge)?;
        let scale = if (scale - 1.0).abs() > NOTABLE { scale } else { 1.0 };
        let mistake = Mistake { layout, scale, constant: None };
        let after = left(&undo(theirs, around, &mistake));
        Some(Explanation { mistake: Some(mistake), row_factors: None, relative_after: after })
    });
    // In this order a tie goes to the simplest.
    let best = by_layout.reduce(|best, next| if next.relative_after < 0.5 * best.relative_after { next } else { best });
    let named = best.filter(|e| {
        let mistaken = e.mistake.as_ref().is_some_and(|m| m.layout != Layout::AsIs || m.scale != 1.0);
        mistaken && e.relative_after < EXPLAINED * plain.relative.value
    });
    let by_rows = || {
        let (scaled, factors) = rows_scaled(theirs, judge)?;
        let after = left(&scaled);
        (after < EXPLAINED * EXPLAINED * plain.relative.value).then_some(Explanation {
            mistake: None,
            row_factors: Some(factors),
            relative_after: after,
        })
    };
    // Rows that differ in their factors also have a common one; it explains far less.
    let rest = named.as_ref().map_or(f64::INFINITY, |e| e.relative_after);
    by_rows().filter(|e| e.relative_after < EXPLAINED * EXPLAINED * rest).or(named).map(named_constant)
}

/// Constants that people multiply by or forget.
fn named_constant(mut e: Explanation) -> Explanation {
    use std::f64::consts::PI;
    let known = [(PI, "pi"), (1.0 / PI, "1/pi"), (2.0, "2"), (0.5, "1/2"), (4.0, "4"), (0.25, "1/4"), (100.0, "100")];
    if let Some(m) = &mut e.mistake {
        m.constant = known.iter().find(|(c, _)| (m.scale / c - 1.0).abs() < NOTABLE).map(|(_, name)| (*name).into());
    }
    e
}

/// The least-squares factor between two matrices.
fn factor(theirs: &FormFactors, judge: &FormFactors) -> Option<f64> {
    let all = (0..theirs.n).flat_map(|i| theirs.row(i).map(move |(j, v)| (i, j, v)));
    let product: f64 = all.map(|(i, j, v)| v * judge.get(i, j)).sum();
    let square: f64 = judge.values.iter().map(|v| v * v).sum();
    Some(product / square).filter(|s| s.is_finite() && *s > 0.0)
}

/// Their rows divided each by its own least-squares factor, with the smallest and the largest of those.
fn rows_scaled(theirs: &FormFactors, judge: &FormFactors) -> Option<(FormFactors, (f64, f64))> {
    let (mut out, mut low, mut high) = (theirs.clone(), f64::INFINITY, 0.0f64);
    for i in 0..theirs.n {
        let product: f64 = theirs.row(i).map(|(j, v)| v * judge.get(i, j)).sum();
        let square: f64 = judge.row(i).map(|(_, v)| v * v).sum();
        if product <= 0.0 || square <= 0.0 {
            continue;
        }
        let s = product / square;
        (low, high) = (low.min(s), high.max(s));
        let range = theirs.row_starts[i]..theirs.row_starts[i + 1];
        out.values[range.clone()].iter_mut().for_each(|v| *v /= s);
        if let Some(e) = &mut out.std_err {
            e[range].iter_mut().for_each(|v| *v /= s);
        }
    }
    (high > 0.0 && high - low > NOTABLE * high).then_some((out, (low, high)))
}
