//! Everything the page says, as ready strings.

use super::EnvmapExtras;
use super::charts::{Section, reach, sections};
use super::clock::{FilterLine, SpeedLine, filters, speed};
use super::parts::{PartRow, bias, rows};
use super::pictures::groups;
use super::words::reading;
use crate::report::chart::{self, Library};
use crate::report::format::{confidence, count, percent_exact, round_number, with_error};
use crate::report::frame::{self, program, sentence, timing};
use crate::report::gallery::Group;
use crate::report::headline::verdict_word;
use crate::report::html::context::{class, minus};
use crate::report::number::{UNKNOWN, number};
use crate::report::template::{filled, inlined};
use crate::report::{Artifact, ReportError};
use crate::study::envmap::EnvmapRecord;
use minijinja::context;
use serde::Serialize;

/// What the page adds to the frame of audits.
const TEMPLATES: [(&str, &str); 3] = [
    ("envmap.html", include_str!("page/envmap.html.j2")),
    ("sections.html", include_str!("page/sections.html.j2")),
    ("envmap.css", include_str!("page/envmap.css")),
];

#[derive(Debug, Serialize)]
pub(super) struct Page<'a> {
    title: String,
    scene: &'a str,
    subtitle: String,
    class: &'static str,
    word: &'static str,
    sentence: String,
    facts: Vec<(&'static str, String)>,
    findings: Vec<String>,
    parts: Vec<PartRow>,
    sections: Vec<Section>,
    filters: Vec<FilterLine>,
    groups: Vec<Group>,
    read: Vec<(&'static str, String)>,
    settings: Vec<(&'static str, String)>,
    speed: Vec<SpeedLine>,
    timing: Vec<(&'a str, String)>,
    program: String,
}

impl<'a> Page<'a> {
    pub(super) fn new(record: &'a EnvmapRecord, extras: &'a EnvmapExtras) -> Self {
        let word = record.verdict.map_or("NO LIMIT", verdict_word);
        Self {
            title: format!("{word}: environment map of {} in {}", record.object, record.scene),
            scene: &record.scene,
            subtitle: format!("An environment map of \u{201c}{}\u{201d}, audited", record.object),
            class: class(record.verdict),
            word,
            sentence: sentence(&record.findings, record.verdict, record.limit),
            facts: facts(record),
            findings: record.findings.iter().skip(1).map(|f| minus(f)).collect(),
            parts: rows(&record.irradiance),
            sections: sections(record),
            filters: filters(record),
            groups: groups(extras.pictures),
            read: reading(record.confidence),
            settings: settings(record),
            speed: speed(record),
            timing: timing(extras.timing),
            program: program(),
        }
    }

    fn all_charts(&self) -> impl Iterator<Item = &chart::Block> {
        self.sections.iter().flat_map(|s| &s.charts)
    }

    /// Drawings and tables of its charts.
    pub(super) fn chart_files(&self) -> Vec<Artifact> {
        chart::files(self.all_charts())
    }
}

/// A place, metres.
fn place(p: &[f64; 3]) -> String {
    let [x, y, z] = p.map(round_number);
    minus(&format!("({x}, {y}, {z}) m"))
}

/// Each centre; of many the first and how many there are.
fn centres(record: &EnvmapRecord) -> String {
    match record.centres.as_slice() {
        [] => UNKNOWN.into(),
        [one] => place(one),
        [first, ..] => format!("{}, the first at {}", count(record.centres.len()), place(first)),
    }
}

fn facts(record: &EnvmapRecord) -> Vec<(&'static str, String)> {
    let p = &record.irradiance;
    let ([w, h], edge) = (record.table.map(|n| count(n as usize)), count(record.size as usize));
    let signed = |b: f64| minus(&format!("{} %", with_error(100.0 * b, None)));
    vec![
        ("Error of the irradiance", number(p.total.as_ref()).in_line()),
        ("Bias", bias(p).map_or(UNKNOWN.into(), signed)),
        ("Limit", record.limit.map_or("none given".into(), percent_exact)),
        (
            "Distance within the stated error",
            format!("{}: {}", percent_exact(record.range.stated), reach(&record.range)),
        ),
        (if record.centres.len() > 1 { "World centres" } else { "World centre" }, centres(record)),
        ("Cube", format!("faces of {edge} \u{d7} {edge} texels")),
        ("Diffuse map", format!("{w} \u{d7} {h}")),
        ("Points on the object", count(p.points)),
        ("Truth", record.truth.clone()),
        ("Rays at each point", count(record.rays as usize)),
    ]
}

fn settings(record: &EnvmapRecord) -> Vec<(&'static str, String)> {
    let all: Vec<String> = record.centres.iter().map(place).collect();
    vec![
        ("Scene", record.scene.clone()),
        ("Object", record.object.clone()),
        ("World centres", if all.is_empty() { UNKNOWN.into() } else { all.join(", ") }),
        ("Limit", record.limit.map_or("none".into(), percent_exact)),
        ("Error that the distance is stated for", percent_exact(record.range.stated)),
        ("Confidence of intervals", confidence(record.confidence)),
        ("Truth", record.truth.clone()),
    ]
}

/// Fills in the page; everything that is not markup of the template or a drawing is escaped.
pub(super) fn render(page: &Page, pictures: &[Artifact]) -> Result<String, ReportError> {
    let uris = inlined(pictures);
    let library = Library::for_charts(page.all_charts().next().is_some());
    let templates = frame::TEMPLATES.into_iter().chain(TEMPLATES);
    filled(templates, "envmap.html", context! { page, uris, library, styles => ["envmap.css"] })
}
