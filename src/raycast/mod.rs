//! Ray kernels: batches of rays in, the facets they hit out.
//!
//! Kernels answer one question only: which facet does a ray meet first? Where on it, on which side and in
//! which patch is decided in double precision by the [`Tracer`].

mod kernel;
mod locate;
mod tracer;

pub use kernel::{KernelError, KernelInfo, KernelKind, RayBatch, RayKernel};
pub use locate::{BACK, ESCAPED};
pub use tracer::{Tally, TraceScratch, Tracer};
