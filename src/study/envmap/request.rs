//! What is asked of an audit of environment maps.

use crate::math::DVec3;
use crate::render::Centre;
use crate::solution::Replicates;
use crate::view::Camera;

/// What is asked.
#[derive(Debug, Clone)]
pub struct EnvmapRequest {
    /// Name of the scene, for the record.
    pub scene: String,
    /// Object or surface that is shaded by the map.
    pub object: String,
    /// World centres; empty: the middle of the object's box.
    pub centres: Vec<DVec3>,
    /// Which way is the front, and up; of the point nothing is taken.
    pub axes: Centre,
    /// Who looks at the object: reflections are seen from its eye, and its picture is drawn.
    pub camera: Camera,
    /// Weights of diffuse and of mirror light in that picture: `dc D + sc S`.
    pub shading: [f64; 2],
    /// Edge of the cube's faces, texels.
    pub size: u32,
    /// Samples along each edge of a texel that shows more than one thing.
    pub samples: u32,
    /// Width and height of the diffuse map.
    pub table: [u32; 2],
    /// Points over the object.
    pub points: usize,
    /// Directions that fast filters are compared with exact ones in.
    pub directions: u64,
    /// Rays of the truth at each point, over all replicates.
    pub rays: u64,
    /// Seed of all that is random.
    pub seed: u64,
    /// Error that the distance from the centre is stated for.
    pub stated: f64,
    /// Limit on the error of the irradiance over the object.
    pub limit: Option<f64>,
    /// Confidence of the intervals.
    pub confidence: f64,
}

/// The light: radiosities by replicate, and where they come from.
#[derive(Debug, Clone)]
pub struct Light {
    /// Patch-major, W/m^2.
    pub radiosities: Replicates,
    /// In words.
    pub source: String,
}

/// Replicates that a solution without any is given, so that rays have some.
pub const REPLICATES: usize = 16;

impl Light {
    /// Radiosities without replicates: all alike, so that only the rays of the truth have a spread.
    pub fn exact(bands: usize, values: Vec<f64>, source: String) -> Self {
        Self { radiosities: Replicates { bands, replicates: vec![values; REPLICATES] }, source }
    }

    /// Means over the replicates, patch-major.
    pub fn mean(&self) -> Vec<f64> {
        let all = &self.radiosities.replicates;
        let of = |k: usize| all.iter().map(|r| r[k]).sum::<f64>() / all.len() as f64;
        (0..all.first().map_or(0, Vec::len)).map(of).collect()
    }
}

/// Why there is no audit.
#[derive(Debug, thiserror::Error)]
pub enum EnvmapError {
    /// No such object.
    #[error("there is no object or surface \"{name}\"; the scene has {known}")]
    NoObject {
        /// Name asked for.
        name: String,
        /// Names there are.
        known: String,
    },
    /// It takes no part.
    #[error("\"{name}\" does not stand there in this state: choose another --state or --object")]
    Absent {
        /// Name asked for.
        name: String,
    },
    /// Nothing of it is free.
    #[error("\"{name}\" is covered all over by what touches it: no light arrives on it; choose another --object")]
    Covered {
        /// Name asked for.
        name: String,
    },
    /// A centre that sees nothing.
    #[error(
        "the world centre {x}, {y}, {z} sees no light at all: move it with --at, or look whether the solution is dark"
    )]
    Dark {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// Metres.
        z: f64,
    },
    /// Point lights.
    #[error("the scene has point lights, which shine on no map: leave them out, or make them small emitters")]
    PointLights,
    /// No kernel.
    #[error(transparent)]
    Kernel(#[from] crate::raycast::KernelError),
}
