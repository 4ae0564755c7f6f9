//! A chart in a page and in the page's folder.

use super::Chart;
use crate::report::Artifact;
use crate::report::html::context::minus;
use serde::Serialize;

/// The macro that shows a chart, for the templates of pages.
pub(in crate::report) const TEMPLATE: (&str, &str) = ("chart.html", include_str!("page/chart.html.j2"));
/// The style of charts.
pub(in crate::report) const STYLE: (&str, &str) = ("chart.css", include_str!("page/chart.css"));

const PLOTLY: &str = include_str!("../vendor/plotly-basic.min.js");
const LICENCES: &str = include_str!("../vendor/LICENSES.txt");
const CODE: &str =
    concat!(include_str!("page/look.js"), include_str!("page/picture.js"), include_str!("page/charts.js"));

/// What a page carries to draw its charts.
#[derive(Debug, Clone, Copy, Serialize)]
pub(in crate::report) struct Library {
    /// The notice that goes with the library.
    pub notice: &'static str,
    /// The library.
    pub plotly: &'static str,
    /// What calls it.
    pub code: &'static str,
}

impl Library {
    /// Nothing for a page without charts.
    pub(in crate::report) fn for_charts(any: bool) -> Option<Self> {
        let notice = LICENCES.find("plotly.js").map_or(LICENCES, |at| &LICENCES[at..]);
        any.then_some(Self { notice: notice.trim(), plotly: PLOTLY.trim(), code: CODE.trim() })
    }
}

/// A chart in a page.
#[derive(Debug, Clone, Serialize)]
pub(in crate::report) struct Block {
    pub stem: String,
    pub title: String,
    pub caption: String,
    /// The drawing for print, and for where no scripts run.
    pub svg: String,
    /// What the script draws, as JSON.
    pub data: String,
    /// The table.
    pub head: Vec<String>,
    pub rows: Vec<Vec<String>>,
    /// Said where rows are left out.
    pub left_out: Option<String>,
    #[serde(skip)]
    csv: Vec<u8>,
}

impl Block {
    /// `None` where no point can be placed.
    pub(in crate::report) fn of(chart: &Chart) -> Option<Self> {
        let svg = chart.svg()?;
        let rows = chart.rows();
        let shown = rows.rows.len();
        Some(Self {
            stem: chart.stem.clone(),
            title: chart.title.clone(),
            caption: minus(&chart.caption),
            svg,
            data: chart.data(),
            head: rows.head,
            rows: rows.rows,
            left_out: (shown < rows.all).then(|| format!("The first {shown} of {} rows; the file has all.", rows.all)),
            csv: chart.csv(),
        })
    }

    /// Drawing and table.
    pub(in crate::report) fn files(&self) -> [Artifact; 2] {
        [
            Artifact::new(format!("{}.svg", self.stem), self.svg.clone()),
            Artifact::new(format!("{}.csv", self.stem), self.csv.clone()),
        ]
    }
}

/// Drawings and tables of charts.
pub(in crate::report) fn files<'a>(blocks: impl IntoIterator<Item = &'a Block>) -> Vec<Artifact> {
    blocks.into_iter().flat_map(Block::files).collect()
}
