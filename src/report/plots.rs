//! Charts of errors, as pages of audits have them: put together from a few words each.

use super::chart::{Axis, Cell, Chart, Dot, Paint, Rule, Scale, Series, Shape, Unit, round_step};
use super::format::{percent, percent_exact};
use super::number::number;
use crate::stats::Estimate;

/// A logarithmic axis.
pub(super) fn axis(title: &str, column: &str, unit: Unit) -> Axis {
    Axis { title: title.into(), column: column.into(), unit, scale: Scale::Log }
}

/// The axis of errors.
pub(super) fn errors() -> Axis {
    axis("error", "error", Unit::Percent)
}

/// A linear scale on which `low` to `high` fit, its ends at marks.
pub(super) fn linear(low: f64, high: f64) -> Scale {
    if high <= low {
        let half = 0.5 * low.abs().max(1e-9);
        return linear(low - half, high + half);
    }
    let step = round_step(high - low);
    Scale::Linear { low: (low / step).floor() * step, high: (high / step).ceil() * step, step }
}

/// An error with its interval at `x`; `place` says where that is.
pub(super) fn dot(x: f64, e: &Estimate, place: &str) -> Dot {
    Dot {
        x,
        y: e.value,
        std_err: e.std_err,
        interval: Some((e.low, e.high)),
        hint: format!("{} {place}", number(Some(e)).in_line()),
        ..Dot::default()
    }
}

/// A number without an interval.
pub(super) fn exact_dot(x: f64, y: f64, place: &str) -> Dot {
    Dot { x, y, hint: format!("{} {place}", percent(y)), ..Dot::default() }
}

pub(super) fn series(name: &str, paint: Paint, shape: Shape, dots: Vec<Dot>) -> Series {
    Series { name: name.into(), paint, dashed: false, shape, dots, fit: None }
}

pub(super) fn line(name: &str, k: usize, dots: Vec<Dot>) -> Series {
    series(name, Paint::Method(k), Shape::Line, dots)
}

/// A chart without rules and further columns; the caller adds them.
pub(super) fn chart(
    stem: &str,
    title: &str,
    mut caption: String,
    [x, y]: [Axis; 2],
    series: Vec<Series>,
) -> Option<Chart> {
    let dots = || series.iter().flat_map(|s| &s.dots);
    // 0 has no place on a logarithmic axis.
    if y.scale == Scale::Log && dots().any(|d| d.y == 0.0) {
        let blank = if caption.is_empty() { "" } else { " " };
        caption += &format!("{blank}An error of 0 stands at the lower end.");
    }
    let any = dots().next().is_some();
    let chart = Chart { stem: stem.into(), title: title.into(), caption, x, y, series, rules: vec![], more: vec![] };
    any.then_some(chart)
}

/// A limit as a line across.
pub(super) fn limit(limit: Option<f64>) -> Vec<Rule> {
    let rule = |l| Rule { value: l, name: format!("limit {}", percent_exact(l)) };
    limit.map(rule).into_iter().collect()
}

/// A further cell in percent, to be found in the table alone.
pub(super) fn percent_cell(x: Option<f64>) -> Cell {
    Cell::Number(x, Unit::Percent)
}

pub(super) fn count_cell(n: usize) -> Cell {
    Cell::Number(Some(n as f64), Unit::Count)
}

pub(super) fn columns(all: &[(&str, &'static str)]) -> Vec<(String, &'static str)> {
    all.iter().map(|(column, words)| (column.to_string(), *words)).collect()
}
