//! Everything the page says, as ready strings.

use super::CompositingExtras;
use super::charts::charts;
use super::pictures::groups;
use super::rows::{Table, estimate};
use super::tables::{clusters, composite, edges, lights, picture};
use super::words::READING;
use crate::report::chart::{self, Library};
use crate::report::format::{count, percent_exact, significant};
use crate::report::frame::{self, program, sentence, timing};
use crate::report::gallery::Group;
use crate::report::headline::verdict_word;
use crate::report::html::context::{class, minus};
use crate::report::number::{UNKNOWN, number};
use crate::report::template::{filled, inlined};
use crate::report::{Artifact, ReportError};
use crate::study::compositing::{CompositingRecord, Rms};
use minijinja::context;
use serde::Serialize;

/// What the page adds to the frame of audits.
const TEMPLATES: [(&str, &str); 3] = [
    ("compositing.html", include_str!("page/compositing.html.j2")),
    ("table.html", include_str!("page/table.html.j2")),
    ("compositing.css", include_str!("page/compositing.css")),
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
    charts: Vec<chart::Block>,
    edges: Option<Table>,
    lights: Option<Table>,
    clusters: Vec<Table>,
    picture: Option<Table>,
    groups: Vec<Group>,
    read: Vec<(&'static str, String)>,
    settings: Vec<(&'static str, String)>,
    timing: Vec<(&'a str, String)>,
    program: String,
}

impl<'a> Page<'a> {
    pub(super) fn new(record: &'a CompositingRecord, extras: &'a CompositingExtras) -> Self {
        let word = record.verdict.map_or("NO LIMIT", verdict_word);
        Self {
            title: format!("{word}: compositing of {}", record.scene),
            scene: &record.scene,
            subtitle: format!("Compositing as \u{201c}{}\u{201d} sees it, audited", record.camera),
            class: class(record.verdict),
            word,
            sentence: sentence(&record.findings, record.verdict, record.limit),
            facts: facts(record),
            findings: record.findings.iter().skip(1).map(|f| minus(f)).collect(),
            charts: charts(record),
            edges: edges(record),
            lights: lights(record),
            clusters: [clusters(record), composite(record)].into_iter().flatten().collect(),
            picture: picture(record),
            groups: groups(extras.pictures),
            read: READING.map(|(what, text)| (what, minus(text))).to_vec(),
            settings: settings(record),
            timing: timing(extras.timing),
            program: program(),
        }
    }

    /// Drawings and tables of its charts.
    pub(super) fn chart_files(&self) -> Vec<Artifact> {
        chart::files(&self.charts)
    }
}

fn rms(e: Option<&Rms>) -> String {
    number(e.map(estimate).as_ref()).in_line()
}

fn size([w, h]: [u32; 2]) -> String {
    format!("{} \u{d7} {} pixels", count(w as usize), count(h as usize))
}

/// How many of the lights are within the judge's errors.
fn within(record: &CompositingRecord) -> String {
    let within = record.lights.iter().filter(|l| l.within).count();
    let of = record.lights.len();
    if of == 0 { UNKNOWN.into() } else { format!("{} of {}", count(within), count(of)) }
}

fn facts(record: &CompositingRecord) -> Vec<(&'static str, String)> {
    let judged = record.edges.iter().find(|r| r.sub_scanlines == record.judged_at);
    let same = match &record.composite {
        Some(c) if c.same_segments => "the same to the bit",
        Some(_) => "not the same",
        None => UNKNOWN,
    };
    vec![
        ("Error of the edges", rms(judged.map(|r| &r.error))),
        ("At sub-scanlines", count(record.judged_at as usize)),
        ("Limit", record.limit.map_or("none given".into(), percent_exact)),
        ("Power with which it falls", record.rate.map_or(UNKNOWN.into(), |r| minus(&significant(r, 3)))),
        ("Lights within the judge\u{2019}s errors", within(record)),
        ("Error of the picture", rms(Some(&record.picture.error))),
        ("Clusters", count(record.clusters.len())),
        ("All in one against the whole", same.into()),
        ("Faces", count(record.faces)),
        ("Size", size(record.size)),
    ]
}

fn settings(record: &CompositingRecord) -> Vec<(&'static str, String)> {
    let lights = &record.picture.lights;
    vec![
        ("Scene", record.scene.clone()),
        ("Camera", record.camera.clone()),
        ("Size", size(record.size)),
        ("Lights", if lights.is_empty() { "none".into() } else { lights.join(", ") }),
        ("Sub-scanlines that the limit is held against", count(record.judged_at as usize)),
        ("Limit", record.limit.map_or("none".into(), percent_exact)),
        ("Judge", format!("rays of the kernel {}", record.kernel)),
        ("Samples per pixel of the judge", count(record.samples as usize)),
        ("Seed", record.seed.to_string()),
    ]
}

/// Fills in the page; everything that is not markup of the template or a drawing is escaped.
pub(super) fn render(page: &Page, pictures: &[Artifact]) -> Result<String, ReportError> {
    let uris = inlined(pictures);
    let library = Library::for_charts(!page.charts.is_empty());
    let templates = frame::TEMPLATES.into_iter().chain(TEMPLATES);
    filled(templates, "compositing.html", context! { page, uris, library, styles => ["compositing.css"] })
}
