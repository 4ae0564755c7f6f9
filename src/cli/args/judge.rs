//! `etalon compare` and `etalon check`.

use super::brought::BroughtArgs;
use super::reference::Truth;
use super::viewing::LookingArgs;
use crate::cli::values::{Fraction, PerLevel, Span, StateChoice};
use crate::metrics::Limit;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// What is compared with what.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// Solution file or reference directory.
    pub solution: PathBuf,
    /// Reference directory, one that comes with the program (builtin:NAME), or another solution (then no rays: old
    /// against new).
    // With --residual there is none, and nobody looks at this value.
    #[arg(
        long,
        value_name = "DIR|SOLUTION",
        required = false,
        required_unless_present = "residual",
        default_value_if("residual", "true", "none")
    )]
    pub reference: PathBuf,
    /// The state before the change, for the top-1 % metric.
    #[arg(long, value_name = "DIR|SOLUTION")]
    pub before: Option<PathBuf>,
    /// Verify that the reference belongs to this scene; gives areas when comparing two solutions.
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<String>,
    /// State of that scene: initial, the number of edits applied, or final.
    #[arg(long, default_value = "final", value_name = "initial|K|final")]
    pub state: StateChoice,
    /// Longest patch edge of that scene, metres.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// Confidence of the intervals: two-sided, simultaneous over the limits given.
    #[arg(long, default_value = "0.95", value_name = "C", allow_hyphen_values = true)]
    pub confidence: Fraction,
    /// Level of the values.
    #[arg(long, value_enum, default_value_t = PerLevel::Patch)]
    pub per: PerLevel,
    /// Metrics on B - E instead of B.
    #[arg(long)]
    pub reflected: bool,
    /// The truth asked for: has to be the one the reference holds.
    #[arg(long, value_enum)]
    pub truth: Option<Truth>,
    /// The form factors the solution was computed with (.npz, .csv, .mtx): tells errors of the solver from errors of
    /// the form factors.
    #[arg(long, value_name = "FILE")]
    pub form_factors: Option<PathBuf>,
    /// A patch-system reference beside a continuous one: tells apart what the division into patches costs.
    #[arg(long, value_name = "DIR")]
    pub patch_system: Option<PathBuf>,
    /// Write the HTML report here.
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Write GitHub-flavoured Markdown here.
    #[arg(long, value_name = "FILE")]
    pub markdown: Option<PathBuf>,
    /// Look for the mistake that explains the error (radiance for radiosity, sRGB, swapped materials, a missing object or
    /// bounce...): auto, where a check fails.
    #[arg(long, value_enum, value_name = "WHEN", default_value_t = Causes::Auto)]
    pub causes: Causes,
    /// Who looks: for --max-visible and the pictures of the report.
    #[command(flatten)]
    pub looking: LookingArgs,
    /// A solution as another program wrote it.
    #[command(flatten)]
    pub brought: BroughtArgs,
    /// Without a reference.
    #[command(flatten)]
    pub residual: ResidualArgs,
}

/// Judging a solution by its own residual, without a reference.
#[derive(Debug, Args)]
#[command(next_help_heading = "Without a reference")]
pub struct ResidualArgs {
    /// Judge the solution by its own residual E + rho F B - B, cast by rays: two-sided bounds on its error.
    #[arg(long, requires = "scene", conflicts_with_all = ["reference", "before", "truth", "report", "markdown"])]
    pub residual: bool,
    /// Bounces of the residual: more bring the bounds together; default: until a tenth of any error is left, at
    /// most 16.
    #[arg(long, value_name = "N", requires = "residual", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub bounces: Option<u32>,
    /// Rays per patch of the first bounce, rounded up to R 2^m; a quarter for each further one. Default: some four
    /// million in all.
    #[arg(long, value_name = "N", requires = "residual", allow_hyphen_values = true,
          value_parser = clap::value_parser!(u64).range(1..))]
    pub rays: Option<u64>,
    /// Independent randomisations of the whole scene.
    #[arg(long, value_name = "R", requires = "residual", default_value_t = 16,
          value_parser = clap::value_parser!(u16).range(8..=4095))]
    pub randomisations: u16,
    /// Seed of the random streams.
    #[arg(long, requires = "residual", default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
    /// Write the residual of every patch here, W/m^2 per band with its standard error: .csv, .json, .npy or .npz.
    #[arg(long, value_name = "FILE", requires = "residual")]
    pub save_residual: Option<PathBuf>,
}

/// `etalon check`
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// What is compared with what.
    #[command(flatten)]
    pub compare: CompareArgs,
    /// Limit on the area-weighted luminance RMS (eq. 7): 0.05 or 5%.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub max_rms: Option<Fraction>,
    /// Limit on the top-1 % metric; needs --before.
    #[arg(long, value_name = "Y", allow_hyphen_values = true)]
    pub max_top1: Option<Fraction>,
    /// More limits.
    #[command(flatten)]
    pub limits: LimitArgs,
    /// Write JUnit XML here.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Exit code instead of 3 when inconclusive.
    #[arg(long, value_enum, value_name = "pass|fail")]
    pub on_inconclusive: Option<OnInconclusive>,
    /// While inconclusive: compute a better reference of the same scene and look again, with intervals that hold
    /// although the check stops as soon as it knows.
    #[arg(long, conflicts_with = "residual")]
    pub until_decided: bool,
    /// With --until-decided: stop when no better reference would fit into this time (default 10m). With --residual: cast
    /// fewer rays where all would not fit. Else a check casts none.
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub max_time: Option<Span>,
    /// With --until-decided: keep the last reference computed here, for the next check to begin with.
    #[arg(long, value_name = "DIR", requires = "until_decided")]
    pub save_reference: Option<PathBuf>,
}

/// Limits beside those on eq. 7 and the top 1 %.
#[derive(Debug, Args)]
#[command(next_help_heading = "More limits")]
pub struct LimitArgs {
    /// Limit on the worst patch: |difference| relative to the reference there.
    #[arg(long, value_name = "X", conflicts_with = "residual", allow_hyphen_values = true)]
    pub max_worst: Option<Fraction>,
    /// Limit on the light in excess or missing over the whole scene.
    #[arg(long, value_name = "X", conflicts_with = "residual", allow_hyphen_values = true)]
    pub max_energy: Option<Fraction>,
    /// Limit on what is seen of the error: the share of the picture that is off by more than one step (of 255) of the
    /// display, for an eye adapted to the picture. The picture is that of the scene's cameras; see --tone.
    #[arg(long, value_name = "X", conflicts_with = "residual", allow_hyphen_values = true)]
    pub max_visible: Option<Fraction>,
    /// A limit by name, as often as you like: METRIC=X or METRIC@WHERE=X; METRIC is rms, worst or energy, WHERE is
    /// surface:NAME, object:NAME or band:NAME. For example rms@surface:floor=3%.
    #[arg(long = "limit", value_name = "LIMIT", conflicts_with = "residual", allow_hyphen_values = true)]
    pub named: Vec<Limit>,
    /// A baseline (`etalon baseline save`): eq. 7 must not be surely larger than that of the solution stored there.
    #[arg(long, value_name = "FILE", conflicts_with = "residual")]
    pub baseline: Option<PathBuf>,
    /// With --baseline: eq. 7 may be larger by this much, and has to be surely so: then a close call is inconclusive.
    #[arg(long, value_name = "X", requires = "baseline", allow_hyphen_values = true)]
    pub max_worse: Option<Fraction>,
}

/// When causes are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Causes {
    /// Where a check fails.
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

/// What exit 3 becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OnInconclusive {
    /// Exit 0.
    Pass,
    /// Exit 1.
    Fail,
}
