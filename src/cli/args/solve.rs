//! `etalon solve`.

use super::rays::Estimator;
use super::scene::SceneArgs;
use crate::cli::values::{PerLevel, Span};
use clap::Args;
use std::path::PathBuf;

/// `etalon solve`
#[derive(Debug, Args)]
pub struct SolveArgs {
    /// Scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// gather, hemicube, progressive or redistribution, with parameters as hemicube:resolution=200,delta=exact or
    /// progressive:rays=4096,unshot=0.1%.
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
    /// Keep the series of snapshots of a method that shoots, as `converge --series` reads it (per patch).
    #[arg(long, value_name = "DIR")]
    pub snapshots: Option<PathBuf>,
    /// For methods that shoot: go on from this file where it is there, and leave there what to go on from (JSON). A stop by
    /// shots or seconds then counts from where the last run ended.
    #[arg(long, value_name = "FILE", conflicts_with = "snapshots")]
    pub resume: Option<PathBuf>,
    /// Snapshots after these numbers of shots since the last edit; a dense choice unless given.
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', requires = "snapshots")]
    pub snapshot_shots: Vec<u64>,
    /// Also a snapshot every so much time of computing: 0.5s.
    #[arg(long, value_name = "T", requires = "snapshots")]
    pub snapshot_every: Option<Span>,
    /// Level of the values.
    #[arg(long, value_enum, default_value_t = PerLevel::Patch)]
    pub per: PerLevel,
}
