//! Ray-cast form factors and radiosities against exact values.
//!
//! Statistical tests have fixed seeds; the chance of a false alarm is stated at each.

#[path = "common/truth.rs"]
mod common;

use common::{Polygons, Silent, kernels, number, truth_cases, unit_cube, vertices};
use etalon::estimate::{HitCounts, Plan, cast, patch_emitters};
use etalon::metrics::{Judged, Truth, compare};
use etalon::raycast::KernelKind;
use etalon::reference::{Evidence, Options, compute};
use etalon::sampling::{Role, Stream};
use etalon::scene::{Grid, Stage};
use etalon::solution::{Radiosity, Replicates};
use etalon::stats::{form_factor_interval, t_p_value};
use etalon::study::Session;
use serde_json::Value;

/// Chance that a whole test file's worth of intervals holds one miss by chance.
const FAMILY: f64 = 1e-4;

fn counts(stage: &Stage, kernel: KernelKind, plan: &Plan, seed: u64) -> HitCounts {
    counts_of(&Session::open(stage, kernel).expect("a kernel"), plan, seed)
}

/// Convex polygon pairs of the truth file, blockers (if any) polygons too.
fn polygon_cases() -> Vec<Value> {
    let is_polygon = |s: &Value| s["type"] == "polygon" && etalon::math::convex_defect(&vertices(s)) > -1e-9;
    let all = |c: &Value| {
        is_polygon(&c["surface1"])
            && is_polygon(&c["surface2"])
            && c["blockers"].as_array().expect("blockers").iter().all(is_polygon)
    };
    truth_cases("form_factors.json").into_iter().filter(all).collect()
}

fn stage_of(case: &Value) -> Stage {
    let mut polygons = Polygons::new(1);
    polygons.black(vertices(&case["surface1"])).black(vertices(&case["surface2"]));
    for b in case["blockers"].as_array().expect("blockers") {
        // Blockers are opaque from both sides; backs are black anyway.
        polygons.black(vertices(b));
    }
    polygons.stage()
}

/// Every exact polygon-to-polygon form factor lies in its interval at 65,536 rays in 32 randomisations; and the
/// deviations, in their own standard errors, centre on 0. False alarms: 1e-4 for the intervals, 1e-4 for the mean.
#[test]
fn polygon_pairs_lie_in_their_intervals() {
    let cases = polygon_cases();
    assert!(cases.len() >= 72, "{}", cases.len());
    let plan = Plan { rays: 65_536, randomisations: 32, ..Plan::default() };
    for kernel in kernels() {
        let mut z = Vec::new();
        println!("{kernel:?}: case, direction, exact, estimate, standard error, relative error");
        for (k, case) in cases.iter().enumerate() {
            let counts = counts(&stage_of(case), kernel, &plan, k as u64);
            for (i, j, name) in [(0, 1, "F12"), (1, 0, "F21")] {
                if case["values"][name].is_null() {
                    continue;
                }
                let exact = number(&case["values"][name]);
                let confidence = 1.0 - FAMILY / (2.0 * cases.len() as f64);
                let hits = counts.of_pair(i, j);
                let e = form_factor_interval(&hits, counts.rays, confidence, None);
                let relative = if exact > 0.0 { (e.value - exact).abs() / exact } else { e.value };
                println!("{} {name} {exact:.9} {:.9} {:?} {relative:.1e}", case["id"], e.value, e.std_err);
                // Exact values reach the file rounded to doubles; coordinates do too.
                let slack = 1e-12;
                assert!(
                    e.low - slack <= exact && exact <= e.high + slack,
                    "{kernel:?} {} {name}: {exact} outside {e:?}",
                    case["id"]
                );
                let total: u64 = hits.iter().sum();
                if let (Some(se), true) = (e.std_err, total >= 200) {
                    z.push((e.value - exact) / se);
                }
            }
        }
        let n = z.len() as f64;
        let mean = z.iter().sum::<f64>() / n;
        let spread = (z.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        println!("{kernel:?}: {n} deviations, mean {mean:.3}, spread {spread:.3} (t with 31 degrees: 1.033)");
        assert!(t_p_value(mean, spread / n.sqrt(), n - 1.0) > 1e-4, "biased: mean z {mean} over {n}");
        assert!((0.7..1.4).contains(&spread), "errors are not what they say: spread {spread}");
    }
}

fn reference(stage: &Stage, kernel: KernelKind, rays: u64, seed: u64) -> Replicates {
    let session = Session::open(stage, kernel).expect("a kernel");
    let options = Options { plan: Plan { rays, ..Plan::default() }, seed };
    compute(&session.tracer(), &options, &Evidence::default(), &Silent).expect("solvable").patches
}

/// A unit cube of one patch per face.
fn cube(bands: usize, reflectance: &dyn Fn(usize) -> Vec<f64>, emission: &dyn Fn(usize) -> Vec<f64>) -> Stage {
    let mut p = Polygons::new(bands);
    for (k, face) in unit_cube().into_iter().enumerate() {
        p.add(face, Grid::Quad { na: 1, nb: 1 }, &reflectance(k), &emission(k));
    }
    p.stage()
}

fn case(id: &str) -> Value {
    truth_cases("radiosity.json").into_iter().find(|c| c["id"] == id).expect("a case of the truth file")
}

/// Exact radiosities lie in their intervals: Student t with R - 1 degrees, family-wise 1e-4 per case.
fn assert_inside(name: &str, b: &Replicates, exact: &[f64]) {
    let mean = b.mean();
    let errors = mean.std_err.as_ref().expect("replicates have errors");
    for (k, exact) in exact.iter().enumerate() {
        let (value, se) = (mean.values[k], errors[k]);
        let p = if se > 0.0 { t_p_value(value - exact, se, b.count() as f64 - 1.0) } else { 1.0 };
        println!("{name} [{k}]: exact {exact:.9}, estimate {value:.9}, standard error {se:.1e}, p {p:.3}");
        // Digits of the printed form factors limit what is exact.
        let rounding = (value - exact).abs() <= 1e-10 * exact.abs();
        assert!(rounding || p > FAMILY / 20.0, "{name} [{k}]: {exact} against {value} +- {se}");
    }
}

#[test]
fn cubes_of_six_patches() {
    for kernel in kernels() {
        for rho in [0.5, 0.8] {
            let c = case(&format!("cube-one-emitter-rho{rho}"));
            let stage = cube(1, &|_| vec![rho], &|k| vec![f64::from(u8::from(k == 0))]);
            let v = |name: &str| number(&c["values"][name]);
            let exact = [v("B_emitter"), v("B_opposite"), v("B_side"), v("B_side"), v("B_side"), v("B_side")];
            assert_inside("cube-one-emitter", &reference(&stage, kernel, 65_536, 1), &exact);
        }
        let c = case("cube-separate-rho");
        let list = |v: &Value| v.as_array().expect("a list").iter().map(number).collect::<Vec<f64>>();
        let (rho, e) = (list(&c["data"]["rho"]), list(&c["data"]["E"]));
        let stage = cube(1, &|k| vec![rho[k]], &|k| vec![e[k]]);
        assert_inside("cube-separate-rho", &reference(&stage, kernel, 65_536, 2), &list(&c["values"]["B"]));
        let c = case("cube-rgb");
        let rows = |v: &Value| v.as_array().expect("rows").iter().map(list).collect::<Vec<_>>();
        let (rho, e) = (rows(&c["data"]["rho"]), rows(&c["data"]["E"]));
        let stage = cube(3, &|k| rho[k].clone(), &|k| e[k].clone());
        assert_inside("cube-rgb", &reference(&stage, kernel, 65_536, 3), &rows(&c["values"]["B_rgb"]).concat());
    }
}

#[test]
fn tetrahedron_and_open_squares() {
    let p = etalon::math::DVec3::new;
    let corner = [p(1.0, 1.0, 1.0), p(1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, -1.0, 1.0)];
    // Faces opposite each corner, wound to be seen from inside.
    let faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]].map(|f| f.map(|k| corner[k]).to_vec());
    let c = case("tetra-rational");
    let list = |v: &Value| v.as_array().expect("a list").iter().map(number).collect::<Vec<f64>>();
    let (rho, e) = (list(&c["data"]["rho"]), list(&c["data"]["E"]));
    let mut tetra = Polygons::new(1);
    for (k, face) in faces.into_iter().enumerate() {
        let inward = etalon::math::unit_normal(&face).dot(-etalon::math::centroid(&face)) > 0.0;
        let face = if inward { face } else { face.into_iter().rev().collect() };
        tetra.add(face, Grid::Triangle { n: 1 }, &[rho[k]], &[e[k]]);
    }
    let c2 = case("two-squares-open");
    let cube = unit_cube();
    let mut open = Polygons::new(1);
    open.add(cube[0].clone(), Grid::Quad { na: 1, nb: 1 }, &[0.6], &[1.0]);
    open.add(cube[1].clone(), Grid::Quad { na: 1, nb: 1 }, &[0.9], &[0.0]);
    for kernel in kernels() {
        assert_inside("tetra-rational", &reference(&tetra.stage(), kernel, 65_536, 4), &list(&c["values"]["B"]));
        let exact = [number(&c2["values"]["B1"]), number(&c2["values"]["B2"])];
        assert_inside("two-squares-open", &reference(&open.stage(), kernel, 65_536, 5), &exact);
    }
}

/// Rows of a closed scene sum to one by counting, so the furnace has no noise at all.
#[test]
fn white_furnace_is_exact() {
    let c = case("furnace");
    for kernel in kernels() {
        for (rho, exact) in c["values"]["B_by_rho"].as_object().expect("a table") {
            let (rho, exact): (f64, f64) = (rho.parse().expect("a number"), number(exact));
            let mut p = Polygons::new(1);
            for face in unit_cube() {
                p.add(face, Grid::Quad { na: 3, nb: 2 }, &[rho], &[1.0]);
            }
            let b = reference(&p.stage(), kernel, 1024, 6).mean();
            let worst = b.values.iter().map(|b| (b / exact - 1.0).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-9, "{kernel:?}, reflectance {rho}: off by {worst:e}");
        }
    }
}

/// Face means of finer cubes against the exact patch systems of the truth file.
#[test]
fn refined_cubes() {
    for row in case("cube-refined")["values"]["table"].as_array().expect("rows") {
        let n = row["n_per_edge"].as_u64().expect("a count") as u32;
        if n > 8 {
            continue;
        }
        let rho = number(&row["rho"]);
        let mut p = Polygons::new(1);
        for (k, face) in unit_cube().into_iter().enumerate() {
            p.add(face, Grid::Quad { na: n, nb: n }, &[rho], &[f64::from(u8::from(k == 0))]);
        }
        let b = reference(&p.stage(), KernelKind::Builtin, 8192, 7);
        let per_face = (n * n) as usize;
        let means = |v: &Vec<f64>| -> Vec<f64> {
            let face: Vec<f64> = v.chunks(per_face).map(|f| f.iter().sum::<f64>() / per_face as f64).collect();
            vec![face[0], face[1], face[2..].iter().sum::<f64>() / 4.0]
        };
        let faces = Replicates { bands: 1, replicates: b.replicates.iter().map(means).collect() };
        let exact = ["mean_B_emitter", "mean_B_opposite", "mean_B_side"].map(|k| number(&row[k]));
        assert_inside(&format!("cube-refined n={n} rho={rho}"), &faces, &exact);
    }
}

/// Solving with noisy factors shifts the mean; leaving one out takes the shift away. Two bright squares face each
/// other at a quarter of their edge, few rays on purpose, many seeds. The mean of R separate solutions shows the
/// bias clearly, the replicates do not (|t| < 4.5, false alarm 1e-5).
#[test]
fn the_bias_of_noisy_factors_is_gone() {
    let (rho, f) = (0.99, 0.632_036_430_014);
    let exact = rho * f / (1.0 - rho * rho * f * f);
    let [floor, ceiling, ..] = unit_cube();
    let lowered = ceiling.into_iter().map(|v| v - etalon::math::DVec3::Z * 0.75).collect();
    let mut squares = Polygons::new(1);
    squares.add(floor, Grid::Quad { na: 1, nb: 1 }, &[rho], &[1.0]);
    squares.add(lowered, Grid::Quad { na: 1, nb: 1 }, &[rho], &[0.0]);
    let stage = squares.stage();
    let session = Session::open(&stage, KernelKind::Builtin).expect("built in");
    let plan = Plan { rays: 64, randomisations: 8, ..Plan::default() };
    let (mut debiased, mut naive) = (Vec::new(), Vec::new());
    for seed in 0..4000 {
        let options = Options { plan, seed };
        let b = compute(&session.tracer(), &options, &Evidence::default(), &Silent).expect("solvable").patches;
        debiased.push(b.mean().values[1]);
        let counts = counts_of(&session, &plan, seed);
        let share = |i: usize, j: usize| counts.of_pair(i, j).into_iter().map(|h| h as f64 / counts.rays as f64);
        let each = share(0, 1).zip(share(1, 0)).map(|(f, g)| rho * g / (1.0 - rho * rho * f * g));
        naive.push(each.sum::<f64>() / f64::from(plan.randomisations));
    }
    let t = |v: &[f64]| {
        let n = v.len() as f64;
        let mean = v.iter().sum::<f64>() / n;
        let se = (v.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt();
        (mean / exact - 1.0, (mean - exact) / se)
    };
    let ((bias, z), (naive_bias, naive_z)) = (t(&debiased), t(&naive));
    println!("replicates: bias {bias:.2e} (t {z:.1}); separate solutions: bias {naive_bias:.2e} (t {naive_z:.1})");
    assert!(z.abs() < 4.5, "the replicates are biased: {bias:e}, t {z}");
    assert!(naive_z.abs() > 10.0, "the test cannot see a bias: t {naive_z}");
}

fn counts_of(session: &Session, plan: &Plan, seed: u64) -> HitCounts {
    let stream = Stream::new(Role::Judge, seed);
    cast(&session.tracer(), &patch_emitters(session.stage()), stream, plan, &|_| 0.0, &|_| ()).counts
}

/// The exact solution reads 0 within its interval, one that is 1 % bright reads 0.010.
#[test]
fn exact_and_bright_solutions_read_as_they_are() {
    let c = case("cube-one-emitter-rho0.8");
    let v = |name: &str| number(&c["values"][name]);
    let exact = [v("B_emitter"), v("B_opposite"), v("B_side"), v("B_side"), v("B_side"), v("B_side")];
    let stage = cube(1, &|_| vec![0.8], &|k| vec![f64::from(u8::from(k == 0))]);
    let truth = Truth::Sampled(reference(&stage, KernelKind::Builtin, 262_144, 8));
    let bands = ["y".to_string()];
    let emission = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let judged = Judged { areas: &[1.0; 6], emission: &emission, surfaces: &["s"; 6], bands: &bands, weights: &[1.0] };
    let rms = |factor: f64| {
        let solution = Radiosity { bands: 1, values: exact.iter().map(|b| b * factor).collect(), std_err: None };
        compare(&solution, &truth, None, &judged, 0.999, false).expect("comparable").rms
    };
    let (same, bright) = (rms(1.0), rms(1.01));
    println!("exact solution: {same:?}\n1 % bright: {bright:?}");
    assert!(same.low == 0.0 && same.value < 1e-3 && same.high < 2e-3, "{same:?}");
    assert!(bright.low <= 0.01 && 0.01 <= bright.high && (bright.value - 0.01).abs() < 5e-4, "{bright:?}");
}
