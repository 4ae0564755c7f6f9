//! Known mistakes are named, with their place; solutions that are right, or honestly approximate, get no name.

#[path = "planted_faults/workshop.rs"]
mod workshop;

use etalon::estimate::Estimator;
use std::sync::OnceLock;
use workshop::{Bench, CORNELL, Targets, faults, mixed, solved};

/// Made once for all tests.
fn cornell_box() -> &'static Bench {
    static BENCH: OnceLock<Bench> = OnceLock::new();
    BENCH.get_or_init(|| Bench::new("cornell-box-coarse"))
}

fn all_are_named(bench: &Bench, targets: &Targets) {
    let mut wrong = Vec::new();
    for fault in faults(bench, targets) {
        let found = bench.causes_of(&fault.solution);
        let first = found.first();
        if !first.is_some_and(|c| c.kind == fault.kind && c.place == fault.place && c.explains > 0.5) {
            wrong.push(format!("{}: expected {} at {:?}, got {first:?}", fault.what, fault.kind, fault.place));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_planted_fault_is_named_first_in_the_cornell_box() {
    all_are_named(cornell_box(), &CORNELL);
}

#[test]
fn one_of_two_lamps_is_named() {
    let bench = Bench::with_two_lamps();
    let solved = |factor: f64| {
        let m = bench.material("green");
        bench.edited(|s| s.materials[m].emission.iter_mut().for_each(|e| *e *= factor))
    };
    for (factor, kind) in [(0.7, "lamp"), (0.0, "lamp-off"), (1.5, "lamp")] {
        let found = bench.causes_of(&solved(factor));
        let first = found.first().unwrap_or_else(|| panic!("no name for a lamp times {factor}"));
        assert_eq!((first.kind.as_str(), first.place.as_deref()), (kind, Some("green")), "{factor}: {found:?}");
    }
}

#[test]
fn small_faults_are_named_too() {
    let bench = cornell_box();
    // A tenth of each is still told from all others.
    let all = faults(bench, &CORNELL);
    for what in ["all 1 % bright", "sRGB-encoded", "bounce 2 missing", "materials swapped", "material 20 % darker"] {
        let fault = all.iter().find(|f| f.what == what).expect("a fault");
        let found = bench.causes_of(&mixed(&bench.right, &fault.solution, 0.1));
        assert_eq!(found.first().map(|c| c.kind.as_str()), Some(fault.kind), "{what}: {found:?}");
    }
}

#[test]
fn the_same_question_gets_the_same_answer_on_any_number_of_threads() {
    let bench = cornell_box();
    let solution = bench.cut_off(2);
    let ask = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| bench.causes_of(&solution))
    };
    assert_eq!(ask(1), ask(3));
}

#[test]
fn two_faults_at_once_get_no_wrong_name() {
    let bench = cornell_box();
    // Half of the squared error each: neither alone explains most of it.
    let (one, other) = (bench.cut_off(2), bench.seen_through("tall-block"));
    let off = |b: &etalon::solution::Radiosity| bench.rms(b);
    let both = mixed(&one, &other, off(&one) / (off(&one) + off(&other)));
    let found = bench.causes_of(&both);
    assert!(found.iter().all(|c| c.explains < 0.95), "{found:?}");
}

#[test]
fn right_and_honestly_approximate_solutions_get_no_name() {
    let bench = cornell_box();
    let mut wrong = Vec::new();
    let mut none = |what: String, solution| {
        let found = bench.causes_of(&solution);
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
}
