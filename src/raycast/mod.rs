//! Ray kernels: batches of rays in, the facets they hit out.
//!
//! Kernels answer one question only: which facet does a ray meet first? Where on it, on which side and in
//! which patch is decided in double precision by the [`Tracer`].

mod bodies;
mod builtin;
mod coplanar;
mod embree;
#[cfg(feature = "embree4-rs")]
mod embree4_rs;
mod find;
mod hierarchy;
mod kernel;
mod locate;
mod polygons;
mod select;
mod shaft;
pub mod specimen;
mod tracer;
mod witness;

pub use bodies::{Bodies, bodies};
pub use builtin::BuiltinKernel;
pub use coplanar::plane_groups;
pub use embree::{EmbreeKernel, Packets};
pub use find::{Candidate, EMBREE_VARIABLE, Refused, Search, embree_folder, find_embree, use_embree};
pub use kernel::{KernelError, KernelInfo, KernelKind, RayBatch, RayKernel};
pub use locate::{BACK, ESCAPED, ElementLocator, PatchLocator};
pub use select::{Kernels, open_kernel, open_kernels};
pub use shaft::{Between, Shaft};
pub use tracer::{Tally, TraceScratch, Tracer};
pub use witness::{Agreement, Disagreement, agree};
