//! The command line as typed. Plans are made of it in `commands`; nothing here does any work.

mod audit;
mod baseline;
mod brought;
mod compositing;
mod converge;
mod convert;
mod form_factors;
mod judge;
mod manual;
mod project;
mod rays;
mod reference;
mod render;
mod scene;
mod setup;
mod solve;
mod suites;
mod viewing;

pub use audit::{AuditArgs, AuditCommand, AuditForm};
pub use baseline::{BaselineChangeArgs, BaselineCommand, BaselineSaveArgs, BisectArgs};
pub use brought::{BroughtArgs, Up};
pub use compositing::{CompositeArgs, CompositingArgs, ScanArgs, ShadeArgs};
pub use converge::{ConvergeArgs, ConvergeCommand, ConvergeDiffArgs, ConvergeOther};
pub use convert::ConvertArgs;
pub use form_factors::{
    FormFactorsArgs, FormFactorsCheckArgs, FormFactorsCommand, FormFactorsCompareArgs, FormFactorsRepairArgs,
    MatrixArgs, MatrixCommand,
};
pub use judge::{Causes, CheckArgs, CompareArgs, OnInconclusive};
pub use manual::{CompletionsArgs, ManArgs};
pub use project::{EnvmapArgs, GivenLayout, LayoutChoice, ProjectArgs};
pub use rays::{Estimator, RayArgs, SuiteArgs};
pub use reference::{ReferenceArgs, Truth};
pub use render::{OnOff, RenderArgs, RenderStyle};
pub use scene::{SceneArgs, SceneCommand};
pub use setup::SetupCommand;
pub use solve::SolveArgs;
pub use suites::{DisplaySuiteArgs, ReceiversArgs, ValidateCommand};
pub use viewing::{LookingArgs, ToneChoice, ViewingArgs};

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Ray-traced reference validator and error metrics for radiosity and view factors.
///
/// Exit codes: 0 done, every limit met; 1 a limit is exceeded; 2 bad usage or input; 3 inconclusive;
/// 4 the reference failed its own self-check; 70 a bug; 130 interrupted (143 by SIGTERM).
#[derive(Debug, Parser)]
#[command(name = "etalon", version, propagate_version = true, arg_required_else_help = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Options that every command takes.
    #[command(flatten)]
    pub global: Global,
}

/// Options that every command takes.
#[derive(Debug, Clone, Args)]
pub struct Global {
    /// Print one JSON object on stdout and nothing else.
    #[arg(long, global = true)]
    pub json: bool,
    /// Say only what was asked for.
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Say more (settings in force, kernels, row sums).
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Threads; default: all.
    #[arg(long, global = true, value_name = "T", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Ray kernel.
    #[arg(long, global = true, value_enum, default_value_t = Kernel::Auto)]
    pub kernel: Kernel,
}

/// Ray kernels by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kernel {
    /// Embree 4 where there is one, else the built-in.
    Auto,
    /// Embree 4.
    Embree,
    /// Pure Rust, double precision.
    Builtin,
    /// Embree 4 through the published wrapper (cargo feature `embree4-rs`).
    #[value(name = "embree4-rs")]
    Embree4Rs,
}

/// Commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Look at a scene.
    #[command(subcommand)]
    Scene(SceneCommand),
    /// Form-factor matrix by ray casting, with standard errors; check or repair a matrix of any tool.
    FormFactors(FormFactorsCommand),
    /// Reference radiosity, stored for re-use.
    Reference(ReferenceArgs),
    /// Run a candidate method.
    Solve(SolveArgs),
    /// Metrics of a solution against a reference (or another solution).
    Compare(CompareArgs),
    /// The same with limits and a verdict.
    Check(CheckArgs),
    /// A stored solution that later ones are held against: saved, compared, replaced.
    #[command(subcommand)]
    Baseline(BaselineCommand),
    /// A check for `git bisect run`: exit 0 good, 1 bad, 125 skip (no verdict, or no solution to read); 128 ends the
    /// bisection. Takes what check takes; better references are computed while it is open (--max-time).
    Bisect(BisectArgs),
    /// A solution on a mesh of its own, or in other units, as radiosities of the patches of a scene.
    Convert(ConvertArgs),
    /// Convergence curves: error against shots, rays and seconds, of any methods and of series of snapshots.
    Converge(ConvergeCommand),
    /// What a method is wrong about, why, and what would mend it.
    #[command(subcommand)]
    Audit(AuditCommand),
    /// Pictures of a solution or a reference, or of the patches alone.
    Render(RenderArgs),
    /// The whole world as it is seen from one point: cube, latitude-longitude, fish-eye, perspective; one layout from
    /// another.
    Project(Box<ProjectArgs>),
    /// What a camera sees, by visible segments with depth on sub-scanlines, in a file: pictures of any scale and light are
    /// made of it without asking again what is visible.
    Scan(Box<ScanArgs>),
    /// Span files of one view in one: depth decides, faces may go through each other.
    Composite(Box<CompositeArgs>),
    /// A picture from a span file, at any scale, under any lights: shadows, fog, textures, mirrors.
    Shade(Box<ShadeArgs>),
    /// Write the HTML report of a finished run again.
    Report {
        /// Directory that `check --report`, `compare --report` or `demo` wrote.
        directory: PathBuf,
    },
    /// The whole chain on the Cornell box.
    Demo {
        /// Where the report goes.
        #[arg(short, long, value_name = "DIR", default_value = "reports/demo")]
        output: PathBuf,
    },
    /// Irradiance at the receivers of a scene, with standard errors.
    Receivers(ReceiversArgs),
    /// Published test suites: what this program is validated against.
    #[command(subcommand)]
    Validate(ValidateCommand),
    /// Get what is missing on this machine.
    #[command(subcommand)]
    Setup(SetupCommand),
    /// Ray kernels found, threads, self-test.
    Doctor,
    /// The script that completes commands and options in a shell.
    Completions(CompletionsArgs),
    /// Manual pages, one per command.
    Man(ManArgs),
    /// The JSON Schema of what `check --json` and `compare --json` print.
    Schema,
}
