//! `etalon scan`, `composite`, `shade`, and the audit of what comes of them.

use super::judge::OnInconclusive;
use super::viewing::{ToneChoice, ViewingArgs};
use crate::cli::values::{Fraction, Pixels, StateChoice};
use clap::Args;
use std::path::PathBuf;

/// `etalon scan`
#[derive(Debug, Args)]
pub struct ScanArgs {
    /// Scene file or builtin:NAME.
    pub scene: String,
    /// Camera; default: the first of the scene.
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Sub-scanlines per scanline: more of them smooth edges better and allow larger pictures.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub sub_scanlines: u32,
    /// Objects to scan as one cluster; default: everything, each object a cluster of its own.
    #[arg(long, value_name = "OBJECT,...", value_delimiter = ',')]
    pub cluster: Vec<String>,
    /// One file per object in the folder of -o; only objects that changed are scanned again.
    #[arg(long, conflicts_with = "cluster")]
    pub each: bool,
    /// The file (.span), or the folder with --each.
    #[arg(short, long, value_name = "FILE|DIR")]
    pub output: PathBuf,
    /// Scans even if the file holds the same already.
    #[arg(long)]
    pub force: bool,
    /// Size of the picture at scale 1; default: the camera's.
    #[arg(long, value_name = "WxH")]
    pub size: Option<Pixels>,
    /// Lights, fog, background and finishes in place of the scene's (etalon-lighting/1).
    #[arg(long, value_name = "FILE")]
    pub lighting: Option<PathBuf>,
    /// State of a scene with edits: initial, the number of edits applied, or final (default).
    #[arg(long, value_name = "initial|K|final")]
    pub state: Option<StateChoice>,
}

/// `etalon composite`
#[derive(Debug, Args)]
pub struct CompositeArgs {
    /// Span files of one view, in any order.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where the composite goes (.span).
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Lights, fog, background and finishes in place of those in the files (etalon-lighting/1).
    #[arg(long, value_name = "FILE")]
    pub lighting: Option<PathBuf>,
}

/// `etalon shade`
#[derive(Debug, Args)]
pub struct ShadeArgs {
    /// A span file, from `etalon scan` or `etalon composite`.
    pub file: PathBuf,
    /// .exr (radiance, W/(m^2 sr) a band, linear) or .png (as an eye would see it).
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Width of the picture as a multiple of the scanned one's.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_hyphen_values = true)]
    pub scale_x: f64,
    /// Height of the picture as a multiple of the scanned one's: at most the number of sub-scanlines.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_hyphen_values = true)]
    pub scale_y: f64,
    /// Lights, fog, background and finishes in place of those in the file (etalon-lighting/1).
    #[arg(long, value_name = "FILE")]
    pub lighting: Option<PathBuf>,
    /// Only these lights; `emitters` stands for the surfaces that emit.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub light: Vec<String>,
    /// Radiosities as the diffuse term (with --scene): they hold the light of emitting surfaces and point lights already.
    #[arg(long, value_name = "SOLUTION|DIR", requires = "scene")]
    pub solution: Option<PathBuf>,
    /// The scene that the solution belongs to.
    #[arg(long, value_name = "SCENE", requires = "solution")]
    pub scene: Option<String>,
    /// State of that scene: initial, the number of edits applied, or final (default).
    #[arg(long, value_name = "initial|K|final", requires = "scene")]
    pub state: Option<StateChoice>,
    /// Longest patch edge of that scene, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, requires = "scene")]
    pub max_edge: Option<f64>,
    /// Nothing hides a lamp.
    #[arg(long)]
    pub no_shadows: bool,
    /// Mirrors and glass are left as their matt part.
    #[arg(long)]
    pub no_trace: bool,
    /// Memory for shadow volumes at a time, MiB; faces are shaded in groups that keep to it.
    #[arg(long, value_name = "MIB", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub shadow_memory: u32,
    /// A deep .exr: in each pixel every face with its depth, opacity and radiance, for compositing elsewhere.
    #[arg(long)]
    pub deep: bool,
    /// How natural colours are made: tr93-consistent, tr93, film, television, brightest.
    #[arg(long, value_name = "OPERATOR", default_value = "tr93-consistent")]
    pub tone: ToneChoice,
    /// Screen and eye.
    #[command(flatten)]
    pub viewing: ViewingArgs,
}

/// `etalon audit compositing`
#[derive(Debug, Args)]
pub struct CompositingArgs {
    /// Scene file or builtin:NAME.
    pub scene: String,
    /// Camera; default: the first of the scene.
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Where the page, the tables and the pictures go.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Numbers of sub-scanlines that are tried.
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "1,2,3,5,9,17",
          value_parser = clap::value_parser!(u32).range(1..=64))]
    pub sub_scanlines: Vec<u32>,
    /// Vertical and horizontal scales that are tried.
    #[arg(long, value_name = "X,...", value_delimiter = ',', default_value = "0.5,0.8,1,1.2,2")]
    pub scales: Vec<f64>,
    /// Samples per pixel of the judge's pictures.
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(16..=65_536))]
    pub samples: u32,
    /// Points at which every light is judged.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(10..=100_000))]
    pub points: u32,
    /// Rays of the truth at each point and light.
    #[arg(long, default_value_t = 16_384, allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(256..=1 << 20))]
    pub rays: u64,
    /// Seed of the random streams.
    #[arg(long, default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
    /// Size of the pictures; default: the camera's, at most 320 pixels wide.
    #[arg(long, value_name = "WxH")]
    pub size: Option<Pixels>,
    /// Limit on the antialiasing error at 3 sub-scanlines (or the largest number tried below): 0.05 or 5%.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub max_error: Option<Fraction>,
    /// Exit code instead of 3 when inconclusive.
    #[arg(long, value_enum, value_name = "pass|fail")]
    pub on_inconclusive: Option<OnInconclusive>,
    /// Lights, fog, background and finishes in place of the scene's (etalon-lighting/1).
    #[arg(long, value_name = "FILE")]
    pub lighting: Option<PathBuf>,
    /// State of a scene with edits: initial, the number of edits applied, or final (default).
    #[arg(long, value_name = "initial|K|final")]
    pub state: Option<StateChoice>,
    /// Screen and eye.
    #[command(flatten)]
    pub viewing: ViewingArgs,
}
