//! A chart as a table: CSV with numbers that read back exactly, and rows to be read.

use super::axis::Scale;
use super::{Cell, Chart, Dot, Series, Unit, is_finite};
use crate::report::format::percent_estimate;
use crate::report::html::context::minus;
use crate::stats::Estimate;

/// Rows that stand in the page; the file has all.
const ROWS: usize = 200;

/// Rows for readers.
#[derive(Debug)]
pub(super) struct Rows {
    pub head: Vec<String>,
    pub rows: Vec<Vec<String>>,
    /// Rows there are.
    pub all: usize,
}

/// Which columns there are.
struct Columns {
    series: bool,
    span: bool,
    std_err: bool,
    interval: bool,
}

impl Columns {
    fn of(chart: &Chart) -> Self {
        Self {
            series: chart.series.iter().any(|s| !s.name.is_empty()),
            span: chart.dots().any(|d| d.span.is_some()),
            std_err: chart.dots().any(|d| d.std_err.is_some()),
            interval: chart.dots().any(|d| d.interval.is_some()),
        }
    }
}

fn number(x: Option<f64>) -> String {
    x.filter(|x| is_finite(*x)).map_or(String::new(), |x| format!("{x:?}"))
}

impl Chart {
    /// One line for each point. What is not known is an empty field; an open end of a bin is `-inf` or `inf`.
    pub(in crate::report) fn csv(&self) -> Vec<u8> {
        let columns = Columns::of(self);
        let mut out = csv::Writer::from_writer(Vec::new());
        let (x, y) = (&self.x.column, &self.y.column);
        let mut head = Vec::new();
        head.extend(columns.series.then(|| "series".to_string()));
        head.extend(if columns.span { vec![format!("{x}_from"), format!("{x}_to")] } else { vec![x.clone()] });
        head.push(y.clone());
        head.extend(columns.std_err.then(|| format!("{y}_std_err")));
        head.extend(columns.interval.then(|| [format!("{y}_low"), format!("{y}_high")]).into_iter().flatten());
        head.extend(self.more.iter().map(|m| m.0.clone()));
        out.write_record(&head).expect("memory is writable");
        for s in &self.series {
            for d in &s.dots {
                out.write_record(self.fields(&columns, s, d)).expect("memory is writable");
            }
        }
        out.into_inner().expect("memory is writable")
    }

    fn fields(&self, columns: &Columns, s: &Series, d: &Dot) -> Vec<String> {
        let mut row = Vec::new();
        row.extend(columns.series.then(|| s.name.clone()));
        match (columns.span, &self.x.scale) {
            (true, _) => {
                let (from, to) = d.span.unwrap_or((d.x, d.x));
                row.extend([format!("{from:?}"), format!("{to:?}")]);
            }
            (false, Scale::Names(names)) => row.push(names.get(d.x as usize).cloned().unwrap_or_default()),
            (false, _) => row.push(number(Some(d.x))),
        }
        row.push(number(Some(d.y)));
        row.extend(columns.std_err.then(|| number(d.std_err)));
        row.extend(
            columns
                .interval
                .then(|| [d.interval.map(|i| i.0), d.interval.map(|i| i.1)])
                .into_iter()
                .flatten()
                .map(number),
        );
        row.extend(d.more.iter().map(|c| match c {
            Cell::Number(x, _) => number(*x),
            Cell::Text(text) => text.clone(),
        }));
        row
    }

    /// The same as people read it; the first points only, where there are many.
    pub(super) fn rows(&self) -> Rows {
        let columns = Columns::of(self);
        let mut head = Vec::new();
        head.extend(columns.series.then(String::new));
        head.extend([self.x.title.clone(), self.y.title.clone()]);
        head.extend(columns.interval.then(|| "interval".to_string()));
        head.extend(self.more.iter().map(|m| m.1.to_string()));
        let all: Vec<(&Series, &Dot)> = self.series.iter().flat_map(|s| s.dots.iter().map(move |d| (s, d))).collect();
        let rows = all.iter().take(ROWS).map(|(s, d)| self.cells(&columns, s, d)).collect();
        Rows { head, rows, all: all.len() }
    }

    fn cells(&self, columns: &Columns, s: &Series, d: &Dot) -> Vec<String> {
        let x = |x: f64| minus(&self.x.unit.value(x));
        let mut row = Vec::new();
        row.extend(columns.series.then(|| s.name.clone()));
        row.push(match (d.span, &self.x.scale) {
            (Some((from, to)), _) if !is_finite(from) => format!("below {}", x(to)),
            (Some((from, to)), _) if !is_finite(to) => format!("from {} on", x(from)),
            (Some((from, to)), _) => format!("{} to {}", x(from), x(to)),
            (None, Scale::Names(names)) => names.get(d.x as usize).cloned().unwrap_or_default(),
            (None, _) => x(d.x),
        });
        let (value, interval) = self.value(d);
        row.push(value);
        row.extend(columns.interval.then(|| interval.unwrap_or_default()));
        row.extend(d.more.iter().map(|c| match c {
            Cell::Number(x, unit) => x.filter(|x| is_finite(*x)).map_or(String::new(), |x| minus(&unit.value(x))),
            Cell::Text(text) => text.clone(),
        }));
        row
    }

    /// Value and interval, rounded alike.
    fn value(&self, d: &Dot) -> (String, Option<String>) {
        match (self.y.unit, d.interval) {
            (Unit::Percent, Some((low, high))) => {
                let shown = percent_estimate(&Estimate { value: d.y, std_err: d.std_err, low, high }, false);
                (minus(&shown.value), shown.interval.map(|i| minus(&i)))
            }
            (unit, interval) => {
                let text = |x: f64| minus(&unit.value(x));
                (text(d.y), interval.map(|(low, high)| format!("{} to {}", text(low), text(high))))
            }
        }
    }
}
