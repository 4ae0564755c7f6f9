//! Fast filters against the exact one, by the width of the cone.

use super::super::clock::filter_name;
use super::{axis, chart, columns, errors, exact_dot, line, percent_cell};
use crate::report::chart::{Chart, Dot, Series, Unit};
use crate::report::format::round_number;
use crate::study::envmap::{EnvmapRecord, FilterRow};

/// Different values, in the order in which they come.
fn distinct<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut out = Vec::new();
    for x in all {
        if !out.contains(&x) {
            out.push(x);
        }
    }
    out
}

/// One chart for each filter and stretch.
pub(super) fn charts(record: &EnvmapRecord) -> Vec<Chart> {
    let layouts = distinct(record.filters.iter().map(|f| f.layout));
    let kinds = distinct(record.filters.iter().map(|f| (f.filter, f.stretch)));
    kinds.into_iter().filter_map(|(filter, stretch)| of(record, &layouts, filter, stretch)).collect()
}

/// Each layout in its colour, near the poles with dashes.
fn of(record: &EnvmapRecord, layouts: &[&'static str], filter: &'static str, stretch: f64) -> Option<Chart> {
    let rows = |layout: &'static str| {
        record.filters.iter().filter(move |f| f.layout == layout && f.filter == filter && f.stretch == stretch)
    };
    let place = |f: &FilterRow| format!("in cones of {} degrees", round_number(f.width));
    let mut all: Vec<Series> = Vec::new();
    for (k, layout) in layouts.iter().enumerate() {
        let everywhere = |f: &FilterRow| {
            let dot = exact_dot(f.width, f.error, &place(f));
            Dot { more: vec![percent_cell(Some(f.worst))], ..dot }
        };
        let poles = |f: &FilterRow| {
            let dot = exact_dot(f.width, f.near_poles?, &format!("near the poles {}", place(f)));
            Some(Dot { more: vec![percent_cell(None)], ..dot })
        };
        all.push(line(layout, k, rows(layout).map(everywhere).collect()));
        let near = line(&format!("{layout}, near the poles"), k, rows(layout).filter_map(poles).collect());
        all.push(Series { dashed: true, ..near });
    }
    all.retain(|s| !s.dots.is_empty());
    let shape = if stretch == 1.0 {
        "cones as wide as long".to_string()
    } else {
        format!("cones {} times as long as wide", round_number(stretch))
    };
    let name = filter_name(filter);
    let mut first = name.chars();
    let name: String = first.next().into_iter().flat_map(char::to_uppercase).chain(first).collect();
    let stem = format!("filter-{filter}-{}", round_number(stretch));
    let x = axis("full opening angle across the shorter axis, degrees", "degrees", Unit::Plain);
    let mut chart = chart(&stem, &format!("{name}: {shape}"), String::new(), [x, errors()], all)?;
    chart.more = columns(&[("worst", "largest error over the root mean square")]);
    Some(chart)
}
