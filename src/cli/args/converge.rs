//! `etalon converge`.

use super::rays::RayArgs;
use super::reference::Truth;
use crate::cli::values::{Fraction, NamedFolder, StateChoice};
use clap::{ArgMatches, Args, FromArgMatches, Subcommand};
use std::path::PathBuf;

/// `etalon converge SCENE`
#[derive(Debug, Args)]
pub struct ConvergeArgs {
    /// Scene file, mesh (.obj, .ply, .gltf, .glb), View3D input (.vs3), or builtin:NAME.
    pub scene: String,
    /// Methods with parameters, commas between; a|b makes one curve of several runs: gather:rays=1024|4096,hemicube.
    #[arg(long, value_name = "M1,M2")]
    pub methods: Option<String>,
    /// Snapshots of any solver: a folder with index.csv (file,seconds,shots,rays,edit). May be given again.
    #[arg(long, value_name = "NAME=DIR")]
    pub series: Vec<NamedFolder>,
    /// Where tables, drawings, page and references go.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Error against mesh size instead: every grid of the scene finer by these factors; judged by the continuous truth.
    #[arg(long, value_name = "1,2,4", value_delimiter = ',', conflicts_with = "series", requires = "methods")]
    pub refine: Vec<u32>,
    /// With --refine: state of a scene with edits; curves are made of all states.
    #[arg(long, value_name = "initial|K|final", requires = "refine")]
    pub state: Option<StateChoice>,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// Rays of the references.
    #[command(flatten)]
    pub rays: RayArgs,
    /// Which truth; default: patch-system, and continuous with --refine. For continuous, --rays counts paths.
    #[arg(long, value_enum)]
    pub truth: Option<Truth>,
    /// Confidence of the intervals, two-sided.
    #[arg(long, default_value = "0.95", value_name = "C", allow_hyphen_values = true)]
    pub confidence: Fraction,
    /// Pictures of every method after these numbers of shots since the edit, beside the references.
    #[arg(long, value_name = "N,N", value_delimiter = ',', conflicts_with = "refine")]
    pub pictures: Vec<u64>,
    /// Metrics on B - E instead of B.
    #[arg(long)]
    pub reflected: bool,
}

/// `etalon converge diff`
#[derive(Debug, Args)]
pub struct ConvergeDiffArgs {
    /// Folder of the first run.
    #[arg(value_name = "DIR1")]
    pub first: PathBuf,
    /// Folder of the second run.
    #[arg(value_name = "DIR2")]
    pub second: PathBuf,
    /// Where tables, drawings and page go.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Confidence of the fitted rates, two-sided.
    #[arg(long, default_value = "0.95", value_name = "C", allow_hyphen_values = true)]
    pub confidence: Fraction,
}

/// `etalon converge ...`: make curves, or look at those that are there.
#[derive(Debug)]
pub enum ConvergeCommand {
    /// Make them.
    Run(Box<ConvergeArgs>),
    /// Those that are there.
    Other(ConvergeOther),
}

/// What is done with curves that are there.
#[derive(Debug, Subcommand)]
pub enum ConvergeOther {
    /// Two runs overlaid: cost at equal error, error at equal cost.
    Diff(ConvergeDiffArgs),
}

// By hand, as for `FormFactorsCommand`.
impl Args for ConvergeCommand {
    fn augment_args(command: clap::Command) -> clap::Command {
        ConvergeOther::augment_subcommands(ConvergeArgs::augment_args(command))
            .subcommand_required(false)
            .arg_required_else_help(false)
            .args_conflicts_with_subcommands(true)
            .subcommand_negates_reqs(true)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for ConvergeCommand {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        match matches.subcommand_name() {
            Some(_) => ConvergeOther::from_arg_matches(matches).map(Self::Other),
            None => ConvergeArgs::from_arg_matches(matches).map(|a| Self::Run(Box::new(a))),
        }
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
