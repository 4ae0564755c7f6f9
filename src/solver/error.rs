//! Why a patch system cannot be solved.

/// Refusals and failures of the solvers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolverError {
    /// A vector does not fit the system.
    #[error("{what} has {got} values where the patch system needs {expected}")]
    Shape {
        /// Which vector.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length that fits.
        expected: usize,
    },
    /// A value that no system can have.
    #[error("{what} of receiver {receiver}, band {band}, is {value}; it must be finite")]
    NotFinite {
        /// Which vector.
        what: &'static str,
        /// Receiver number.
        receiver: usize,
        /// Band number.
        band: usize,
        /// The value.
        value: f64,
    },
    /// A receiver that sees itself so well that its own equation has no solution.
    #[error("receiver {receiver} reflects all it emits onto itself (rho F_ii = {product}): no finite radiosity")]
    Singular {
        /// Receiver number.
        receiver: usize,
        /// rho_i F_ii.
        product: f64,
    },
    /// The iteration limit was reached.
    #[error(
        "{solver} stopped after {iterations} iterations; band {band} still has relative residual {residual:.3e}; \
         allow more iterations, loosen the tolerance, or look for form-factor rows that sum to more than one"
    )]
    NotConverged {
        /// Name of the solver.
        solver: &'static str,
        /// Iterations made.
        iterations: usize,
        /// Worst band.
        band: usize,
        /// Its relative residual.
        residual: f64,
    },
    /// The iteration grows without bound.
    #[error(
        "{solver} diverges: band {band} left the range of numbers after {iterations} iterations; \
         some form-factor row times reflectance sums to more than one"
    )]
    Diverged {
        /// Name of the solver.
        solver: &'static str,
        /// Iterations made.
        iterations: usize,
        /// The band.
        band: usize,
    },
    /// Light that is less than none.
    #[error("the emission of receiver {receiver} is {value}; bounds need emissions of 0 or more")]
    Negative {
        /// Receiver number.
        receiver: usize,
        /// The emission, W/m^2.
        value: f64,
    },
    /// Bounds on form factors that contradict what rows sum to.
    #[error(
        "the bounds on the form factors of receiver {receiver} allow row sums from {least:.6} to {most:.6} only, and \
         none of these can be; a scene that is not closed must not be called closed"
    )]
    BoundsMissRowSum {
        /// Receiver number.
        receiver: usize,
        /// Sum of the lower bounds.
        least: f64,
        /// Sum of the upper bounds.
        most: f64,
    },
}
