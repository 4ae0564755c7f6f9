//! What resolution can mend and what it cannot: the mean error of a hemi-cube over 16 rotations.
//!
//! `cargo run --release --example hemicube_rotations`: unit squares face to face 1 m apart and at right angles.
//! The error against the value at the patch centre falls to nothing; the error against the true form factor stops
//! at what one point leaves out of the patch.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Build, flat, p};
use etalon::math::DVec3;
use etalon::methods::hemicube::{Delta, Params, form_factors};
use etalon::scene::{Grid, Stage};

/// Rotations, spread over the quarter turn after which a hemi-cube repeats itself.
const ROTATIONS: u32 = 16;

fn pair(other: &[DVec3]) -> Stage {
    let mut b = Build::new();
    b.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.0), Grid::Whole, 0.5, 0.0);
    b.surface(other, Grid::Whole, 0.5, 0.0);
    b.0
}

/// F_01 at every rotation.
fn values(stage: &Stage, resolution: u32) -> Vec<f64> {
    let turned = |k: u32| Params {
        resolution,
        delta: Delta::Exact,
        rotation: 90.0 * (f64::from(k) + 0.37) / f64::from(ROTATIONS),
        ..Params::default()
    };
    (0..ROTATIONS).map(|k| form_factors(stage, &turned(k), &|_| ()).expect("form factors").get(0, 1)).collect()
}

/// Mean of |F - wanted| / wanted, in percent.
fn mean_error(values: &[f64], wanted: f64) -> f64 {
    100.0 * values.iter().map(|f| (f / wanted - 1.0).abs()).sum::<f64>() / values.len() as f64
}

fn main() {
    let opposite: Vec<DVec3> = flat(-0.5, -0.5, 0.5, 0.5, 1.0).into_iter().rev().collect();
    let upright = [p(-0.5, -0.5, 0.0), p(-0.5, 0.5, 0.0), p(-0.5, 0.5, 1.0), p(-0.5, -0.5, 1.0)];
    // (name, the other square, value at the centre, true form factor)
    let pairs = [
        ("face to face", pair(&opposite), 0.239456470461, 0.199824895698),
        ("right angle", pair(&upright), 0.190135882385, 0.200043776075),
    ];
    println!("mean error over {ROTATIONS} rotations, %");
    println!("{:>12} {:>10} {:>16} {:>18}", "squares", "resolution", "to centre value", "to true factor");
    for (name, stage, centre, truth) in &pairs {
        for resolution in [10, 20, 50, 100, 200, 400, 800] {
            let f = values(stage, resolution);
            println!("{name:>12} {resolution:>10} {:>16.4} {:>18.4}", mean_error(&f, *centre), mean_error(&f, *truth));
        }
    }
}
