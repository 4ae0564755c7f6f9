//! Which charts the page has, in sections.

mod distance;
mod filters;
mod parts;
mod sizes;

pub(super) use parts::reach;

use super::parts::bias;
use crate::report::chart::{Block, Chart};
use crate::report::plots::{
    axis, chart, columns, count_cell, dot, errors, exact_dot, limit, line, linear, percent_cell, series,
};
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
