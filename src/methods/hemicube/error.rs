//! Why a hemi-cube cannot be had.

use crate::solver::SolverError;

/// Refusals and failures of the hemi-cube method.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HemicubeError {
    /// A setting that is not `key=value`.
    #[error("hemicube: `{text}` is not of the form key=value; keys are {keys}")]
    NotAPair {
        /// What was written.
        text: String,
        /// Keys there are.
        keys: &'static str,
    },
    /// A setting that does not exist.
    #[error("hemicube: there is no setting `{key}`; settings are {keys}")]
    UnknownKey {
        /// What was written.
        key: String,
        /// Keys there are.
        keys: &'static str,
    },
    /// A setting given twice.
    #[error("hemicube: `{key}` is given twice; keep one")]
    RepeatedKey {
        /// The key.
        key: String,
    },
    /// A value that cannot be read.
    #[error("hemicube: {key} cannot be `{value}`; it must be {wanted}")]
    BadValue {
        /// The key.
        key: String,
        /// What was written.
        value: String,
        /// What it must be.
        wanted: &'static str,
    },
    /// A resolution out of range.
    #[error("hemicube: resolution {got} is not possible; it must be even, from 4 to 4096")]
    Resolution {
        /// What was asked for.
        got: u32,
    },
    /// A hemi-cube that cannot stand where it is put.
    #[error("hemicube: a hemi-cube of row {row} is not possible; {what}")]
    BadStand {
        /// Row it belongs to.
        row: usize,
        /// What it must be.
        what: &'static str,
    },
    /// Form factors of another scene.
    #[error("the form factors are for {got} patches and the scene has {expected}; compute them for this scene")]
    ForeignMatrix {
        /// Rows of the matrix.
        got: usize,
        /// Patches of the scene.
        expected: usize,
    },
    /// The iteration failed.
    #[error(transparent)]
    Solver(#[from] SolverError),
}
