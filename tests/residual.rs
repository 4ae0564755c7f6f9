//! Judging a solution by its own residual: against exact radiosities, by closed forms, over many seeds, and as a
//! script sees it.

#[path = "common/truth.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use common::{Polygons, Silent, number, truth_cases, unit_cube};
use etalon::metrics::{Judged, Rebounded, ResidualMetrics, Verdict, bound_error, decide_residual};
use etalon::raycast::KernelKind;
use etalon::scene::{Grid, Stage};
use etalon::solution::Radiosity;
use etalon::study::{ResidualRequest, Session, residual};
use program::{json, ok, refused, run};
use std::path::Path;

/// The unit cube, one patch per face, face z = 0 emitting; with its exact radiosities.
fn cube(rho: &str) -> (Stage, Vec<f64>) {
    let case = truth_cases("radiosity.json").into_iter().find(|c| c["id"] == format!("cube-one-emitter-rho{rho}"));
    let case = case.expect("a case of the truth file");
    let v = |name: &str| number(&case["values"][name]);
    let side = v("B_side");
    let reflectance: f64 = rho.parse().expect("a number");
    let mut cube = Polygons::new(1);
    for (k, face) in unit_cube().into_iter().enumerate() {
        cube.add(face, Grid::Quad { na: 1, nb: 1 }, &[reflectance], &[f64::from(u8::from(k == 0))]);
    }
    (cube.stage(), vec![v("B_emitter"), v("B_opposite"), side, side, side, side])
}

fn one_band(values: Vec<f64>) -> Radiosity {
    Radiosity { bands: 1, values, std_err: None }
}

fn judge(stage: &Stage, solution: &Radiosity, request: &ResidualRequest) -> ResidualMetrics {
    let session = Session::open(stage, KernelKind::Builtin).expect("built in");
    let cast = residual(&session, solution, request, &Silent).expect("castable");
    let (areas, emission, reflectance) = (stage.areas(), stage.emissions(), stage.reflectances());
    let judged = Judged {
        areas: &areas,
        emission: &emission,
        surfaces: &vec!["face"; areas.len()],
        bands: &stage.photometry.bands,
        weights: &stage.photometry.weights,
    };
    let rebounded =
        Rebounded { residual: &cast.residual, series: &cast.series, bounces: cast.bounces, reflectance: &reflectance };
    bound_error(solution, &rebounded, &judged, 0.95, false).expect("comparable")
}

fn relative_error(wrong: &[f64], exact: &[f64]) -> f64 {
    let square = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>();
    (square(&mut wrong.iter().zip(exact).map(|(a, b)| a - b)) / square(&mut exact.iter().copied())).sqrt()
}

/// The exact solution has no residual: bounds from 0 to a fraction of a per cent, at any number of bounces.
#[test]
fn an_exact_solution_passes_a_tight_limit() {
    for rho in ["0.5", "0.8"] {
        let (stage, exact) = cube(rho);
        for bounces in [1, 2, 8] {
            let request = ResidualRequest { rays: Some(65_536), bounces: Some(bounces), ..ResidualRequest::default() };
            let m = judge(&stage, &one_band(exact.clone()), &request);
            println!("rho {rho}, {bounces} bounces: {:?} {:?}", m.residual, m.error_bounds);
            assert_eq!(m.error_bounds.low, 0.0, "{m:?}");
            assert_eq!(decide_residual(&m, 0.01).verdict, Verdict::Pass, "{m:?}");
        }
    }
}

/// Everything 5 % too bright: r = -0.05 (I - K) B* = -0.05 E, so |r| / |B| is known in closed form, and n bounces
/// close the bounds in on 5 %.
#[test]
fn a_solution_five_per_cent_too_bright() {
    let (stage, exact) = cube("0.5");
    let solution = one_band(exact.iter().map(|b| 1.05 * b).collect());
    let norm = exact.iter().map(|b| b * b).sum::<f64>().sqrt();
    let known = 0.05 / (1.05 * norm);
    for bounces in [1, 4, 12] {
        let request = ResidualRequest { rays: Some(65_536), bounces: Some(bounces), ..ResidualRequest::default() };
        let m = judge(&stage, &solution, &request);
        let r = m.residual.expect("lit");
        println!("{bounces} bounces: residual {r:?} (known {known}), bounds {:?}", m.error_bounds);
        assert!(r.low <= known && known <= r.high && (r.value / known - 1.0).abs() < 0.05, "{r:?} {known}");
        let (low, high) = (m.error_bounds.low, m.error_bounds.high.expect("bounded"));
        assert!(low < 0.05 && 0.05 < high, "{low} {high}");
        // One bounce: |r| / 1.5 and |r| / 0.5 of the truth, up to what the truth's own norm leaves open.
        if bounces == 1 {
            assert!(low > 0.9 * 1.05 * known / 1.5 && high < 1.15 * 1.05 * known / 0.5, "{low} {high}");
        } else if bounces == 12 {
            assert!(low > 0.048 && high < 0.052, "{low} {high}");
            assert_eq!(decide_residual(&m, 0.04).verdict, Verdict::Fail);
            assert_eq!(decide_residual(&m, 0.06).verdict, Verdict::Pass);
        }
    }
}

/// A candidate exactly at the limit, 400 castings with few rays: the verdict may be wrong 2.5 % of the time to each
/// side; 400 castings allow 3 sigma more, 4.84 %. Many bounces, so that nothing but noise keeps it open.
#[test]
fn at_the_limit_both_errors_keep_their_rates() {
    const CASTINGS: u64 = 400;
    let (stage, exact) = cube("0.5");
    let shape = [1.0, -2.0, 0.5, 1.0, -1.5, 2.0];
    let wrong: Vec<f64> = exact.iter().zip(shape).map(|(b, s)| b * (1.0 + 0.02 * s)).collect();
    let limit = relative_error(&wrong, &exact);
    let allowed = 0.025 + 3.0 * (0.025f64 * 0.975 / CASTINGS as f64).sqrt();
    for rays in [128, 512] {
        let mut counts = [0u32; 3];
        for seed in 0..CASTINGS {
            let request = ResidualRequest { rays: Some(rays), bounces: Some(8), seed, ..ResidualRequest::default() };
            let m = judge(&stage, &one_band(wrong.clone()), &request);
            counts[decide_residual(&m, limit).verdict as usize] += 1;
        }
        let share = |v: Verdict| f64::from(counts[v as usize]) / CASTINGS as f64;
        let (pass, fail) = (share(Verdict::Pass), share(Verdict::Fail));
        println!("{rays} rays per patch, at the limit {limit:.4}: pass {pass:.4}, fail {fail:.4}");
        assert!(pass <= allowed && fail <= allowed, "{rays} rays: pass {pass}, fail {fail}, allowed {allowed}");
    }
}

/// Away from the limit the verdict comes: one that never decides would pass the test above.
#[test]
fn away_from_the_limit_it_decides() {
    let (stage, exact) = cube("0.8");
    let wrong: Vec<f64> = exact.iter().map(|b| 1.03 * b).collect();
    for (limit, expected) in [(0.015, Verdict::Fail), (0.06, Verdict::Pass)] {
        for seed in 0..20 {
            let request = ResidualRequest { rays: Some(16_384), seed, ..ResidualRequest::default() };
            let d = decide_residual(&judge(&stage, &one_band(wrong.clone()), &request), limit);
            assert_eq!(d.verdict, expected, "seed {seed}: {d:?}");
        }
    }
}

fn scaled(here: &Path, from: &str, to: &str, factor: impl Fn(usize, f64) -> f64) {
    let text = std::fs::read_to_string(here.join(from)).expect("written");
    let mut lines = text.lines();
    let bands = lines.next().expect("a header").split(',').skip(1).filter(|h| !h.ends_with("_std_err")).count();
    let header: Vec<&str> = text.lines().next().expect("a header").split(',').take(bands + 1).collect();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let patch: usize = cells[0].parse().expect("a number");
        let values = cells[1..=bands].iter().map(|x| factor(patch, x.parse().expect("a number")).to_string());
        format!("{patch},{}\n", values.collect::<Vec<_>>().join(","))
    };
    let rows: String = lines.map(row).collect();
    std::fs::write(here.join(to), format!("{}\n{rows}", header.join(","))).expect("writable");
}

#[test]
fn the_three_verdicts_from_the_command_line() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "solve builtin:furnace --method gather:rays=2048 -o good.csv");
    scaled(here, "good.csv", "bright.csv", |_, b| 1.05 * b);
    let check = |file: &str, more: &str| format!("check {file} --scene builtin:furnace --residual --rays 512 {more}");
    let v = json(here, &check("good.csv", "--max-rms 0.1%"));
    assert_eq!(v["verdict"], "pass", "{v}");
    let (code, out, _) = run(here, &check("bright.csv", "--max-rms 1%"));
    assert_eq!(code, 1, "{out}");
    assert!(out.starts_with("FAIL"), "{out}");
    // rho = 0.5, one bounce: r = -0.05, of 2.1; the error lies between 1 / 1.5 and 1 / 0.5 of it.
    let one = check("bright.csv", "--max-rms 3% --bounces 1");
    let (code, out, _) = run(here, &one);
    assert_eq!(code, 3, "{out}");
    assert!(out.contains("--bounces"), "says what would decide: {out}");
    assert_eq!(run(here, &format!("{one} --on-inconclusive pass")).0, 0);
    assert_eq!(run(here, &format!("{one} --on-inconclusive fail")).0, 1);
    let v = json(here, &format!("{one} --on-inconclusive pass"));
    let value = v["residual"]["value"].as_f64().expect("a number");
    assert!((value - 0.05 / 2.1).abs() < 1e-9, "{v}");
    assert!(v["error_bounds"]["low"].as_f64() < Some(0.05) && v["error_bounds"]["high"].as_f64() >= Some(0.05 - 1e-9));
    assert_eq!((v["rho_max"].as_f64(), v["bounces"].as_u64()), (Some(0.5), Some(1)));
    let v = json(here, "compare bright.csv --scene builtin:furnace --residual --rays 512");
    assert!(v["verdict"].is_null() && v["error_bounds"]["low"].as_f64() > Some(0.03), "{v}");
}

/// Lost emission, a lost wall: found, and named.
#[test]
fn the_cause_is_named_and_mapped() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "solve builtin:cube-one-emitter --method gather:rays=16384 -o good.csv");
    ok(here, "scene patches builtin:cube-one-emitter -o patches.csv");
    let base = "--scene builtin:cube-one-emitter --residual --rays 4096";
    let good = json(here, &format!("check good.csv {base} --max-rms 3% --save-residual map.csv"));
    assert_eq!(good["verdict"], "pass", "{good}");
    let map = std::fs::read_to_string(here.join("map.csv")).expect("written");
    assert!(map.starts_with("patch,y,y_std_err\n"), "{map}");
    // One patch keeps only half of its light.
    scaled(here, "good.csv", "dim.csv", |patch, b| if patch == 3 { 0.5 * b } else { b });
    let (code, out, err) = run(here, &format!("check dim.csv {base} --max-rms 1% --json"));
    assert_eq!(code, 1, "{out}{err}");
    let v: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(v["worst"][0]["patch"], 3, "{v}");
    assert!(v["worst"][0]["residual"].as_f64() > Some(0.0), "too dark: {v}");
    assert!(v["surfaces"][0]["share"].as_f64() > Some(0.5), "{v}");
}

#[test]
fn same_bytes_on_any_number_of_threads() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "solve builtin:cornell-box-coarse --method hemicube:resolution=50 -o h.csv");
    let result = |threads: u32| {
        let map = format!("map{threads}.csv");
        let line = format!(
            "check h.csv --scene builtin:cornell-box-coarse --residual --max-rms 50% --rays 256 --save-residual {map} \
             --on-inconclusive pass --threads {threads}"
        );
        let mut v = json(here, &line);
        v["seconds"] = serde_json::Value::Null;
        (v, std::fs::read(here.join(map)).expect("written"))
    };
    assert!(result(1) == result(2));
}

#[test]
fn what_a_residual_cannot_answer_is_refused() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "solve builtin:furnace --method gather:rays=512 -o good.csv");
    for (line, expected) in [
        ("check good.csv --residual --max-rms 1%", "--scene"),
        ("check good.csv --residual --scene builtin:furnace", "--max-rms"),
        ("check good.csv --residual --scene builtin:furnace --reference ref --max-rms 1%", "--reference"),
        ("check good.csv --residual --scene builtin:furnace --max-rms 1% --max-top1 1%", "--max-top1"),
        ("check good.csv --residual --scene builtin:furnace --max-rms 1% --per element", "--per patch"),
        ("check good.csv --residual --scene builtin:furnace --max-rms 1% --report out", "--report"),
        ("check good.csv --residual --scene builtin:furnace --max-rms 1% --junit j.xml", "--junit"),
        ("check good.csv --residual --scene builtin:furnace --max-rms 1% --bounces 0", "bounces"),
        ("check good.csv --residual --scene builtin:furnace --max-rms 1% --save-residual m.txt", "ending"),
        ("check good.csv --residual --scene builtin:cornell-box --max-rms 1%", "good.csv"),
        ("check good.csv --max-rms 1%", "--reference"),
        ("check good.csv --reference ref --max-rms 1% --bounces 2", "--residual"),
    ] {
        let message = refused(here, line);
        assert!(message.contains(expected), "{line}: {message}");
    }
    assert!(!here.join("j.xml").exists() && !here.join("out").exists());
}
