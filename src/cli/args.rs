//! The command line as typed. Plans are made of it in `commands`; nothing here does any work.

use super::values::{Fraction, PerLevel, Pixels, Quantity, Span, StateChoice};
use crate::io::MatrixLayout;
use clap::{ArgMatches, Args, FromArgMatches, Parser, Subcommand, ValueEnum};
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
    /// Pictures of a solution or a reference, or of the patches alone.
    Render(RenderArgs),
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
}

/// `etalon scene ...`
#[derive(Debug, Subcommand)]
pub enum SceneCommand {
    /// Validate a scene.
    Check {
        /// Scene.
        #[command(flatten)]
        scene: SceneArgs,
        /// Make findings an error (exit 1).
        #[arg(long)]
        strict: bool,
    },
    /// List the patches: what a solver needs to write a solution.
    Patches {
        /// Scene.
        #[command(flatten)]
        scene: SceneArgs,
        /// .csv, .obj or .ply.
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
    },
}

/// `etalon setup ...`
#[derive(Debug, Subcommand)]
pub enum SetupCommand {
    /// Find an Embree 4, or fetch the pinned one into the user data folder.
    Embree,
}

/// Which scene, in which state.
#[derive(Debug, Clone, Args)]
pub struct SceneArgs {
    /// Scene file, mesh (.obj, .ply, .gltf, .glb), View3D input (.vs3), or builtin:NAME.
    pub scene: String,
    /// State of a scene with edits: initial, the number of edits applied, or final.
    #[arg(long, default_value = "final", value_name = "initial|K|final")]
    pub state: StateChoice,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
}

/// How many rays.
#[derive(Debug, Clone, Args)]
pub struct RayArgs {
    /// Rays per patch over all randomisations, rounded up to R 2^m.
    #[arg(long, default_value_t = 16_384, allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(1..))]
    pub rays: u64,
    /// Go on until this one-sigma relative error is reached, instead of --rays.
    #[arg(long, value_name = "E", conflicts_with = "rays", allow_hyphen_values = true)]
    pub target_error: Option<Fraction>,
    /// Independent randomisations of the whole scene.
    #[arg(long, value_name = "R", default_value_t = 16, value_parser = clap::value_parser!(u16).range(8..=4095))]
    pub randomisations: u16,
    /// Stop when more would not fit into this time: 90s, 5m, 1h.
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub max_time: Option<Span>,
    /// Seed of the random streams.
    #[arg(long, default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
    /// auto: whatever is most accurate (closed forms and exact shadows, rays for the rest); rays: hemisphere rays only.
    #[arg(long, value_enum, default_value_t = Estimator::Auto)]
    pub estimator: Estimator,
}

/// Estimators by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Estimator {
    /// Whatever is most accurate.
    Auto,
    /// Hemisphere rays only.
    Rays,
}

/// Which truth, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Truth {
    /// The exact solution of the patch-constant system.
    PatchSystem,
    /// The true mean radiosity of each patch.
    Continuous,
}

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

/// `etalon reference`
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    /// Scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Rays.
    #[command(flatten)]
    pub rays: RayArgs,
    /// Directory of the reference. While it is computed, DIR.part stands beside it: after an interruption the
    /// same command goes on from there.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Also write bounds on the radiosity of every patch, at 95 % for all together (patch, then low and high of each
    /// band): .csv.
    #[arg(long, value_name = "FILE")]
    pub bounds: Option<PathBuf>,
    /// Compute it even if DIR already holds a reference that would do.
    #[arg(long)]
    pub force: bool,
    /// Which truth. For continuous, --rays counts paths, and an interrupted run begins again.
    #[arg(long, value_enum, default_value_t = Truth::PatchSystem)]
    pub truth: Truth,
}

/// `etalon solve`
#[derive(Debug, Args)]
pub struct SolveArgs {
    /// Scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// gather or hemicube, with parameters as hemicube:resolution=200,delta=exact.
    #[arg(long, value_name = "M")]
    pub method: String,
    /// .csv, .json, .npy or .npz.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Re-use stored form factors: ours or anybody's.
    #[arg(long, value_name = "FILE")]
    pub form_factors: Option<PathBuf>,
    /// Store the form factors that were computed.
    #[arg(long, value_name = "FILE", conflicts_with = "form_factors")]
    pub save_form_factors: Option<PathBuf>,
    /// Rays per patch of ray-cast methods; parameters of --method win.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    pub rays: Option<u64>,
    /// Seed of ray-cast methods.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Estimator of ray-cast methods: auto settles what it can without rays.
    #[arg(long, value_enum, default_value_t = Estimator::Auto)]
    pub estimator: Estimator,
    /// Level of the values.
    #[arg(long, value_enum, default_value_t = PerLevel::Patch)]
    pub per: PerLevel,
}

/// `etalon receivers`
#[derive(Debug, Args)]
pub struct ReceiversArgs {
    /// Scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Rays of each receiver, and of each patch where surfaces reflect.
    #[command(flatten)]
    pub suite: SuiteArgs,
    /// .csv: name, position, normal, irradiance and standard error per band.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

/// `etalon validate ...`
#[derive(Debug, Subcommand)]
pub enum ValidateCommand {
    /// CIE 171:2006, cases 5.2, 5.3, 5.4, 5.6, 5.7 and 5.8, as built-in scenes.
    Cie171(SuiteArgs),
    /// 114 exact form factors: polygons, disks, spheres, obstructed pairs.
    ClosedForms(SuiteArgs),
}

/// How much a suite may cast.
#[derive(Debug, Clone, Args)]
pub struct SuiteArgs {
    /// Rays of each value that takes rays, over all randomisations; rounded up to R 2^m.
    #[arg(long, default_value_t = 262_144, allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(1..=1 << 32))]
    pub rays: u64,
    /// Independent randomisations.
    #[arg(long, value_name = "R", default_value_t = 16, value_parser = clap::value_parser!(u16).range(8..=4095))]
    pub randomisations: u16,
    /// Seed of the random streams.
    #[arg(long, default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
}

/// What is compared with what.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// Solution file or reference directory.
    pub solution: PathBuf,
    /// Reference directory, or another solution (then no rays: old against new).
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
    /// Write JUnit XML here.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Exit code instead of 3 when inconclusive.
    #[arg(long, value_enum, value_name = "pass|fail")]
    pub on_inconclusive: Option<OnInconclusive>,
    /// With --residual: cast fewer rays where all would not fit into this time. Without, a check casts none.
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub max_time: Option<Span>,
}

/// What exit 3 becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OnInconclusive {
    /// Exit 0.
    Pass,
    /// Exit 1.
    Fail,
}

/// `etalon render`
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Scene file, builtin:NAME, or a reference directory (it holds its scene).
    pub scene: String,
    /// What to show: a solution file or a reference directory; default: the reference named first.
    #[arg(long, value_name = "SOLUTION|DIR")]
    pub solution: Option<PathBuf>,
    /// .png; .exr (numbers, linear, in layers); or a folder: one .png for each camera.
    #[arg(short, long, value_name = "FILE|DIR")]
    pub output: PathBuf,
    /// Through this camera; default: the first, or all where -o is a folder.
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// How patches are filled; default: smooth, and constant with --quantity.
    #[arg(long, value_enum)]
    pub style: Option<RenderStyle>,
    /// One quantity in false colours with a bar: luminance, std-err, relative-std-err or band:NAME.
    #[arg(long, value_name = "Q")]
    pub quantity: Option<Quantity>,
    /// Brighter (1 shows everything twice as bright) or darker (-1) than the fitted exposure.
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    pub exposure: Option<f64>,
    /// Luminance shown white, W/m^2, instead of the fitted one: the same for pictures of several runs.
    #[arg(long, value_name = "W/m^2", conflicts_with = "exposure", allow_hyphen_values = true)]
    pub white: Option<f64>,
    /// Samples along each edge of a pixel.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub samples: u32,
    /// Size of the picture, pixels; default: the camera's.
    #[arg(long, value_name = "WxH")]
    pub size: Option<Pixels>,
    /// Words around the picture: titles, exposure; default: on for --style both and --quantity.
    #[arg(long, value_enum, value_name = "on|off")]
    pub caption: Option<OnOff>,
    /// Level of the values.
    #[arg(long, value_enum, default_value_t = PerLevel::Patch)]
    pub per: PerLevel,
    /// State of a scene with edits: initial, the number of edits applied, or final (default).
    #[arg(long, value_name = "initial|K|final")]
    pub state: Option<StateChoice>,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
}

/// How patches are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RenderStyle {
    /// Interpolated between vertices (Cohen and Greenberg 1985).
    Smooth,
    /// The value of each patch, as it was solved.
    Constant,
    /// Both, side by side.
    Both,
    /// Each patch in a colour of its own; needs no solution.
    Items,
}

/// A switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OnOff {
    /// With.
    On,
    /// Without.
    Off,
}
