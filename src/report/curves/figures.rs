//! Which drawings there are: one for each state, error and cost.

use super::axis::Unit;
use super::plot::{Plot, PlotLine};
use super::words::{metric_name, state_name};
use super::{CurvesReport, DifferenceReport, MeshReport};
use crate::metrics::{Point, fit_rate};
use crate::study::converge::{Axis, Curve, Metric, mesh_rate};

/// A drawing with its file name.
#[derive(Debug, Clone)]
pub(super) struct Drawing {
    pub file: String,
    pub svg: String,
    /// State it belongs to.
    pub edit: usize,
    /// True if it depends on the machine.
    pub is_clock: bool,
}

fn x_title(axis: Axis, edit: usize) -> String {
    let what = match axis {
        Axis::Shots => "shots",
        Axis::Rays => "rays",
        Axis::Seconds => "seconds of computing",
    };
    if edit == 0 { what.into() } else { format!("{what} since the edit") }
}

/// States in rising order.
pub(super) fn edits(curves: &[Curve]) -> Vec<usize> {
    let mut edits: Vec<usize> = curves.iter().map(|c| c.edit).collect();
    edits.sort_unstable();
    edits.dedup();
    edits
}

/// Methods in order of appearance: each keeps its colour in every drawing.
fn methods(curves: &[Curve]) -> Vec<&str> {
    let mut out: Vec<&str> = Vec::new();
    for c in curves {
        if !out.contains(&c.method.as_str()) {
            out.push(&c.method);
        }
    }
    out
}

fn line(curve: &Curve, points: Vec<Point>, colour: usize, confidence: f64) -> PlotLine {
    let rate = fit_rate(&points, confidence);
    PlotLine { name: curve.method.clone(), points, rate, colour, dashed: false }
}

fn drawing(metric: Metric, axis: Axis, edit: usize, last: usize, lines: Vec<PlotLine>) -> Option<Drawing> {
    let floor = lines.iter().flat_map(|l| &l.points).filter_map(|p| p.floor).reduce(f64::max);
    let x_unit = if axis.is_clock() { Unit::Plain } else { Unit::Count };
    let against = if axis.is_clock() { "time" } else { axis.name() };
    let title = format!("{}: {} against {against}", state_name(edit, last), metric_name(metric));
    let plot = Plot { title, x_title: x_title(axis, edit), y_title: metric_name(metric).into(), x_unit, lines, floor };
    let file = format!("{}-{}-edit-{edit}.svg", metric.name(), axis.name());
    plot.svg().map(|svg| Drawing { file, svg, edit, is_clock: axis.is_clock() })
}

/// Every combination of state, error and cost.
fn every(curves: &[Curve], lines: impl Fn(Metric, Axis, usize) -> Vec<PlotLine>) -> Vec<Drawing> {
    let edits = edits(curves);
    let last = edits.last().copied().unwrap_or(0);
    let mut out = Vec::new();
    for edit in edits {
        for metric in Metric::ALL {
            out.extend(Axis::ALL.into_iter().filter_map(|a| drawing(metric, a, edit, last, lines(metric, a, edit))));
        }
    }
    out
}

pub(super) fn of_curves(report: &CurvesReport) -> Vec<Drawing> {
    let methods = methods(&report.curves);
    let colour = |c: &Curve| methods.iter().position(|m| *m == c.method).unwrap_or(0);
    every(&report.curves, |metric, axis, edit| {
        let drawn = report.curves.iter().filter(|c| c.edit == edit && c.spends(axis));
        drawn.map(|c| line(c, c.against(metric, axis), colour(c), report.about.confidence)).collect()
    })
}

pub(super) fn of_difference(report: &DifferenceReport) -> Vec<Drawing> {
    let methods = methods(&report.curves[0]);
    let shared: Vec<Curve> = report.curves[0]
        .iter()
        .filter(|a| report.curves[1].iter().any(|b| b.method == a.method && b.edit == a.edit))
        .cloned()
        .collect();
    every(&shared, |metric, axis, edit| {
        let mut lines = Vec::new();
        for (colour, method) in methods.iter().enumerate() {
            for (number, (run, name)) in report.curves.iter().zip(&report.names).enumerate() {
                let Some(c) = run.iter().find(|c| c.edit == edit && c.method == *method && c.spends(axis)) else {
                    continue;
                };
                let mut drawn = line(c, c.against(metric, axis), colour, report.about.confidence);
                drawn.name = format!("{name}: {method}");
                drawn.dashed = number == 1;
                lines.push(drawn);
            }
        }
        lines
    })
}

pub(super) fn of_meshes(report: &MeshReport) -> Vec<Drawing> {
    let lines: Vec<PlotLine> = report
        .curves
        .iter()
        .enumerate()
        .map(|(colour, c)| PlotLine {
            name: c.method.clone(),
            points: c.against_size(),
            rate: mesh_rate(c, report.about.confidence),
            colour,
            dashed: false,
        })
        .collect();
    let floor = lines.iter().flat_map(|l| &l.points).filter_map(|p| p.floor).reduce(f64::max);
    let plot = Plot {
        title: "Luminance error (eq. 7) against the size of the mesh".into(),
        x_title: "mean size of a patch (square root of its area), m".into(),
        y_title: metric_name(Metric::Rms).into(),
        x_unit: Unit::Plain,
        lines,
        floor,
    };
    let svg = plot.svg();
    svg.map(|svg| Drawing { file: "rms-size.svg".into(), svg, edit: 0, is_clock: false }).into_iter().collect()
}
