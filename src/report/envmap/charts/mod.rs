//! Which charts the page has, in sections.

mod distance;
mod filters;
mod parts;
mod sizes;

pub(super) use parts::reach;

use super::parts::bias;
use crate::report::chart::{Axis, Block, Cell, Chart, Dot, Paint, Rule, Scale, Series, Shape, Unit, round_step};
use crate::report::format::{percent, percent_exact};
use crate::report::number::number;
use crate::stats::Estimate;
use crate::study::envmap::EnvmapRecord;
use serde::Serialize;

/// Charts that belong together.
#[derive(Debug, Serialize)]
pub(super) struct Section {
    pub title: &'static str,
    pub lead: &'static str,
    pub charts: Vec<Block>,
    /// The table of filters follows.
    pub has_filters: bool,
}

/// Sections that have charts. None of them depends on the clock.
pub(super) fn sections(record: &EnvmapRecord) -> Vec<Section> {
    let section = |title, lead, charts: Vec<Option<Chart>>, has_filters| Section {
        title,
        lead,
        charts: charts.iter().flatten().filter_map(Block::of).collect(),
        has_filters,
    };
    let all = [
        section(
            "Where the map can be used",
            "How the error grows with the distance from the centre, in the open and over the object, and what is left of \
             it where light comes from a wider cone.",
            vec![parts::range(record), distance::points(record), parts::bands(record), parts::reflection(record)],
            false,
        ),
        section(
            "Fast filters",
            "Look-ups at constant cost against exact filtering of the same map, over all directions. Greene (1986) \
             claims that the cube filters better than latitude and longitude.",
            filters::charts(record).into_iter().map(Some).collect(),
            !record.filters.is_empty(),
        ),
        section(
            "What more would bring",
            "More texels, more centres, rays near by; and what is lost when one layout is turned into another.",
            vec![
                sizes::cubes(record),
                sizes::tables(record),
                parts::several(record),
                sizes::hybrid(record),
                sizes::round_trips(record),
            ],
            false,
        ),
    ];
    all.into_iter().filter(|s| !s.charts.is_empty() || s.has_filters).collect()
}

fn axis(title: &str, column: &str, unit: Unit) -> Axis {
    Axis { title: title.into(), column: column.into(), unit, scale: Scale::Log }
}

/// The axis of errors.
fn errors() -> Axis {
    axis("error", "error", Unit::Percent)
}

/// A linear scale on which `low` to `high` fit, its ends at marks.
fn linear(low: f64, high: f64) -> Scale {
    if high <= low {
        let half = 0.5 * low.abs().max(1e-9);
        return linear(low - half, high + half);
    }
    let step = round_step(high - low);
    Scale::Linear { low: (low / step).floor() * step, high: (high / step).ceil() * step, step }
}

/// An error with its interval at `x`; `place` says where that is.
fn dot(x: f64, e: &Estimate, place: &str) -> Dot {
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
fn exact_dot(x: f64, y: f64, place: &str) -> Dot {
    Dot { x, y, hint: format!("{} {place}", percent(y)), ..Dot::default() }
}

fn series(name: &str, paint: Paint, shape: Shape, dots: Vec<Dot>) -> Series {
    Series { name: name.into(), paint, dashed: false, shape, dots, fit: None }
}

fn line(name: &str, k: usize, dots: Vec<Dot>) -> Series {
    series(name, Paint::Method(k), Shape::Line, dots)
}

/// A chart without rules and further columns; the caller adds them.
fn chart(stem: &str, title: &str, mut caption: String, [x, y]: [Axis; 2], series: Vec<Series>) -> Option<Chart> {
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

/// The limit on the irradiance over the object as a line across.
fn limit(record: &EnvmapRecord) -> Vec<Rule> {
    let rule = |l| Rule { value: l, name: format!("limit {}", percent_exact(l)) };
    record.limit.map(rule).into_iter().collect()
}

/// A further cell in percent, to be found in the table alone.
fn percent_cell(x: Option<f64>) -> Cell {
    Cell::Number(x, Unit::Percent)
}

fn count_cell(n: usize) -> Cell {
    Cell::Number(Some(n as f64), Unit::Count)
}

fn columns(all: &[(&str, &'static str)]) -> Vec<(String, &'static str)> {
    all.iter().map(|(column, words)| (column.to_string(), *words)).collect()
}
