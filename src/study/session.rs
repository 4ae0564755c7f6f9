//! A stage with its kernels: what every ray-casting run needs.

use crate::estimate::is_closed;
use crate::raycast::{KernelError, KernelInfo, KernelKind, RayKernel, Tracer, open_kernels};
use crate::scene::Stage;
use std::sync::Arc;

/// Kernels opened on a stage, and whether the stage is closed.
pub struct Session<'a> {
    stage: &'a Stage,
    kernel: Arc<dyn RayKernel>,
    exact: Arc<dyn RayKernel>,
    enclosure: bool,
    notice: Option<String>,
    kind: KernelKind,
}

impl<'a> Session<'a> {
    /// Opens the kernel asked for and the double-precision one beside it.
    pub fn open(stage: &'a Stage, kind: KernelKind) -> Result<Self, KernelError> {
        let kernels = open_kernels(kind, stage)?;
        let exact: Arc<dyn RayKernel> = kernels.exact;
        let enclosure = stage.enclosure.unwrap_or_else(|| is_closed(stage, &exact));
        Ok(Self { stage, kernel: kernels.kernel, exact, enclosure, notice: kernels.notice, kind })
    }

    /// What the user should know about the kernel: that there is no Embree, and why.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// The kernel that was asked for.
    pub fn kind(&self) -> KernelKind {
        self.kind
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
