//! What `form-factors check`, `repair` and `--enforce` say to people.

use super::inputs::thousands;
use crate::formfactor::{
    Enforcement, ErrorsAfter, Impossible, Layout, Mistake, Move, PairDefect, Physics, Reason, RowDefect, Tested,
    Weights,
};
use crate::scene::Stage;
use std::fmt::Write;
use std::path::Path;

/// So many of the worst are printed; `--json` has ten.
const SHOWN: usize = 3;

/// A judgement, in lines.
pub fn physics(file: &Path, stage: &Stage, p: &Physics) -> String {
    let mut out = format!(
        "{}: {n} x {n}, {} stored; the scene is {}; standard errors {}\n",
        file.display(),
        thousands(p.stored as u64),
        if p.closed { "closed" } else { "open" },
        if p.errors_known { "known" } else { "not stated" },
        n = stage.patch_count(),
    );
    let r = &p.residue;
    let off = if p.closed { "row sums off by" } else { "row sums above 1 by" };
    let _ = writeln!(
        out,
        "{off} up to {:.2e}, rms {:.2e}{}",
        r.largest_closure,
        r.rms_closure,
        verdicts(&p.closure, "rows")
    );
    for d in p.closure.worst.iter().filter(|d| d.broken).take(SHOWN) {
        let _ = writeln!(out, "  {}", row(stage, d));
    }
    let _ = writeln!(
        out,
        "reciprocity off by up to {:.2e} of a factor, one-sided {:.2e} of all exchange{}",
        r.largest_reciprocity,
        r.one_sided,
        verdicts(&p.reciprocity, "pairs")
    );
    for d in p.reciprocity.worst.iter().filter(|d| d.broken).take(SHOWN) {
        let _ = writeln!(out, "  {}", pair(stage, d));
    }
    for i in &p.impossible {
        let _ = writeln!(out, "{}", impossible(i));
    }
    if let Some(m) = &p.mistake {
        let _ = writeln!(out, "likely cause: {}; `etalon form-factors repair` undoes it", mistake(m));
    }
    out + &verdict(p)
}

fn verdict(p: &Physics) -> String {
    let tolerance = p.rule.tolerance;
    let by = match p.threshold {
        Some(t) => format!(
            "beyond {tolerance:e} and {t:.1} standard errors: one false alarm in {:.0e} sound matrices",
            1.0 / p.rule.false_alarm
        ),
        None => format!("beyond a tolerance of {tolerance:e}; the file states no errors, so chance is not weighed"),
    };
    let outcome = if p.broken { "breaks physics" } else { "nothing breaks physics" };
    format!("{outcome} ({by})")
}

fn verdicts<T>(t: &Tested<T>, what: &str) -> String {
    let sigmas = t.rms_sigmas.map_or(String::new(), |s| format!(" ({s:.2} standard errors rms)"));
    format!("{sigmas}; {} of {} {what} wrong for sure", thousands(t.broken as u64), thousands(t.tested as u64))
}

fn patch(stage: &Stage, i: usize) -> String {
    format!("patch {i} ({})", stage.surface_name(i))
}

fn in_sigmas(sigmas: Option<f64>) -> String {
    sigmas.map_or(String::new(), |s| format!(", {s:+.1} standard errors"))
}

fn row(stage: &Stage, d: &RowDefect) -> String {
    format!("{}: row sum {:.6}{}", patch(stage, d.row), 1.0 + d.defect, in_sigmas(d.sigmas))
}

fn pair(stage: &Stage, d: &PairDefect) -> String {
    let (i, j) = d.pair;
    let sides = format!("{} and {}", patch(stage, i), patch(stage, j));
    format!("{sides}: A_i F_ij - A_j F_ji = {:.3e} m^2{}", d.defect, in_sigmas(d.sigmas))
}

fn impossible(i: &Impossible) -> String {
    let why = match i.reason {
        Reason::NotANumber => "are not numbers",
        Reason::Negative => "are negative",
        Reason::AboveOne => "are above 1",
        Reason::AbsentPatch => "are of patches that take no part in this state",
        Reason::SeesItself => "are on the diagonal, but planar patches do not see themselves",
        Reason::FacingAway => "are between patches that face away or lie in one plane",
        Reason::AboveUnobstructed => "are larger than with nothing in between",
    };
    let (row, column) = i.worst;
    format!(
        "impossible: {} entries {why} (worst: F({row}, {column}) = {:.6}, off by {:.2e})",
        thousands(i.entries as u64),
        i.value,
        i.excess
    )
}

/// A mistake, as the end of "the matrix ...".
pub fn mistake(m: &Mistake) -> String {
    let layout = match m.layout {
        Layout::AsIs => None,
        Layout::Transposed => Some("the matrix is transposed (F_ij stands in row j)"),
        Layout::ExchangeAreas => Some("the matrix holds exchange areas A_i F_ij, not form factors"),
        Layout::OneTriangle => Some("the matrix holds each pair in one direction only"),
    };
    let scale = (m.scale != 1.0).then(|| {
        let ratio = m.constant.as_ref().map_or(String::new(), |c| format!(" (the ratio is {c})"));
        format!("all entries are {:.5} x what they should be{ratio}", m.scale)
    });
    let parts: Vec<String> = layout.map(String::from).into_iter().chain(scale).collect();
    parts.join(", and ")
}

/// What enforcement did, in lines.
pub fn enforcement(stage: &Stage, e: &Enforcement) -> String {
    let weights = match e.weights {
        Weights::StandardErrors => "weighed by the standard errors",
        Weights::ProportionalToExchange => "no errors are stated: variances taken as proportional to the exchange",
    };
    let errors = match e.errors {
        ErrorsAfter::Propagated => "standard errors carried through all constraints",
        ErrorsAfter::Bound => "standard errors are upper bounds (one constraint at a time)",
        ErrorsAfter::Unknown => "standard errors unknown",
    };
    let (b, a) = (&e.before, &e.after);
    let mut out = format!(
        "closure and reciprocity enforced in {} steps ({weights}; {errors})\n\
         row sums off by up to {:.2e}, now {:.2e}; reciprocity off by up to {:.2e}, now {:.2e}\n\
         values moved by up to {:.2e}",
        e.steps, b.largest_closure, a.largest_closure, b.largest_reciprocity, a.largest_reciprocity, e.moves.largest
    );
    if let (Some(max), Some(rms), Some(share)) = (e.moves.max_sigmas, e.moves.rms_sigmas, e.moves.share_above_3) {
        let _ = write!(out, ", {max:.1} standard errors ({rms:.2} rms, {:.2} % above 3)", 100.0 * share);
    }
    for m in e.moves.worst.iter().filter(|m| m.sigmas.is_none_or(|s| s.abs() > 3.0) && m.after != m.before).take(SHOWN)
    {
        let _ = write!(out, "\n  {}", moved(m));
    }
    for (count, what) in [
        (e.forbidden, "entries that geometry forbids taken out"),
        (e.pressed_to_zero, "pairs pressed to 0 (they would have become negative)"),
        (e.opened, "pairs never hit opened, since their rows could not be closed otherwise"),
        (e.moves.exact_moved, "values stated as exact had to move: their errors are wrong"),
    ] {
        if count > 0 {
            let _ = write!(out, "\n{} {what}", thousands(count as u64));
        }
    }
    for u in e.unmet.iter().take(SHOWN) {
        let _ = write!(out, "\n{}: row sum {:.6}, nothing in it is free to move", patch(stage, u.row), 1.0 + u.defect);
    }
    if e.unmet.len() > SHOWN {
        let _ = write!(out, "\n{} rows could not be closed", e.unmet.len());
    }
    out
}

fn moved(m: &Move) -> String {
    format!("F({}, {}): {:.6} to {:.6}{}", m.from, m.to, m.before, m.after, in_sigmas(m.sigmas))
}
