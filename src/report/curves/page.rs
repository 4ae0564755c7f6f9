//! The page: drawings inline, tables, settings; what the clock says in one marked block.

use super::figures::{Drawing, edits};
use super::words::{cost, metric_name, metric_short, noise_word, slope_text, state_name};
use super::{About, CurvesReport, DifferenceReport, Film, MeshReport};
use crate::metrics::FLOOR_FACTOR;
use crate::report::chart::{self, Block, Library};
use crate::report::format::{confidence, count, percent, percent_estimate, percent_exact, significant};
use crate::report::html::context::minus;
use crate::report::template::filled;
use crate::report::{ReportError, scene3d};
use crate::study::converge::{At, Axis, Difference, ReachedRow, mesh_rate};
use minijinja::context;
use serde::Serialize;

/// The page and what it is put together from.
const TEMPLATES: [(&str, &str); 4] = [
    ("curves.html", include_str!("page/curves.html.j2")),
    ("style.css", include_str!("../html/page/style.css")),
    chart::TEMPLATE,
    chart::STYLE,
];
/// What is not known.
const NONE: &str = "\u{2013}";

#[derive(Debug, Default, Serialize)]
struct Page<'a> {
    title: String,
    scene: &'a str,
    lead: String,
    notices: &'a [String],
    sections: Vec<Section<'a>>,
    /// Sections that depend on the machine.
    clock: Vec<Section<'a>>,
    read: Vec<(&'static str, String)>,
    settings: &'a [(String, String)],
    provenance: &'a [(String, String)],
    replay: &'a str,
    timing: Vec<(String, String)>,
    program: String,
}

#[derive(Debug, Default, Serialize)]
struct Section<'a> {
    title: String,
    figures: Vec<&'a Block>,
    tables: Vec<Table>,
    /// Rows of (picture, caption).
    pictures: Vec<Vec<(String, &'a str)>>,
}

#[derive(Debug, Default, Serialize)]
struct Table {
    title: String,
    caption: String,
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Section<'_> {
    fn is_empty(&self) -> bool {
        self.figures.is_empty() && self.tables.iter().all(|t| t.rows.is_empty())
    }
}

fn page<'a>(about: &'a About, title: &str, lead: String) -> Page<'a> {
    Page {
        title: title.into(),
        scene: &about.scene,
        lead,
        notices: &about.notices,
        settings: &about.settings,
        provenance: &about.provenance,
        replay: &about.replay,
        timing: about.timing.iter().map(|p| (p.name.clone(), format!("{:.2} s", p.seconds))).collect(),
        program: format!("etalon {}", env!("CARGO_PKG_VERSION")),
        ..Page::default()
    }
}

fn render(page: &Page, viewer: Option<&Film>) -> Result<String, ReportError> {
    let drawn = page.sections.iter().chain(&page.clock).any(|s| !s.figures.is_empty());
    let library = Library::for_charts(drawn);
    filled(TEMPLATES.into_iter().chain(scene3d::TEMPLATES), "curves.html", context! { page, viewer, library })
}

fn drawn(figures: &[Drawing], edit: usize, clock: bool) -> Vec<&Block> {
    figures.iter().filter(|f| f.edit == edit && f.is_clock == clock).map(|f| &f.chart).collect()
}

fn headed(words: &[&str]) -> Vec<String> {
    words.iter().map(ToString::to_string).collect()
}

/// How the page is to be read.
fn reading(about: &About) -> Vec<(&'static str, String)> {
    let interval = confidence(about.confidence);
    vec![
        (
            "Bars and bands",
            format!(
                "The interval of the error at {interval}. All points of a state are held against one reference, so \
                 its noise shifts them alike: it does not make a curve jagged."
            ),
        ),
        (
            "Noise of the reference",
            format!(
                "The dashed line is what a perfect solution would read if the noise were not taken out. Fits leave \
                 out what lies within {FLOOR_FACTOR} times that, and whatever has an interval that reaches 0."
            ),
        ),
        (
            "Slope",
            format!(
                "The power of the cost that the error follows, by weighted least squares on logarithmic axes, with \
                 its interval at {interval} by Student's t: \u{2212}1 halves the error when the cost doubles, \
                 \u{2212}0.5 when it grows fourfold. The dotted line shows it over the points it rests on."
            ),
        ),
        (
            "Reached",
            "The cost of the first snapshot from which on the error stays at or below the level. What lies between \
             snapshots is not known: the level is reached at or before that cost. In brackets: where the upper end \
             of the interval does so too."
                .into(),
        ),
        (
            "Since the edit",
            "Costs count from the last snapshot before the edit. A snapshot taken at once stands at 0, in the grey \
             margin. Judging a solution takes no part in any cost."
                .into(),
        ),
    ]
}

pub(super) fn of_curves(report: &CurvesReport, figures: &[Drawing]) -> Result<String, ReportError> {
    let edits = edits(&report.curves);
    let last = edits.last().copied().unwrap_or(0);
    let snapshots: usize = report.curves.iter().map(|c| c.points.len()).sum();
    let lead = format!(
        "{} snapshots, each held against a ray-traced reference of its own state of the scene.",
        count(snapshots)
    );
    let mut page = page(&report.about, "Convergence", lead);
    for edit in edits {
        let section = |clock: bool| Section {
            title: state_name(edit, last),
            figures: drawn(figures, edit, clock),
            tables: vec![reached_table(report, edit, clock), rates_table(report, edit, clock)],
            pictures: if clock { Vec::new() } else { shown(report, edit) },
        };
        let (costs, clock) = (section(false), section(true));
        page.sections.extend(Some(costs).filter(|s| !s.is_empty()));
        page.clock.extend(Some(clock).filter(|s| !s.is_empty()));
    }
    page.read = reading(&report.about);
    page.read.extend(report.pictures.first().map(|p| ("Pictures", minus(&p.words))));
    render(&page, report.film.as_ref())
}

fn shown(report: &CurvesReport, edit: usize) -> Vec<Vec<(String, &str)>> {
    let rows = report.pictures.iter().filter(|p| p.edit == edit).flat_map(|p| &p.rows);
    rows.map(|row| row.iter().map(|p| (p.inline(), p.caption.as_str())).collect()).collect()
}

/// Columns of the costs that are shown: those of the clock, or the others.
fn axes(clock: bool) -> impl Iterator<Item = (usize, Axis)> {
    Axis::ALL.into_iter().enumerate().filter(move |(_, a)| a.is_clock() == clock)
}

fn reached_table(report: &CurvesReport, edit: usize, clock: bool) -> Table {
    let used = |k: usize| report.digest.reached.iter().any(|r| r.costs[k].is_some());
    let shown: Vec<(usize, Axis)> = axes(clock).filter(|(k, _)| used(*k)).collect();
    let mut head = headed(&["method", "error", "level"]);
    for (_, axis) in &shown {
        head.extend([axis.name().to_string(), "times fewer".into()]);
    }
    let row = |r: &ReachedRow| {
        let mut row = vec![r.method.clone(), metric_name(r.metric).into(), percent_exact(r.level)];
        for (k, axis) in &shown {
            row.push(r.costs[*k].map_or(NONE.into(), |c| cost(c, *axis)));
            row.push(r.first_over_this[*k].map_or(NONE.into(), |x| significant(x, 3)));
        }
        row
    };
    let rows = report
        .digest
        .reached
        .iter()
        .filter(|r| r.edit == edit && shown.iter().any(|(k, _)| r.costs[*k].is_some()))
        .map(row)
        .collect();
    let caption = "At or before; in brackets with confidence. \u{201c}Times fewer\u{201d}: the cost of the first \
                   method over that of this one.";
    Table { title: "What it takes".into(), caption: caption.into(), head, rows }
}

fn rates_table(report: &CurvesReport, edit: usize, clock: bool) -> Table {
    let of_state = report.digest.rates.iter().filter(|r| r.edit == edit && r.axis.is_clock() == clock);
    let row = |r: &crate::study::converge::RateRow| {
        let slope = r.rate.as_ref().map_or("too few points clear of the noise".into(), slope_text);
        let points = r.rate.as_ref().map_or(NONE.into(), |r| r.points.to_string());
        vec![r.method.clone(), metric_name(r.metric).into(), r.axis.name().into(), slope, points]
    };
    let caption = format!("Power of the cost that the error follows, at {}.", confidence(report.about.confidence));
    let head = headed(&["method", "error", "against", "slope", "points"]);
    Table { title: "Rates".into(), caption, head, rows: of_state.map(row).collect() }
}

pub(super) fn of_meshes(report: &MeshReport, figures: &[Drawing]) -> Result<String, ReportError> {
    let lead = "Each mesh is held against the true mean radiosities of its own patches: what is left is the error \
                of the method and of its division into patches.";
    let mut page = page(&report.about, "Error against mesh size", lead.into());
    let mesh = |name: &str, p: &crate::study::converge::MeshPoint| {
        let shown = p.rms.map(|e| percent_estimate(&e, false));
        let (value, interval) = shown.map_or((NONE.into(), None), |s| (s.value, s.interval));
        vec![
            name.to_string(),
            format!("{}\u{d7}", p.size.factor),
            count(p.size.patches),
            significant(p.size.longest_edge, 3),
            significant(p.size.mean_size, 3),
            value,
            interval.unwrap_or_default(),
            p.noise_floor.map_or(NONE.into(), percent),
        ]
    };
    let rows = report.curves.iter().flat_map(|c| c.points.iter().map(move |p| mesh(&c.method, p))).collect();
    let head = headed(&[
        "method",
        "factor",
        "patches",
        "longest edge, m",
        "mean size, m",
        "error",
        "interval",
        "noise of the reference",
    ]);
    let meshes = Table { title: "Meshes".into(), caption: String::new(), head, rows };
    let order = |c: &crate::study::converge::MeshCurve| {
        let rate = mesh_rate(c, report.about.confidence);
        let text = rate.as_ref().map_or("too few meshes clear of the noise".into(), slope_text);
        vec![c.method.clone(), text, rate.map_or(NONE.into(), |r| r.points.to_string())]
    };
    let orders = Table {
        title: "Orders".into(),
        caption: format!("Power of the mean size that the error follows, at {}.", confidence(report.about.confidence)),
        head: headed(&["method", "order", "meshes"]),
        rows: report.curves.iter().map(order).collect(),
    };
    page.sections = vec![Section {
        title: "Meshes".into(),
        figures: drawn(figures, 0, false),
        tables: vec![meshes, orders],
        ..Section::default()
    }];
    page.read =
        reading(&report.about).into_iter().filter(|(t, _)| !["Reached", "Since the edit"].contains(t)).collect();
    render(&page, None)
}

pub(super) fn of_difference(report: &DifferenceReport, figures: &[Drawing]) -> Result<String, ReportError> {
    let [first, second] = &report.names;
    let lead =
        format!("{second} (dashed) over {first}: curves of equal method and state, read between their snapshots.");
    let mut page = page(&report.about, "Two runs", lead);
    let all = edits(&report.curves[0]);
    let last = all.last().copied().unwrap_or(0);
    for edit in all {
        let section = |clock: bool| Section {
            title: state_name(edit, last),
            figures: drawn(figures, edit, clock),
            tables: vec![difference_table(report, edit, clock)],
            ..Section::default()
        };
        let (costs, clock) = (section(false), section(true));
        page.sections.extend(Some(costs).filter(|s| !s.is_empty()));
        page.clock.extend(Some(clock).filter(|s| !s.is_empty()));
    }
    page.read = reading(&report.about).into_iter().filter(|(t, _)| *t != "Reached").collect();
    page.read.push((
        "Within the noise",
        "The intervals of both sides overlap: the noise of the references may be all there is between them. Where \
         they lie apart, it is not. Seconds vary from run to run; nothing here says how much."
            .into(),
    ));
    render(&page, None)
}

fn difference_table(report: &DifferenceReport, edit: usize, clock: bool) -> Table {
    let row = |d: &Difference| {
        let number = |x: f64| significant(x, 3);
        let (at, show): (String, fn(f64) -> String) = match d.at {
            At::Error(level) => (format!("{} at {}", d.axis.name(), percent_exact(level)), |x| significant(x, 3)),
            At::Cost(x) => (format!("error at {} {}", number(x), d.axis.name()), percent),
        };
        let side = |s: Option<crate::study::converge::Side>| s.map_or("not reached".into(), |s| show(s.value));
        let noise = d.noise().map_or(NONE, noise_word);
        let ratio = d.ratio().map_or(NONE.into(), number);
        vec![d.method.clone(), metric_short(d.metric).into(), at, side(d.first), side(d.second), ratio, noise.into()]
    };
    let of_state = report.differences.iter().filter(|d| d.edit == edit && d.axis.is_clock() == clock);
    let [first, second] = &report.names;
    let head = headed(&["method", "error", "what", first, second, "second over first", "noise"]);
    Table { title: "Ratios".into(), caption: String::new(), head, rows: of_state.map(row).collect() }
}
