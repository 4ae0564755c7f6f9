//! The interface of a ray kernel.

use crate::math::DVec3;
use crate::scene::NO_FACET;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A batch of rays that start on one facet (or on none), structure of arrays, double precision, metres.
#[derive(Debug, Clone, Default)]
pub struct RayBatch {
    /// Origins: x, y, z.
    pub origin: [Vec<f64>; 3],
    /// Unit directions: x, y, z.
    pub direction: [Vec<f64>; 3],
    /// Facet all of them start on: it and every facet in its plane are never hit. [`NO_FACET`] for a camera.
    pub from: u32,
}

impl RayBatch {
    /// A batch of `n` rays, all zero, to be filled in.
    pub fn zeroed(n: usize) -> Self {
        let column = || std::array::from_fn(|_| vec![0.0; n]);
        Self { origin: column(), direction: column(), from: NO_FACET }
    }

    /// Number of rays.
    pub fn len(&self) -> usize {
        self.origin[0].len()
    }

    /// True if there are no rays.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Changes the number of rays; new ones are zero.
    pub fn resize(&mut self, n: usize) {
        self.origin.iter_mut().chain(&mut self.direction).for_each(|c| c.resize(n, 0.0));
    }

    /// Sets ray k.
    pub fn set(&mut self, k: usize, origin: DVec3, direction: DVec3) {
        for c in 0..3 {
            self.origin[c][k] = origin[c];
            self.direction[c][k] = direction[c];
        }
    }

    /// Origin of ray k.
    pub fn origin_of(&self, k: usize) -> DVec3 {
        DVec3::new(self.origin[0][k], self.origin[1][k], self.origin[2][k])
    }

    /// Direction of ray k.
    pub fn direction_of(&self, k: usize) -> DVec3 {
        DVec3::new(self.direction[0][k], self.direction[1][k], self.direction[2][k])
    }
}

/// Finds the first facet along each ray of a batch.
///
/// No minimum distance: a ray that starts a hair's breadth before a wall hits it. The plane it starts on
/// is left out by number, not by distance.
pub trait RayKernel: Send + Sync {
    /// Which kernel this is.
    fn info(&self) -> &KernelInfo;

    /// Number of the facet that each ray meets first, [`NO_FACET`] for none. `facets` has the batch's length.
    /// A hit on the back of a facet counts; where two facets coincide, either may be named.
    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]);
}

/// What a kernel is, for provenance.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KernelInfo {
    /// `embree`, `builtin` or `embree4-rs`.
    pub name: String,
    /// Version of the library.
    pub version: String,
    /// Where it was loaded from, if it is a library.
    pub path: Option<PathBuf>,
    /// Instruction set it runs on, where it tells.
    pub instruction_set: Option<String>,
}

/// Which kernel the user asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum KernelKind {
    /// Embree if there is one, else the built-in.
    #[default]
    Auto,
    /// Embree 4, loaded at run time.
    Embree,
    /// Pure Rust, double precision.
    Builtin,
    /// Embree 4 through the published wrapper.
    #[serde(rename = "embree4-rs")]
    Embree4Rs,
}

/// Why a kernel cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum KernelError {
    /// No Embree 4 was found.
    #[error(
        "no Embree 4 library was found (looked in {looked_in}); run `etalon setup embree`, or use --kernel builtin"
    )]
    NotFound {
        /// Places that were searched.
        looked_in: String,
    },
    /// A library was found but cannot be used.
    #[error("the Embree library {path} cannot be used: {why}; run `etalon setup embree`, or use --kernel builtin")]
    Unusable {
        /// The library.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// This build does not carry the kernel.
    #[error("this build has no kernel {name}; build with `--features {name}`")]
    NotBuilt {
        /// Kernel name.
        name: &'static str,
    },
    /// Embree reported an error.
    #[error("Embree reported an error while {doing}: {what}")]
    Failed {
        /// What was being done.
        doing: &'static str,
        /// What it said.
        what: String,
    },
}
