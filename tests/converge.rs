//! `etalon converge` from outside: curves of methods and of foreign series, refinement, two runs overlaid.

#[path = "common/program.rs"]
mod program;

use program::{ok, refused};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const SCENE: &str = "builtin:dynamic-cube";
/// Few rays, seen by rays alone: there is a noise floor to look at.
const RAYS: &str = "--rays 256 --randomisations 8 --estimator rays --kernel builtin --quiet";

type Row = BTreeMap<String, String>;

fn table(path: &Path) -> Vec<Row> {
    let mut csv = csv::Reader::from_path(path).expect("a table");
    let header = csv.headers().expect("a header").clone();
    let row = |r: csv::StringRecord| header.iter().map(String::from).zip(r.iter().map(String::from)).collect();
    csv.records().map(|r| row(r.expect("a row"))).collect()
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// The means of a stored reference: header, and rows of patch number and radiosities.
fn reference(folder: &Path) -> (String, Vec<(String, Vec<f64>)>) {
    let rows = table(&folder.join("reference.csv"));
    let text = fs::read_to_string(folder.join("reference.csv")).expect("a reference");
    let bands: Vec<String> = text.lines().next().expect("a header").split(',').map(String::from).collect();
    let bands: Vec<&String> = bands.iter().filter(|b| *b != "patch" && !b.ends_with("_std_err")).collect();
    let values = rows.iter().map(|r| (r["patch"].clone(), bands.iter().map(|b| number(r, b)).collect())).collect();
    (format!("patch,{}", bands.iter().map(|b| b.as_str()).collect::<Vec<_>>().join(",")), values)
}

/// Snapshots whose error after `shots` is `scale / shots` exactly: the reference, that much too bright.
fn plant(folder: &Path, references: &[&Path], scale: f64) {
    fs::create_dir_all(folder).expect("a folder");
    let mut index = String::from("edit,file,rays,shots,seconds\n");
    let mut cost = 0;
    for (edit, place) in references.iter().enumerate() {
        let (header, rows) = reference(place);
        for k in 0..6 {
            let shots = 10u64 << k;
            let factor = 1.0 + scale / shots as f64;
            let line = |(patch, values): &(String, Vec<f64>)| {
                let values: Vec<String> = values.iter().map(|v| format!("{:?}", v * factor)).collect();
                format!("{patch},{}\n", values.join(","))
            };
            let text: String = rows.iter().map(line).collect();
            fs::write(folder.join(format!("{edit}-{k}.csv")), format!("{header}\n{text}")).expect("written");
            let all = cost + shots;
            index += &format!("{edit},{edit}-{k}.csv,{},{all},{:?}\n", 64 * all, 0.001 * all as f64);
        }
        cost += 320;
    }
    fs::write(folder.join("index.csv"), index).expect("written");
}

#[test]
fn curves_of_methods_before_and_after_the_edit() {
    let place = tempfile::tempdir().expect("a folder");
    let methods = "--methods gather:rays=64|256|1024,estimator=rays,hemicube:resolution=10|20";
    let stdout = ok(place.path(), &format!("converge {SCENE} {methods} -o out {RAYS} --json"));
    let json: Value = serde_json::from_str(&stdout).expect("one object");
    assert!(json["reached"].as_array().is_some_and(|a| !a.is_empty()) && json["rates"].is_array());
    let out = place.path().join("out");
    for file in ["curves.csv", "rates.csv", "reached.csv", "index.html", "timing.json", "rms-rays-edit-0.svg"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    assert!(out.join("top1-seconds-edit-1.svg").is_file() && !out.join("top1-seconds-edit-0.svg").is_file());
    let header = fs::read_to_string(out.join("curves.csv")).expect("a table");
    assert!(header.starts_with(
        "method,edit,shots,rays,seconds,shots_since_edit,rays_since_edit,seconds_since_edit,rms,rms_std_err,rms_low,\
         rms_high,top1,top1_std_err,top1_low,top1_high,noise_floor"
    ));
    let rows = table(&out.join("curves.csv"));
    let edits = rows.iter().map(|r| r["edit"].parse::<usize>().expect("a number")).max().expect("rows");
    assert!(edits > 0);
    assert_eq!(rows.len(), 5 * (edits + 1));
    for r in &rows {
        assert!(number(r, "rms_low") <= number(r, "rms") && number(r, "rms") <= number(r, "rms_high"), "{r:?}");
        assert!(number(r, "noise_floor") > 0.0 && r["shots"] == "0");
        assert_eq!(r["edit"] == "0", r["top1"].is_empty(), "{r:?}");
        assert_eq!(r["method"].starts_with("hemicube"), r["rays"] == "0", "{r:?}");
    }
    // Each variant is solved anew in each state: the same rays as before, counted since the edit.
    let gather: Vec<&Row> = rows.iter().filter(|r| r["method"].starts_with("gather")).collect();
    let (first, second) = (gather[0], gather.iter().find(|r| r["edit"] == "1").expect("a state"));
    assert!(number(second, "rays") > number(first, "rays"));
    assert_eq!(number(second, "rays_since_edit"), number(second, "rays") - number(first, "rays"));
    let page = fs::read_to_string(out.join("index.html")).expect("a page");
    assert!(page.contains("noise of the reference") && page.contains("etalon converge builtin:dynamic-cube"));
}

#[test]
fn a_planted_rate_is_found_again_and_references_are_used_again() {
    // The plant is made of the reference itself: its noise must be small against what is planted.
    const RAYS: &str = "--rays 256 --randomisations 8 --kernel builtin --quiet";
    let place = tempfile::tempdir().expect("a folder");
    let at = |name: &str| place.path().join(name);
    let out = |arguments: &str| ok(place.path(), arguments);
    out(&format!("reference {SCENE} --state 0 -o out/reference-0 {RAYS}"));
    out(&format!("reference {SCENE} --state 1 -o out/reference-1 {RAYS}"));
    let before = fs::metadata(at("out/reference-1/replicates.npz")).and_then(|m| m.modified()).expect("a time");
    plant(&at("mine"), &[&at("out/reference-0"), &at("out/reference-1")], 4.0);
    plant(&at("twice"), &[&at("out/reference-0"), &at("out/reference-1")], 8.0);
    let text = out(&format!("converge {SCENE} --series mine=mine --series twice=twice -o out {RAYS}"));
    assert!(text.contains("mine") && text.contains("10 %") && text.contains("index.html"), "{text}");
    let after = fs::metadata(at("out/reference-1/replicates.npz")).and_then(|m| m.modified()).expect("a time");
    assert_eq!(before, after, "the reference was computed again");
    // The error of a solution that is everywhere too bright by x is x; cost counts from the edit.
    for r in table(&at("out/curves.csv")) {
        let planted = if r["method"] == "mine" { 4.0 } else { 8.0 } / number(&r, "shots_since_edit");
        assert!(number(&r, "rms_low") <= planted && planted <= number(&r, "rms_high"), "{planted} {r:?}");
    }
    let rates = table(&at("out/rates.csv"));
    assert_eq!(rates.len(), 2 * 3 * 3, "methods, axes, two errors after the edit and one before");
    for r in rates {
        let fitted = (number(&r, "slope_low"), number(&r, "slope_high"));
        assert!(fitted.0 <= -1.0 && -1.0 <= fitted.1, "{r:?}");
        assert!(number(&r, "points") >= 3.0 && fitted.1 - fitted.0 < 0.5, "{r:?}");
    }
    // 4 / shots is at 10 % from 40 shots on, 8 / shots from 80.
    let reached = table(&at("out/reached.csv"));
    let row = |m: &str| {
        let mut all = reached.iter().filter(|r| r["method"] == m && r["metric"] == "rms" && r["level"] == "0.1");
        all.next_back().expect("a row")
    };
    let (mine, twice) = (number(row("mine"), "shots"), number(row("twice"), "shots"));
    assert!((40.0..=80.0).contains(&mine) && twice == 2.0 * mine, "{mine} {twice}");
    assert_eq!(number(row("twice"), "shots_first_over_this"), 0.5);
}

#[test]
fn twice_the_same_bytes_but_for_the_clock_and_two_runs_overlaid() {
    let place = tempfile::tempdir().expect("a folder");
    let run = |name: &str, threads: usize| {
        let folder = place.path().join(name);
        fs::create_dir(&folder).expect("a folder");
        let methods = "--methods gather:rays=64|128|256,randomisations=8,estimator=rays";
        ok(&folder, &format!("converge {SCENE} {methods} -o out {RAYS} --threads {threads}"));
        folder.join("out")
    };
    let (a, b) = (run("a", 1), run("b", 2));
    let without_clock = |folder: &Path, file: &str| {
        let text = fs::read_to_string(folder.join(file)).expect("a file");
        match (text.find("<!-- wall-clock: begin"), text.find("<!-- wall-clock: end")) {
            (Some(begin), Some(end)) => text[..begin].to_string() + &text[end..],
            _ => text,
        }
    };
    let mut names: Vec<String> = fs::read_dir(&a)
        .expect("a folder")
        .map(|e| e.expect("an entry").file_name().into_string().expect("text"))
        .collect();
    names.sort();
    for name in names.iter().filter(|n| n.ends_with(".svg") && !n.contains("seconds") || *n == "index.html") {
        assert_eq!(without_clock(&a, name), without_clock(&b, name), "{name}");
    }
    let timeless = |folder: &Path, file: &str| {
        let mut rows = table(&folder.join(file));
        rows.iter_mut().for_each(|r| r.retain(|k, _| !k.starts_with("seconds")));
        rows.retain(|r| r.get("axis").is_none_or(|a| a != "seconds"));
        rows
    };
    for name in ["curves.csv", "rates.csv", "reached.csv"] {
        assert_eq!(timeless(&a, name), timeless(&b, name), "{name}");
    }
    let text = ok(place.path(), "converge diff a/out b/out -o over");
    assert!(text.contains("ratio 1.00") && text.contains("within the noise"), "{text}");
    let rows = table(&place.path().join("over/diff.csv"));
    let on_rays: Vec<&Row> =
        rows.iter().filter(|r| r["axis"] == "rays" && !r["second_over_first"].is_empty()).collect();
    assert!(!on_rays.is_empty());
    for r in on_rays {
        assert!(number(r, "second_over_first") == 1.0 && r["noise"] == "within-noise", "{r:?}");
    }
    assert!(place.path().join("over/rms-rays-edit-0.svg").is_file() && place.path().join("over/index.html").is_file());
    assert!(refused(place.path(), "converge diff a/out a -o over").contains("curves.csv"));
    fs::write(place.path().join("a/curves.csv"), "method,edit\nx,0\n").expect("written");
    assert!(refused(place.path(), "converge diff a/out a -o over").contains("line 2"));
}

/// Reflecting nothing but lit unevenly, the division into patches is all there is to be seen; here a closed cube with
/// one glowing face, its other faces grey.
#[test]
fn refinement_gives_an_order() {
    let place = tempfile::tempdir().expect("a folder");
    let rays = "--rays 2048 --randomisations 8 --kernel builtin --quiet";
    let methods = "--methods hemicube:resolution=100";
    let json: Value = serde_json::from_str(&ok(
        place.path(),
        &format!("converge builtin:cube-one-emitter {methods} --refine 1,2,3 -o out {rays} --json"),
    ))
    .expect("one object");
    let meshes = json["curves"][0]["meshes"].as_array().expect("meshes").clone();
    assert_eq!(meshes.len(), 3);
    let size = |k: usize| meshes[k]["mean_size"].as_f64().expect("a size");
    assert!((size(0) / size(1) - 2.0).abs() < 1e-9 && (size(0) / size(2) - 3.0).abs() < 1e-9);
    let rows = table(&place.path().join("out/refine.csv"));
    assert_eq!(rows.len(), 3);
    assert!(number(&rows[1], "patches") == 4.0 * number(&rows[0], "patches"));
    // A constant radiosity per patch: the error falls with the mesh.
    assert!(number(&rows[2], "rms") < number(&rows[0], "rms"), "{rows:?}");
    for file in ["orders.csv", "index.html", "rms-size.svg", "reference-x3/reference.json"] {
        assert!(place.path().join("out").join(file).is_file(), "{file}");
    }
}

#[test]
fn mistakes_are_refused_before_any_work() {
    let place = tempfile::tempdir().expect("a folder");
    let said = |arguments: &str| refused(place.path(), &format!("converge {arguments} -o out"));
    assert!(said(SCENE).contains("--methods, --series"));
    assert!(said(&format!("{SCENE} --methods photon-map")).contains("methods are"));
    assert!(said(&format!("{SCENE} --methods gather,gather")).contains("twice"));
    assert!(said(&format!("{SCENE} --methods gather --series gather=x")).contains("gather"));
    assert!(said(&format!("{SCENE} --series x")).contains("NAME=DIR"));
    assert!(said(&format!("{SCENE} --series x=nowhere")).contains("index.csv"));
    assert!(said(&format!("{SCENE} --methods gather --confidence 1")).contains("--confidence"));
    assert!(said(&format!("{SCENE} --methods gather --refine 1,0")).contains("--refine 0"));
    assert!(said(&format!("{SCENE} --methods gather --refine 1,1")).contains("twice"));
    assert!(said(&format!("{SCENE} --methods gather --refine 4000")).contains("patches"));
    assert!(said(&format!("{SCENE} --methods gather:rays=8|16 --refine 1,2")).contains("once for each value"));
    assert!(said(&format!("{SCENE} --methods gather --refine 1,2 --truth patch-system")).contains("continuous"));
    assert!(said("nowhere.toml --methods gather").contains("nowhere.toml"));
    let series = place.path().join("series");
    fs::create_dir(&series).expect("a folder");
    for (index, message) in [
        ("file,seconds,shots,rays\n", "\"edit\""),
        ("file,seconds,shots,rays,edit\n", "no snapshot"),
        ("file,seconds,shots,rays,edit\na.csv,0,0,x,0\n", "line 2"),
        ("file,seconds,shots,rays,edit\n../a.csv,0,0,0,0\n", "leaves the folder"),
        ("file,seconds,shots,rays,edit\na.csv,0,0,0,99\n", "edit 99"),
        ("file,seconds,shots,rays,edit\na.csv,0,0,0,0\n", "no file \"a.csv\""),
    ] {
        fs::write(series.join("index.csv"), index).expect("written");
        let said = said(&format!("{SCENE} --series x=series"));
        assert!(said.contains(message) && said.contains("index.csv"), "{message}: {said}");
    }
    assert!(!place.path().join("out").exists(), "something was left behind");
}
