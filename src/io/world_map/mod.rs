//! World maps as files: environment maps of others, photographs of the sky, and our own.

mod faces;
mod picture;
mod read;
mod write;

pub use read::{LayoutHint, ReadMap, read_world_map};
pub use write::world_map_exr;

/// Header attribute that names the layout of our own files.
const LAYOUT: &str = "worldLayout";
/// Header attribute with the names of the bands of our own files, one a line.
const BANDS: &str = "worldBands";

#[cfg(test)]
mod tests;
