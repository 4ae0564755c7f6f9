//! A stage with its kernels: what every ray-casting run needs.

use crate::estimate::{Plan, cast, patch_emitters};
use crate::raycast::{KernelError, KernelInfo, KernelKind, RayKernel, Tracer, open_kernels};
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use std::sync::Arc;

/// Patches from which an undeclared scene is probed for openings.
const PROBED_PATCHES: usize = 4096;
/// Rays of each.
const PROBE_RAYS: u64 = 64;

/// Kernels opened on a stage, and whether the stage is closed.
pub struct Session<'a> {
    stage: &'a Stage,
    kernel: Arc<dyn RayKernel>,
    exact: Arc<dyn RayKernel>,
    enclosure: bool,
    notice: Option<String>,
}

impl<'a> Session<'a> {
    /// Opens the kernel asked for and the double-precision one beside it.
    pub fn open(stage: &'a Stage, kind: KernelKind) -> Result<Self, KernelError> {
        let kernels = open_kernels(kind, stage)?;
        let exact: Arc<dyn RayKernel> = kernels.exact;
        let enclosure = stage.enclosure.unwrap_or_else(|| is_closed(stage, &exact));
        Ok(Self { stage, kernel: kernels.kernel, exact, enclosure, notice: kernels.notice })
    }

    /// What the user should know about the kernel: that there is no Embree, and why.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// The stage.
    pub fn stage(&self) -> &'a Stage {
        self.stage
    }

    /// True if the author says so or, where he says nothing, if no probing ray finds an opening.
    pub fn is_enclosure(&self) -> bool {
        self.enclosure
    }

    /// The kernel in use.
    pub fn kernel(&self) -> &KernelInfo {
        self.kernel.info()
    }

    /// A tracer on the kernel in use.
    pub fn tracer(&self) -> Tracer<'a> {
        Tracer::new(self.stage, self.kernel.clone(), self.exact.clone(), self.enclosure)
    }

    /// The kernel in use and the one that witnesses: double precision beside any other, `None` where the
    /// built-in kernel itself is in use.
    pub fn witness(&self) -> Option<(&dyn RayKernel, &dyn RayKernel)> {
        (self.kernel.info().name != self.exact.info().name).then_some((&*self.kernel, &*self.exact))
    }
}

/// Casts a few rays from (up to 4,096 of) the patches: closed if none escapes and none meets a back.
fn is_closed(stage: &Stage, exact: &Arc<dyn RayKernel>) -> bool {
    let tracer = Tracer::new(stage, exact.clone(), exact.clone(), false);
    let step = stage.patch_count().div_ceil(PROBED_PATCHES).max(1);
    let mut emitters = patch_emitters(stage);
    emitters.iter_mut().enumerate().filter(|(i, _)| i % step != 0).for_each(|(_, e)| *e = None);
    let plan = Plan { rays: PROBE_RAYS, randomisations: 8, ..Plan::default() };
    let stream = Stream::new(Role::Witness, 0);
    let tally = cast(&tracer, &emitters, stream, &plan, &|_| 0.0, &|_| ()).counts.tally;
    tally.rays > 0 && tally.escapes == 0 && tally.back_hits == 0
}
