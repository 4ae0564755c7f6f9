//! Polygon pairs with polygons between: by exact shadows, and by rays with an interval.

use crate::estimate::{PairPlan, Plan, cast, pair_form_factors, patch_emitters};
use crate::math::DVec3;
use crate::raycast::{KernelError, KernelKind, Tracer, open_kernels};
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::stats::{Estimate, form_factor_interval};

/// Relative error asked for.
const TARGET: f64 = 1e-13;

/// Form factors there and back between the first two polygons, the others standing between, with their stated errors:
/// no rays.
pub(super) fn exchange(polygons: &[Vec<DVec3>]) -> [[f64; 2]; 2] {
    let plan = PairPlan { target_error: Some(TARGET), arranged_bodies: 6, ..PairPlan::default() };
    let f = pair_form_factors(&Stage::from_polygons(polygons), &plan, &|_| ()).form_factors;
    [(0, 1), (1, 0)].map(|(i, j)| [f.get(i, j), f.std_err_of(i, j).unwrap_or(0.0)])
}

/// The same by `plan.rays` hemisphere rays each.
///
/// # Errors
/// If the kernel cannot be had.
pub(super) fn by_rays(
    polygons: &[Vec<DVec3>],
    kernel: KernelKind,
    plan: &Plan,
    stream: Stream,
    confidence: f64,
) -> Result<[Estimate; 2], KernelError> {
    let stage = Stage::from_polygons(polygons);
    let kernels = open_kernels(kernel, &stage)?;
    let tracer = Tracer::new(&stage, kernels.kernel, kernels.exact, false);
    let mut emitters = patch_emitters(&stage);
    emitters[2..].iter_mut().for_each(|e| *e = None);
    let counts = cast(&tracer, &emitters, stream, plan, &|_| 0.0, &|_| ()).counts;
    Ok([(0, 1), (1, 0)]
        .map(|(from, to)| form_factor_interval(&counts.of_pair(from, to), counts.rays, confidence, None)))
}

/// The stream of a case: the judge's own rays, another address for each case.
pub(super) fn stream(seed: u64, case: usize) -> Stream {
    Stream::new(Role::Judge, seed).child(case as u64)
}
