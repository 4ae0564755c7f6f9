//! The linear systems of `references/truth/radiosity.json`, by both solvers.

use super::*;
use crate::solution::FormFactors;
use serde_json::Value;

fn case(id: &str) -> Value {
    let all: Value = serde_json::from_str(include_str!("../../references/truth/radiosity.json")).unwrap();
    all["cases"].as_array().unwrap().iter().find(|c| c["id"] == id).unwrap().clone()
}

/// Numbers written as numbers or as strings of many digits, nested lists flattened.
fn numbers(v: &Value) -> Vec<f64> {
    match v {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        Value::String(s) => vec![s.parse().unwrap()],
        other => vec![other.as_f64().unwrap()],
    }
}

fn number(v: &Value) -> f64 {
    numbers(v)[0]
}

fn matrix(rows: &[Vec<f64>]) -> FormFactors {
    let sparse =
        |row: &Vec<f64>| row.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(j, v)| (j as u32, *v)).collect();
    FormFactors::from_exact_rows(rows.iter().map(sparse).collect())
}

/// A unit cube with one patch per face, faces in opposite pairs.
fn cube() -> FormFactors {
    let data = &case("cube-one-emitter-rho0.5")["data"];
    let (opposite, adjacent) = (number(&data["F_opposite"]), number(&data["F_adjacent"]));
    let of_pair = |i: usize, j: usize| match (i == j, i / 2 == j / 2) {
        (true, _) => 0.0,
        (_, true) => opposite,
        _ => adjacent,
    };
    matrix(&(0..6).map(|i| (0..6).map(|j| of_pair(i, j)).collect()).collect::<Vec<_>>())
}

/// Both solvers, to the last digits.
fn assert_solved(name: &str, system: &System, f: &FormFactors, exact: &[f64]) {
    let (krylov, _) = krylov::solve(system, f, None, &krylov::Params::default(), |_, _| ()).unwrap();
    let tight = gauss_seidel::Params { tolerance: 1e-16, max_iterations: 10_000 };
    let (sweeps, _) = gauss_seidel::solve(system, f, &tight, |_| ()).unwrap();
    for k in 0..exact.len() {
        for (which, b, allowed) in [("GMRES", &krylov, 1e-12), ("Gauss-Seidel", &sweeps, 5e-15)] {
            let error = (b[k] / exact[k] - 1.0).abs();
            assert!(error < allowed, "{name}, {which}, value {k}: {} for {}, error {error:e}", b[k], exact[k]);
        }
    }
    let again = gather_once(system, f, exact).unwrap();
    assert!(again.iter().zip(exact).all(|(a, b)| (a / b - 1.0).abs() < 5e-15), "{name}: one gather moves the solution");
}

#[test]
fn one_emitting_face() {
    for rho in ["0.5", "0.8"] {
        let c = case(&format!("cube-one-emitter-rho{rho}"));
        let v = &c["values"];
        let side = number(&v["B_side"]);
        let exact = [number(&v["B_emitter"]), number(&v["B_opposite"]), side, side, side, side];
        let (e, rho) = (numbers(&c["data"]["E"]), vec![number(&c["data"]["rho"]); 6]);
        assert_solved("cube-one-emitter", &System { emission: &e, reflectance: &rho, bands: 1 }, &cube(), &exact);
    }
}

#[test]
fn six_reflectances_and_three_bands() {
    for (id, values, bands) in [("cube-separate-rho", "B", 1), ("cube-rgb", "B_rgb", 3)] {
        let c = case(id);
        let (e, rho) = (numbers(&c["data"]["E"]), numbers(&c["data"]["rho"]));
        let system = System { emission: &e, reflectance: &rho, bands };
        assert_solved(id, &system, &cube(), &numbers(&c["values"][values]));
    }
}

#[test]
fn the_tetrahedron_with_rational_radiosities() {
    let c = case("tetra-rational");
    let (e, rho) = (numbers(&c["data"]["E"]), numbers(&c["data"]["rho"]));
    let third = |i: usize| (0..4).map(|j| if i == j { 0.0 } else { 1.0 / 3.0 }).collect();
    let f = matrix(&(0..4).map(third).collect::<Vec<_>>());
    let system = System { emission: &e, reflectance: &rho, bands: 1 };
    assert_solved("tetra-rational", &system, &f, &numbers(&c["values"]["B"]));
}

#[test]
fn two_squares_in_the_open() {
    let c = case("two-squares-open");
    let f12 = number(&c["data"]["F12"]);
    let rho = [number(&c["data"]["rho1"]), number(&c["data"]["rho2"])];
    let system = System { emission: &[1.0, 0.0], reflectance: &rho, bands: 1 };
    let exact = [number(&c["values"]["B1"]), number(&c["values"]["B2"])];
    assert_solved("two-squares-open", &system, &matrix(&[vec![0.0, f12], vec![f12, 0.0]]), &exact);
}

#[test]
fn the_l_shaped_room() {
    let c = case("lroom-ceiling");
    let rows: Vec<Vec<f64>> = c["data"]["F"].as_array().unwrap().iter().map(numbers).collect();
    let (e, rho) = (numbers(&c["data"]["E"]), numbers(&c["data"]["rho"]));
    let system = System { emission: &e, reflectance: &rho, bands: 1 };
    assert_solved("lroom-ceiling", &system, &matrix(&rows), &numbers(&c["values"]["B"]));
}

#[test]
fn gauss_seidel_passes_through_the_known_iterates() {
    let iterates: Vec<Value> = case("cube-iterations")["values"]["gauss_seidel"].as_array().unwrap().clone();
    let system = System { emission: &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], reflectance: &[0.5; 6], bands: 1 };
    let mut seen = 0;
    let params = gauss_seidel::Params { tolerance: 1e-12, max_iterations: 100 };
    gauss_seidel::solve(&system, &cube(), &params, |step| {
        if let Some(known) = iterates.get(step.iteration - 1) {
            let exact = numbers(&known["B"]);
            assert!(step.radiosity.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 2e-16), "step {}", step.iteration);
            seen += 1;
        }
    })
    .unwrap();
    assert_eq!(seen, iterates.len());
}
