//! Ray kernels: batches of rays in, the facets they hit out.
//!
//! Kernels answer one question only: which facet does a ray meet first? Where on it, on which side and in
//! which patch is decided in double precision by the [`Tracer`].

mod builtin;
mod coplanar;
mod embree;
mod find;
mod hierarchy;
mod kernel;
mod locate;
mod tracer;
mod polygons;
mod select;
pub mod specimen;

pub use builtin::BuiltinKernel;
pub use coplanar::plane_groups;
pub use embree::EmbreeKernel;
pub use find::{Candidate, EMBREE_VARIABLE, Refused, Search, embree_folder, find_embree};
pub use kernel::{KernelError, KernelInfo, KernelKind, RayBatch, RayKernel};
pub use locate::{BACK, ESCAPED};
pub use tracer::{Tally, TraceScratch, Tracer};
pub use select::{Kernels, open_kernel, open_kernels};
