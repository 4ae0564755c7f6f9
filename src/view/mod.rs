//! Cameras and photometry.

mod camera;
mod photometry;

pub use camera::Camera;
pub use photometry::{Photometry, Primaries};
