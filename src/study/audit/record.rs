//! What an audit has found: data only, ready to be stored, shown and put into words.

use super::findings::Finding;
use crate::audit::{Cause, Cure, Fingerprint, Seen, Source, View};
use crate::metrics::Verdict;
use crate::stats::Estimate;
use serde::Serialize;

/// Where the hemi-cubes stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// At the receivers: the full matrix.
    Receiver,
    /// At the shooters: progressive refinement.
    Shooter,
}

/// How wrong a solution is: reflected light against the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Wrong {
    /// Eq. 7 on reflected light; `None` where the scene is dark.
    pub rms: Option<Estimate>,
    /// The same of the 1 % of patches that receive most.
    pub top1: Option<Estimate>,
}

/// A source with all that was found about it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SourceAudit {
    /// Who, and how much by which cause.
    #[serde(flatten)]
    pub source: Source,
    /// By whom it is seen, and how.
    pub seen: Seen,
    /// The cause that matters most.
    pub main_cause: Cause,
    /// Resolution at which counting pixels would do everywhere, by the number of pixels it covers; `None` where it is
    /// not seen.
    pub resolution_by_pixels: Option<u32>,
    /// Cheapest cure that brings its error below the limit, by number in [`AuditRecord::cures`]; `None` where no cure
    /// that was run does, or no limit was given.
    pub mended_by: Option<usize>,
}

/// A cure that was run: the mended method's form factors, solved and judged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CureRun {
    /// What was done.
    pub cure: Cure,
    /// In words.
    pub words: String,
    /// How wrong what came of it is.
    #[serde(flatten)]
    pub wrong: Wrong,
    /// The verdict, where a limit was given.
    pub verdict: Option<Verdict>,
    /// Error that each listed source still brings at the first bounce, as [`Source::error`].
    pub by_source: Vec<f64>,
    /// Seconds for the form factors.
    pub seconds: f64,
    /// Hemi-cubes drawn.
    pub hemicubes: usize,
    /// Pixels drawn.
    pub pixels: u64,
    /// Points of exact visibility.
    pub points: usize,
    /// Both, in pixels: what cures are sorted by, since seconds differ from run to run.
    pub work: u64,
}

/// A hemi-cube at another setting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct At {
    /// Resolution, or degrees of rotation.
    pub x: f64,
    /// How wrong.
    #[serde(flatten)]
    pub wrong: Wrong,
    /// `sqrt(sum A_i^2 dF^2 / sum A_i^2 F^2)` of aliasing alone, over the matrix.
    pub aliasing: f64,
    /// Seconds for the form factors.
    pub seconds: f64,
}

/// A receiving patch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Receiver {
    /// Luminance error at the first bounce, by cause.
    pub first: [f64; 3],
    /// Standard errors of those.
    pub std_err: [f64; 3],
    /// Luminance error in the solution, by cause: carried through all bounces.
    pub carried: [f64; 3],
    /// Luminance reflected, by the reference.
    pub reflected: f64,
    /// Sum of its row of form factors.
    pub row_sum: f64,
}

/// Errors of the matrix: `sqrt(sum A_i^2 e^2 / sum A_i^2 F^2)` of the whole error and of each cause.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MatrixError {
    /// Of hemi-cube minus truth.
    pub total: f64,
    /// Of each cause, in the order of [`Cause::ALL`].
    pub by_cause: [f64; 3],
    /// Of the standard errors of the truth.
    pub noise: f64,
}

/// A finished audit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AuditRecord {
    /// Scene, as it was named.
    pub scene: String,
    /// Patches that take part.
    pub patches: usize,
    /// Settings of the hemi-cube; what was fingerprinted where the matrix is somebody else's.
    pub method: String,
    /// Name of the file with somebody else's form factors.
    pub theirs: Option<String>,
    /// Where the hemi-cubes stand.
    pub form: Form,
    /// Resolution of the hemi-cube that is audited.
    pub resolution: u32,
    /// How the truth was come by.
    pub truth: String,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// Limit on eq. 7 of reflected light.
    pub limit: Option<f64>,
    /// The verdict on the hemi-cube as it is.
    pub verdict: Option<Verdict>,
    /// How wrong the hemi-cube's solution is.
    pub wrong: Wrong,
    /// The same with each cause switched off in turn.
    pub without: [Wrong; 3],
    /// What each cause alone does to the solution, eq. 7 of the carried parts (they add up as vectors).
    pub alone: [f64; 3],
    /// At infinite resolution: the exact value at the centres.
    pub infinite: Wrong,
    /// Errors of the form factors themselves.
    pub matrix: MatrixError,
    /// Sources, the largest error first.
    pub sources: Vec<SourceAudit>,
    /// All surfaces by the error they bring, for the record.
    pub ranking: Vec<Source>,
    /// Receivers of the first source.
    pub views: Vec<View>,
    /// Error against resolution.
    pub resolutions: Vec<At>,
    /// Exponent of aliasing against resolution with its interval; `None` where points do not suffice.
    pub rate: Option<Estimate>,
    /// Error under rotation about the normal, degrees.
    pub rotations: Vec<At>,
    /// Cures that were run, in the order of their cost.
    pub cures: Vec<CureRun>,
    /// Every patch; zeros where it takes no part.
    pub receivers: Vec<Receiver>,
    /// What can be told of somebody else's matrix.
    pub fingerprint: Option<Fingerprint>,
    /// What the judge found about itself, where something failed.
    pub self_check_failures: Vec<String>,
    /// In words.
    pub findings: Vec<Finding>,
}
