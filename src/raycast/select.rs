//! Choosing a kernel.

use super::find::find_embree;
use super::{BuiltinKernel, EmbreeKernel, KernelError, KernelInfo, KernelKind, RayBatch, RayKernel};
use crate::scene::Stage;
use std::sync::Arc;

/// The kernels of one stage.
pub struct Kernels {
    /// The one that was asked for.
    pub kernel: Arc<dyn RayKernel>,
    /// The built-in one: arbiter, witness. The same as `kernel` where that is the built-in.
    pub exact: Arc<BuiltinKernel>,
    /// What the user should know: that there is no Embree, and why.
    pub notice: Option<String>,
}

impl<K: RayKernel + ?Sized> RayKernel for Arc<K> {
    fn info(&self) -> &KernelInfo {
        (**self).info()
    }

    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        (**self).intersect(rays, facets);
    }
}

/// The kernel that is asked for, on a stage.
///
/// # Errors
/// As [`open_kernels`].
pub fn open_kernel(kind: KernelKind, stage: &Stage) -> Result<Box<dyn RayKernel>, KernelError> {
    open_kernels(kind, stage).map(|k| Box::new(k.kernel) as Box<dyn RayKernel>)
}

/// The kernel that is asked for together with the built-in one, on a stage.
///
/// # Errors
/// If a kernel other than `auto` or `builtin` is asked for: [`KernelError::NotFound`] if there is no Embree,
/// [`KernelError::Unusable`] if it is refused, [`KernelError::NotBuilt`] if this build lacks the kernel,
/// [`KernelError::Failed`] if it reports an error.
pub fn open_kernels(kind: KernelKind, stage: &Stage) -> Result<Kernels, KernelError> {
    let exact = Arc::new(BuiltinKernel::new(stage));
    let alone = |notice| Kernels { kernel: exact.clone(), exact: exact.clone(), notice };
    match kind {
        KernelKind::Builtin => Ok(alone(None)),
        KernelKind::Auto => Ok(embree(stage, &exact).unwrap_or_else(|e| alone(Some(without_embree(&e))))),
        KernelKind::Embree => embree(stage, &exact),
        KernelKind::Embree4Rs => wrapper(stage, &exact),
    }
}

fn embree(stage: &Stage, exact: &Arc<BuiltinKernel>) -> Result<Kernels, KernelError> {
    let library = find_embree().result()?;
    let kernel = EmbreeKernel::new(library, stage, exact.clone())?;
    Ok(Kernels { kernel: Arc::new(kernel), exact: exact.clone(), notice: None })
}

#[cfg(feature = "embree4-rs")]
fn wrapper(stage: &Stage, exact: &Arc<BuiltinKernel>) -> Result<Kernels, KernelError> {
    let library = find_embree().result()?;
    let kernel = EmbreeKernel::through_wrapper(library, stage, exact.clone())?;
    Ok(Kernels { kernel: Arc::new(kernel), exact: exact.clone(), notice: None })
}

#[cfg(not(feature = "embree4-rs"))]
fn wrapper(_: &Stage, _: &Arc<BuiltinKernel>) -> Result<Kernels, KernelError> {
    Err(KernelError::NotBuilt { name: "embree4-rs" })
}

/// What is lost, and how to mend it.
fn without_embree(error: &KernelError) -> String {
    format!(
        "tracing with the built-in kernel, several times slower than Embree and without a second kernel to check \
         it: {error}"
    )
}
