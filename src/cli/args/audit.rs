//! `etalon audit`.

use super::compositing::CompositingArgs;
use super::judge::OnInconclusive;
use super::project::EnvmapArgs;
use super::rays::RayArgs;
use super::scene::SceneArgs;
use crate::cli::values::Fraction;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// `etalon audit ...`
#[derive(Debug, Subcommand)]
pub enum AuditCommand {
    /// Where, why and by how much a hemi-cube is wrong, and what would mend it.
    Hemicube(Box<AuditArgs>),
    /// How wrong the light of an environment map is on an object, where, why, and how far from its centre it can be used.
    Envmap(Box<EnvmapArgs>),
    /// How far pictures made from sub-scanlines are from pictures by rays: edges, every light and its shadows, clusters
    /// against the whole.
    Compositing(Box<CompositingArgs>),
}

/// Where hemi-cubes stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum AuditForm {
    /// At every receiver: the full matrix.
    Matrix,
    /// At the shooter: progressive refinement.
    Progressive,
}

/// `etalon audit hemicube`
#[derive(Debug, Args)]
pub struct AuditArgs {
    /// Scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Where the page, the tables and the pictures go.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Pixels along the top's edge: the first is audited, all make the curve of error against resolution.
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_values_t = [100, 50, 200],
          value_parser = clap::value_parser!(u32))]
    pub resolution: Vec<u32>,
    /// Settings of the hemi-cube besides: delta=midpoint|exact, rotation=DEGREES, turn=SEED, jitter=SEED.
    #[arg(long, value_name = "KEY=VALUE,...", default_value = "")]
    pub settings: String,
    /// Angles about the normal, evenly over a quarter turn, for the curve of error under rotation; 0: none.
    #[arg(long, value_name = "K", default_value_t = 8, value_parser = clap::value_parser!(u32).range(0..=90))]
    pub rotations: u32,
    /// Surface or object to look at as a source; may be given again. Default: those that bring the largest errors.
    #[arg(long, value_name = "NAME")]
    pub source: Vec<String>,
    /// Limit on the error of the reflected light (eq. 7): 0.05 or 5%.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub max_error: Option<Fraction>,
    /// Exit code instead of 3 when inconclusive.
    #[arg(long, value_enum, value_name = "pass|fail")]
    pub on_inconclusive: Option<OnInconclusive>,
    /// The method whose hemi-cubes are audited.
    #[arg(long, value_enum, default_value_t = AuditForm::Matrix)]
    pub method: AuditForm,
    /// Somebody else's form factors (.npz, .csv, .mtx): audit these, and tell what made them.
    #[arg(long, value_name = "FILE", conflicts_with = "method")]
    pub form_factors: Option<PathBuf>,
    /// Run no cures: only find the errors.
    #[arg(long)]
    pub no_cures: bool,
    /// Patch whose item buffer is drawn; may be given again. Default: the worst receivers of the sources.
    #[arg(long, value_name = "I")]
    pub patch: Vec<usize>,
    /// Pairs in pairs.csv at most, those that bring the largest errors.
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    pub pairs: usize,
    /// Confidence of the intervals, two-sided.
    #[arg(long, default_value = "0.95", value_name = "C", allow_hyphen_values = true)]
    pub confidence: Fraction,
    /// Rays of the truth.
    #[command(flatten)]
    pub rays: RayArgs,
}
