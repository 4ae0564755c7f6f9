//! Why no reference came of it.

use crate::solver::SolverError;

/// Failures of the judge.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// The patch system could not be solved.
    #[error("the reference radiosity cannot be solved: {0}")]
    Solver(#[from] SolverError),
    /// Bounds of a scene with point lights.
    #[error("radiosities cannot be bounded where point lights shine: their light is estimated; leave --bounds out")]
    PointLights,
    /// The scene is larger than the counters.
    #[error("{what} is {got}, more than this version holds ({most}); {mend}")]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// How large.
        got: u64,
        /// The limit.
        most: u64,
        /// What to do.
        mend: &'static str,
    },
}
