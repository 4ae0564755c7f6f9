//! Which drawings there are: one for each state, error and cost.

use super::words::{metric_name, slope_text, state_name};
use super::{CurvesReport, DifferenceReport, MeshReport};
use crate::metrics::{Rate, fit_rate};
use crate::report::chart::{Axis as ChartAxis, Block, Cell, Chart, Dot, Fit, Paint, Rule, Scale, Series, Shape, Unit};
use crate::report::format::{count, percent, percent_estimate, significant};
use crate::report::html::context::minus;
use crate::stats::Estimate;
use crate::study::converge::{Axis, Curve, CurvePoint, MeshCurve, Metric, mesh_rate};

/// A chart with the state it belongs to.
#[derive(Debug, Clone)]
pub(super) struct Drawing {
    pub chart: Block,
    /// State it belongs to.
    pub edit: usize,
    /// True if it depends on the machine.
    pub is_clock: bool,
}

/// What a cost is called.
fn what(axis: Axis) -> &'static str {
    match axis {
        Axis::Shots => "shots",
        Axis::Rays => "rays",
        Axis::Seconds => "seconds of computing",
    }
}

fn x_title(axis: Axis, edit: usize) -> String {
    if edit == 0 { what(axis).into() } else { format!("{} since the edit", what(axis)) }
}

/// Its column, as in the table of all curves.
fn column(axis: Axis, edit: usize) -> String {
    format!("{}{}", axis.name(), if edit == 0 { "" } else { "_since_edit" })
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

/// A power law over the points it rests on.
fn fit(rate: &Rate) -> Fit {
    let at = |x: f64| (x, (rate.intercept + rate.slope.value * x.ln()).exp());
    Fit { ends: [at(rate.range.0), at(rate.range.1)], text: format!("slope {}", slope_text(rate)) }
}

/// Error with its interval.
fn error_text(e: &Estimate) -> String {
    let shown = percent_estimate(e, false);
    minus(&shown.interval.map_or(shown.value.clone(), |i| format!("{} ({i})", shown.value)))
}

/// A cost with its unit.
fn cost_text(x: f64, axis: Axis) -> String {
    let unit = |one: &str| if x == 1.0 { one.to_string() } else { format!("{one}s") };
    match axis {
        Axis::Shots => format!("{} {}", count(x.round() as usize), unit("shot")),
        Axis::Rays => format!("{} {}", count(x.round() as usize), unit("ray")),
        Axis::Seconds => format!("{} s", significant(x, 3)),
    }
}

fn unit(axis: Axis) -> Unit {
    if axis.is_clock() { Unit::Plain } else { Unit::Count }
}

/// The costs told beside that of the axis: seconds only where the clock is spoken of anyhow.
fn beside(axis: Axis) -> impl Iterator<Item = Axis> {
    Axis::ALL.into_iter().filter(move |a| *a != axis && (!a.is_clock() || axis.is_clock()))
}

fn dot(p: &CurvePoint, metric: Metric, axis: Axis) -> Option<Dot> {
    let e = p.error(metric)?;
    let costs: Vec<String> = std::iter::once(axis).chain(beside(axis)).map(|a| cost_text(p.cost(a), a)).collect();
    let costs_beside = beside(axis).map(|a| Cell::Number(Some(p.cost(a)), unit(a)));
    Some(Dot {
        x: p.cost(axis),
        y: e.value,
        std_err: e.std_err,
        interval: Some((e.low, e.high)),
        hint: format!("{} at {}", error_text(&e), costs.join(", ")),
        more: costs_beside.chain([Cell::Number(p.floor(metric), Unit::Percent)]).collect(),
        ..Dot::default()
    })
}

fn line(curve: &Curve, metric: Metric, axis: Axis, colour: usize, confidence: f64) -> Series {
    let rate = fit_rate(&curve.against(metric, axis), confidence);
    Series {
        name: curve.method.clone(),
        paint: Paint::Method(colour),
        dashed: false,
        shape: Shape::Line,
        dots: curve.points.iter().filter_map(|p| dot(p, metric, axis)).collect(),
        fit: rate.as_ref().map(fit),
    }
}

/// The noise of the reference as a line across.
fn floor_rule(floor: Option<f64>) -> Vec<Rule> {
    let rule = |f: f64| Rule { value: f, name: format!("noise of the reference: {}", percent(f)) };
    floor.filter(|f| *f > 0.0).map(rule).into_iter().collect()
}

fn drawing(
    metric: Metric,
    axis: Axis,
    edit: usize,
    last: usize,
    curves: &[Curve],
    series: Vec<Series>,
) -> Option<Drawing> {
    let drawn = curves.iter().filter(|c| c.edit == edit && c.spends(axis));
    let floor = drawn
        .flat_map(|c| &c.points)
        .filter(|p| p.error(metric).is_some())
        .filter_map(|p| p.floor(metric))
        .reduce(f64::max);
    let against = if axis.is_clock() { "time" } else { axis.name() };
    let noise = (format!("{}noise_floor", if metric == Metric::Top1 { "top1_" } else { "" }), "noise of the reference");
    let chart = Chart {
        stem: format!("{}-{}-edit-{edit}", metric.name(), axis.name()),
        title: format!("{}: {} against {against}", state_name(edit, last), metric_name(metric)),
        caption: String::new(),
        x: ChartAxis { title: x_title(axis, edit), column: column(axis, edit), unit: unit(axis), scale: Scale::Log },
        y: ChartAxis {
            title: metric_name(metric).into(),
            column: metric.name().into(),
            unit: Unit::Percent,
            scale: Scale::Log,
        },
        series,
        rules: floor_rule(floor),
        more: beside(axis).map(|a| (column(a, edit), what(a))).chain([noise]).collect(),
    };
    Some(Drawing { chart: Block::of(&chart)?, edit, is_clock: axis.is_clock() })
}

/// Every combination of state, error and cost.
fn every(curves: &[Curve], series: impl Fn(Metric, Axis, usize) -> Vec<Series>) -> Vec<Drawing> {
    let edits = edits(curves);
    let last = edits.last().copied().unwrap_or(0);
    let mut out = Vec::new();
    for edit in edits {
        for metric in Metric::ALL {
            let of = |a| drawing(metric, a, edit, last, curves, series(metric, a, edit));
            out.extend(Axis::ALL.into_iter().filter_map(of));
        }
    }
    out
}

pub(super) fn of_curves(report: &CurvesReport) -> Vec<Drawing> {
    let methods = methods(&report.curves);
    let colour = |c: &Curve| methods.iter().position(|m| *m == c.method).unwrap_or(0);
    every(&report.curves, |metric, axis, edit| {
        let drawn = report.curves.iter().filter(|c| c.edit == edit && c.spends(axis));
        drawn.map(|c| line(c, metric, axis, colour(c), report.about.confidence)).collect()
    })
}

pub(super) fn of_difference(report: &DifferenceReport) -> Vec<Drawing> {
    let methods = methods(&report.curves[0]);
    let both =
        |a: &&Curve| report.curves.iter().all(|run| run.iter().any(|b| b.method == a.method && b.edit == a.edit));
    let shared: Vec<Curve> = report.curves.iter().flatten().filter(both).cloned().collect();
    every(&shared, |metric, axis, edit| {
        let mut lines = Vec::new();
        for (colour, method) in methods.iter().enumerate() {
            for (number, (run, name)) in report.curves.iter().zip(&report.names).enumerate() {
                let Some(c) = run.iter().find(|c| c.edit == edit && c.method == *method && c.spends(axis)) else {
                    continue;
                };
                let mut drawn = line(c, metric, axis, colour, report.about.confidence);
                drawn.name = format!("{name}: {method}");
                drawn.dashed = number == 1;
                lines.push(drawn);
            }
        }
        lines
    })
}

/// A method's meshes.
fn mesh_line(colour: usize, c: &MeshCurve, confidence: f64) -> Series {
    let dot = |p: &crate::study::converge::MeshPoint| {
        let e = p.rms?;
        let size = significant(p.size.mean_size, 3);
        Some(Dot {
            x: p.size.mean_size,
            y: e.value,
            std_err: e.std_err,
            interval: Some((e.low, e.high)),
            hint: format!("{} at {size} m, {} patches", error_text(&e), count(p.size.patches)),
            more: vec![
                Cell::Number(Some(f64::from(p.size.factor)), Unit::Count),
                Cell::Number(Some(p.size.patches as f64), Unit::Count),
                Cell::Number(p.noise_floor, Unit::Percent),
            ],
            ..Dot::default()
        })
    };
    Series {
        name: c.method.clone(),
        paint: Paint::Method(colour),
        dashed: false,
        shape: Shape::Line,
        dots: c.points.iter().filter_map(dot).collect(),
        fit: mesh_rate(c, confidence).as_ref().map(fit),
    }
}

pub(super) fn of_meshes(report: &MeshReport) -> Vec<Drawing> {
    let confidence = report.about.confidence;
    let points = report.curves.iter().flat_map(|c| &c.points).filter(|p| p.rms.is_some());
    let floor = points.filter_map(|p| p.noise_floor).reduce(f64::max);
    let chart = Chart {
        stem: "rms-size".into(),
        title: "Luminance error (eq. 7) against the size of the mesh".into(),
        caption: String::new(),
        x: ChartAxis {
            title: "mean size of a patch (square root of its area), m".into(),
            column: "mean_size".into(),
            unit: Unit::Plain,
            scale: Scale::Log,
        },
        y: ChartAxis {
            title: metric_name(Metric::Rms).into(),
            column: "rms".into(),
            unit: Unit::Percent,
            scale: Scale::Log,
        },
        series: report.curves.iter().enumerate().map(|(k, c)| mesh_line(k, c, confidence)).collect(),
        rules: floor_rule(floor),
        more: [("factor", "factor"), ("patches", "patches"), ("noise_floor", "noise of the reference")]
            .map(|(column, words)| (column.into(), words))
            .to_vec(),
    };
    Block::of(&chart).map(|chart| Drawing { chart, edit: 0, is_clock: false }).into_iter().collect()
}
