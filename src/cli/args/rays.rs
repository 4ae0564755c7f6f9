//! How many rays, of what kind.

use crate::cli::values::{Fraction, Span};
use clap::{Args, ValueEnum};

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
