//! Charts. One description, and from it: a drawing for print ([`Chart::svg`]), a table for programs ([`Chart::csv`]), and
//! what the page's script draws to be pointed at ([`Chart::data`]).

mod axis;
mod block;
mod data;
mod draw;
mod labels;
mod legend;
mod paint;
mod svg;
mod table;
#[cfg(test)]
pub(super) mod testing;
#[cfg(test)]
mod tests;

pub(super) use axis::{Axis, Scale, Unit, round_step};
pub(super) use block::{Block, Library, STYLE, TEMPLATE, files};
pub(super) use paint::Paint;

/// A chart to be made.
#[derive(Debug, Clone)]
pub(super) struct Chart {
    /// Stem of its files; its name within the page.
    pub stem: String,
    pub title: String,
    /// What stands beside it in the page.
    pub caption: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    /// Lines across.
    pub rules: Vec<Rule>,
    /// What the further cells of each point are: column of the table, and the same in words.
    pub more: Vec<(String, &'static str)>,
}

/// Points of one colour.
#[derive(Debug, Clone)]
pub(super) struct Series {
    /// Empty where there is but one, with nothing to be said of it.
    pub name: String,
    pub paint: Paint,
    /// Drawn with dashes.
    pub dashed: bool,
    pub shape: Shape,
    pub dots: Vec<Dot>,
    /// A fitted line, dotted.
    pub fit: Option<Fit>,
}

/// How points are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// Joined, with a band between the ends of the intervals.
    Line,
    /// Each by itself.
    Dots,
    /// Bars from the axis up.
    Bars,
    /// A step over the width of each point.
    Steps,
}

/// A point of a chart.
#[derive(Debug, Clone, Default)]
pub(super) struct Dot {
    pub x: f64,
    pub y: f64,
    pub std_err: Option<f64>,
    pub interval: Option<(f64, f64)>,
    /// What a bar or a step counts: from, to; its drawn place and width may differ, where an end is open.
    pub span: Option<(f64, f64)>,
    /// Drawn width of a bar or a step.
    pub width: f64,
    /// Written beside the point.
    pub label: Option<String>,
    /// What a reader is told who points at it.
    pub hint: String,
    /// Further cells of the table.
    pub more: Vec<Cell>,
}

/// A further cell of the table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell {
    /// A number; what is not known stays empty.
    Number(Option<f64>, Unit),
    Text(String),
}

/// A line fitted through points.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub ends: [(f64, f64); 2],
    /// What it says, in the legend.
    pub text: String,
}

/// A line across the chart.
#[derive(Debug, Clone)]
pub(super) struct Rule {
    pub value: f64,
    /// What it is; nothing is written where this is empty.
    pub name: String,
}

impl Chart {
    /// Every point.
    fn dots(&self) -> impl Iterator<Item = &Dot> {
        self.series.iter().flat_map(|s| &s.dots)
    }

    /// True if a series is made of bars.
    fn has_bars(&self) -> bool {
        self.series.iter().any(|s| s.shape == Shape::Bars)
    }
}

/// False for what stands for "no end" or "not known".
fn is_finite(x: f64) -> bool {
    x.abs() < 1e300
}
