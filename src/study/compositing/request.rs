//! What is asked of an audit of compositing.

use crate::audit::picture::PictureFault;
use crate::compositing::{CompositeError, ScaleError, ScanError, ShadeError};
use crate::io::FileError;
use crate::study::JudgeError;
use crate::view::Camera;

/// What is asked.
#[derive(Debug, Clone)]
pub struct CompositingRequest {
    /// Name of the scene, for the record.
    pub scene: String,
    /// From where pictures are made, and how large.
    pub camera: Camera,
    /// Numbers of sub-scanlines, ascending.
    pub counts: Vec<u32>,
    /// Scales.
    pub scales: Vec<f64>,
    /// Samples per pixel of the judge.
    pub samples: u64,
    /// Points at which each light is judged.
    pub points: usize,
    /// Rays at each point and light.
    pub rays: u64,
    /// Seed of all that is random.
    pub seed: u64,
    /// Limit on the antialiasing error.
    pub limit: Option<f64>,
}

/// Why an audit ends early.
#[derive(Debug, thiserror::Error)]
pub enum CompositingError {
    /// Not scanned.
    #[error(transparent)]
    Scan(#[from] ScanError),
    /// Not at this scale.
    #[error(transparent)]
    Scale(#[from] ScaleError),
    /// Not shaded.
    #[error(transparent)]
    Shade(#[from] ShadeError),
    /// Not composited.
    #[error(transparent)]
    Composite(#[from] CompositeError),
    /// The judge refused.
    #[error(transparent)]
    Picture(#[from] PictureFault),
    /// No kernel.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// Not as a file.
    #[error(transparent)]
    File(#[from] FileError),
    /// Nothing stands before the camera.
    #[error("the camera \"{0}\" sees nothing of the scene: turn it, or name another with --camera")]
    Nothing(String),
}
