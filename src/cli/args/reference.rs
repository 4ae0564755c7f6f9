//! `etalon reference`.

use super::rays::RayArgs;
use super::scene::SceneArgs;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Which truth, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Truth {
    /// The exact solution of the patch-constant system.
    PatchSystem,
    /// The true mean radiosity of each patch.
    Continuous,
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
    // With --print-key there is none, and nobody looks at this value.
    #[arg(
        short,
        long,
        value_name = "DIR",
        required = false,
        required_unless_present = "print_key",
        default_value_if("print_key", "true", "none")
    )]
    pub output: PathBuf,
    /// Compute nothing: print a key that is the same for as long as the stored reference would be, for the cache of a CI
    /// (scene, state, options, version, ray kernel).
    #[arg(long)]
    pub print_key: bool,
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
