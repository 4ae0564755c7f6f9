//! `form-factors check` and `repair`: what they say of sound and of broken matrices, ours and anybody's.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused, run};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Coarse Cornell box, cast into `f.csv` (errors in its own column), `f.npz` and `se.npz`.
fn workshop() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    ok(place.path(), "form-factors builtin:cornell-box-coarse -o f.csv --rays 4096 --estimator rays");
    ok(place.path(), "form-factors builtin:cornell-box-coarse -o f.npz --std-err se.npz --rays 4096 --estimator rays");
    place
}

/// (i, j) -> (form factor, standard error) of a .csv matrix.
fn entries(path: &Path) -> BTreeMap<(usize, usize), (f64, f64)> {
    let text = std::fs::read_to_string(path).expect("written");
    let entry = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap_or(f64::NAN);
        ((number(0) as usize, number(1) as usize), (number(2), number(3)))
    };
    text.lines().skip(1).map(entry).collect()
}

/// Writes a matrix without errors.
fn write(path: &Path, entries: impl Iterator<Item = ((usize, usize), f64)>) {
    let lines: String = entries.map(|((i, j), v)| format!("{i},{j},{v:?}\n")).collect();
    std::fs::write(path, format!("i,j,form_factor\n{lines}")).expect("writable");
}

fn verdict(folder: &Path, arguments: &str) -> (i32, Value) {
    let (code, out, err) = run(folder, &format!("{arguments} --json"));
    (code, serde_json::from_str(&out).unwrap_or_else(|e| panic!("{arguments}: {e}\n{out}\n{err}")))
}

#[test]
fn rays_of_ours_pass_and_come_out_closed_and_reciprocal() {
    let place = workshop();
    let here = place.path();
    let scene = "--scene builtin:cornell-box-coarse";
    let found = json(here, &format!("form-factors check f.npz {scene} --std-err se.npz"));
    assert_eq!(found["physics"]["broken"], false, "{found}");
    assert!(found["physics"]["reciprocity"]["rms_sigmas"].as_f64().is_some_and(|s| (0.5..1.5).contains(&s)), "{found}");
    // The same errors out of the column of the .csv.
    let (code, same) = verdict(here, &format!("form-factors check f.csv {scene}"));
    assert_eq!((code, &same["physics"]["reciprocity"]), (0, &found["physics"]["reciprocity"]));

    let told = json(here, &format!("form-factors repair f.csv {scene} -o fixed.csv --save-std-err fixed-se.npz"));
    let enforcement = &told["enforcement"];
    assert_eq!(enforcement["weights"], "standard-errors");
    assert!(told["closed"] == false && enforcement["unmet"].as_array().is_some_and(Vec::is_empty), "{told}");
    assert!(enforcement["after"]["largest_reciprocity"].as_f64().is_some_and(|d| d < 1e-15), "{enforcement}");
    assert!(enforcement["after"]["largest_closure"].as_f64().is_some_and(|d| d < 1e-14), "{enforcement}");
    // Standard errors shrink where two directions were pooled, and never grow much.
    let (before, after) = (entries(&here.join("f.csv")), entries(&here.join("fixed.csv")));
    let mean = |all: &BTreeMap<_, (f64, f64)>| all.values().map(|e| e.1 * e.1).sum::<f64>();
    assert!(mean(&after) < 0.6 * mean(&before), "{} {}", mean(&after), mean(&before));
    let (code, again) = verdict(here, &format!("form-factors check fixed.csv {scene}"));
    assert_eq!(code, 0, "{again}");
}

#[test]
fn a_closed_room_is_closed_and_the_same_on_any_number_of_threads() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "form-factors builtin:furnace -o f.csv --rays 1024 --estimator rays");
    let told =
        json(here, "form-factors repair f.csv --scene builtin:furnace -o one.npz --save-std-err se1.npz --threads 1");
    assert_eq!(told["closed"], true);
    assert!(told["enforcement"]["after"]["largest_closure"].as_f64().is_some_and(|d| d < 1e-14), "{told}");
    ok(here, "form-factors repair f.csv --scene builtin:furnace -o two.npz --save-std-err se2.npz --threads 2");
    for (a, b) in [("one.npz", "two.npz"), ("se1.npz", "se2.npz")] {
        assert!(std::fs::read(here.join(a)).expect("written") == std::fs::read(here.join(b)).expect("written"), "{a}");
    }
}

#[test]
fn classic_mistakes_are_named_and_repaired() {
    let place = workshop();
    let here = place.path();
    let f = entries(&here.join("f.csv"));
    let scene = "--scene builtin:cornell-box-coarse";
    // Of a ray-cast matrix, with its noise, and without errors, as another tool would hand it over.
    write(&here.join("transposed.csv"), f.iter().map(|((i, j), e)| ((*j, *i), e.0)));
    let (code, found) = verdict(here, &format!("form-factors check transposed.csv {scene}"));
    assert_eq!((code, &found["physics"]["mistake"]["layout"]), (1, &Value::from("transposed")), "{found}");
    let (code, out, _) = run(here, &format!("form-factors check transposed.csv {scene}"));
    assert!(code == 1 && out.contains("transposed") && out.contains("states no errors"), "{out}");
    let told = json(here, &format!("form-factors repair transposed.csv {scene} -o fixed.csv"));
    assert_eq!(told["undone"]["layout"], "transposed");
    assert_eq!(told["enforcement"]["weights"], "proportional-to-exchange");
    let fixed = entries(&here.join("fixed.csv"));
    let largest = f.iter().map(|(at, e)| (fixed.get(at).map_or(0.0, |x| x.0) - e.0).abs()).fold(0.0, f64::max);
    assert!(largest < 0.05, "{largest}");

    ok(here, "form-factors builtin:furnace -o cube.csv --rays 4096");
    let cube = entries(&here.join("cube.csv"));
    write(&here.join("pi.csv"), cube.iter().map(|(at, e)| (*at, e.0 * std::f64::consts::PI)));
    let (code, found) = verdict(here, "form-factors check pi.csv --scene builtin:furnace");
    assert_eq!((code, &found["physics"]["mistake"]["constant"]), (1, &Value::from("pi")), "{found}");
}

#[test]
fn a_broken_row_is_found_in_its_own_errors() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "form-factors builtin:furnace -o f.csv --rays 4096 --estimator rays");
    let lines = std::fs::read_to_string(here.join("f.csv")).expect("written");
    // Row 5 loses its entries above 1 %.
    let keep = |line: &&str| {
        !(line.starts_with("5,") && line.split(',').nth(2).is_some_and(|v| v.parse::<f64>().is_ok_and(|v| v > 0.01)))
    };
    let kept: Vec<&str> = lines.lines().filter(keep).collect();
    assert!(kept.len() < lines.lines().count());
    std::fs::write(here.join("g.csv"), kept.join("\n") + "\n").expect("writable");
    let (code, found) = verdict(here, "form-factors check g.csv --scene builtin:furnace");
    assert_eq!(code, 1, "{found}");
    assert_eq!(found["physics"]["closure"]["worst"][0]["row"], 5, "{found}");
}

#[test]
fn an_open_scene_is_not_asked_to_close() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "form-factors builtin:opposed-squares -o f.csv --rays 4096 --estimator rays");
    let scene = "--scene builtin:opposed-squares";
    let found = json(here, &format!("form-factors check f.csv {scene}"));
    assert_eq!((&found["physics"]["closed"], &found["physics"]["broken"]), (&Value::from(false), &Value::from(false)));
    let told = json(here, &format!("form-factors repair f.csv {scene} -o g.csv"));
    assert!(told["enforcement"]["moves"]["max_sigmas"].as_f64().is_some_and(|s| s < 8.0), "{told}");
}

#[test]
fn mistakes_of_the_user_are_refused_before_anything_is_written() {
    let place = workshop();
    let here = place.path();
    let scene = "--scene builtin:cornell-box-coarse";
    // The one format that has no room for standard errors.
    ok(here, "form-factors builtin:cornell-box-coarse -o f.mtx --rays 256 --estimator rays");
    let message = refused(here, "form-factors check f.npz --scene builtin:furnace");
    assert!(message.contains("f.npz") && message.contains("patches"), "{message}");
    let message = refused(here, &format!("form-factors check f.npz {scene} --std-err se.csv"));
    assert!(message.contains("own column"), "{message}");
    let message = refused(here, &format!("form-factors repair f.mtx {scene} -o x.npz --save-std-err y.npz"));
    assert!(message.contains("--std-err"), "{message}");
    assert!(!here.join("x.npz").exists() && !here.join("y.npz").exists());
    refused(here, &format!("form-factors repair f.npz {scene} -o x.txt"));
    refused(here, &format!("form-factors check nothing.npz {scene}"));
    refused(here, "form-factors check f.npz");
    refused(here, "form-factors");
    refused(here, "form-factors builtin:furnace");
    refused(here, &format!("form-factors check f.npz {scene} --tolerance -1"));
}
