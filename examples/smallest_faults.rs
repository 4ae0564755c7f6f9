//! The smallest size at which a known mistake is still named right, and eq. 7 at that size.
//!
//! `cargo run --release --example smallest_faults` plants each mistake, lets the solution go only a part of the way from
//! right to wrong, and finds by bisection the smallest part at which the right cause is still the first one named.

#[path = "../tests/planted_faults/workshop.rs"]
#[allow(dead_code)]
mod workshop;

use std::time::Instant;
use workshop::{Bench, CORNELL, Fault, Targets, faults, mixed};

/// Halvings tried, and steps of bisection within the last.
const HALVINGS: i32 = 16;
const STEPS: usize = 3;

fn named(bench: &Bench, fault: &Fault, t: f64) -> bool {
    let found = bench.causes_of(&mixed(&bench.right, &fault.solution, t));
    found.first().is_some_and(|c| c.kind == fault.kind && c.place == fault.place)
}

/// The smallest part of the way that is named right; `None` where not even the whole is.
fn smallest(bench: &Bench, fault: &Fault) -> Option<f64> {
    if !named(bench, fault, 1.0) {
        return None;
    }
    let good = (0..HALVINGS).take_while(|k| named(bench, fault, 0.5f64.powi(*k))).last()?;
    let (mut low, mut high) = (0.5f64.powi(good + 1), 0.5f64.powi(good));
    for _ in 0..STEPS {
        let middle = (low * high).sqrt();
        if named(bench, fault, middle) { high = middle } else { low = middle }
    }
    Some(high)
}

fn table(name: &str, bench: &Bench, targets: &Targets) {
    println!(
        "\n{name}: {} patches; the candidate that is right: eq. 7 {:.2e}",
        bench.stage.patch_count(),
        bench.rms(&bench.right)
    );
    println!("| mistake | named | smallest part of it | eq. 7 there | eq. 7 of all of it | seconds for all of it |");
    println!("| --- | --- | ---: | ---: | ---: | ---: |");
    for fault in faults(bench, targets) {
        let begin = Instant::now();
        bench.causes_of(&fault.solution);
        let seconds = begin.elapsed().as_secs_f64();
        let part = smallest(bench, &fault);
        let (size, at) = part.map_or(("not named".into(), "".into()), |t| {
            let rms = bench.rms(&mixed(&bench.right, &fault.solution, t));
            (format!("{:.3} %", 100.0 * t), format!("{:.4} %", 100.0 * rms))
        });
        let whole = 100.0 * bench.rms(&fault.solution);
        println!("| {} | {} | {size} | {at} | {whole:.2} % | {seconds:.2} |", fault.what, fault.kind);
    }
}

fn main() {
    table("cornell-box-coarse", &Bench::new("cornell-box-coarse"), &CORNELL);
    let lamps = Targets { lamp: Some("green"), ..CORNELL };
    table("cornell-box-coarse with a green wall that glows", &Bench::with_two_lamps(), &lamps);
}
