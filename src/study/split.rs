//! Telling apart where an error comes from: the levels of truth, and the candidate's own form factors.

use super::{Against, JudgeError, Receivers};
use crate::io::StoredReference;
use crate::methods::gather;
use crate::metrics::{Split, Steps, Truth, split};
use crate::scene::Stage;
use crate::solution::{FormFactors, Radiosity, TruthLevel};
use crate::solver::SolverError;

/// Why an error cannot be split.
#[derive(Debug, thiserror::Error)]
pub enum SplitError {
    /// The judge refuses.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// The system of the candidate's form factors cannot be solved.
    #[error("the form factors given cannot be solved with: {0}; check their row sums")]
    Solve(#[from] SolverError),
}

/// What is at hand beside the solution.
#[derive(Debug, Clone, Copy, Default)]
pub struct Beside<'a> {
    /// The candidate's own form factors.
    pub form_factors: Option<&'a FormFactors>,
    /// A patch-system reference, where the judge is a continuous one.
    pub patch_system: Option<&'a StoredReference>,
}

/// Splits the error of a solution, per patch. Intervals at `confidence`.
///
/// # Errors
/// Form factors that cannot be solved with; what [`split`] refuses.
pub fn split_error(
    stage: &Stage,
    solution: &Radiosity,
    against: &Against,
    beside: &Beside,
    receivers: &Receivers,
    confidence: f64,
) -> Result<Split, SplitError> {
    let solved = beside.form_factors.map(|f| gather::solve_with(stage, f)).transpose()?.map(|(b, _)| b);
    let judge = against.truth(false)?;
    let is_continuous = matches!(against, Against::Reference(r) if r.provenance.truth == TruthLevel::Continuous);
    let beside_system = beside.patch_system.map(|r| Truth::Sampled(r.patches.clone()));
    let (patch_system, continuous) =
        if is_continuous { (beside_system, Some(judge)) } else { (beside_system.or(Some(judge)), None) };
    let steps = Steps {
        solution,
        solved: solved.as_ref(),
        patch_system: patch_system.as_ref(),
        continuous: continuous.as_ref(),
    };
    let surfaces: Vec<&str> = receivers.surfaces.iter().map(String::as_str).collect();
    Ok(split(&steps, &receivers.judged(&surfaces), confidence).map_err(JudgeError::from)?)
}
