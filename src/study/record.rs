//! The finished record of a comparison: all a report needs, nothing left to compute.

use super::{Cause, Contributions, Look};
use crate::metrics::{AsSeen, Breakdown, Comparison, Decision, Split};
use crate::scene::{Finding, Stage};
use crate::solution::Radiosity;
use serde::{Deserialize, Serialize};

/// A finished comparison or check. What is short comes first: so it is stored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// What the solution is called: a file name, or the method with its parameters.
    pub solution_name: String,
    /// Which truth: `patch-system`, `continuous`, or `solution` where another solution stands for it.
    pub truth: String,
    /// The verdict; `None` when no limit was given.
    pub decision: Option<Decision>,
    /// The metrics.
    pub comparison: Comparison,
    /// Where the error comes from; `None` where nothing tells its parts apart.
    #[serde(default)]
    pub split: Option<Split>,
    /// What can be seen of the error; `None` where nobody looks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub as_seen: Option<AsSeen>,
    /// How the error is spread; `None` where no report was asked for.
    pub breakdown: Option<Breakdown>,
    /// What lights the worst patches; empty where no rays can be cast: against another solution, without a scene.
    pub contributions: Vec<Contributions>,
    /// What the scene doctor found.
    #[serde(default)]
    pub findings: Vec<Finding>,
    /// Known mistakes that explain most of the error, the best first; empty where none does, or none was looked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub causes: Vec<Cause>,
    /// Looks by better and better references, where it took more than the stored one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub looks: Vec<Look>,
    /// Things the reader has to know: self-check findings, notices of the scene.
    pub notices: Vec<String>,
    /// Effective settings.
    pub settings: Vec<Setting>,
    /// Where everything comes from: (what, value), in order of display.
    pub provenance: Vec<(String, String)>,
    /// The command that repeats this run.
    pub replay: String,
    /// Mean of the reference with its standard errors, per patch.
    pub reference: Radiosity,
    /// The solution that was judged, per patch.
    pub solution: Radiosity,
    /// Scene at the judged state.
    pub stage: Stage,
    /// The scene before an edit, where that was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before: Option<Before>,
}

/// What stood there before an edit, and its light.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Before {
    /// Where it comes from: a reference by its path.
    pub name: String,
    /// Mean of its reference, per patch.
    pub reference: Radiosity,
    /// Scene at that state.
    pub stage: Stage,
}

/// Whose setting it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// Of the judgement.
    Judgement,
    /// Of the reference.
    Reference,
    /// Of the solution.
    Solution,
}

/// One effective setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// Whose.
    pub of: Part,
    /// Name as on the command line.
    pub name: String,
    /// Value in force.
    pub value: String,
    /// Value without being asked for; `None` for what has none and must be given.
    pub default: Option<String>,
}

impl Setting {
    /// A setting that has a default.
    pub fn new(of: Part, name: &str, value: impl ToString, default: impl ToString) -> Self {
        Self { of, name: name.into(), value: value.to_string(), default: Some(default.to_string()) }
    }

    /// A setting that has none.
    pub fn given(of: Part, name: &str, value: impl ToString) -> Self {
        Self { of, name: name.into(), value: value.to_string(), default: None }
    }

    /// True if it has a default and another value.
    pub fn differs(&self) -> bool {
        self.default.as_ref().is_some_and(|d| *d != self.value)
    }
}
