//! Entries that no scene can have: not a share, where geometry forbids them, or more than with nothing in between.

use super::{NoExchange, Surroundings, polygon_to_polygon};
use crate::math::area;
use crate::solution::FormFactors;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Most entries compared with their unobstructed value: spread evenly over the matrix.
const COMPARED: usize = 50_000;

/// Why an entry cannot be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// Not finite.
    NotANumber,
    /// Below 0.
    Negative,
    /// Above 1.
    AboveOne,
    /// From or to a patch that takes no part in this state.
    AbsentPatch,
    /// On the diagonal: a planar patch does not see itself.
    SeesItself,
    /// Between patches of which one lies behind the plane of the other, or in it.
    FacingAway,
    /// Larger than with nothing in between (closed form; of up to 50,000 entries).
    AboveUnobstructed,
}

/// Entries that cannot be, for one reason.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Impossible {
    /// Why.
    pub reason: Reason,
    /// How many.
    pub entries: usize,
    /// How many of them are beyond tolerance and chance.
    pub broken: usize,
    /// The worst: row, column.
    pub worst: (usize, usize),
    /// Its form factor.
    pub value: f64,
    /// By how much it is too large (negative: below 0).
    pub excess: f64,
}

struct Entry {
    i: usize,
    j: usize,
    value: f64,
    std_err: Option<f64>,
}

/// All reasons found in a matrix. `threshold` in standard errors where they are known.
pub(super) fn impossible(
    f: &FormFactors,
    around: &Surroundings,
    tolerance: f64,
    threshold: Option<f64>,
) -> Vec<Impossible> {
    let stride = f.stored().div_ceil(COMPARED).max(1);
    let look = |i: usize| -> Vec<(Reason, f64, Entry)> {
        let errors = f.std_err.as_ref().filter(|_| threshold.is_some());
        let entry = |k: usize| Entry { i, j: f.columns[k] as usize, value: f.values[k], std_err: errors.map(|e| e[k]) };
        let judged = (f.row_starts[i]..f.row_starts[i + 1]).filter_map(|k| {
            let e = entry(k);
            let (reason, excess) = reason(&e, around, k % stride == 0)?;
            Some((reason, excess, e))
        });
        judged.collect()
    };
    let rows: Vec<Vec<(Reason, f64, Entry)>> = (0..f.n).into_par_iter().map(look).collect();
    let mut found: Vec<Impossible> = Vec::new();
    for (reason, excess, e) in rows.into_iter().flatten() {
        let chance = threshold.zip(e.std_err).is_none_or(|(t, se)| excess.abs() > t * se);
        // Against a NaN nothing can be weighed.
        let broken = reason == Reason::NotANumber || (excess.abs() > tolerance && chance);
        let new = Impossible { reason, entries: 0, broken: 0, worst: (e.i, e.j), value: e.value, excess };
        let place = found.iter().position(|x| x.reason == reason).unwrap_or_else(|| {
            found.push(new);
            found.len() - 1
        });
        let kind = &mut found[place];
        kind.entries += 1;
        kind.broken += usize::from(broken);
        if excess.abs() > kind.excess.abs() {
            (kind.worst, kind.value, kind.excess) = (new.worst, e.value, excess);
        }
    }
    found.sort_by_key(|x| x.reason);
    found
}

/// The first reason against an entry, and by how much it is too large.
fn reason(e: &Entry, around: &Surroundings, compare: bool) -> Option<(Reason, f64)> {
    if !e.value.is_finite() {
        return Some((Reason::NotANumber, 0.0));
    }
    if e.value < 0.0 {
        return Some((Reason::Negative, e.value));
    }
    if e.value == 0.0 {
        return None;
    }
    match around.forbids(e.i, e.j) {
        Some(NoExchange::Absent) => return Some((Reason::AbsentPatch, e.value)),
        Some(NoExchange::Itself) => return Some((Reason::SeesItself, e.value)),
        Some(NoExchange::FacingAway) => return Some((Reason::FacingAway, e.value)),
        None => {}
    }
    if e.value > 1.0 + 1e-12 {
        return Some((Reason::AboveOne, e.value - 1.0));
    }
    let excess = if compare { e.value - unobstructed(around, e.i, e.j)? } else { 0.0 };
    (excess > 1e-9).then_some((Reason::AboveUnobstructed, excess))
}

/// Upper bound of F_ij: nothing in between. Patches in contact count in full, which only raises it.
pub(super) fn unobstructed(around: &Surroundings, i: usize, j: usize) -> Option<f64> {
    let (a, b) = (around.patches.get(i)?, around.patches.get(j)?);
    Some(polygon_to_polygon(&a.corners, &b.corners) * area(&a.corners) / a.area)
}
