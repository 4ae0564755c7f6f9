//! File formats: scenes, matrices, solutions, references, images; files that are whole or not there.

mod archive;
pub mod atomic;
mod certified;
mod claim;
mod deep_exr;
mod error;
mod folder;
pub mod image;
mod journal;
mod matrix;
mod mesh_values;
mod npz;
mod patches;
pub mod scene;
mod series;
mod solution;
mod span;
mod store;
mod unfinished;
pub mod world_map;

pub use certified::{certified, certified_names};
pub use claim::{Claim, end_claims};
pub use deep_exr::{DeepPixel, DeepSample, deep_exr};
pub use error::FileError;
pub use folder::write_folder;
pub use journal::{Found, Journal};
pub use matrix::{
    Level, MatrixFormat, MatrixLayout, MatrixStyle, SurfaceRows, read_by_surface, read_form_factors,
    read_form_factors_of, surface_rows, write_form_factors, write_matrix,
};
pub use mesh_values::{MeshValuesOptions, is_mesh_values, read_mesh_values, write_vtu};
pub use patches::{PatchFormat, write_patches, write_ply_values};
pub use series::{INDEX as SERIES_INDEX, SeriesWriter, read_series};
pub use solution::{BandNames, SolutionFile, SolutionFormat, read_solution, write_solution};
pub use span::{SPAN_FORMAT, SpanWriteError, read_span, span_bytes, write_span};
pub use store::{Files, StoredReference, is_reference};
pub use unfinished::abandon;
