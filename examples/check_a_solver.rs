//! A solver of one's own, held against the judge: what a test in its repository would do.
//!
//! `cargo run --release --example check_a_solver` solves an L-shaped room twice by simple iteration, once with enough
//! bounces and once with one, and prints both verdicts.

use etalon::{Limits, Radiosity, Reference, ReferenceOptions, Stage, Verdict, assert_verdict, open_scene};

/// The solver under test: form factors from the middles of the patches, nothing between them, then `bounces` sweeps.
/// Middles are crude where patches touch, and the room's corner does stand between: the judge says how much it matters.
fn my_solver(stage: &Stage, bounces: usize) -> Radiosity {
    let n = stage.patch_count();
    let middle = |i: usize| stage.patches[i].region.centroid().expect("a patch that takes part");
    let factor = |i: usize, j: usize| {
        let (a, b) = (&stage.patches[i], &stage.patches[j]);
        let to = middle(j) - middle(i);
        let cosines = to.dot(a.normal).max(0.0) * (-to).dot(b.normal).max(0.0);
        if i == j { 0.0 } else { cosines * b.area / (std::f64::consts::PI * to.length_squared().powi(2)) }
    };
    let rows: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| factor(i, j)).collect()).collect();
    let (emission, reflectance) = (stage.emissions(), stage.reflectances());
    let bands = stage.band_count();
    let mut values = emission.clone();
    for _ in 0..bounces {
        let next = |k: usize| {
            let (i, c) = (k / bands, k % bands);
            // Closed scene: rows are scaled to sum to 1.
            let total: f64 = rows[i].iter().sum();
            let gathered: f64 = (0..n).map(|j| rows[i][j] / total * values[j * bands + c]).sum();
            emission[k] + reflectance[k] * gathered
        };
        values = (0..n * bands).map(next).collect();
    }
    Radiosity { bands, values, std_err: None }
}

fn main() -> Result<(), etalon::Error> {
    let stage = open_scene("builtin:l-room")?.at(0)?;
    let reference = Reference::compute(&stage, &ReferenceOptions::default().rays(16_384))?;
    let limit = Limits::rms(0.05);
    for bounces in [60, 1] {
        let check = reference.check(&my_solver(&stage, bounces), &limit)?;
        println!("{bounces} bounces: {check}\n");
        if bounces == 1 {
            assert_verdict!(check, Fail);
        }
    }
    // The judge's own radiosities stand at 0 within their error.
    let own = reference.check(&reference.radiosity(), &limit)?;
    assert_eq!(own.verdict(), Verdict::Pass);
    Ok(())
}
