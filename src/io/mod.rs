//! File formats: scenes, matrices, solutions, references, images. Reads and writes, never computes.

mod error;
mod matrix;
mod npz;
mod solution;
mod store;

pub use error::FileError;
pub use matrix::{MatrixFormat, read_form_factors, write_form_factors};
pub use solution::{BandNames, SolutionFile, SolutionFormat, read_solution, write_solution};
pub use store::{Files, StoredReference, is_reference};
