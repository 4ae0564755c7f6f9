//! What is asked of an audit, and why there may be none.

use super::record::Form;
use crate::methods::hemicube::{HemicubeError, Params};
use crate::reference::{Options, ReferenceError};
use crate::scene::Stage;
use crate::solution::FormFactors;
use crate::solver::SolverError;
use crate::study::JudgeError;

/// What is asked.
#[derive(Debug, Clone)]
pub struct AuditRequest<'a> {
    /// Name of the scene.
    pub scene: String,
    /// The hemi-cube.
    pub params: Params,
    /// Further resolutions for the curve.
    pub resolutions: Vec<u32>,
    /// Angles between 0 and 90 degrees for the curve under rotation.
    pub rotations: u32,
    /// Surfaces or objects to be looked at; empty: those that bring the largest errors.
    pub sources: Vec<String>,
    /// Limit on eq. 7 of reflected light.
    pub limit: Option<f64>,
    /// Confidence of intervals.
    pub confidence: f64,
    /// Where the hemi-cubes stand.
    pub form: Form,
    /// Somebody else's form factors, with the name of their file.
    pub theirs: Option<(&'a FormFactors, String)>,
    /// Run the cures.
    pub cures: bool,
    /// Of the truth; its seed is also that of random turns.
    pub reference: Options,
}

/// Why there is no audit.
#[derive(Debug, thiserror::Error)]
pub enum AuditError {
    /// The judge.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The hemi-cube.
    #[error(transparent)]
    Hemicube(#[from] HemicubeError),
    /// A patch system.
    #[error("the patch system with {what} cannot be solved: {source}")]
    Solver {
        /// Which matrix.
        what: String,
        /// Why.
        source: SolverError,
    },
    /// A comparison.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// No such source.
    #[error("there is no surface and no object \"{name}\" in this scene{near}; `etalon scene patches` lists them")]
    NoSource {
        /// As given.
        name: String,
        /// Names that are near.
        near: String,
    },
    /// Lights that hemi-cubes do not see.
    #[error("the scene has {0} point lights, which hemi-cubes do not see; use an emitting surface, or leave them out")]
    PointLights(usize),
    /// Nothing to audit.
    #[error("nothing in this scene is lit: no surface emits, so that no error can matter; give a material an emission")]
    Dark,
    /// A matrix of another scene.
    #[error("the form factors have {got} rows where the scene has {expected} patches; give those of this scene")]
    ForeignMatrix {
        /// Rows.
        got: usize,
        /// Patches.
        expected: usize,
    },
}

pub(super) fn check(stage: &Stage, request: &AuditRequest) -> Result<(), AuditError> {
    if !stage.lights.is_empty() {
        return Err(AuditError::PointLights(stage.lights.len()));
    }
    if stage.emissions().iter().all(|e| *e == 0.0) {
        return Err(AuditError::Dark);
    }
    if let Some((theirs, _)) = &request.theirs
        && theirs.n != stage.patch_count()
    {
        return Err(AuditError::ForeignMatrix { got: theirs.n, expected: stage.patch_count() });
    }
    request.params.validated()?;
    for name in &request.sources {
        if patches_named(stage, name).is_empty() {
            let known = stage.surfaces.iter().map(|s| s.name.as_str());
            let near = known.filter(|k| k.contains(name.as_str()) || name.contains(*k)).take(3);
            let near: Vec<&str> = near.collect();
            let near = if near.is_empty() { String::new() } else { format!(" (there is {})", near.join(", ")) };
            return Err(AuditError::NoSource { name: name.clone(), near });
        }
    }
    Ok(())
}

/// Patches present of a surface, or of all surfaces of an object.
pub(super) fn patches_named(stage: &Stage, name: &str) -> Vec<u32> {
    let of = |i: &u32| {
        let p = &stage.patches[*i as usize];
        let s = &stage.surfaces[p.surface as usize];
        p.is_present() && (s.name == name || s.object == name)
    };
    (0..stage.patch_count() as u32).filter(of).collect()
}

pub(super) fn unsolved(what: &str, source: SolverError) -> AuditError {
    AuditError::Solver { what: what.into(), source }
}
