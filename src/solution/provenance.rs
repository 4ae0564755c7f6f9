//! Where a reference comes from and what its self-check found: data only.

use serde::{Deserialize, Serialize};

/// Which truth a reference holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TruthLevel {
    /// The exact solution of the patch-constant system.
    #[default]
    PatchSystem,
    /// The true mean radiosity of each patch.
    Continuous,
}

impl TruthLevel {
    /// Name as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::PatchSystem => "patch-system",
            Self::Continuous => "continuous",
        }
    }
}

/// How a reference was computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of this program.
    pub version: String,
    /// Which truth.
    pub truth: TruthLevel,
    /// Seed.
    pub seed: u64,
    /// Rays per patch over all randomisations, as cast.
    pub rays_per_patch: u64,
    /// Number of randomisations R.
    pub randomisations: u16,
    /// Rays cast in all.
    pub rays: u64,
    /// Rays that met nothing.
    pub escapes: u64,
    /// Rays that met a black back.
    pub back_hits: u64,
    /// Ray kernel.
    pub kernel: String,
    /// Its version.
    pub kernel_version: String,
    /// Instruction set it ran on, where it tells.
    pub instruction_set: Option<String>,
    /// True if the scene is closed, by its author's word or by its geometry.
    pub enclosure: bool,
    /// One-sigma relative error of the radiosity in the norm of eq. 7.
    pub relative_error: f64,
    /// Estimator: `auto` or `rays`, as on the command line.
    #[serde(default = "rays")]
    pub estimator: String,
}

/// What references say that were stored before there was a choice.
fn rays() -> String {
    "rays".into()
}

/// What the judge found about itself.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SelfCheck {
    /// One by one.
    pub checks: Vec<Check>,
}

impl SelfCheck {
    /// True if no check failed.
    pub fn passed(&self) -> bool {
        self.failures().next().is_none()
    }

    /// The checks that failed.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|c| !c.passed)
    }
}

/// One check.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// What was checked, in a word or two.
    pub name: String,
    /// False if a reference with this finding must not judge.
    pub passed: bool,
    /// The finding with its numbers, one sentence.
    pub finding: String,
}
