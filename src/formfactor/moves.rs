//! How far enforcement moved each value, in units of its own error.

use crate::solution::FormFactors;
use serde::{Deserialize, Serialize};

/// So many of the largest moves are told.
const WORST: usize = 10;
/// A value stated as exact has moved if it moved by more than this.
const ROUNDING: f64 = 1e-13;

/// One value that moved.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Move {
    /// From this patch.
    pub from: usize,
    /// To this patch.
    pub to: usize,
    /// Form factor before.
    pub before: f64,
    /// Form factor after.
    pub after: f64,
    /// Standard error before; `None` where it is unknown or the pair was never hit.
    pub std_err: Option<f64>,
    /// The move in standard errors; `None` where there is none above 0.
    pub sigmas: Option<f64>,
}

/// All moves together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Moves {
    /// Values before or after that are not 0.
    pub values: usize,
    /// Largest change of a form factor.
    pub largest: f64,
    /// Largest move in standard errors; `None` without errors.
    pub max_sigmas: Option<f64>,
    /// Root mean square of the moves in standard errors.
    pub rms_sigmas: Option<f64>,
    /// Share of the values with an error that moved by more than three of them: 0.0027 of normal ones would by chance.
    pub share_above_3: Option<f64>,
    /// Values stated as exact that had to move all the same.
    pub exact_moved: usize,
    /// The worst ten: by sigmas, without errors by size.
    pub worst: Vec<Move>,
}

/// Compares two matrices of one size; `known` says whether the errors of the old one are.
pub(super) fn moves(old: &FormFactors, new: &FormFactors, known: bool) -> Moves {
    let mut out = Moves {
        values: 0,
        largest: 0.0,
        max_sigmas: None,
        rms_sigmas: None,
        share_above_3: None,
        exact_moved: 0,
        worst: vec![],
    };
    let (mut judged, mut squares, mut above) = (0usize, 0.0, 0usize);
    for_each(old, new, known, |m| {
        out.values += 1;
        out.largest = out.largest.max((m.after - m.before).abs());
        out.exact_moved += usize::from(m.std_err == Some(0.0) && (m.after - m.before).abs() > ROUNDING);
        if let Some(s) = m.sigmas {
            judged += 1;
            squares += s * s;
            above += usize::from(s.abs() > 3.0);
        }
        keep_worst(&mut out.worst, m);
    });
    if judged > 0 {
        out.max_sigmas = out.worst.iter().filter_map(|m| m.sigmas).map(f64::abs).reduce(f64::max);
        out.rms_sigmas = Some((squares / judged as f64).sqrt());
        out.share_above_3 = Some(above as f64 / judged as f64);
    }
    out
}

fn for_each(old: &FormFactors, new: &FormFactors, known: bool, mut call: impl FnMut(Move)) {
    for i in 0..old.n {
        let told = |j: usize, before: f64, after: f64| {
            let std_err = known.then(|| old.std_err_of(i, j)).flatten();
            let sigmas = std_err.filter(|e| *e > 0.0).map(|e| (after - before) / e);
            Move { from: i, to: j, before, after, std_err, sigmas }
        };
        old.row(i).for_each(|(j, before)| call(told(j, before, new.get(i, j))));
        new.row(i).filter(|(j, _)| !old.holds(i, *j)).for_each(|(j, after)| call(told(j, 0.0, after)));
    }
}

/// Larger is worse: in sigmas first, then in size.
fn badness(m: &Move) -> (f64, f64) {
    (m.sigmas.map_or(0.0, f64::abs), (m.after - m.before).abs())
}

fn keep_worst(worst: &mut Vec<Move>, m: Move) {
    let place = worst.partition_point(|w| badness(w) >= badness(&m));
    if place < WORST {
        worst.insert(place, m);
        worst.truncate(WORST);
    }
}
