//! `etalon project`, and the audit of what comes of it.

use super::judge::OnInconclusive;
use super::viewing::{ToneChoice, ViewingArgs};
use crate::cli::values::{Fraction, Pixels, StateChoice, Triple};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// `etalon project`
#[derive(Debug, Args)]
pub struct ProjectArgs {
    /// Scene file, builtin:NAME, a reference directory; or a picture of a world (.exr, .png), to lay it out in another way.
    pub source: String,
    /// Radiosities of the scene: a solution file or a reference directory.
    #[arg(long, value_name = "SOLUTION|DIR")]
    pub solution: Option<PathBuf>,
    /// From where the world is seen, metres; default: the camera's eye.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub at: Option<Triple>,
    /// How the world is laid out.
    #[arg(long, value_enum, default_value_t = LayoutChoice::Cube)]
    pub layout: LayoutChoice,
    /// Texels: edge of a face of the cube; height of the others (latitude-longitude is twice as wide, perspective 4:3).
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=8192))]
    pub size: u32,
    /// .exr (radiance, W/(m^2 sr) a band, linear) or .png (as an eye would see it).
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Direction of the front; default: the camera's, levelled.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub towards: Option<Triple>,
    /// Motion blur of a perspective: the direction that the camera has turned to when the shutter closes.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub turning_to: Option<Triple>,
    /// Direction that is up; default: the camera's, else z.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub up: Option<Triple>,
    /// Camera that gives place and directions where they are not given; default: the first.
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Angle of view, degrees: across a fish-eye (180), from top to bottom of a perspective (the camera's, else 45).
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    pub field: Option<f64>,
    /// Object or surface that is left out, so that the world is seen from within it.
    #[arg(long, value_name = "NAME")]
    pub without: Option<String>,
    /// Draw it from a cube of this size by filtering, as Greene (1986) does, and say how far that is from rays.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    pub from_cube: Option<u32>,
    /// What is seen where the scene is open: a picture of a world, .exr or .png.
    #[arg(long, value_name = "FILE")]
    pub sky: Option<PathBuf>,
    /// How pictures that are read are laid out, where they do not say: a square .png may be a fish-eye.
    #[arg(long, value_enum, value_name = "LAYOUT")]
    pub given: Option<GivenLayout>,
    /// The irradiance over every normal instead (latitude-longitude, W/m^2): the diffuse illumination map.
    #[arg(long)]
    pub diffuse: bool,
    /// Samples along each edge of a texel that shows more than one thing.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub samples: u32,
    /// How natural colours are made: tr93-consistent, tr93, film, television or brightest.
    #[arg(long, value_name = "OPERATOR", default_value = "tr93-consistent")]
    pub tone: ToneChoice,
    #[command(flatten)]
    pub viewing: ViewingArgs,
    /// State of a scene with edits: initial, the number of edits applied, or final (default).
    #[arg(long, value_name = "initial|K|final")]
    pub state: Option<StateChoice>,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
}

/// Layouts by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LayoutChoice {
    /// Six views of 90 degrees, unfolded.
    Cube,
    /// Longitude across, latitude down.
    Latlong,
    /// Longitude across, sine of the latitude down: texels of equal solid angle.
    SineLatlong,
    /// Equidistant fish-eye about the front.
    Fisheye,
    /// What a pin-hole camera sees.
    Perspective,
}

/// Layouts of pictures that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GivenLayout {
    /// Longitude across, latitude down.
    Latlong,
    /// Longitude across, sine of the latitude down.
    SineLatlong,
    /// Six faces as a cross of 4 by 3.
    Cross,
    /// Six faces as a cross of 3 by 4, the back upside down at its foot: a light probe.
    VerticalCross,
    /// Six faces below one another, in the order of OpenEXR.
    Strip,
    /// Fish-eye of 180 degrees about the front.
    Fisheye,
    /// Fish-eye of 180 degrees about what is up: a photograph of the sky.
    SkyFisheye,
}

/// `etalon audit envmap`
#[derive(Debug, Args)]
pub struct EnvmapArgs {
    /// Scene file, builtin:NAME, or a reference directory.
    pub scene: String,
    /// Radiosities of the scene: a solution file or a reference directory.
    #[arg(long, value_name = "SOLUTION|DIR")]
    pub solution: Option<PathBuf>,
    /// Object (or surface) that the map shades; it is not in the map.
    #[arg(long, value_name = "NAME")]
    pub object: String,
    /// World centre, metres; given again, each point takes the nearest. Default: the middle of the object's box.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub at: Vec<Triple>,
    /// Where the page, the tables and the pictures go.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Edge of the cube's faces, texels.
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(4..=2048))]
    pub size: u32,
    /// Samples along each edge of a texel that shows more than one thing.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub samples: u32,
    /// Size of the diffuse illumination map.
    #[arg(long, value_name = "WxH", default_value = "40x20")]
    pub table: Pixels,
    /// Points over the object.
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(16..=65_536))]
    pub points: u32,
    /// Directions in which fast filters are held against exact ones, for each width of cones.
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(10..=100_000))]
    pub directions: u32,
    /// Rays of the truth at each point, over all randomisations.
    #[arg(long, default_value_t = 16_384, allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(16..=1 << 28))]
    pub rays: u64,
    /// Seed of the random streams.
    #[arg(long, default_value_t = 0, allow_hyphen_values = true)]
    pub seed: u64,
    /// Error that the distance from the centre is stated for.
    #[arg(long, value_name = "X", default_value = "5%", allow_hyphen_values = true)]
    pub stated_error: Fraction,
    /// Limit on the error of the irradiance over the object: 0.05 or 5%.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    pub max_error: Option<Fraction>,
    /// Exit code instead of 3 when inconclusive.
    #[arg(long, value_enum, value_name = "pass|fail")]
    pub on_inconclusive: Option<OnInconclusive>,
    /// Confidence of the intervals, two-sided.
    #[arg(long, default_value = "0.95", value_name = "C", allow_hyphen_values = true)]
    pub confidence: Fraction,
    /// Camera from which reflections are seen; default: the first.
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Weights of diffuse and mirror light in the pictures: reflected = DC D + SC S.
    #[arg(long, value_name = "DC,SC", default_value = "0.5,0.5", value_delimiter = ',', allow_hyphen_values = true)]
    pub shading: Vec<f64>,
    /// State of a scene with edits: initial, the number of edits applied, or final (default).
    #[arg(long, value_name = "initial|K|final")]
    pub state: Option<StateChoice>,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// Screen and eye.
    #[command(flatten)]
    pub viewing: ViewingArgs,
}
