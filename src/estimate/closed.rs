//! Whether a scene is closed, where its author does not say.

use super::{Plan, cast, patch_emitters};
use crate::raycast::{RayKernel, Tracer};
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use std::sync::Arc;

/// Patches from which an undeclared scene is probed for openings.
const PROBED_PATCHES: usize = 4096;
/// Rays of each.
const PROBE_RAYS: u64 = 64;

/// Casts a few rays from (up to 4,096 of) the patches: closed if none escapes and none meets a back.
pub fn is_closed(stage: &Stage, exact: &Arc<dyn RayKernel>) -> bool {
    let tracer = Tracer::new(stage, exact.clone(), exact.clone(), false);
    let step = stage.patch_count().div_ceil(PROBED_PATCHES).max(1);
    let mut emitters = patch_emitters(stage);
    emitters.iter_mut().enumerate().filter(|(i, _)| i % step != 0).for_each(|(_, e)| *e = None);
    let plan = Plan { rays: PROBE_RAYS, randomisations: 8, ..Plan::default() };
    let stream = Stream::new(Role::Witness, 0);
    let tally = cast(&tracer, &emitters, stream, &plan, &|_| 0.0, &|_| ()).counts.tally;
    tally.rays > 0 && tally.escapes == 0 && tally.back_hits == 0
}
