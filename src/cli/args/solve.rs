//! `etalon solve`.

use super::rays::Estimator;
use super::scene::SceneArgs;
use crate::cli::values::PerLevel;
use clap::Args;
use std::path::PathBuf;

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
