//! The page of small real audits.

use super::*;
use crate::io::scene::builtin;
use crate::raycast::KernelKind;
use crate::reference::{Options, Progress};
use crate::render::{Visibility, fit_camera};
use crate::report::chart::testing::without_library;
use crate::report::format::percent_estimate;
use crate::report::html::context::minus;
use crate::report::testing::{assert_well_formed, outside, shown};
use crate::study::Session;
use crate::study::audit::{AuditRequest, Form, audit};
use std::sync::OnceLock;

struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}

fn stage() -> Stage {
    builtin("cube-one-emitter").expect("a scene").at(0).expect("a state")
}

fn request<'a>() -> AuditRequest<'a> {
    AuditRequest {
        scene: "cube <with> \"names\" & more".into(),
        params: "resolution=20".parse().expect("settings"),
        resolutions: vec![10, 40, 80],
        rotations: 3,
        sources: Vec::new(),
        limit: Some(0.01),
        confidence: 0.95,
        form: Form::Receiver,
        theirs: None,
        cures: true,
        reference: Options::default(),
    }
}

/// One audit for all tests.
fn record() -> &'static AuditRecord {
    static RECORD: OnceLock<AuditRecord> = OnceLock::new();
    RECORD.get_or_init(|| {
        let stage = stage();
        let session = Session::open(&stage, KernelKind::Builtin).expect("a kernel");
        audit(&session, &request(), &Silent).expect("an audit").record
    })
}

/// Few pixels: the tests look at what is painted, not at how well.
fn small_view(stage: &Stage) -> View {
    let session = Session::open(stage, KernelKind::Builtin).expect("a kernel");
    let tracer = session.tracer();
    let mut camera = fit_camera(&tracer);
    camera.size = [64, 48];
    View { visibility: Visibility::cast(&tracer, &camera, 1), fitted: true }
}

fn files(record: &AuditRecord) -> Vec<Artifact> {
    let stage = stage();
    let views = [small_view(&stage)];
    let image = Raster { width: 2, height: 1, rgba: vec![255; 8] };
    let pictures = [AuditPicture { name: "unfolded-1.png".into(), caption: "patch 1 <b> of -2 %".into(), image }];
    let timing = [Phase { name: "audit".into(), seconds: 1.25 }];
    let extras = AuditExtras { stage: &stage, views: &views, pictures: &pictures, timing: &timing };
    audit_files(record, &extras).expect("files")
}

fn page(record: &AuditRecord) -> String {
    let files = files(record);
    assert_eq!(files[0].name, AUDIT_PAGE);
    String::from_utf8(files[0].bytes.clone()).expect("text")
}

#[test]
fn the_page_holds_verdict_numbers_causes_sources_and_cures() {
    let record = record();
    let page = page(record);
    let rms = percent_estimate(&record.wrong.rms.expect("an error"), false).value;
    assert!(page.matches(&minus(&rms)).count() >= 3, "{rms}");
    let word = match record.verdict.expect("a verdict") {
        crate::metrics::Verdict::Pass => "PASS",
        crate::metrics::Verdict::Fail => "FAIL",
        crate::metrics::Verdict::Inconclusive => "INCONCLUSIVE",
    };
    assert!(page.contains(&format!("<span class=\"word\">{word}</span>")));
    for text in record.findings.iter().map(|f| &f.text).chain(record.cures.iter().map(|c| &c.words)) {
        assert!(page.contains(&shown(text)), "{text}");
    }
    let parts =
        ["By cause", "By source", "Worst receivers of", "Cures", "Error against cost", "Error against resolution"];
    let more = ["Counted over exact", "Error under rotation", "Where it is wrong", "What the hemi-cube saw"];
    for part in parts.iter().chain(&more).chain(&["Aliasing", "Proximity", "Visibility", "How it was made"]) {
        assert!(page.contains(part), "{part}");
    }
    let rate = record.rate.expect("a rate").value;
    assert!(page.contains(&minus(&format!("the power {rate:.2} of"))), "{rate}");
    assert!(page.contains(">power ") && page.contains(">limit 1 %</text>"));
}

#[test]
fn names_stay_text_and_nothing_comes_from_outside() {
    let page = page(record());
    assert!(page.contains("cube &lt;with&gt; &quot;names&quot; &amp; more") && !page.contains("<with>"));
    assert!(page.contains("patch 1 &lt;b&gt; of \u{2212}2\u{202f}%"));
    let page = without_library(&page);
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src=\"un"));
}

#[test]
fn the_page_is_well_formed() {
    assert_well_formed(&page(record()));
}

#[test]
fn maps_and_pictures_stand_beside_the_page() {
    let files = files(record());
    let names: Vec<&str> = files.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names.iter().filter(|n| n.starts_with("map-")).count() % 5, 0);
    for kind in ["light", "error", "aliasing", "proximity", "visibility"] {
        assert!(names.iter().any(|n| n.starts_with("map-") && n.ends_with(&format!("-{kind}.png"))), "{kind}");
    }
    assert!(names.contains(&"unfolded-1.png"));
    for stem in ["resolution", "ratio", "rotation", "cures"] {
        let of = |end: &str| files.iter().find(|f| f.name == format!("{stem}.{end}")).map(|f| f.bytes.as_slice());
        let svg = std::str::from_utf8(of("svg").expect("a drawing")).expect("text");
        roxmltree::Document::parse(svg).expect("xml");
        assert!(of("csv").expect("a table").iter().filter(|b| **b == b'\n').count() > 2, "{stem}");
    }
    let pictures = files.iter().filter(|f| f.name.ends_with(".png"));
    assert!(pictures.clone().all(|f| f.bytes.starts_with(b"\x89PNG")) && pictures.count() == files.len() - 9);
}

/// The tables of charts hold the numbers of the record.
#[test]
fn tables_beside_charts_hold_the_records_numbers() {
    let record = record();
    let files = files(record);
    let table = |name: &str| {
        let file = files.iter().find(|f| f.name == name).expect("a table");
        let rows = csv::Reader::from_reader(file.bytes.as_slice()).into_records().map(|r| r.expect("a row"));
        rows.collect::<Vec<csv::StringRecord>>()
    };
    let number = |row: &csv::StringRecord, k: usize| row[k].parse::<f64>().expect("a number");
    let resolutions = table("resolution.csv");
    for (row, at) in resolutions.iter().zip(&record.resolutions) {
        let e = at.wrong.rms.expect("an error");
        assert_eq!((number(row, 1), number(row, 2), number(row, 4)), (at.x, e.value, e.low));
    }
    let n = record.resolutions.len();
    assert!(resolutions[n..].iter().zip(&record.resolutions).all(|(row, at)| number(row, 2) == at.aliasing));
    let ratios = table("ratio.csv");
    assert_eq!(ratios.len(), record.views.iter().filter(|v| v.point > 0.0).count());
    for row in &ratios {
        let v = record.views.iter().find(|v| v.patch.to_string() == row[3]).expect("a patch");
        assert_eq!((number(row, 6), number(row, 7)), (v.cube, v.point));
    }
}

/// The maps show the causes: a cause that does nothing is the colour of nothing everywhere.
#[test]
fn a_map_follows_its_cause() {
    let bytes = |r: &AuditRecord, kind: &str| {
        let end = format!("-{kind}.png");
        files(r).into_iter().find(|f| f.name.ends_with(&end)).expect("a map").bytes
    };
    let mut other = record().clone();
    other.receivers.iter_mut().for_each(|r| r.carried[0] = 0.0);
    assert_ne!(bytes(record(), "aliasing"), bytes(&other, "aliasing"));
    assert_ne!(bytes(record(), "error"), bytes(&other, "error"));
    assert_eq!(bytes(record(), "light"), bytes(&other, "light"));
}

#[test]
fn only_marked_blocks_depend_on_the_clock() {
    let slow = {
        let mut r = record().clone();
        for (k, c) in r.cures.iter_mut().enumerate() {
            c.seconds *= 3.0 + k as f64;
        }
        r.cures.reverse();
        r.resolutions.iter_mut().chain(&mut r.rotations).for_each(|a| a.seconds *= 7.0);
        r.sources.iter_mut().for_each(|s| s.mended_by = Some(0));
        r.findings.iter_mut().filter(|f| f.about == "mend").for_each(|f| f.text = "took longer".into());
        r
    };
    let (fast, slow) = (page(record()), page(&slow));
    assert_ne!(fast, slow);
    assert_eq!(outside(&fast), outside(&slow));
    assert!(outside(&fast).len() > fast.len() / 3, "most of the page is no clock");
}

#[test]
fn progressive_refinement_and_foreign_matrices_are_named() {
    let mut r = record().clone();
    r.form = Form::Shooter;
    assert!(page(&r).contains("Progressive refinement with a hemi-cube of resolution 20 at the shooter"));
    assert!(!page(record()).contains("at the shooter"));
    r.form = Form::Receiver;
    r.theirs = Some("their<F>.csv".into());
    let page = page(&r);
    assert!(page.contains("Somebody else&#x27;s matrix") && page.contains("their&lt;F&gt;.csv"));
}

#[test]
fn an_audit_without_limit_cures_and_curves_has_a_page() {
    let mut r = record().clone();
    (r.limit, r.verdict, r.rate, r.wrong.top1) = (None, None, None, None);
    r.cures.clear();
    r.resolutions.truncate(1);
    r.rotations.clear();
    r.sources.clear();
    r.views.clear();
    let page = page(&r);
    assert!(
        page.contains("NO LIMIT")
            && !page.contains("<h2>Cures")
            && !page.contains("class=\"chart\"")
            && !page.contains("Plotly")
    );
}

#[test]
fn a_record_of_another_scene_is_refused() {
    let mut r = record().clone();
    r.receivers.pop();
    let stage = stage();
    let extras = AuditExtras { stage: &stage, views: &[], pictures: &[], timing: &[] };
    assert!(matches!(audit_files(&r, &extras), Err(ReportError::Shape { what: "audit", .. })));
}
