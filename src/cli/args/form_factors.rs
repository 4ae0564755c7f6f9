//! `etalon form-factors`.

use super::rays::RayArgs;
use super::scene::SceneArgs;
use crate::cli::values::{Fraction, StateChoice};
use crate::io::MatrixLayout;
use clap::{ArgMatches, Args, FromArgMatches, Subcommand};
use std::path::PathBuf;

/// `etalon form-factors`
#[derive(Debug, Args)]
pub struct FormFactorsArgs {
    /// Scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Rays.
    #[command(flatten)]
    pub rays: RayArgs,
    /// .npz (SciPy CSR), .csv, .mtx, .vf (View3D) or .idf (EnergyPlus).
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Format whatever the ending: npz, csv, mtx, view3d, energyplus; with details as csv:by=surface, csv:names,
    /// view3d:by=patch, energyplus:zone=NAME.
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<MatrixLayout>,
    /// Standard errors likewise.
    #[arg(long, value_name = "FILE")]
    pub std_err: Option<PathBuf>,
    /// Make the matrix reciprocal, its rows closed and nowhere negative, by weighted least squares.
    #[arg(long)]
    pub enforce: bool,
}

/// `etalon form-factors ...`: cast a matrix, or look at one that is there.
#[derive(Debug)]
pub enum FormFactorsCommand {
    /// Cast one.
    Cast(FormFactorsArgs),
    /// One that is there.
    Matrix(MatrixCommand),
}

// By hand: the derived version of "arguments of its own or a subcommand" drops the arguments.
impl Args for FormFactorsCommand {
    fn augment_args(command: clap::Command) -> clap::Command {
        MatrixCommand::augment_subcommands(FormFactorsArgs::augment_args(command))
            .subcommand_required(false)
            .arg_required_else_help(false)
            .args_conflicts_with_subcommands(true)
            .subcommand_negates_reqs(true)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FormFactorsCommand {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        match matches.subcommand_name() {
            Some(_) => MatrixCommand::from_arg_matches(matches).map(Self::Matrix),
            None => FormFactorsArgs::from_arg_matches(matches).map(Self::Cast),
        }
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// What is done with a form-factor matrix of any tool.
#[derive(Debug, Subcommand)]
pub enum MatrixCommand {
    /// Row sums, reciprocity, impossible entries, classic mistakes. Exit 1 if the matrix breaks physics for sure.
    Check(FormFactorsCheckArgs),
    /// Entry by entry against the judge's: how far off, beyond which errors, and who breaks physics there.
    Compare(FormFactorsCompareArgs),
    /// The most likely matrix that is closed, reciprocal and nowhere negative. Exit 1 if a row could not be closed.
    Repair(FormFactorsRepairArgs),
}

/// A matrix and the scene it belongs to.
#[derive(Debug, Args)]
pub struct MatrixArgs {
    /// Form-factor matrix: .npz, .csv or .mtx.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Scene file, mesh, or builtin:NAME: its patches number the rows.
    #[arg(long)]
    pub scene: String,
    /// State of a scene with edits: initial, the number of edits applied, or final.
    #[arg(long, default_value = "final", value_name = "initial|K|final")]
    pub state: StateChoice,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// Standard errors of the matrix, .npz or .mtx; a .csv matrix may hold its own.
    #[arg(long, value_name = "FILE")]
    pub std_err: Option<PathBuf>,
}

/// `etalon form-factors check`
#[derive(Debug, Args)]
pub struct FormFactorsCheckArgs {
    /// The matrix.
    #[command(flatten)]
    pub matrix: MatrixArgs,
    /// Defects of a factor or row sum never held against the matrix; default: 1e-9 with standard errors, else 1e-3.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub tolerance: Option<Fraction>,
    /// Randomisations behind the standard errors: few make them uncertain themselves.
    #[arg(long, value_name = "R", default_value_t = 16, value_parser = clap::value_parser!(u16).range(2..))]
    pub randomisations: u16,
}

/// `etalon form-factors compare`
#[derive(Debug, Args)]
pub struct FormFactorsCompareArgs {
    /// Their matrix.
    #[command(flatten)]
    pub matrix: MatrixArgs,
    /// How the judge computes.
    #[command(flatten)]
    pub rays: RayArgs,
    /// The judge's form factors as stored, instead of computing them: .npz, .csv, .mtx or .vf, a row per patch.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["rays", "target_error", "max_time", "seed", "estimator"])]
    pub reference: Option<PathBuf>,
    /// Standard errors of that file, .npz or .mtx; without them it counts as exact.
    #[arg(long, value_name = "FILE", requires = "reference")]
    pub reference_std_err: Option<PathBuf>,
    /// Limit on the relative norm of the difference, sqrt(sum d^2) / sqrt(sum F^2): 0.01 or 1%.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub max_rms: Option<Fraction>,
    /// Limit on the difference of every form factor.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub max_entry: Option<Fraction>,
    /// Confidence of the intervals: two-sided, simultaneous over the limits given.
    #[arg(long, default_value = "0.95", value_name = "C", allow_hyphen_values = true)]
    pub confidence: Fraction,
    /// Randomisations or batches behind the standard errors that they state.
    #[arg(long, value_name = "R", default_value_t = 16, value_parser = clap::value_parser!(u32).range(2..))]
    pub their_randomisations: u32,
}

/// `etalon form-factors repair`
#[derive(Debug, Args)]
pub struct FormFactorsRepairArgs {
    /// The matrix.
    #[command(flatten)]
    pub matrix: MatrixArgs,
    /// .npz (SciPy CSR), .csv or .mtx.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Standard errors of the repaired matrix likewise.
    #[arg(long, value_name = "FILE")]
    pub save_std_err: Option<PathBuf>,
}
