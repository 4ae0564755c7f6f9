//! The report folder from outside: complete, made again to the byte, sound where little is known.

#[path = "common/program.rs"]
mod program;

use program::{ok, refused};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entry = |e: std::io::Result<std::fs::DirEntry>| {
        let path = e.expect("an entry").path();
        (path.file_name().expect("a name").to_string_lossy().to_string(), std::fs::read(&path).expect("readable"))
    };
    std::fs::read_dir(folder).expect("a folder").map(entry).collect()
}

fn record(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("record.json")).expect("a record")).expect("json")
}

fn workshop() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    ok(place.path(), "reference builtin:cornell-box-coarse -o ref --rays 4096 --seed 5 --estimator rays");
    ok(place.path(), "solve builtin:cornell-box-coarse --method hemicube:resolution=20 -o h.csv");
    place
}

#[test]
fn the_page_is_made_again_to_the_byte() {
    let place = workshop();
    let (here, page) = (place.path(), place.path().join("page"));
    ok(here, "compare h.csv --reference ref --report page");
    let first = files(&page);
    for name in first.keys().filter(|n| !n.ends_with(".json")) {
        std::fs::remove_file(page.join(name)).expect("removed");
    }
    ok(here, "report page");
    assert!(files(&page) == first);
    // Without the clock's file only the marked block is gone.
    std::fs::remove_file(page.join("timing.json")).expect("removed");
    ok(here, "report page");
    assert!(!String::from_utf8_lossy(&files(&page)["report.html"]).contains("wall-clock: begin"));
}

#[test]
fn the_record_says_what_lights_the_worst_and_who_set_what() {
    let place = workshop();
    ok(place.path(), "check h.csv --reference ref --max-rms 99% --report page");
    let r = record(&place.path().join("page"));
    assert_eq!(r["format"], "etalon-record/1");
    let worst: Vec<&Value> = r["comparison"]["worst"].as_array().expect("a list").iter().take(5).collect();
    let lit = r["contributions"].as_array().expect("a list");
    assert_eq!(lit.len(), 5);
    for (w, c) in worst.iter().zip(lit) {
        assert_eq!((&w["patch"], &w["surface"]), (&c["receiver"], &c["surface"]));
        let number = |v: &Value| v.as_f64().expect("a number");
        // The judge's own rays again: the sum is the reference, but for the bias it has shed.
        let (sum, reference) = (number(&c["sum"]["value"]), number(&c["reference"]["value"]));
        assert!((sum - reference).abs() < 0.1 * number(&c["reference"]["std_err"]), "{sum} {reference}");
        let parts = number(&c["own"]["value"]) + number(&c["handed_on"]["value"]);
        assert!((parts - number(&c["difference"])).abs() < 1e-12);
        assert!((number(&c["difference"]) - number(&w["difference"])).abs() < 1e-12);
    }
    let setting = |of: &str, name: &str| {
        let all = r["settings"].as_array().expect("a list");
        let one = all.iter().find(|s| s["of"] == of && s["name"] == name).unwrap_or_else(|| panic!("{of} {name}"));
        (one["value"].as_str().expect("text").to_string(), one["default"].as_str().map(str::to_string))
    };
    assert_eq!(setting("reference", "--rays"), ("4096".into(), Some("16384".into())));
    assert_eq!(setting("reference", "--seed"), ("5".into(), Some("0".into())));
    assert_eq!(setting("judgement", "--max-rms"), ("0.99".into(), Some("none".into())));
    assert!(r["replay"].as_str().is_some_and(|t| t.contains("--report page")));
}

#[test]
fn elements_are_explained_as_elements() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "reference builtin:dynamic-cube -o ref --rays 1024");
    ok(here, "solve builtin:dynamic-cube --method hemicube:resolution=20 --per element -o e.csv");
    ok(here, "compare e.csv --reference ref --per element --report page");
    let r = record(&here.join("page"));
    let (worst, lit) = (&r["comparison"]["worst"], &r["contributions"]);
    assert_eq!(worst[0]["patch"], lit[0]["receiver"]);
    let (a, b) = (worst[0]["reference"].as_f64().expect("a number"), lit[0]["reference"]["value"].as_f64());
    assert!((a - b.expect("a number")).abs() < 1e-12 * a.abs());
}

#[test]
fn another_solution_has_no_noise_and_casts_no_rays() {
    let place = workshop();
    let here = place.path();
    ok(here, "solve builtin:cornell-box-coarse --method hemicube:resolution=50 -o better.csv");
    ok(here, "solve builtin:cube-one-emitter --method hemicube:resolution=20 -o cube.csv");
    ok(here, "solve builtin:cube-one-emitter --method hemicube:resolution=50 -o finer.csv");
    ok(here, "compare cube.csv --reference finer.csv --report page");
    let r = record(&here.join("page"));
    assert!(r["breakdown"]["noise"].is_null() && r["contributions"].as_array().is_some_and(Vec::is_empty));
    ok(here, "compare h.csv --reference better.csv --scene builtin:cornell-box-coarse --report seen");
    let surfaces = record(&here.join("seen"))["breakdown"]["surfaces"].clone();
    let shares: f64 = surfaces.as_array().expect("a list").iter().filter_map(|s| s["share"]["value"].as_f64()).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");
}

#[test]
fn a_damaged_or_foreign_record_is_refused_with_its_mend() {
    let place = workshop();
    let here = place.path();
    ok(here, "compare h.csv --reference ref --report page");
    let path = here.join("page/record.json");
    let whole = std::fs::read_to_string(&path).expect("readable");
    let half = whole[..whole.len() / 2].to_string();
    for (text, says) in [
        (whole.replace("etalon-record/1", "etalon-record/9"), "etalon-record/9"),
        (half, "cannot be read"),
        (String::new(), "cannot be read"),
        ("{\"format\": \"etalon-record/1\"}".into(), "missing field"),
    ] {
        std::fs::write(&path, text).expect("writable");
        let err = refused(here, "report page");
        assert!(err.contains(says) && err.contains("record.json") && err.contains("check --report"), "{err}");
    }
}
