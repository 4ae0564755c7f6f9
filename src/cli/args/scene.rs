//! Which scene, and the commands that look at one.

use crate::cli::values::StateChoice;
use clap::{Args, Subcommand};
use std::path::PathBuf;

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
