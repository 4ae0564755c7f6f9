//! Known mistakes are named, with their place; solutions that are right, or honestly approximate, get no name.

#[path = "planted_faults/workshop.rs"]
mod workshop;

use etalon::estimate::Estimator;
use workshop::{Bench, CORNELL, Targets, faults, mixed, solved};

fn all_are_named(bench: &Bench, targets: &Targets) {
    let mut wrong = Vec::new();
    for fault in faults(bench, targets) {
        let begin = std::time::Instant::now();
        let found = bench.causes_of(&fault.solution);
        println!("{:?} eq 7 {:.2e}", begin.elapsed(), bench.rms(&fault.solution));
        let first = found.first();
        println!("{:26} {:?}", fault.what, found);
        if !first.is_some_and(|c| c.kind == fault.kind && c.place == fault.place && c.explains > 0.5) {
            wrong.push(format!("{}: expected {} at {:?}, got {first:?}", fault.what, fault.kind, fault.place));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_planted_fault_is_named_first_in_the_cornell_box() {
    all_are_named(&Bench::new("cornell-box-coarse"), &CORNELL);
}

#[test]
fn right_and_honestly_approximate_solutions_get_no_name() {
    let bench = Bench::new("cornell-box-coarse");
    let mut wrong = Vec::new();
    let mut none = |what: String, solution| {
        let found = bench.causes_of(&solution);
        println!("{what}: eq. 7 {:.5}, {found:?}", bench.rms(&solution));
        if let Some(c) = found.first() {
            wrong.push(format!("{what}: {c:?}"));
        }
    };
    none("right".into(), bench.right.clone());
    none("the reference itself".into(), bench.reference.patches.mean());
    for (seed, rays) in [(5, 256), (6, 1024), (7, 16), (8, 64), (9, 4096)] {
        none(format!("{rays} rays, seed {seed}"), solved(&bench.stage, seed, rays, Estimator::Rays).0);
    }
    for resolution in [20, 50, 100, 200] {
        none(format!("hemi-cube {resolution}"), bench.hemicube(resolution));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let _ = mixed;
}

#[test]
#[ignore = "sweep"]
fn sweep() {
    for name in ["cornell-box-coarse", "furnished-room", "cube-room"] {
        let begin = std::time::Instant::now();
        let bench = if name.starts_with('c') && name.ends_with('e') { Bench::new(name) } else { Bench::coarse(name) };
        println!("{name}: bench {:?}, {} patches", begin.elapsed(), bench.stage.patch_count());
        let none = |what: String, solution| {
            let begin = std::time::Instant::now();
            let found = bench.causes_of(&solution);
            println!("{name} {what}: eq. 7 {:.5}, {:?} {found:?}", bench.rms(&solution), begin.elapsed());
        };
        none("right".into(), bench.right.clone());
        for (seed, rays) in (0..12).map(|s| (s, 16 << (s % 6 * 2))) {
            none(format!("{rays} rays, seed {seed}"), solved(&bench.stage, seed, rays, Estimator::Rays).0);
        }
        for resolution in [4, 6, 8, 10, 14, 20, 30, 50, 70, 100, 150] {
            none(format!("hemi-cube {resolution}"), bench.hemicube(resolution));
        }
    }
}

#[test]
#[ignore = "slow"]
fn furnished() {
    let begin = std::time::Instant::now();
    let bench = Bench::coarse("furnished-room");
    println!("bench {:?} {} right {:.2e}", begin.elapsed(), bench.stage.patch_count(), bench.rms(&bench.right));
    all_are_named(&bench, &workshop::FURNISHED);
}

#[test]
#[ignore = "slow"]
fn timing() {
    let mut bench = Bench::coarse("cornell-box");
    println!("{}", bench.stage.patch_count());
    let begin = std::time::Instant::now();
    let stage = etalon::io::scene::builtin("cornell-box").unwrap().at(0).unwrap();
    let (a, _) = solved(&stage, 1, 4096, Estimator::Rays);
    println!("solved {:?}", begin.elapsed());
    let (b, _) = solved(&stage, 2, 4096, Estimator::Rays);
    let values = |k: f64| a.values.iter().zip(&b.values).map(|(a, b)| a + k * (b - a)).collect::<Vec<_>>();
    bench.reference.patches.replicates = (0..8).map(|k| values(0.01 * k as f64)).collect();
    bench.stage = stage;
    let t = std::time::Instant::now();
    let found = bench.causes_of(&b);
    println!("causes {:?} {found:?}", t.elapsed());
}
