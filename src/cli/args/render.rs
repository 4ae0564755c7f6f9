//! `etalon render`.

use super::viewing::{Positive, ToneChoice, ViewingArgs};
use crate::cli::values::{PerLevel, Pixels, Quantity, StateChoice};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

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
    /// How natural colours are made: tr93-consistent (as the eye would see it; default), tr93 (the same as printed in 1993:
    /// dark), film, television, brightest, or linear.
    #[arg(long, value_name = "OPERATOR")]
    pub tone: Option<ToneChoice>,
    #[command(flatten)]
    pub viewing: ViewingArgs,
    /// All light times whatever gives the brightest lamp this luminance, cd/m^2: light is linear, eyes are not. Several,
    /// with commas between them: one picture for each, side by side.
    #[arg(long, value_name = "CD/M2", value_delimiter = ',', allow_hyphen_values = true)]
    pub lamp: Vec<Positive>,
    /// Brighter (1 shows everything twice as bright) or darker (-1) than the fitted linear exposure.
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    pub exposure: Option<f64>,
    /// Luminance shown white, W/m^2, instead of the fitted one, on a linear scale: the same for pictures of several runs.
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
