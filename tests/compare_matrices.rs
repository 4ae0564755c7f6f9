//! `form-factors compare` on true output of other tools and on errors of known size.
//!
//! The files and how they were made: `tests/data/tools/PROVENANCE.md`. They are fixed, so nothing here is random but
//! the judge's few witness rays, whose seed is fixed; settled pairs are exact to 1e-7.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused, run};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn data(name: &str) -> String {
    root().join("tests/data/tools").join(name).display().to_string()
}

fn cube_box() -> String {
    root().join("examples/tools/cube-box.toml").display().to_string()
}

/// The judge's matrix of the cube with a box, kept for one test.
fn judged(place: &Path) -> String {
    ok(place, &format!("form-factors {} -o judge.npz --std-err judge-se.npz --target-error 1e-6", cube_box()));
    format!("--scene {} --reference judge.npz --reference-std-err judge-se.npz", cube_box())
}

fn compared(place: &Path, with: &str, tool: &str, errors: bool) -> Value {
    let std_err =
        if errors { format!("--std-err {}", data(&format!("{tool}-cube-box-std-err.npz"))) } else { String::new() };
    json(place, &format!("form-factors compare {} {std_err} {with}", data(&format!("{tool}-cube-box.npz"))))
}

fn number(found: &Value, path: &str) -> f64 {
    found.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {found}"))
}

#[test]
fn ray_casters_with_honest_errors_do_not_differ_beyond_them() {
    let place = tempfile::tempdir().expect("a folder");
    let with = judged(place.path());
    // Relative norms as computed by hand from the same files (numpy).
    for (tool, relative) in [("embreex", 0.0397), ("mitsuba", 0.0399), ("raystrack", 0.0190), ("radiance", 0.0855)] {
        let found = compared(place.path(), &with, tool, true);
        assert!((number(&found, "/comparison/relative/value") - relative).abs() < 1e-4, "{tool}: {found}");
        let honesty = number(&found, "/comparison/honesty/value");
        assert!((honesty - 1.0).abs() < 0.06, "{tool}: {honesty}");
        assert_eq!(found["explanation"], Value::Null, "{tool}");
    }
    // Counts of independent rays, binomial errors.
    for tool in ["embreex", "mitsuba"] {
        let found = compared(place.path(), &with, tool, true);
        let (low, high) = (number(&found, "/comparison/honesty/low"), number(&found, "/comparison/honesty/high"));
        assert!(low < 1.0 && 1.0 < high && number(&found, "/comparison/beyond") == 0.0, "{tool}: {found}");
    }
}

#[test]
fn correlated_random_numbers_show_in_the_size_of_errors() {
    let place = tempfile::tempdir().expect("a folder");
    let with = judged(place.path());
    let found = compared(place.path(), &with, "mitsuba-correlated", true);
    // 5.4 % above what independent rays do, 2 % for sure.
    assert!(number(&found, "/comparison/honesty/low") > 1.01, "{found}");
}

#[test]
fn a_transposed_matrix_is_told_by_name() {
    let place = tempfile::tempdir().expect("a folder");
    let with = judged(place.path());
    let found = compared(place.path(), &with, "pyviewfactor-as-it-comes", false);
    assert_eq!(found["explanation"]["mistake"]["layout"], "transposed", "{found}");
    let right = compared(place.path(), &with, "pyviewfactor", false);
    let after = number(&found, "/explanation/relative_after");
    assert!((after - number(&right, "/comparison/relative/value")).abs() < 1e-9, "{after}");
    assert_eq!(right["explanation"], Value::Null);
}

/// Writes the judge's own matrix with each value changed by `f(i, j, value)`.
fn changed(place: &Path, name: &str, f: impl Fn(usize, usize, f64) -> f64) {
    if !place.join("judge.csv").exists() {
        ok(place, &format!("form-factors {} -o judge.csv --target-error 1e-6", cube_box()));
    }
    let text = std::fs::read_to_string(place.join("judge.csv")).expect("written");
    let mut out = String::from("i,j,form_factor\n");
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let (i, j, v): (usize, usize, f64) =
            (cells[0].parse().expect("i"), cells[1].parse().expect("j"), cells[2].parse().expect("F"));
        out += &format!("{i},{j},{:?}\n", f(i, j, v));
    }
    std::fs::write(place.join(name), out).expect("writable");
}

#[test]
fn errors_of_known_size_come_out_and_are_explained() {
    let place = tempfile::tempdir().expect("a folder");
    let (here, with) = (place.path(), judged(place.path()));
    let found = |name: &str| json(here, &format!("form-factors compare {name} {with}"));
    // One entry.
    changed(here, "one.csv", |i, j, v| if (i, j) == (3, 20) { v + 1e-4 } else { v });
    let one = found("one.csv");
    assert_eq!(number(&one, "/comparison/beyond"), 1.0, "{one}");
    assert!((number(&one, "/comparison/largest/value") - 1e-4).abs() < 1e-7);
    assert!((number(&one, "/comparison/rms/value") - 1e-4 / 120.0).abs() < 1e-9);
    let worst = &one["witnesses"][0];
    assert_eq!((worst["row"].as_u64(), worst["column"].as_u64()), (Some(3), Some(20)));
    // Physics shows which of the two is wrong: the other direction of the pair says so.
    assert!(
        (number(worst, "/their_reciprocity") - 1e-4).abs() < 1e-6 && number(worst, "/judge_reciprocity").abs() < 1e-6
    );
    // Six decimals are no difference.
    changed(here, "six.csv", |_, _, v| (v * 1e6).round() / 1e6);
    let six = found("six.csv");
    assert_eq!(
        (number(&six, "/comparison/beyond"), number(&six, "/comparison/rounding/decimals")),
        (0.0, 6.0),
        "{six}"
    );
    // A constant, and a factor of its own for each row.
    changed(here, "two.csv", |_, _, v| 2.0 * v);
    let two = found("two.csv");
    assert!((number(&two, "/explanation/mistake/scale") - 2.0).abs() < 1e-6, "{two}");
    changed(here, "rows.csv", |i, _, v| v * (1.0 + 0.001 * i as f64));
    let rows = found("rows.csv");
    assert!((number(&rows, "/explanation/row_factors/1") - 1.119).abs() < 1e-5, "{rows}");
}

#[test]
fn limits_make_verdicts() {
    let place = tempfile::tempdir().expect("a folder");
    let (here, with) = (place.path(), judged(place.path()));
    changed(here, "one.csv", |i, j, v| if (i, j) == (3, 20) { v + 1e-4 } else { v });
    let code = |limits: &str| run(here, &format!("form-factors compare one.csv {with} {limits}")).0;
    assert_eq!(code(""), 0);
    assert_eq!(code("--max-entry 2e-4 --max-rms 1%"), 0);
    assert_eq!(code("--max-entry 0.5e-4"), 1);
    assert_eq!(code("--max-entry 1e-4"), 3);
    assert_eq!(code("--max-entry 2e-4 --max-rms 1e-6"), 1);
    // Against rays, whose noise is larger than the limit, nobody knows.
    let rays = format!("form-factors compare judge.npz --scene {} --estimator rays --rays 1024", cube_box());
    assert_eq!(run(here, &format!("{rays} --max-rms 1%")).0, 3);
    assert_eq!(run(here, &format!("{rays} --max-rms 50%")).0, 0);
}

#[test]
fn view3d_with_combined_surfaces_is_compared_by_surface() {
    let place = tempfile::tempdir().expect("a folder");
    let compare = |name: &str, target: &str| {
        let (file, scene) = (data(&format!("view3d/{name}.out.txt")), data(&format!("view3d/{name}.vs3")));
        json(place.path(), &format!("form-factors compare {file} --scene {scene} --target-error {target}"))
    };
    let facet = compare("facet", "1e-6");
    assert_eq!((&facet["rows"], number(&facet, "/comparison/rounding/decimals")), (&Value::from("patches"), 6.0));
    assert!(number(&facet, "/comparison/largest/value") < 1e-5, "{facet}");
    let gunter = compare("gunter1", "1e-4");
    assert_eq!((&gunter["rows"], number(&gunter, "/comparison/present")), (&Value::from("surfaces"), 16.0));
    assert!((1e-4..1e-2).contains(&number(&gunter, "/comparison/largest/value")), "{gunter}");
}

#[test]
fn mistakes_of_the_user_are_refused() {
    let place = tempfile::tempdir().expect("a folder");
    let (here, scene) = (place.path(), format!("--scene {}", cube_box()));
    let file = data("embreex-cube-box.npz");
    let message = refused(here, &format!("form-factors compare {file} --scene builtin:furnace"));
    assert!(message.contains("embreex-cube-box.npz"), "{message}");
    refused(here, &format!("form-factors compare nothing.npz {scene}"));
    refused(here, &format!("form-factors compare {file}"));
    refused(here, &format!("form-factors compare {file} {scene} --confidence 0.5"));
    refused(here, &format!("form-factors compare {file} {scene} --max-rms -1"));
    refused(here, &format!("form-factors compare {file} {scene} --reference-std-err x.npz"));
    refused(here, &format!("form-factors compare {file} {scene} --reference missing.npz"));
}
