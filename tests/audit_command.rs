//! `etalon audit hemicube` as a script runs it.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused, run};
use serde_json::Value;
use std::fs;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

/// A record without its seconds, which differ from run to run.
fn timeless(mut value: Value) -> Value {
    program::strip_seconds(&mut value);
    // Findings quote seconds in words.
    value["findings"].as_array_mut().expect("findings").retain(|f| f["about"] != "mend");
    value
}

#[test]
fn the_limit_sets_the_exit_code() {
    let place = folder();
    let here = place.path();
    let audit = |rest: &str| run(here, &format!("audit hemicube builtin:small-lamp -o audit --rotations 0 {rest}"));
    let (code, out, err) = audit("--max-error 5% --resolution 50 --source lamp");
    assert_eq!(code, 1, "{out}{err}");
    assert!(
        out.contains("mostly aliasing") && out.contains("miss it altogether") && out.contains("cheapest that passes")
    );
    for file in ["index.html", "audit.json", "pairs.csv", "patches.csv", "sources.csv", "cures.csv", "curves.csv"] {
        assert!(here.join("audit").join(file).metadata().is_ok_and(|m| m.len() > 100), "{file}");
    }
    let (code, out, err) = audit("--max-error 5% --resolution 400 --no-cures");
    assert_eq!(code, 0, "{out}{err}");
    // A limit that is the error itself cannot be told from it by rays.
    let cube = "audit hemicube builtin:cube-one-emitter -o cube --resolution 50 --rotations 0 --no-cures";
    let value = json(here, cube)["wrong"]["rms"]["value"].as_f64().expect("a number");
    let by_rays = format!("{cube} --estimator rays --rays 4096 --max-error {value}");
    let (code, out, err) = run(here, &by_rays);
    assert_eq!(code, 3, "{out}{err}");
    assert_eq!(run(here, &format!("{by_rays} --on-inconclusive fail")).0, 1);
}

#[test]
fn the_same_on_any_number_of_threads() {
    let place = folder();
    let here = place.path();
    let audit = |threads: u32| {
        let line = format!(
            "audit hemicube builtin:cube-one-emitter -o a{threads} --resolution 50 --rotations 2 --max-error 1%"
        );
        let (code, ..) = run(here, &format!("{line} --threads {threads}"));
        assert!(code < 2);
        let text = fs::read(here.join(format!("a{threads}/audit.json"))).expect("written");
        (
            timeless(serde_json::from_slice(&text).expect("JSON")),
            fs::read(here.join(format!("a{threads}/pairs.csv"))).ok(),
        )
    };
    assert!(audit(1) == audit(2));
}

/// Of every pair the three causes add up to hemi-cube minus truth, also in the file.
#[test]
fn the_table_of_pairs_adds_up() {
    let place = folder();
    let here = place.path();
    ok(here, "audit hemicube builtin:cube-one-emitter -o a --resolution 50 --rotations 0 --no-cures");
    let mut table = csv::Reader::from_path(here.join("a/pairs.csv")).expect("a table");
    let mut rows = 0;
    for row in table.records() {
        let row: Vec<f64> = row.expect("a row").iter().map(|x| x.parse().expect("a number")).collect();
        assert!((row[2] - row[4] - row[6] - row[8] - row[10]).abs() < 1e-15, "{row:?}");
        rows += 1;
    }
    assert!(rows >= 20, "{rows}");
    ok(here, "audit hemicube builtin:cube-one-emitter -o a --resolution 50 --rotations 0 --no-cures --pairs 10");
    assert_eq!(fs::read_to_string(here.join("a/pairs.csv")).expect("a table").lines().count(), 11);
}

/// Our own hemi-cube's matrix, as anybody might hand it over: the same errors, and what made it.
#[test]
fn anybodys_matrix() {
    let place = folder();
    let here = place.path();
    ok(here, "solve builtin:cube-one-emitter --method hemicube:resolution=64 -o s.csv --save-form-factors f.npz");
    let line = "audit hemicube builtin:cube-one-emitter -o a --rotations 0 --no-cures";
    let theirs = json(here, &format!("{line} --form-factors f.npz --resolution 100"));
    let ours = json(here, &format!("{line} --resolution 64"));
    assert_eq!(theirs["fingerprint"]["resolution"], 64, "{}", theirs["fingerprint"]);
    assert_eq!(theirs["resolution"], 64);
    assert_eq!(theirs["matrix"], ours["matrix"]);
    assert_eq!(theirs["alone"], ours["alone"]);
}

/// Hemi-cubes at the shooter make other errors than hemi-cubes at the receivers, and the words say which they are.
#[test]
fn progressive_refinement_has_errors_of_its_own() {
    let place = folder();
    let here = place.path();
    let line = "audit hemicube builtin:cornell-box-coarse -o a --resolution 50 --rotations 0 --no-cures";
    let of = |rest: &str| {
        let found = json(here, &format!("{line} {rest}"));
        let text = found["findings"][0]["text"].as_str().expect("words").to_string();
        (found["wrong"]["rms"]["value"].as_f64().expect("a number"), text)
    };
    let ((matrix, at_receivers), (shooter, at_shooters)) = (of(""), of("--method progressive"));
    assert!((matrix - shooter).abs() > 1e-3, "{matrix} {shooter}");
    assert!(at_receivers.contains("at every patch") && at_shooters.contains("progressive refinement"));
}

#[test]
fn bad_input_names_the_place_and_the_mend() {
    let place = folder();
    let here = place.path();
    fs::write(here.join("short.csv"), "i,j,form_factor\n0,1,0.5\n").expect("written");
    for (line, said) in [
        ("builtin:small-lamp -o a --source lmap", "lmap"),
        ("builtin:small-lamp -o a --resolution 51", "even"),
        ("builtin:small-lamp -o a --resolution 50,9000", "4096"),
        ("builtin:small-lamp -o a --settings resolution=50", "--resolution"),
        ("builtin:small-lamp -o a --settings delta=best", "midpoint or exact"),
        ("builtin:small-lamp -o a --patch 100000", "etalon scene patches"),
        ("builtin:small-lamp -o a --confidence 1", "between 0 and 1"),
        ("builtin:small-lamp -o a --form-factors none.npz", "none.npz"),
        ("builtin:small-lamp -o a --form-factors short.csv --method progressive", "cannot be used with"),
        ("builtin:no-such-scene -o a", "no-such-scene"),
    ] {
        let message = refused(here, &format!("audit hemicube {line}"));
        assert!(message.contains(said), "{line}: {message}");
        assert!(!here.join("a").exists(), "{line}");
    }
}
