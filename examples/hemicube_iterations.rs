//! Gauss-Seidel iterations of the hemi-cube method against size and reflectance.
//!
//! The paper sees six to eight, "regardless of the size of the matrix". `cargo run --release --example
//! hemicube_iterations` prints the table for cubes of 96 to 9,600 patches whose floor emits.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Build, p};
use etalon::math::DVec3;
use etalon::methods::hemicube::{Params, form_factors, solve_with};
use etalon::methods::{MethodInfo, PatchVectors};
use etalon::scene::Stage;
use etalon::solution::FormFactors;
use etalon::solver::krylov;

/// Reflectances of the columns.
const REFLECTANCES: [f64; 6] = [0.3, 0.5, 0.7, 0.8, 0.9, 0.95];

/// A unit cube with `n` x `n` patches per face whose floor emits 1 W/m^2.
fn cube(n: u32) -> Stage {
    let mut b = Build::new();
    b.room(DVec3::ZERO, p(1.0, 1.0, 1.0), n, 0.0, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    b.0
}

fn at_reflectance(stage: &mut Stage, rho: f64) {
    stage.materials.iter_mut().for_each(|m| m.reflectance = vec![rho]);
}

/// Largest relative error that the stopping rule leaves, against the exact solution of the same system.
fn error_left(stage: &Stage, f: &FormFactors, values: &[f64]) -> f64 {
    let vectors = PatchVectors::of(stage);
    let (exact, _) = krylov::solve(&vectors.system(), f, None, &krylov::Params::default(), |_, _| ()).expect("GMRES");
    values.iter().zip(exact).map(|(b, e)| (b / e - 1.0).abs()).fold(0.0, f64::max)
}

fn main() {
    for tolerance in [0.01, 0.001] {
        let params = Params { resolution: 50, tolerance, ..Params::default() };
        println!("until no radiosity changes by more than {} %: iterations (largest error left)", 100.0 * tolerance);
        println!("patches   {}", REFLECTANCES.map(|r| format!("{:>16}", format!("rho = {r}"))).join(""));
        for size in [4, 8, 16, 32, 40] {
            let mut stage = cube(size);
            let f = form_factors(&stage, &params, &|_| ()).expect("form factors");
            print!("{:>7}   ", f.n);
            for rho in REFLECTANCES {
                at_reflectance(&mut stage, rho);
                let (radiosity, MethodInfo { iterations, .. }) = solve_with(&stage, &f, &params).expect("a solution");
                let left = error_left(&stage, &f, &radiosity.values);
                print!("{:>16}", format!("{} ({:.2} %)", iterations[0], 100.0 * left));
            }
            println!();
        }
    }
}
