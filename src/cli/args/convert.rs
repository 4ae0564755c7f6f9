//! `etalon convert`.

use super::brought::BroughtArgs;
use crate::cli::values::StateChoice;
use clap::Args;
use std::path::PathBuf;

/// `etalon convert`
#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// Solution: values on a mesh (.ply, .obj, .gltf, .glb, .vtu, .exr), or per patch (.csv, .json, .npy, .npz).
    pub solution: PathBuf,
    /// Scene file, mesh, or builtin:NAME: onto its patches.
    #[arg(long)]
    pub scene: String,
    /// State of a scene with edits: initial, the number of edits applied, or final.
    #[arg(long, default_value = "final", value_name = "initial|K|final")]
    pub state: StateChoice,
    /// Longest patch edge, metres; overrides the file's max_edge.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub max_edge: Option<f64>,
    /// .csv, .json, .npy, .npz, .vtu or .ply.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// What the solution brings along.
    #[command(flatten)]
    pub brought: BroughtArgs,
}
