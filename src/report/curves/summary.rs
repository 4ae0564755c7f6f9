//! What the terminal and programs are told.

use super::figures::edits;

use super::words::{cost, metric_short, noise_word, slope_text, state_name};
use super::{CurvesReport, DifferenceReport, MeshReport};
use crate::metrics::Rate;
use crate::report::format::{percent_estimate, percent_exact, printable, significant};
use crate::study::converge::{At, Axis, Metric, mesh_rate};
use serde_json::{Value, json};

/// What it takes to reach each level, and the last error of every curve.
pub fn convergence_text(report: &CurvesReport) -> String {
    let states = edits(&report.curves);
    let last = states.last().copied().unwrap_or(0);
    let mut out = format!("convergence on {}\n", printable(&report.about.scene));
    for edit in states {
        out += &format!("\n{}\n", state_name(edit, last));
        for curve in report.curves.iter().filter(|c| c.edit == edit) {
            out += &format!("  {}\n", printable(&curve.method));
            for metric in Metric::ALL {
                let Some(error) = curve.points.iter().rev().find_map(|p| p.error(metric)) else { continue };
                let shown = percent_estimate(&error, false);
                let interval = shown.interval.map_or(String::new(), |i| format!(" ({i})"));
                out += &format!("    {:8} ends at {}{interval}\n", metric_short(metric), shown.value);
                out += &levels(report, &curve.method, edit, metric);
            }
        }
    }
    out + "\nCosts are those of snapshots: a level is reached at or before them.\n"
}

fn levels(report: &CurvesReport, method: &str, edit: usize, metric: Metric) -> String {
    let rows = report.digest.reached.iter().filter(|r| r.method == method && r.edit == edit && r.metric == metric);
    let line = |r: &crate::study::converge::ReachedRow| {
        let known = Axis::ALL.into_iter().zip(&r.costs).filter_map(|(a, c)| c.map(|c| (a, c)));
        let text = |(a, c): (Axis, crate::metrics::Reached)| {
            // Seconds bring their unit.
            let unit = if a.is_clock() { String::new() } else { format!(" {}", a.name()) };
            format!("{}{unit}", cost(c, a))
        };
        let reached: Vec<String> = known.filter(|(_, c)| c.by_value.is_some()).map(text).collect();
        let reached = if reached.is_empty() { "not reached".into() } else { reached.join(", ") };
        format!("      {:>4}: {reached}\n", percent_exact(r.level))
    };
    rows.map(line).collect()
}

/// Errors by mesh, and orders.
pub fn mesh_text(report: &MeshReport) -> String {
    let mut out = format!("error against mesh size on {}\n", printable(&report.about.scene));
    for curve in &report.curves {
        out += &format!("\n  {}\n", printable(&curve.method));
        for p in &curve.points {
            let error = p.rms.map_or("dark".into(), |e| {
                let shown = percent_estimate(&e, false);
                format!("{}{}", shown.value, shown.interval.map_or(String::new(), |i| format!(" ({i})")))
            });
            let (factor, size) = (p.size.factor, significant(p.size.mean_size, 3));
            out += &format!("    x{factor}: {} patches of {size} m: {error}\n", p.size.patches);
        }
        let order = mesh_rate(curve, report.about.confidence);
        let order = order.as_ref().map_or("too few meshes clear of the noise".into(), slope_text);
        out += &format!("    order {order}\n");
    }
    out
}

/// Ratios, one a line.
pub fn difference_text(report: &DifferenceReport) -> String {
    let [first, second] = &report.names;
    let mut out = format!("{} against {}\n", printable(second), printable(first));
    for d in &report.differences {
        let Some(ratio) = d.ratio() else { continue };
        let what = match d.at {
            At::Error(level) => format!("{} at {}", d.axis.name(), percent_exact(level)),
            At::Cost(x) => format!("error at {} {}", significant(x, 3), d.axis.name()),
        };
        let noise = d.noise().map_or("", noise_word);
        out += &format!(
            "  {}, edit {}, {}: {what}: ratio {} ({noise})\n",
            printable(&d.method),
            d.edit,
            metric_short(d.metric),
            significant(ratio, 3)
        );
    }
    out
}

fn rate_json(rate: Option<&Rate>) -> Value {
    rate.map_or(Value::Null, |r| json!({ "slope": r.slope, "points": r.points, "from": r.range.0, "to": r.range.1 }))
}

/// Rates and levels.
pub fn convergence_json(report: &CurvesReport) -> Value {
    let rates = report.digest.rates.iter().map(|r| {
        json!({ "method": r.method, "edit": r.edit, "metric": r.metric.name(), "axis": r.axis.name(),
                "rate": rate_json(r.rate.as_ref()) })
    });
    let reached = report.digest.reached.iter().map(|r| {
        let mut row = json!({ "method": r.method, "edit": r.edit, "metric": r.metric.name(), "level": r.level });
        for (k, axis) in Axis::ALL.iter().enumerate() {
            row[axis.name()] = r.costs[k].map_or(Value::Null, |c| {
                json!({ "by_value": c.by_value, "with_confidence": c.with_confidence,
                        "first_over_this": r.first_over_this[k] })
            });
        }
        row
    });
    let (rates, reached): (Vec<Value>, Vec<Value>) = (rates.collect(), reached.collect());
    let snapshots: usize = report.curves.iter().map(|c| c.points.len()).sum();
    json!({ "scene": report.about.scene, "confidence": report.about.confidence, "snapshots": snapshots,
            "reached": reached, "rates": rates, "notices": report.about.notices })
}

/// Meshes and orders.
pub fn mesh_json(report: &MeshReport) -> Value {
    let curve = |c: &crate::study::converge::MeshCurve| {
        let mesh = |p: &crate::study::converge::MeshPoint| {
            json!({ "factor": p.size.factor, "patches": p.size.patches, "longest_edge": p.size.longest_edge,
                    "mean_size": p.size.mean_size, "rms": p.rms, "noise_floor": p.noise_floor })
        };
        let meshes: Vec<Value> = c.points.iter().map(mesh).collect();
        let order = mesh_rate(c, report.about.confidence);
        json!({ "method": c.method, "meshes": meshes, "order": rate_json(order.as_ref()) })
    };
    let curves: Vec<Value> = report.curves.iter().map(curve).collect();
    json!({ "scene": report.about.scene, "confidence": report.about.confidence, "curves": curves })
}

/// Ratios.
pub fn difference_json(report: &DifferenceReport) -> Value {
    let row = |d: &crate::study::converge::Difference| {
        let (at, x) = match d.at {
            At::Error(x) => ("error", x),
            At::Cost(x) => ("cost", x),
        };
        let side = |s: Option<crate::study::converge::Side>| {
            s.map_or(Value::Null, |s| json!({ "value": s.value, "low": s.low, "high": s.high }))
        };
        json!({ "method": d.method, "edit": d.edit, "metric": d.metric.name(), "axis": d.axis.name(), "at": at,
                "at_value": x, "first": side(d.first), "second": side(d.second), "ratio": d.ratio(),
                "noise": d.noise().map(|n| n.name()) })
    };
    let rows: Vec<Value> = report.differences.iter().map(row).collect();
    json!({ "first": report.names[0], "second": report.names[1], "differences": rows })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::curves::testing::report;

    #[test]
    fn the_summary_names_levels_states_and_last_errors() {
        let text = convergence_text(&report());
        for part in ["Before the first edit", "After edit 1", "eq. 7", "top 1 %", "ends at", "3 %: ", "at or before"] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        let json = convergence_json(&report());
        assert_eq!(json["reached"][0]["level"], 0.1);
        assert!(json["rates"][0]["rate"]["slope"]["value"].is_number(), "{json}");
    }
}
