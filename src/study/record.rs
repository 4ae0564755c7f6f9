//! The finished record of a comparison: all a report needs, nothing left to compute.

use crate::metrics::{Comparison, Decision};
use crate::scene::{Finding, Stage};
use crate::solution::Radiosity;
use serde::{Deserialize, Serialize};

/// A finished comparison or check.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// Scene at the judged state.
    pub stage: Stage,
    /// Mean of the reference with its standard errors, per patch.
    pub reference: Radiosity,
    /// The solution that was judged, per patch.
    pub solution: Radiosity,
    /// What the solution is called: a file name, or the method with its parameters.
    pub solution_name: String,
    /// The metrics.
    pub comparison: Comparison,
    /// The verdict; `None` when no limit was given.
    pub decision: Option<Decision>,
    /// Which truth: `patch-system` or `continuous`.
    pub truth: String,
    /// Effective settings.
    pub settings: Vec<Setting>,
    /// Where everything comes from: (what, value), in order of display.
    pub provenance: Vec<(String, String)>,
    /// Things the reader has to know: self-check findings, notices of the scene.
    pub notices: Vec<String>,
    /// What the scene doctor found.
    #[serde(default)]
    pub findings: Vec<Finding>,
    /// The command that repeats this run.
    pub replay: String,
}

/// One effective setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// Name as on the command line.
    pub name: String,
    /// Value in force.
    pub value: String,
    /// True if it is the default.
    pub is_default: bool,
}
