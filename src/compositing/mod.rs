//! Compositing with multi-scanning, after Nakamae, Ishizaki, Nishita and Takita (1989).
//!
//! Visible segments with their depth are kept for every sub-scanline; pictures of any scale, any number of clusters and
//! any light are made from them without asking again what is visible.

mod background;
mod batches;
mod composite;
mod deep;
mod emitters;
mod flat;
mod fog;
mod image;
mod light;
mod local;
mod mapping;
mod merge;
mod painter;
mod project;
mod rays;
mod regenerate;
mod scan;
mod shade;
mod shader;
mod soft;
mod sunlit;
mod texture;
mod tree;

pub use composite::{CompositeError, composite};
pub use deep::{DeepPicture, DeepSample, deep};
pub use flat::flat;
pub use image::{Cluster, DepthPlane, Line, Span, SpanFace, SpanImage};
pub use light::{Casters, Lamp, NO_CASTER, Volumes};
pub use project::Projection;
pub use rays::LocalRays;
pub use regenerate::{Pixels, Row, ScaleError, Scaling, regenerate};
pub use scan::{ScanError, ScanRequest};
pub use shade::{ShadeError, ShadeOptions, Shaded, shade};
pub use shader::Diffuse;
pub use texture::PictureError;

#[cfg(test)]
mod shade_tests;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
