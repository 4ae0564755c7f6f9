use super::testing::{curve, report};
use super::*;
use crate::report::chart::testing::without_library;
use crate::study::converge::{MeshPoint, MeshSize, diff};

fn page(files: &[Artifact]) -> String {
    let page = files.iter().find(|f| f.name == CURVES_PAGE).expect("a page");
    String::from_utf8(page.bytes.clone()).expect("text")
}

#[test]
fn a_run_has_its_tables_drawings_and_page() {
    let files = convergence_files(&report()).expect("files");
    let mut names: Vec<&str> = files.iter().map(|f| f.name.as_str()).collect();
    names.sort_unstable();
    let mut known = vec!["curves.csv", "index.html", "rates.csv", "reached.csv", "timing.json"];
    let drawings: Vec<String> = ["rms-shots-edit-0", "rms-rays-edit-0", "rms-seconds-edit-0"]
        .into_iter()
        .map(String::from)
        .chain(["rms", "top1"].iter().flat_map(|m| ["shots", "rays", "seconds"].map(|a| format!("{m}-{a}-edit-1"))))
        .flat_map(|n| [format!("{n}.svg"), format!("{n}.csv")])
        .collect();
    known.extend(drawings.iter().map(String::as_str));
    known.sort_unstable();
    assert_eq!(names, known);
    let page = page(&files);
    for svg in files.iter().filter(|f| f.name.ends_with(".svg")) {
        assert!(page.contains(std::str::from_utf8(&svg.bytes).expect("text").trim_end()), "{}", svg.name);
    }
    assert!(page.contains("a room &lt;with&gt;") && !page.contains("<with>"));
    let outside = without_library(&page);
    assert!(!outside.contains("http:") && !outside.contains("https:"), "asks for something from outside");
}

#[test]
fn only_the_marked_block_depends_on_the_clock() {
    let outside = |r: &CurvesReport| {
        let page = page(&convergence_files(r).expect("files"));
        let (begin, end) = (page.find("<!-- wall-clock: begin"), page.find("<!-- wall-clock: end"));
        page[..begin.expect("a block")].to_string() + &page[end.expect("its end")..]
    };
    let mut slow = report();
    for p in slow.curves.iter_mut().flat_map(|c| &mut c.points) {
        p.seconds *= 7.0;
        p.seconds_since_edit *= 7.0;
    }
    slow.digest = crate::study::converge::digest(&slow.curves, 0.95);
    slow.about.timing.clear();
    assert_eq!(outside(&report()), outside(&slow));
}

#[test]
fn the_first_method_is_what_the_others_are_measured_by() {
    let files = convergence_files(&report()).expect("files");
    let table = files.iter().find(|f| f.name == "reached.csv").expect("a table");
    let text = std::str::from_utf8(&table.bytes).expect("text");
    // 0.15 / shots against 1 / shots: 3 % at 10 and at 40 shots, of 10, 20, 40, ...
    let line = text.lines().find(|l| l.starts_with("redistribution,1,rms,0.03,")).expect("a line");
    assert!(line.starts_with("redistribution,1,rms,0.03,10.0,10.0,4.0,"), "{line}");
}

#[test]
fn two_runs_are_overlaid() {
    let runs = [vec![curve("m", 0, 1.0)], vec![curve("m", 0, 2.0), curve("other", 0, 1.0)]];
    let differences = diff(&runs[0], &runs[1]);
    let about = About { confidence: 0.95, ..report().about };
    let report = DifferenceReport { about, names: ["old".into(), "new".into()], curves: runs, differences };
    let files = difference_files(&report).expect("files");
    let page = page(&files);
    assert!(page.contains("old: m") && page.contains("new: m") && !page.contains("new: other"));
    assert!(page.contains("stroke-dasharray=\"6 4\"") && page.contains("apart"));
    assert!(difference_text(&report).contains("shots at 3 %: ratio 2.00 (apart)"), "{}", difference_text(&report));
}

#[test]
fn a_refinement_states_its_order() {
    let point = |factor: u32| {
        let h = 0.5 / f64::from(factor);
        let value = 0.2 * h * h;
        let rms = crate::stats::Estimate { value, std_err: Some(0.01 * value), low: 0.97 * value, high: 1.03 * value };
        let size = MeshSize { factor, patches: 6 * (factor * factor) as usize, longest_edge: h, mean_size: h };
        MeshPoint { size, rms: Some(rms), noise_floor: Some(1e-6) }
    };
    let curves = vec![MeshCurve { method: "gather".into(), points: [1, 2, 4, 8].map(point).to_vec() }];
    let report = MeshReport { about: report().about, curves };
    let files = mesh_files(&report).expect("files");
    let names: Vec<&str> = files.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["refine.csv", "orders.csv", "rms-size.svg", "rms-size.csv", "index.html", "timing.json"]);
    assert!(mesh_text(&report).contains("order 2.00"), "{}", mesh_text(&report));
    assert!(
        (mesh_json(&report)["curves"][0]["order"]["slope"]["value"].as_f64().expect("a number") - 2.0).abs() < 1e-9
    );
}

/// Each drawing's table holds the numbers of the run, to the bit.
#[test]
fn a_drawings_table_holds_the_numbers_of_the_run() {
    let report = report();
    let files = convergence_files(&report).expect("files");
    let table = files.iter().find(|f| f.name == "rms-shots-edit-1.csv").expect("a table");
    let mut read = csv::Reader::from_reader(table.bytes.as_slice());
    assert_eq!(
        read.headers().expect("a head").iter().collect::<Vec<_>>().join(","),
        "series,shots_since_edit,rms,rms_std_err,rms_low,rms_high,rays_since_edit,noise_floor"
    );
    let rows: Vec<csv::StringRecord> = read.records().map(|r| r.expect("a row")).collect();
    let points =
        report.curves.iter().filter(|c| c.edit == 1).flat_map(|c| c.points.iter().map(move |p| (&c.method, p)));
    let wanted: Vec<_> = points.collect();
    assert_eq!(rows.len(), wanted.len());
    for (row, (method, p)) in rows.iter().zip(wanted) {
        let (e, read) = (p.rms.expect("an error"), |k: usize| row[k].parse::<f64>().expect("a number"));
        assert_eq!((&row[0], read(1), read(2)), (method.as_str(), p.shots_since_edit as f64, e.value));
        assert_eq!((read(3), read(4), read(5)), (e.std_err.expect("an error"), e.low, e.high));
        assert_eq!((read(6), read(7)), (p.rays_since_edit as f64, p.noise_floor.expect("a floor")));
    }
}

/// The page's script is told what the drawing shows, and seconds only where the clock is spoken of.
#[test]
fn what_is_pointed_at_says_error_interval_and_costs() {
    let page = page(&convergence_files(&report()).expect("files"));
    let of = |stem: &str| {
        let from = page.find(&format!("id=\"{stem}\"")).expect("a chart");
        let data = &page[from + page[from..].find("<script type=\"application/json\">").expect("data") + 32..];
        serde_json::from_str::<serde_json::Value>(&data[..data.find("</script>").expect("an end")]).expect("json")
    };
    let shots = of("rms-shots-edit-0");
    let text = |v: &serde_json::Value| v["series"][0]["text"][2].as_str().expect("text").to_string();
    assert_eq!(text(&shots), "5.00\u{202f}% (4.85 to 5.15\u{202f}%) at 20 shots, 1,280 rays");
    assert!(text(&of("rms-seconds-edit-0")).ends_with("at 0.200 s, 20 shots, 1,280 rays"));
}
