//! Engines made wrong on purpose: the self-check of a reference has to catch each, by name.

#[path = "common/truth.rs"]
mod common;

use common::{Polygons, Silent, unit_cube};
use etalon::estimate::{Estimator, Plan};
use etalon::math::DVec3;
use etalon::raycast::{KernelInfo, KernelKind, RayBatch, RayKernel, Tracer, open_kernels};
use etalon::reference::{Evidence, Options, compute};
use etalon::scene::{Grid, NO_FACET, Stage};
use etalon::solution::SelfCheck;
use std::sync::Arc;

/// A kernel that gives other answers than it is given.
struct Wrong<F> {
    sound: Arc<dyn RayKernel>,
    spoil: F,
}

impl<F: Fn(&RayBatch, usize, u32) -> u32 + Send + Sync> RayKernel for Wrong<F> {
    fn info(&self) -> &KernelInfo {
        self.sound.info()
    }

    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        self.sound.intersect(rays, facets);
        for (k, f) in facets.iter_mut().enumerate() {
            *f = (self.spoil)(rays, k, *f);
        }
    }
}

/// A room with a box in the air; the ceiling emits. `flipped`: this face of the box is wound the wrong way.
fn stage(flipped: Option<usize>, with_box: bool) -> Stage {
    let mut p = Polygons::new(1);
    for (k, face) in unit_cube().into_iter().enumerate() {
        p.add(face, Grid::Quad { na: 3, nb: 3 }, &[0.7], &[if k == 1 { 1.0 } else { 0.0 }]);
    }
    for (k, mut face) in unit_cube().into_iter().enumerate() {
        if flipped != Some(k) {
            face.reverse();
        }
        let placed = face.into_iter().map(|v| DVec3::new(0.35, 0.4, 0.3) + v * 0.3).collect();
        if with_box {
            p.add(placed, Grid::Quad { na: 1, nb: 1 }, &[0.7], &[0.0]);
        }
    }
    p.stage()
}

fn check_with(stage: &Stage, spoil: impl Fn(&RayBatch, usize, u32) -> u32 + Send + Sync + 'static) -> SelfCheck {
    let sound = open_kernels(KernelKind::Builtin, stage).expect("built in");
    let exact: Arc<dyn RayKernel> = sound.exact;
    let wrong: Arc<dyn RayKernel> = Arc::new(Wrong { sound: exact.clone(), spoil });
    let tracer = Tracer::new(stage, wrong, exact, false);
    let plan = Plan { rays: 16_384, estimator: Estimator::Auto, ..Plan::default() };
    let evidence = Evidence { declared_enclosure: true, ..Evidence::default() };
    compute(&tracer, &Options { plan, seed: 3 }, &evidence, &Silent).expect("solvable").self_check
}

fn failed(check: &SelfCheck) -> Vec<&str> {
    check.failures().map(|c| c.name.as_str()).collect()
}

#[test]
fn a_sound_engine_passes() {
    let check = check_with(&stage(None, true), |_, _, f| f);
    assert!(check.passed(), "{:?}", check.checks);
}

#[test]
fn half_a_percent_of_rays_dropped() {
    let check = check_with(&stage(None, true), |rays, k, f| {
        let bits = rays.direction[0][k].to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        if bits % 200 == 0 { NO_FACET } else { f }
    });
    assert!(failed(&check).contains(&"leaks"), "{:?}", check.checks);
    assert!(failed(&check).contains(&"pairs by rays"), "{:?}", check.checks);
}

#[test]
fn one_normal_flipped() {
    let check = check_with(&stage(Some(2), true), |_, _, f| f);
    assert!(failed(&check).contains(&"leaks"), "{:?}", check.checks);
}

#[test]
fn one_occluder_lost() {
    // Rays go through the box to what the empty room has behind it.
    let empty = stage(None, false);
    let through = open_kernels(KernelKind::Builtin, &empty).expect("built in").exact;
    let check = check_with(&stage(None, true), move |rays, k, f| {
        if f < 6 || f == NO_FACET {
            return f;
        }
        let mut one = RayBatch::zeroed(1);
        one.set(0, rays.origin_of(k), rays.direction_of(k));
        one.from = rays.from;
        let mut answer = [NO_FACET];
        if rays.from < 6 || rays.from == NO_FACET {
            through.intersect(&one, &mut answer);
        } else {
            return f;
        }
        answer[0]
    });
    assert!(failed(&check).contains(&"pairs by rays"), "{:?}", check.checks);
}
