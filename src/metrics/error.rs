//! What can be wrong with a comparison.

/// Why two radiosities cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MetricsError {
    /// Something does not have one entry per receiver (or per band).
    #[error("{what} has {got} {unit} where the judged scene has {expected}; compare solutions of the same scene")]
    Shape {
        /// What is of the wrong size.
        what: &'static str,
        /// What is counted.
        unit: &'static str,
        /// Its size.
        got: usize,
        /// The size of the judged scene.
        expected: usize,
    },
    /// A value that is not a number.
    #[error("{what} holds a value that is not finite at patch {patch}; compute it anew")]
    NotFinite {
        /// Where it was found.
        what: &'static str,
        /// Receiver number.
        patch: usize,
    },
    /// No receiver takes part.
    #[error("no patch is present in the judged state: there is nothing to compare; choose another --state")]
    NothingPresent,
    /// The spread of so few replicates says nothing.
    #[error("{what} has {got} replicates, too few for an interval; {needed} are needed (--randomisations)")]
    TooFewReplicates {
        /// Which reference.
        what: &'static str,
        /// Replicates it has.
        got: usize,
        /// Replicates needed.
        needed: usize,
    },
    /// The denominator of eq. 7 is zero, or not distinguishable from zero.
    #[error(
        "{what} of the reference is dark, or too noisy to tell from dark: a relative error against it is not \
         defined; light the scene, or use more --rays"
    )]
    DarkReference {
        /// Luminance or reflected luminance.
        what: &'static str,
    },
    /// A confidence that is not between 0 and 1.
    #[error("a confidence of {confidence} is not between 0 and 1")]
    Confidence {
        /// What was asked for.
        confidence: f64,
    },
    /// A limit on a place that is not there.
    #[error("there is no {kind} \"{name}\" in the judged state; there are: {known}")]
    NoSuchPlace {
        /// Surface, object or band.
        kind: &'static str,
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
}
