//! Everything the page says, as ready strings.

use super::AuditExtras;
use super::charts::charts;
use super::cures::{Cures, cures};
use super::maps::MapView;
use super::sources::{SourceRow, rows};
use crate::audit::Cause;
use crate::metrics::Verdict;
use crate::report::chart::{self, Block, Library};
use crate::report::format::{confidence, count, percent, percent_exact, significant};
use crate::report::headline::verdict_word;
use crate::report::html::context::{class, minus};
use crate::report::number::{Number, number};
use crate::report::template::{filled, inlined};
use crate::report::{Artifact, ReportError};
use crate::study::audit::{AuditRecord, Finding, Form, Wrong};
use minijinja::context;
use serde::Serialize;

/// The page and what it is put together from.
const TEMPLATES: [(&str, &str); 9] = [
    ("audit.html", include_str!("page/audit.html.j2")),
    ("why.html", include_str!("page/why.html.j2")),
    ("mends.html", include_str!("page/mends.html.j2")),
    ("where.html", include_str!("page/where.html.j2")),
    ("audit.css", include_str!("page/audit.css")),
    ("style.css", include_str!("../html/page/style.css")),
    ("macros.html", include_str!("../html/page/macros.html.j2")),
    chart::TEMPLATE,
    chart::STYLE,
];

/// What each cause is: name and sentence.
const CAUSES: [(&str, &str); 3] = [
    (
        "Aliasing",
        "A pixel shows one thing and stands for an area: the hemi-cube's count minus the exact form factor from its \
         centre, shadows included. More pixels mend it.",
    ),
    (
        "Proximity",
        "One point stands for the whole patch: what is near looks nearer from the centre than it is on average. \
         Smaller patches near the source mend it; pixels do not.",
    ),
    (
        "Visibility",
        "What the centre sees past others stands for what the whole patch sees: the edge of a shadow runs across it. \
         Smaller patches, or points spread over the patch, mend it; pixels do not.",
    ),
];

#[derive(Debug, Serialize)]
pub(super) struct Page<'a> {
    title: String,
    scene: &'a str,
    subtitle: String,
    class: &'static str,
    word: &'static str,
    sentence: String,
    warnings: Vec<String>,
    notes: Vec<(&'static str, String)>,
    facts: Vec<(&'static str, String)>,
    mends: Vec<String>,
    /// `pass` where a cure passes, `open` where none does, `none` without a limit.
    mend_class: &'static str,
    findings: Vec<FindingRow>,
    confidence: String,
    causes: Vec<CauseRow>,
    cause_notes: String,
    sources: Vec<SourceRow>,
    is_shooter: bool,
    limit: Option<String>,
    cures: Option<Cures>,
    charts: Vec<Block>,
    views: &'a [MapView],
    pictures: Vec<(&'a str, String)>,
    read: Vec<(&'static str, &'static str)>,
    settings: Vec<(&'static str, String)>,
    timing: Vec<(&'a str, String)>,
    program: String,
}

#[derive(Debug, Serialize)]
struct FindingRow {
    about: String,
    text: String,
}

/// One line of the table of causes.
#[derive(Debug, Serialize)]
struct CauseRow {
    /// Class of its colour.
    class: String,
    name: &'static str,
    meaning: &'static str,
    /// Alone, and the length of its bar in percent.
    alone: String,
    length: String,
    left: Number,
    matrix: String,
}

/// What is said of a run against the limit.
pub(super) fn chip(verdict: Option<Verdict>) -> &'static str {
    verdict.map_or("", |v| match v {
        Verdict::Pass => "passes",
        Verdict::Fail => "fails",
        Verdict::Inconclusive => "open",
    })
}

impl<'a> Page<'a> {
    pub(super) fn new(record: &'a AuditRecord, extras: &'a AuditExtras, views: &'a [MapView]) -> Self {
        let word = record.verdict.map_or("NO LIMIT", verdict_word);
        let found = |f: &Finding| FindingRow { about: f.about.clone(), text: minus(&f.text) };
        Self {
            title: format!("{word}: hemi-cubes in {}", record.scene),
            scene: &record.scene,
            subtitle: format!("{}, audited", what(record)),
            class: class(record.verdict),
            word,
            sentence: minus(&sentence(record)),
            warnings: record.self_check_failures.clone(),
            notes: notes(record),
            facts: facts(record),
            mends: mends(record),
            mend_class: mend_class(record),
            findings: record.findings.iter().filter(|f| f.about != "mend").map(found).collect(),
            confidence: confidence(record.confidence),
            causes: causes(record),
            cause_notes: cause_notes(record),
            sources: rows(record),
            is_shooter: record.form == Form::Shooter,
            limit: record.limit.map(percent_exact),
            cures: cures(record),
            charts: charts(record),
            views,
            pictures: extras.pictures.iter().map(|p| (p.name.as_str(), minus(&p.caption))).collect(),
            read: CAUSES.to_vec(),
            settings: settings(record),
            timing: extras
                .timing
                .iter()
                .map(|p| (p.name.as_str(), format!("{} s", significant(p.seconds, 3))))
                .collect(),
            program: format!("etalon {}", env!("CARGO_PKG_VERSION")),
        }
    }
}

impl Page<'_> {
    fn all_charts(&self) -> impl Iterator<Item = &Block> {
        self.charts.iter().chain(self.cures.as_ref().and_then(|c| c.chart.as_ref()))
    }

    /// Drawings and tables of its charts.
    pub(super) fn chart_files(&self) -> Vec<Artifact> {
        chart::files(self.all_charts())
    }
}

/// What would mend it: everything first, then source by source.
fn mends(record: &AuditRecord) -> Vec<String> {
    let mut all: Vec<String> = record.findings.iter().filter(|f| f.about == "mend").map(|f| minus(&f.text)).collect();
    // The study tells of the whole last.
    let of_the_whole = usize::from(!all.is_empty());
    all.rotate_right(of_the_whole);
    all
}

fn mend_class(record: &AuditRecord) -> &'static str {
    match record.limit {
        None => "none",
        Some(_) if record.cures.iter().any(|c| c.verdict == Some(Verdict::Pass)) => "pass",
        Some(_) => "open",
    }
}

/// What was audited.
fn what(record: &AuditRecord) -> String {
    match (&record.theirs, record.form) {
        (Some(file), _) => format!("Form factors of {file}"),
        (None, Form::Receiver) => format!("A hemi-cube of resolution {} at every patch", record.resolution),
        (None, Form::Shooter) => {
            format!("Progressive refinement with a hemi-cube of resolution {} at the shooter", record.resolution)
        }
    }
}

/// The answer in two sentences.
fn sentence(record: &AuditRecord) -> String {
    let wrong = number(record.wrong.rms.as_ref());
    let within = wrong.interval.map_or(String::new(), |i| format!(" ({i})"));
    let limit = match (record.verdict, record.limit) {
        (Some(Verdict::Pass), Some(l)) => format!(", within the limit of {}", percent_exact(l)),
        (Some(Verdict::Fail), Some(l)) => format!(", beyond the limit of {}", percent_exact(l)),
        (Some(Verdict::Inconclusive), Some(l)) => {
            format!("; whether that is within the limit of {} cannot be told from this reference", percent_exact(l))
        }
        _ => String::new(),
    };
    let top1 = number(record.wrong.top1.as_ref()).value;
    let main = (0..3).max_by(|a, b| record.alone[*a].total_cmp(&record.alone[*b])).map_or("", |k| Cause::ALL[k].name());
    let source = record.sources.first().map_or(String::new(), |s| {
        format!(" The largest cause is {main}; the source that brings most is \u{201c}{}\u{201d}.", s.source.name)
    });
    format!(
        "Reflected light is wrong by {}{within}{limit}; by {top1} over the 1 % of the patches that receive most.{source}",
        wrong.value
    )
}

fn notes(record: &AuditRecord) -> Vec<(&'static str, String)> {
    let mut notes = Vec::new();
    if let Some(file) = &record.theirs {
        let told = record.fingerprint.as_ref().map_or(String::new(), |f| format!(" Its fingerprint: {f}."));
        let own =
            "Charts and cures are by our own hemi-cube with the settings below, not by the program that wrote it.";
        notes.push(("Somebody else's matrix", minus(&format!("The form factors are those of {file}.{told} {own}"))));
    }
    if record.form == Form::Shooter {
        let text = "The hemi-cubes stand at the shooters, as in progressive refinement: the form factor from a receiver is \
                    that of the shooter turned about by reciprocity. So the patch whose centre stands for the whole is the \
                    source, and an error grows with the area of the receiver. Pixels named on this page are those that a \
                    hemi-cube at the receiver would give to the source.";
        notes.push(("Progressive refinement", text.into()));
    }
    notes
}

fn facts(record: &AuditRecord) -> Vec<(&'static str, String)> {
    let with = |w: &Wrong| number(w.rms.as_ref()).in_line();
    let mut facts = vec![
        ("Error of reflected light (eq. 7)", with(&record.wrong)),
        ("Over the top 1 %", number(record.wrong.top1.as_ref()).value),
        ("Limit", record.limit.map_or("none given".into(), percent_exact)),
        ("At infinite resolution", number(record.infinite.rms.as_ref()).value),
        ("Patches", count(record.patches)),
        ("Hemi-cube", record.method.clone()),
        ("Truth", record.truth.clone()),
    ];
    if record.theirs.is_some() {
        facts[5].0 = "Our hemi-cube, for charts and cures";
    }
    facts
}

/// The causes, the error as it is, and what is left at infinite resolution.
fn causes(record: &AuditRecord) -> Vec<CauseRow> {
    let whole = record.wrong.rms.map_or(0.0, |e| e.value);
    let longest = record.alone.iter().copied().fold(whole, f64::max);
    let length = |x: f64| if longest > 0.0 { format!("{:.2}", 100.0 * x / longest) } else { "0".into() };
    let cause = |k: usize| CauseRow {
        class: format!("c{k}"),
        name: CAUSES[k].0,
        meaning: [
            "pixels stand for areas",
            "centres stand for patches",
            "sight from centres stands for that of patches",
        ][k],
        alone: minus(&percent(record.alone[k])),
        length: length(record.alone[k]),
        left: number(record.without[k].rms.as_ref()),
        matrix: minus(&percent(record.matrix.by_cause[k])),
    };
    let mut rows: Vec<CauseRow> = (0..3).map(cause).collect();
    rows.push(CauseRow {
        class: "whole".into(),
        name: "All together",
        meaning: "the hemi-cube as it is",
        alone: number(record.wrong.rms.as_ref()).value,
        length: length(whole),
        left: Number::unknown(),
        matrix: minus(&percent(record.matrix.total)),
    });
    rows
}

fn cause_notes(record: &AuditRecord) -> String {
    let infinite = number(record.infinite.rms.as_ref());
    let more = record.without.iter().filter_map(|w| w.rms).any(|e| record.wrong.rms.is_some_and(|w| e.value > w.value));
    let cancels =
        if more { " Where more is left than there was, that cause makes up for part of another." } else { "" };
    minus(&format!(
        "A hemi-cube of infinite resolution, without any aliasing, would leave {}{}. The truth's own noise in the form \
         factors is {}.{cancels}",
        infinite.value,
        infinite.interval.map_or(String::new(), |i| format!(" ({i})")),
        percent(record.matrix.noise)
    ))
}

fn settings(record: &AuditRecord) -> Vec<(&'static str, String)> {
    let form = match record.form {
        Form::Receiver => "at the receivers: the full matrix",
        Form::Shooter => "at the shooters: progressive refinement",
    };
    let mut all = vec![
        ("Scene", record.scene.clone()),
        ("Hemi-cube", record.method.clone()),
        ("Hemi-cubes stand", form.into()),
        ("Limit", record.limit.map_or("none".into(), percent_exact)),
        ("Confidence of intervals", confidence(record.confidence)),
        ("Truth", record.truth.clone()),
    ];
    if let Some(file) = &record.theirs {
        all.insert(1, ("Form factors", file.clone()));
    }
    all
}

/// Fills in the page; everything that is not markup of the template or a drawing is escaped.
pub(super) fn render(page: &Page, pictures: &[Artifact]) -> Result<String, ReportError> {
    let uris = inlined(pictures);
    let library = Library::for_charts(page.all_charts().next().is_some());
    filled(TEMPLATES, "audit.html", context! { page, uris, library })
}
