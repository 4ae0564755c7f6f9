//! `etalon receivers` and `etalon validate`.

use super::rays::SuiteArgs;
use super::scene::SceneArgs;
use clap::{Args, Subcommand};
use std::path::PathBuf;

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

/// `etalon validate display`
#[derive(Debug, Args)]
pub struct DisplaySuiteArgs {
    /// Writes Stevens' curves here, as figure 4 of the paper shows them: brightness.svg and brightness.csv.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// `etalon validate ...`
#[derive(Debug, Subcommand)]
pub enum ValidateCommand {
    /// CIE 171:2006, cases 5.2, 5.3, 5.4, 5.6, 5.7 and 5.8, as built-in scenes.
    Cie171(SuiteArgs),
    /// 114 exact form factors: polygons, disks, spheres, obstructed pairs.
    ClosedForms(SuiteArgs),
    /// Tone reproduction: 40 exact values of the operator of Tumblin and Rushmeier (1993), and Stevens' law.
    Display(DisplaySuiteArgs),
}
