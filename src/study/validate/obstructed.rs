//! Polygon pairs with polygons between: form factors with an interval. The one place to change when such pairs can be had
//! without rays.

use crate::estimate::{Plan, cast, patch_emitters};
use crate::math::DVec3;
use crate::raycast::{KernelError, KernelKind, Tracer, open_kernels};
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::stats::{Estimate, form_factor_interval};

/// Form factors there and back between the first two polygons, the others standing between, by `plan.rays` hemisphere
/// rays each.
///
/// # Errors
/// If the kernel cannot be had.
pub(super) fn exchange(
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
