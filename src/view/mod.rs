//! Cameras, photometry, and how light looks: tone reproduction.

mod camera;
mod photometry;
mod tone;

pub use camera::Camera;
pub use photometry::{Photometry, Primaries};
pub use tone::{
    DEFAULT_EFFICACY, Display, Drive, LAMBERT, LEAST_STEVENS, Levels, Observer, Operator, Response, Surround, Tone,
    Viewer,
};
