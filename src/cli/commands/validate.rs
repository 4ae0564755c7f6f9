//! `etalon validate`: published test suites.

use crate::cli::args::{DisplaySuiteArgs, SuiteArgs, ValidateCommand};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::estimate::Plan;
use crate::io::atomic;
use crate::raycast::KernelKind;
use crate::report::{brightness_files, save};
use crate::study::validate::{
    ABSOLUTE, CIE_LIMIT, DISPLAY_TOLERANCE, FALSE_ALARM, Measured, Outcome, RELATIVE, Route, Row, cie171, closed_forms,
    display,
};
use serde_json::json;

pub fn run(command: &ValidateCommand, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    match command {
        ValidateCommand::Cie171(args) => cie(args, kernel, console),
        ValidateCommand::ClosedForms(args) => forms(args, kernel, console),
        ValidateCommand::Display(args) => tones(args, console),
    }
}

fn plan(args: &SuiteArgs) -> Plan {
    Plan { rays: args.rays, randomisations: args.randomisations, ..Plan::default() }
}

fn cie(args: &SuiteArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let found = cie171(kernel, &plan(args), args.seed, console)?;
    console.end();
    let count = |outcome| found.iter().filter(|m| m.outcome == outcome).count();
    let (failed, open) = (count(Outcome::Fail), count(Outcome::Inconclusive));
    let mut text = format!(
        "{:<5}{:<34}{:>12}{:>14}{:>11}{:>8}{:>11}\n",
        "case", "value", "exact", "ours", "std err", "z", "off by"
    );
    for m in &found {
        let number = |x: Option<f64>, f: &dyn Fn(f64) -> String| x.map_or("-".into(), f);
        text += &format!(
            "{:<5}{:<34}{:>12}{:>14}{:>11}{:>8}{:>11}  {}\n",
            m.case,
            format!("{}, {}", m.what, m.unit),
            format!("{:.4}", m.exact),
            format!("{:.4}", m.ours),
            number(m.std_err, &|s| format!("{s:.1e}")),
            number(m.z, &|z| format!("{z:.2}")),
            number(m.deviation, &|d| format!("{:.4} %", 100.0 * d)),
            word(m),
        );
    }
    let verdict = match (failed, open) {
        (0, 0) => {
            format!("validated against CIE 171:2006, cases 5.2, 5.3, 5.4, 5.6, 5.7 and 5.8: all {} values", found.len())
        }
        (0, _) => format!("inconclusive: {open} of {} values need more --rays", found.len()),
        _ => format!("{failed} of {} values differ by more than their errors explain", found.len()),
    };
    text += &format!(
        "{verdict}\n(limit {} % per value; a sound engine fails by chance with a probability of at most {FALSE_ALARM:.0e})",
        100.0 * CIE_LIMIT
    );
    let json = json!({
        "suite": "CIE 171:2006", "values": found, "failed": failed, "inconclusive": open, "limit": CIE_LIMIT,
        "false_alarm": FALSE_ALARM, "verdict": verdict,
    });
    console.result(&text, &json);
    Ok(match (failed, open) {
        (0, 0) => exit::DONE,
        (0, _) => exit::INCONCLUSIVE,
        _ => exit::FAIL,
    })
}

fn word(m: &Measured) -> &'static str {
    match m.outcome {
        Outcome::Pass => "ok",
        Outcome::Fail => "FAILED",
        Outcome::Inconclusive => "too few rays",
    }
}

fn forms(args: &SuiteArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let rows = closed_forms(kernel, &plan(args), args.seed, console)?;
    console.end();
    let failed = rows.iter().filter(|r| !r.passed).count();
    let mut text = format!("{:<26}{:<5}{:<26}{:>22}{:>11}{:>11}\n", "case", "", "by", "exact", "error", "std err");
    for r in &rows {
        text += &format!(
            "{:<26}{:<5}{:<26}{:>22}{:>11}{:>11}  {}\n",
            r.case,
            r.direction,
            r.function,
            format!("{:.15}", r.exact),
            r.error.map_or("-".into(), |e| format!("{e:.1e}")),
            r.std_err.map_or("-".into(), |e| format!("{e:.1e}")),
            if r.passed { "ok" } else { "FAILED" },
        );
    }
    text += &summary(&rows);
    let json = json!({
        "suite": "closed forms", "values": rows, "failed": failed, "relative": RELATIVE, "absolute": ABSOLUTE,
        "false_alarm": FALSE_ALARM,
    });
    console.result(&text, &json);
    Ok(if failed == 0 { exit::DONE } else { exit::FAIL })
}

fn tones(args: &DisplaySuiteArgs, console: &Console) -> Result<u8, Failure> {
    args.output.as_deref().map(atomic::check_folder).transpose()?;
    let suite = display();
    let failed = suite.rows.iter().filter(|r| !r.passed).count();
    let head = ["adapted to", "scene", "screen, exact", "ours", "n, exact", "ours"];
    let mut text = head.map(|h| format!("{h:>19}")).concat() + "\n";
    for r in &suite.rows {
        let cells = [r.adapted_to, r.luminance, r.screen[0], r.screen[1], r.value[0], r.value[1]];
        text += &cells.map(|x| format!("{x:>19.10}")).concat();
        text += if r.passed { "  ok\n" } else { "  FAILED\n" };
    }
    text += &format!(
        "{} of {} values hold to {DISPLAY_TOLERANCE:.0e} (luminances in cd/m^2, on the screen of 1993)\nthe power law is \
         Stevens' law within {:.0e}",
        suite.rows.len() - failed,
        suite.rows.len(),
        suite.law
    );
    if let Some(folder) = &args.output {
        save(folder, &brightness_files(&suite.curves)?)?;
        text += &format!("\nhis curves are in {}", folder.display());
    }
    let json = json!({ "suite": "display", "values": suite.rows, "failed": failed, "tolerance": DISPLAY_TOLERANCE, "law": suite.law });
    console.result(&text, &json);
    Ok(if failed == 0 && suite.law < DISPLAY_TOLERANCE { exit::DONE } else { exit::FAIL })
}

/// One line per route, and the verdict.
fn summary(rows: &[Row]) -> String {
    let mut text = String::new();
    let routes = [
        (Route::Polygon, "polygon integrals, no rays"),
        (Route::Catalogue, "catalogue, no rays"),
        (Route::Shadows, "obstructed, exact shadows, witnessed by rays"),
        (Route::None, "not answered"),
    ];
    for (route, name) in routes {
        let of: Vec<&Row> = rows.iter().filter(|r| r.route == route).collect();
        if of.is_empty() {
            continue;
        }
        let good = of.iter().filter(|r| r.passed).count();
        let worst = of.iter().filter_map(|r| r.error).map(f64::abs).fold(0.0, f64::max);
        text += &format!("{name}: {good} of {} values, largest error {worst:.1e}\n", of.len());
    }
    let passed = rows.iter().filter(|r| r.passed).count();
    text + &format!(
        "{passed} of {} values hold (closed forms to {RELATIVE:.0e} relative or {ABSOLUTE:.0e} absolute; values by rays inside \
         intervals that miss by chance with a probability of at most {FALSE_ALARM:.0e} in all)",
        rows.len()
    )
}
