//! Redistribution against dense solutions with the same rays, over random sequences of edits.
//!
//! The dense side knows nothing of shooting: rows of all patches are cast by the gather method (same seed, hence the
//! same rays), `G_ij = A_j F_ji / A_i` is what a shooter's rays say of the exchange, and Gauss's elimination solves.

#[path = "common/dense.rs"]
mod dense;

use dense::{Known, SEED, below, dense, invariant_gap, params, random_edit, rows, scene, solve};
use etalon::KernelKind;
use etalon::estimate::is_closed;
use etalon::methods::shooting::{Budget, Shooting, ShootingError, Step};
use etalon::raycast::specimen::Numbers;
use etalon::raycast::{RayKernel, open_kernels};
use etalon::scene::Edit;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

/// One random history. Returns the number of edits made and the largest gap of the final solution.
fn history(seed: u64, kernel: KernelKind, edits: usize) -> (usize, f64) {
    let mut n = Numbers::new(seed);
    let scene = scene();
    let mut solver = Shooting::open(&scene, 0, params(), kernel, SEED).unwrap();
    let initial = scene.at(0).unwrap();
    let exact: Arc<dyn RayKernel> = open_kernels(KernelKind::Builtin, &initial).unwrap().exact;
    let mut known = Known { kernel, enclosure: is_closed(&initial, &exact), states: BTreeMap::new() };
    let mut there: BTreeMap<&'static str, bool> = [("box", true), ("glow", false), ("plate", true)].into();
    let mut made = 0;
    let balanced = |s: &Shooting, step: Step| {
        let gap = s.energy().gap();
        assert!(gap < 1e-9, "history {seed}: energy is off by {gap:e} after {step:?}");
    };
    for _ in 0..edits {
        let shots = [0, 1, 3, 10, 40, 100_000][below(&mut n, 6)];
        let budget = Budget { shots: Some(shots), time: None };
        solver.run(budget, &mut |s, e| {
            balanced(s, e.step);
            ControlFlow::Continue(())
        });
        let gap = invariant_gap(&solver, &mut known);
        assert!(gap < 1e-9, "history {seed}, state {}: B = E + rho F (B - U) is off by {gap:e}", solver.state());
        let edit = random_edit(&mut n, &there);
        let presence = match &edit {
            Edit::Add { object } => Some((object.clone(), true)),
            Edit::Remove { object } => Some((object.clone(), false)),
            _ => None,
        };
        // A place that the scene refuses leaves everything as it was.
        let before = (solver.state(), solver.radiosity());
        if let Err(e) = solver.apply(edit) {
            assert!(matches!(e, ShootingError::Scene(_)), "{e}");
            assert_eq!((solver.state(), solver.radiosity()), before);
            continue;
        }
        made += 1;
        if let Some((object, is)) = presence {
            *there.get_mut(object.as_str()).unwrap() = is;
        }
        let gap = invariant_gap(&solver, &mut known);
        assert!(gap < 1e-9, "history {seed}: right after the edit to state {}: off by {gap:e}", solver.state());
    }
    solver.run(Budget::default(), &mut |s, e| {
        balanced(s, e.step);
        ControlFlow::Continue(())
    });
    assert!(solver.is_drained() && solver.log().is_empty());
    let stage = solver.stage();
    let exact = solve(stage, &dense(&rows(stage, kernel, known.enclosure)));
    let b = solver.radiosity();
    // Where all lamps are out, what was bright before measures what rounding may leave.
    let size = exact.iter().fold(solver.energy().brightest, |m, x| m.max(x.abs()));
    let gap = b.values.iter().zip(&exact).map(|(x, y)| (x - y).abs() / size).fold(0.0, f64::max);
    (made, gap)
}

/// Histories of some seeds; most of the edits must be possible.
fn histories(seeds: std::ops::Range<u64>) {
    let (mut edits, mut worst) = (0, 0.0f64);
    for seed in seeds.clone() {
        let (made, gap) = history(seed, KernelKind::Builtin, 1 + seed as usize % 6);
        assert!(gap < 1e-9, "history {seed}: off by {gap:e}");
        edits += made;
        worst = worst.max(gap);
    }
    println!("histories {seeds:?}, {edits} edits: at most {worst:.1e} from the dense solution");
    assert!(edits as u64 > 2 * (seeds.end - seeds.start), "{edits}");
}

#[test]
fn any_sequence_of_edits_ends_in_the_dense_solution() {
    histories(0..100);
}

#[test]
fn so_do_a_hundred_others() {
    histories(100..200);
}

#[test]
fn the_same_on_the_kernel_in_use() {
    for seed in 1000..1030 {
        let (_, gap) = history(seed, KernelKind::Auto, 3);
        assert!(gap < 1e-9, "history {seed}: off by {gap:e}");
    }
}
