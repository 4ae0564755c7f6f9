//! What `form-factors compare` says to people.

use super::form_factors_told as matrix_told;
use super::inputs::thousands;
use crate::formfactor::{Layout, Physics};
use crate::metrics::{Decision, MatrixComparison, Rounding, Verdict};
use crate::stats::Estimate;
use crate::study::{Explanation, MatrixRun, Witness};
use std::fmt::Write;
use std::path::Path;

/// What is compared with what.
pub struct Subject<'a> {
    pub file: &'a Path,
    pub judge: &'a str,
    /// "patches" or "surfaces".
    pub rows: &'a str,
    /// Name of the surface of each row.
    pub names: &'a [String],
}

/// A comparison, in lines.
pub fn run(subject: &Subject, run: &MatrixRun, decision: Option<&Decision>) -> String {
    let c = &run.comparison;
    let mut out = format!(
        "{} against {}: {} {}, {} entries\n",
        subject.file.display(),
        subject.judge,
        thousands(c.present as u64),
        subject.rows,
        thousands(c.compared as u64)
    );
    norms(&mut out, c);
    errors(&mut out, c);
    if let Some(e) = &run.explanation {
        let _ = writeln!(out, "likely cause: {}; without that {:.2e} is left", explained(e), e.relative_after);
    }
    for (whose, p) in [("theirs", &run.theirs), ("judge", &run.judge)] {
        let _ = writeln!(out, "{whose:<7} {}", physics(p));
    }
    worst(&mut out, subject, run);
    if let Some(d) = decision {
        out.push_str(&verdict(d));
    }
    out.trim_end().to_string()
}

fn norms(out: &mut String, c: &MatrixComparison) {
    let percent = (100.0 * c.confidence * 10.0).round() / 10.0;
    let interval = |e: &Estimate| format!("{:.3e}  ({:.3e} to {:.3e})", e.value, e.low, e.high);
    let _ = writeln!(out, "  rms difference      {}  {percent} % interval", interval(&c.rms));
    let _ = writeln!(out, "  relative norm       {}", interval(&c.relative));
    let _ = writeln!(out, "  largest difference  {}", interval(&c.largest));
    if let Some(noise) = c.judge_noise {
        let _ = writeln!(out, "  judge's own error   {noise:.3e} rms");
    }
}

fn errors(out: &mut String, c: &MatrixComparison) {
    match c.rounding {
        Some(Rounding::Decimals(d)) => {
            let noise = c.rounding_noise.unwrap_or(0.0);
            let _ = writeln!(
                out,
                "their values are whole multiples of 1e-{d}: {noise:.1e} rms and 5e-{} at most of rounding is expected",
                d + 1
            );
        }
        Some(Rounding::Single) => {
            let _ = writeln!(out, "their values are of single precision: rounding of 3e-8 of each is expected");
        }
        None => {}
    }
    let beside = match (c.stated_noise, c.honesty) {
        (Some(stated), Some(ratio)) => {
            let interval = format!("{:.3}  ({:.3} to {:.3})", ratio.value, ratio.low, ratio.high);
            let _ = writeln!(out, "they state an error of {stated:.3e} rms; the difference is {interval} times that");
            "the errors of both"
        }
        _ => "rounding and the judge's errors (they state none)",
    };
    let _ = writeln!(
        out,
        "{} of {} entries differ by more than {beside}; one false alarm in {:.0} right matrices",
        thousands(c.beyond as u64),
        thousands(c.compared as u64),
        1.0 / c.false_alarm
    );
}

fn explained(e: &Explanation) -> String {
    match (&e.mistake, e.row_factors) {
        (Some(m), _) if m.layout == Layout::AsIs || m.scale != 1.0 => matrix_told::mistake(m),
        (Some(m), _) => matrix_told::mistake(m),
        (None, Some((low, high))) => {
            format!("each row is scaled by a factor of its own, {low:.5} to {high:.5} (rows normalised?)")
        }
        (None, None) => String::new(),
    }
}

fn physics(p: &Physics) -> String {
    let sums = if p.closed { "row sums off by" } else { "row sums above 1 by" };
    let r = &p.residue;
    format!(
        "{sums} up to {:.1e}; reciprocity by up to {:.1e}{}",
        r.largest_closure,
        r.largest_reciprocity,
        if p.broken { "; breaks physics for sure" } else { "" }
    )
}

fn worst(out: &mut String, subject: &Subject, run: &MatrixRun) {
    if run.witnesses.is_empty() {
        return;
    }
    let _ = writeln!(out, "worst entries");
    let _ = writeln!(out, "  from   to     theirs       judge        difference   std err   reciprocity theirs, judge");
    for w in &run.witnesses {
        let e = &w.entry;
        let errors = [e.their_std_err, e.judge_std_err].into_iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        let _ = writeln!(
            out,
            "  {:<6} {:<6} {:<12.7} {:<12.7} {:<+12.2e} {errors:<9.1e} {:+.1e}, {:+.1e}  {} to {}{}",
            e.row,
            e.column,
            e.theirs,
            e.judge,
            e.difference,
            w.their_reciprocity,
            w.judge_reciprocity,
            subject.names[e.row],
            subject.names[e.column],
            blame(w)
        );
    }
}

fn blame(w: &Witness) -> &'static str {
    if w.speaks_against_them() {
        "  [theirs breaks physics here]"
    } else if w.speaks_against_the_judge() {
        "  [the judge breaks physics here]"
    } else {
        ""
    }
}

fn verdict(d: &Decision) -> String {
    let word = |v: Verdict| match v {
        Verdict::Pass => "PASS",
        Verdict::Fail => "FAIL",
        Verdict::Inconclusive => "INCONCLUSIVE",
    };
    let mut out = String::new();
    for l in &d.limits {
        let more = l.rays_factor.map_or(String::new(), |x| format!("; {x:.0} times the rays would decide"));
        let what = if l.metric == "relative" { "relative norm" } else { "largest difference" };
        let _ = writeln!(out, "{} {what}: limit {:.3e}{more}", word(l.verdict), l.limit);
    }
    out + word(d.verdict)
}
