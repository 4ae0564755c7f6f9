//! `etalon baseline save|diff|update`

use super::bench::Bench;
use super::{inputs, limits};
use crate::cli::args::{BaselineChangeArgs, BaselineCommand, BaselineSaveArgs, CompareArgs};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::metrics::{Change, Limit, Limits, Metric};
use crate::report::change_lines;
use crate::study::{Baseline, Judgement, Question, Taken, judge};
use serde_json::json;
use std::path::Path;

/// A suggested limit leaves this much above what the solution may surely have.
const HEADROOM: f64 = 1.1;

pub fn run(command: &BaselineCommand, console: &Console) -> Result<u8, Failure> {
    match command {
        BaselineCommand::Save(args) => save(args, console),
        BaselineCommand::Diff(args) => change(args, false, console),
        BaselineCommand::Update(args) => change(args, true, console),
    }
}

fn save(args: &BaselineSaveArgs, console: &Console) -> Result<u8, Failure> {
    let path = &args.output;
    if path.exists() {
        let message = format!(
            "{} is there already: `etalon baseline update` puts another solution in its place and says what changes",
            path.display()
        );
        return Err(Failure::input(message).at(path.display().to_string()));
    }
    inputs::check_writable(path)?;
    let bench = read(&args.compare, console)?;
    let (baseline, judgement) = take(&bench, &args.compare)?;
    baseline.write(path)?;
    let suggested = suggested(&judgement);
    let options: Vec<String> =
        suggested.iter().map(|l| format!("--max-{} {}%", l.key(), shortest(100.0 * l.max))).collect();
    let text = format!(
        "{}: baseline of {} written\n  no worse than it:  etalon check MINE --reference {}{} --baseline {}\n  \
         limits it keeps:   {}",
        path.display(),
        args.compare.solution.display(),
        args.compare.reference.display(),
        if args.compare.reflected { " --reflected" } else { "" },
        path.display(),
        options.join(" ")
    );
    let limits: serde_json::Map<String, serde_json::Value> =
        suggested.iter().map(|l| (l.key(), json!(l.max))).collect();
    console.result(&text, &json!({ "baseline": path, "metrics": baseline.metrics, "suggested_limits": limits }));
    Ok(exit::DONE)
}

fn change(args: &BaselineChangeArgs, replace: bool, console: &Console) -> Result<u8, Failure> {
    if replace {
        inputs::check_writable(&args.baseline)?;
    }
    let bench = read(&args.compare, console)?;
    let old = limits::baseline(&args.baseline, &bench, &args.compare)?;
    let changes = old.changes(&bench.solution, &bench.against, &bench.receivers, &question(&args.compare, &bench))?;
    if replace {
        let (new, _) = take(&bench, &args.compare)?;
        new.write(&args.baseline)?;
    }
    let done = if replace { "is now the baseline; before" } else { "against the baseline of" };
    let text = format!("{} {done} {}\n\n{}", args.compare.solution.display(), old.solution, change_lines(&changes));
    let json = json!({
        "baseline": args.baseline, "before": old.solution, "after": args.compare.solution, "updated": replace,
        "changed": is_changed(&changes), "changes": changes,
    });
    console.result(text.trim_end(), &json);
    Ok(exit::DONE)
}

/// True if any metric moved.
fn is_changed(changes: &[Change]) -> bool {
    changes.iter().any(|c| c.before.value != c.after.value)
}

fn read(args: &CompareArgs, console: &Console) -> Result<Bench, Failure> {
    if args.residual.residual {
        return Err(Failure::input("a baseline is judged by a reference: leave out --residual"));
    }
    refuse_pages(args)?;
    let bench = Bench::read(args, true, console)?;
    if bench.reference().is_none() {
        let message = "a baseline is judged by a reference directory, and --reference is a solution";
        return Err(Failure::input(message).at(args.reference.display().to_string()));
    }
    Ok(bench)
}

/// Files that only a check writes.
fn refuse_pages(args: &CompareArgs) -> Result<(), Failure> {
    let asked: [(&str, Option<&Path>); 4] = [
        ("--report", args.report.as_deref()),
        ("--markdown", args.markdown.as_deref()),
        ("--form-factors", args.form_factors.as_deref()),
        ("--patch-system", args.patch_system.as_deref()),
    ];
    match asked.iter().find(|(_, path)| path.is_some()) {
        Some((name, _)) => Err(Failure::input(format!("{name} belongs to `etalon check`: leave it out here"))),
        None => Ok(()),
    }
}

fn question(args: &CompareArgs, bench: &Bench) -> Question {
    Question {
        confidence: args.confidence.0,
        reflected: args.reflected,
        per_element: bench.per_element,
        ..Question::default()
    }
}

/// The baseline of what is judged, with the measures that limits are suggested from.
fn take(bench: &Bench, args: &CompareArgs) -> Result<(Baseline, Judgement), Failure> {
    let reference = bench.reference().expect("read as one");
    let whole = [Metric::Rms, Metric::Worst, Metric::Energy];
    let limits: Limits = whole.into_iter().map(|m| Limit::new(m, 0.0)).collect();
    let question = Question { limits: Some(limits), ..question(args, bench) };
    let judgement = judge(&bench.solution, &bench.against, None, &bench.receivers, &question)?;
    let taken = Taken {
        reference,
        solution: &bench.solution,
        name: &args.solution.display().to_string(),
        comparison: &judgement.comparison,
        per_element: bench.per_element,
        reflected: args.reflected,
    };
    Ok((Baseline::of(&taken), judgement))
}

/// Limits that this solution keeps with a tenth to spare, to two figures; none on what is not known.
fn suggested(judgement: &Judgement) -> Vec<Limit> {
    let outcomes = judgement.decision.iter().flat_map(|d| &d.limits);
    let of = |(o, metric): (&crate::metrics::LimitOutcome, Metric)| {
        let high = o.estimate.high;
        (high < f64::MAX).then(|| Limit::new(metric, two_figures_up(HEADROOM * high)))
    };
    outcomes.zip([Metric::Rms, Metric::Worst, Metric::Energy]).filter_map(of).collect()
}

/// Rounded up to two figures; never below a thousandth of a per cent, where rounding rules.
fn two_figures_up(x: f64) -> f64 {
    let x = x.max(1e-5);
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    (x / unit * (1.0 - 1e-12)).ceil() * unit
}

/// A number as short as it can be said.
fn shortest(x: f64) -> String {
    let text = format!("{x:.7}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_round_and_above() {
        assert_eq!(shortest(100.0 * two_figures_up(0.03312)), "3.4");
        assert_eq!(shortest(100.0 * two_figures_up(0.12)), "12");
        assert_eq!(shortest(100.0 * two_figures_up(0.0)), "0.001");
    }
}
