use super::*;
use crate::metrics::Verdict;
use crate::render::testing::{room, tracer};
use crate::render::{View, views};
use crate::report::Phase;
use crate::report::chart::testing::without_library;
use crate::report::testing::{record, with_split, with_verdict};

fn seen() -> Vec<View> {
    let stage = room();
    views(&tracer(&stage))
}

fn page(record: &Record, extras: &Extras) -> String {
    let files = HtmlReport.export(record, extras).expect("report");
    assert_eq!(files[0].name, PAGE_NAME);
    String::from_utf8(files[0].bytes.clone()).expect("utf-8")
}

#[test]
fn the_pages_data() {
    let record = with_verdict(Verdict::Fail);
    let views = seen();
    let shown = figures(&record, &views).expect("figures");
    insta::assert_json_snapshot!(Page::new(&record, &shown, &[]), {
        ".program" => "[program]",
        ".views[].figures[].bar.stops" => "[colours]",
        ".views[].figures[].marks" => "[marks]",
        ".worst.rows[1:]" => "[more]",
        ".charts[].svg" => "[drawing]",
        ".charts[].data" => "[data]",
        ".charts[].rows[2:]" => "[more]",
    });
}

#[test]
fn the_folder_holds_page_data_pictures_and_layers() {
    let views = seen();
    let timing = [Phase { name: "Rays".into(), seconds: 1.25 }];
    let files = HtmlReport.export(&record(), &Extras { views: &views, timing: &timing }).expect("report");
    let names: Vec<&str> = files.iter().map(|f| f.name.as_str()).collect();
    let expected = [
        "report.html",
        "record.json",
        "timing.json",
        "errors.svg",
        "errors.csv",
        "noise.svg",
        "noise.csv",
        "main-reference.png",
        "main-candidate.png",
        "main-difference.png",
        "main-relative.png",
        "main-std_err.png",
        "main-z.png",
        "main-reference-smooth.png",
        "main-candidate-smooth.png",
        "main.exr",
    ];
    assert_eq!(names, expected);
    assert_eq!(&files[7].bytes[..4], b"\x89PNG");
    assert_eq!(&files[15].bytes[..4], &[0x76, 0x2f, 0x31, 0x01]);
    let data: serde_json::Value = serde_json::from_slice(&files[1].bytes).expect("json");
    assert_eq!(data["format"], "etalon-record/1");
    assert_eq!(data["comparison"]["rms"]["value"], 0.013412);
}

/// Nine figures: machines differ in the last ones.
fn rounded(value: serde_json::Value) -> serde_json::Value {
    use serde_json::Value;
    match value {
        Value::Number(n) if n.is_f64() => {
            let x = n.as_f64().expect("a number");
            format!("{x:.8e}").parse::<f64>().expect("a number").into()
        }
        Value::Array(all) => all.into_iter().map(rounded).collect(),
        Value::Object(all) => all.into_iter().map(|(name, v)| (name, rounded(v))).collect(),
        other => other,
    }
}

#[test]
fn the_record_as_data() {
    let file = record_file(&with_verdict(Verdict::Fail)).expect("json");
    let data: serde_json::Value = serde_json::from_slice(&file.bytes).expect("json");
    insta::assert_json_snapshot!(rounded(data), {
        ".breakdown.noise.scores" => "[by patch]",
        ".reference" => "[by patch]",
        ".solution" => "[by patch]",
        ".stage" => "[the scene]",
    });
}

#[test]
fn the_record_makes_the_same_page_again() {
    let views = seen();
    let timing = [Phase { name: "Rays".into(), seconds: 1.25 }];
    let extras = Extras { views: &views, timing: &timing };
    let first = HtmlReport.export(&with_verdict(Verdict::Fail), &extras).expect("report");
    let read = crate::report::read_record(&first[1].bytes).expect("a record");
    assert!(HtmlReport.export(&read, &extras).expect("report") == first);
}

/// What a reader is told must change with the data: reference and solution swapped, a finding dropped, a bin moved.
#[test]
fn the_pages_data_follow_the_record() {
    let record = with_verdict(Verdict::Fail);
    let data = |r: &Record| serde_json::to_value(Page::new(r, &[], &[])).expect("json");
    let whole = data(&record);
    let mut other = record.clone();
    other.findings.clear();
    assert_eq!(
        (whole["findings"].as_array().map(Vec::len), data(&other)["findings"].as_array().map(Vec::len)),
        (Some(1), Some(0))
    );
    let breakdown = other.breakdown.as_mut().expect("a breakdown");
    let bins = &mut breakdown.errors.as_mut().expect("errors").bins;
    let fullest = (0..bins.len()).max_by(|a, b| bins[*a].total_cmp(&bins[*b])).expect("bins");
    bins.swap(fullest, fullest + 1);
    assert_ne!(whole["charts"][0]["data"], data(&other)["charts"][0]["data"]);
    assert_eq!(whole["charts"][1], data(&other)["charts"][1]);
}

#[test]
fn no_findings_reads_none_and_no_noise_draws_no_noise() {
    let mut r = record();
    assert!(page(&r, &Extras::default()).contains("The middle of patch 12 lies inside the box."));
    r.findings.clear();
    let breakdown = r.breakdown.as_mut().expect("a breakdown");
    breakdown.noise = None;
    r.contributions.clear();
    let html = page(&r, &Extras::default());
    assert!(html.contains("<p class=\"lead\">None.</p>") && !html.contains("Error or noise?"));
    assert!(!html.contains("What lights the worst"));
    r.breakdown = None;
    let html = page(&r, &Extras::default());
    assert!(!html.contains("By surface") && !html.contains(">Why<"));
    let rest = html.len() - scene3d::LIBRARY.len();
    assert!(!html.contains("Plotly") && rest < 200_000, "a page without charts carries no library for them");
}

#[test]
fn whatever_a_scene_is_called_stays_text() {
    let attack = "<script>alert(1)</script>\"'&{{ 7 * 7 }}";
    let mut r = with_verdict(Verdict::Inconclusive);
    r.stage.name = attack.into();
    r.solution_name = attack.into();
    r.replay = attack.into();
    r.notices = vec![attack.into()];
    r.truth = attack.into();
    r.settings[0].value = attack.into();
    r.settings[1].default = Some(attack.into());
    let finding = &mut r.findings[0];
    (finding.what, finding.mend, finding.place.surfaces) = (attack.into(), attack.into(), vec![attack.into()]);
    r.contributions[0].sources[0].surface = attack.into();
    r.contributions[0].surface = attack.into();
    let breakdown = r.breakdown.as_mut().expect("a breakdown");
    breakdown.surfaces[0].name = attack.into();
    breakdown.surfaces[0].object = Some(attack.into());
    breakdown.objects[0].name = attack.into();
    r.provenance[0].1 = attack.into();
    r.comparison.worst[0].surface = attack.into();
    r.comparison.per_band[0].0 = attack.into();
    r.stage.photometry.bands[0] = attack.into();
    let mut views = seen();
    let stage = room();
    let mut camera = stage.cameras[0].clone();
    camera.name = attack.into();
    views[0].visibility = crate::render::Visibility::cast(&tracer(&stage), &camera, 1);
    let html = page(&r, &Extras { views: &views, timing: &[Phase { name: attack.into(), seconds: 1.0 }] });
    assert!(!html.contains("<script>alert"), "an unescaped name");
    assert!(html.contains("&lt;script&gt;alert(1)"));
    assert!(html.contains("{{ 7 * 7 }}") || html.contains("{{ 7 * 7 }}".replace(' ', "&#x20;").as_str()));
    // The page's own script, the charts' library and what calls it, the data of two charts; and of the scene to turn: data,
    // library, program.
    let ours = without_library(&html);
    assert_eq!((ours.matches("<script>").count(), ours.matches("<script").count()), (5, 8));
}

#[test]
fn the_page_asks_for_nothing_from_outside() {
    let views = seen();
    let html = page(&record(), &Extras { views: &views, timing: &[] });
    // The library names an address of XML, which is none of the network.
    let ours = without_library(&html).replace(scene3d::LIBRARY, "");
    assert!(ours.len() + scene3d::LIBRARY.len() < html.len() && html.len() < 6_000_000);
    for outside in ["http://", "https://", "src=\"/", "@import", "url(http", "<link"] {
        assert!(!ours.contains(outside), "{outside}");
    }
    assert_eq!(html.matches("data:image/png;base64,").count(), 8);
}

#[test]
fn the_scene_to_turn_is_there_with_the_licence_of_what_draws_it() {
    let mut r = record();
    let html = page(&r, &Extras::default());
    assert!(html.contains("id=\"viewer-data\"") && html.contains("Copyright \u{a9} 2010-2026 three.js authors"));
    r.stage = crate::study::anonymous_stage(r.stage.patch_count(), r.stage.photometry.clone());
    let html = page(&r, &Extras::default());
    assert!(!html.contains("viewer-data") && !html.contains("three.js"));
}

#[test]
fn each_verdict_has_its_word_its_icon_and_its_sentence_first() {
    for (verdict, class, word) in [
        (Verdict::Pass, "verdict pass", "PASS"),
        (Verdict::Fail, "verdict fail", "FAIL"),
        (Verdict::Inconclusive, "verdict open", "INCONCLUSIVE"),
    ] {
        let html = page(&with_verdict(verdict), &Extras::default());
        let (band, numbers) = (html.find(class).expect("band"), html.find("The numbers").expect("numbers"));
        assert!(band < numbers && html[band..numbers].contains(word));
        assert!(html[band..numbers].contains("<svg") && html[band..numbers].contains("its luminance error is"));
    }
    assert!(page(&record(), &Extras::default()).contains("verdict none"));
}

#[test]
fn only_the_marked_block_depends_on_the_clock() {
    let views = seen();
    let with = |seconds| {
        let timing = [Phase { name: "Rays".into(), seconds }];
        HtmlReport.export(&record(), &Extras { views: &views, timing: &timing }).expect("report")
    };
    let (fast, slow) = (with(1.0), with(2.0));
    let apart = |files: &[Artifact]| -> Vec<Artifact> {
        let cut = |a: &Artifact| {
            let text = String::from_utf8_lossy(&a.bytes).into_owned();
            match (text.find("<!-- wall-clock: begin"), text.find("<!-- wall-clock: end")) {
                (Some(from), Some(to)) => Artifact::new(a.name.clone(), text[..from].to_string() + &text[to..]),
                _ => a.clone(),
            }
        };
        files.iter().filter(|a| a.name != "timing.json").map(cut).collect()
    };
    assert_ne!(fast[0], slow[0]);
    assert_eq!(apart(&fast), apart(&slow));
}

#[test]
fn a_split_is_a_table_and_a_chart_with_intervals() {
    let files = HtmlReport.export(&with_split(), &Extras::default()).expect("report");
    let html = String::from_utf8(files[0].bytes.clone()).expect("utf-8");
    let from = html.find("Where the error comes from").expect("a section");
    let section = &html[from..html.find("Errors and noise").expect("the next")];
    let row = "<span class=\"big\">1.10\u{202f}%</span><small>1.00 to 1.20\u{202f}%</small></td>\n<td class=\"num\">+0.400\u{202f}%";
    assert!(section.contains(row) && section.contains("data-chart"), "{section}");
    assert!(section.contains("0.213\u{202f}% of the squared difference"));
    assert!(files.iter().any(|f| f.name == "budget.svg") && files.iter().any(|f| f.name == "budget.csv"));
    assert!(!page(&record(), &Extras::default()).contains("Where the error comes from"));
}
