//! Everything the page says, as ready strings: what the template gets.

use super::bars::{Bar, axis_end, bar};
use super::budget::{Budget, budget};
use super::charts::charts;
use super::findings::{FindingRow, finding_rows};
use super::groups::{GroupTable, group_tables};
use super::pictures::{ViewBlock, view_block};
use super::seen::{Seen, seen};
use super::settings::{SettingGroup, settings};
use super::sources::{Card, cards};
use crate::metrics::Verdict;
use crate::report::asked::Level;
use crate::report::chart::Block;
use crate::report::figures::ViewFigures;
use crate::report::format::{confidence, count, significant};
use crate::report::lines::worst_title;
use crate::report::{MetricLine, Phase, headline, metric_lines, warnings, worst_lines};
use crate::study::Record;
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct Page {
    pub title: String,
    pub scene: String,
    pub state: Option<String>,
    pub solution: String,
    pub against: &'static str,
    pub verdict: VerdictBand,
    pub facts: Vec<Pair>,
    pub warnings: Vec<Pair>,
    pub metrics: Metrics,
    /// What an eye would see of the error.
    pub seen: Option<Seen>,
    pub views: Vec<ViewBlock>,
    pub worst: Worst,
    pub groups: Vec<GroupTable>,
    pub budget: Option<Budget>,
    pub charts: Vec<Block>,
    pub sources: Vec<Card>,
    pub findings: Vec<FindingRow>,
    pub notices: Vec<String>,
    pub settings: Vec<SettingGroup>,
    pub provenance: Vec<Pair>,
    pub replay: String,
    /// Wall-clock data: the only part that differs between runs on the same input.
    pub timing: Vec<Pair>,
    pub program: String,
}

/// A label with its text.
#[derive(Debug, Serialize)]
pub(super) struct Pair {
    pub label: String,
    pub text: String,
}

#[derive(Debug, Serialize)]
pub(super) struct VerdictBand {
    /// `pass`, `fail`, `open` or `none`: what the template chooses colour and icon by.
    pub class: &'static str,
    pub word: &'static str,
    pub sentence: String,
}

#[derive(Debug, Serialize)]
pub(super) struct Metrics {
    pub confidence: String,
    /// Label of the right end of the axis of the bars.
    pub axis_end: Option<String>,
    pub rows: Vec<MetricRow>,
}

#[derive(Debug, Serialize)]
pub(super) struct MetricRow {
    pub key: String,
    pub name: String,
    pub meaning: &'static str,
    pub value: String,
    pub interval: Option<String>,
    pub limit: Option<String>,
    pub class: &'static str,
    pub word: &'static str,
    pub bar: Option<Bar>,
}

#[derive(Debug, Serialize)]
pub(super) struct Worst {
    pub title: String,
    pub noun: &'static str,
    pub rows: Vec<WorstRow>,
    /// True if some of them are out of sight of every camera.
    pub any_hidden: bool,
}

#[derive(Debug, Serialize)]
pub(super) struct WorstRow {
    pub rank: usize,
    pub number: usize,
    /// The patch that shows it in the scene to turn.
    pub patch: Option<usize>,
    pub surface: String,
    pub reference: String,
    pub solution: String,
    pub difference: String,
    pub relative: Option<String>,
    pub in_std_errs: Option<String>,
    pub hidden: bool,
}

fn pair(label: &str, text: impl Into<String>) -> Pair {
    Pair { label: label.into(), text: text.into() }
}

impl Page {
    pub(super) fn new(record: &Record, views: &[ViewFigures], timing: &[Phase]) -> Self {
        let head = headline(record);
        Self {
            title: format!("{}: {}", head.word, record.stage.name),
            scene: record.stage.name.clone(),
            state: (record.stage.state > 0).then(|| format!("after edit {}", record.stage.state)),
            solution: record.solution_name.clone(),
            against: if record.truth == "solution" { "against another solution" } else { "judged by ray casting" },
            verdict: VerdictBand { class: class(head.verdict), word: head.word, sentence: minus(&head.sentence) },
            facts: facts(record),
            warnings: warnings(record).into_iter().map(|(label, text)| Pair { label, text: minus(&text) }).collect(),
            metrics: metrics(record),
            seen: seen(record),
            views: views.iter().map(view_block).collect(),
            worst: worst(record, views),
            groups: group_tables(record),
            budget: budget(record),
            charts: charts(record),
            sources: cards(record),
            findings: finding_rows(record),
            notices: record.notices.clone(),
            settings: settings(record),
            provenance: record.provenance.iter().map(|(what, value)| pair(what, value)).collect(),
            replay: record.replay.clone(),
            timing: timing.iter().map(|p| pair(&p.name, format!("{} s", significant(p.seconds, 3)))).collect(),
            program: format!("etalon {}", env!("CARGO_PKG_VERSION")),
        }
    }
}

impl Page {
    /// Every chart of the page.
    pub(super) fn all_charts(&self) -> impl Iterator<Item = &Block> {
        self.charts.iter().chain(self.budget.as_ref().and_then(|b| b.chart.as_ref()))
    }
}

/// What a page chooses colour and icon of a verdict by.
pub(in crate::report) fn class(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Pass) => "pass",
        Some(Verdict::Fail) => "fail",
        Some(Verdict::Inconclusive) => "open",
        None => "none",
    }
}

fn facts(record: &Record) -> Vec<Pair> {
    let c = &record.comparison;
    let truth = match record.truth.as_str() {
        "patch-system" => "exact solution of the patch system".to_string(),
        "continuous" => "true mean radiosity of each patch".to_string(),
        "solution" => "another solution, taken as it is".to_string(),
        other => other.to_string(),
    };
    vec![
        pair(if Level::of(record) == Level::Patch { "Patches" } else { "Elements" }, count(c.patches)),
        pair("Bands", record.stage.photometry.bands.join(", ")),
        pair("Judged against", truth),
        pair("Confidence", minus(&confidence(c.confidence))),
    ]
}

fn metrics(record: &Record) -> Metrics {
    let lines = metric_lines(record);
    let end = axis_end(&lines);
    Metrics {
        confidence: minus(&confidence(record.comparison.confidence)),
        axis_end: end.map(|e| minus(&format!("{} %", significant(100.0 * e, 2)))),
        rows: lines.into_iter().map(|l| metric_row(l, end)).collect(),
    }
}

fn metric_row(line: MetricLine, end: Option<f64>) -> MetricRow {
    MetricRow {
        bar: end.and_then(|e| bar(&line, e)),
        class: class(line.verdict),
        word: line.verdict.map_or("", |v| match v {
            Verdict::Pass => "kept",
            Verdict::Fail => "exceeded",
            Verdict::Inconclusive => "open",
        }),
        key: line.key,
        name: line.name,
        meaning: line.meaning,
        value: minus(&line.value),
        interval: line.interval.map(|i| minus(&i)),
        limit: line.limit.map(|l| minus(&l)),
    }
}

fn worst(record: &Record, views: &[ViewFigures]) -> Worst {
    let in_sight = |number| views.iter().any(|v| v.marks.iter().any(|m| m.number == number));
    let row = |(k, w): (usize, crate::report::WorstLine)| WorstRow {
        rank: k + 1,
        hidden: !views.is_empty() && !in_sight(w.number),
        number: w.number,
        patch: Level::of(record).patch(record, w.number),
        surface: w.surface,
        reference: minus(&w.reference),
        solution: minus(&w.solution),
        difference: minus(&w.difference),
        relative: w.relative.map(|r| minus(&r)),
        in_std_errs: w.in_std_errs.map(|e| minus(&e)),
    };
    let rows: Vec<WorstRow> = worst_lines(record).into_iter().enumerate().map(row).collect();
    let (title, noun) = (worst_title(record), Level::of(record).noun());
    Worst { title, noun, any_hidden: rows.iter().any(|r| r.hidden), rows }
}

/// A true minus sign before numbers, and narrow no-break spaces before per cent signs.
pub(in crate::report) fn minus(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut chars = text.chars().peekable();
    let mut before = ' ';
    while let Some(c) = chars.next() {
        let sign = c == '-' && matches!(before, ' ' | '(' | '\u{b1}') && chars.peek().is_some_and(char::is_ascii_digit);
        let unit = c == ' ' && before.is_ascii_digit() && chars.peek() == Some(&'%');
        out.push(if sign {
            '\u{2212}'
        } else if unit {
            '\u{202f}'
        } else {
            c
        });
        before = c;
    }
    out
}
