//! Solvers of the patch system `(I - diag(rho) F) B = E`, all bands at once.
//!
//! Vectors are row-major, n receivers x bands. Solvers take `Params`, call back per iteration and return the
//! radiosities with an `Info`, or a [`SolverError`] that carries the last residual.

pub mod bounds;
mod error;
pub mod gauss_seidel;
pub mod krylov;
mod system;
#[cfg(test)]
mod truth;

pub use error::SolverError;
pub use system::{Norm, System, Transport, gather_once, relative_residual};
