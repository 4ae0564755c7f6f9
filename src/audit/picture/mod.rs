//! The judge of pictures and of light: plain Monte Carlo over the ray kernels, with standard errors.
//!
//! Shares nothing with `compositing`, the candidate: skies, lamps, textures, trees, fog and mirrors are written here once
//! more from their definitions. Errors come from the spread of independent randomisations, each a scrambled net.

mod backdrop;
mod cast;
mod compare;
mod grove;
mod lamp;
mod light;
mod lit;
mod net;
mod setting;
mod shadow;
mod sky;
mod spherical;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_shown;
mod texel;
mod wave;

pub use cast::{Diffuse, PictureOptions, RayPicture, cast_picture};
pub use compare::{PictureError, compare};
pub use light::{LightJudge, RANDOMISATIONS};

/// Why a picture cannot be cast or compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PictureFault {
    /// A picture's bytes do not fit its size.
    #[error("picture `{name}` has {bytes} bytes for {} x {} pixels of 4", size[0], size[1])]
    Bytes {
        /// Its name.
        name: String,
        /// What it has.
        bytes: usize,
        /// Width and height.
        size: [u32; 2],
    },
    /// A texture, a tree or a background refers to a picture that is not there.
    #[error("there is no picture number {0}")]
    Missing(usize),
    /// The scale leaves nothing, or is no number above 0.
    #[error("a scale of {} x {}: give numbers above 0 that leave a pixel", .0[0], .0[1])]
    Scale([f64; 2]),
    /// Values do not fit what they are for.
    #[error("{what}: {found} values where {expected} are needed")]
    Length {
        /// What they are.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there have to be.
        expected: usize,
    },
}
