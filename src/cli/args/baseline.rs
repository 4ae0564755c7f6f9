//! `etalon baseline` and `etalon bisect`.

use super::judge::{CheckArgs, CompareArgs};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// `etalon baseline`
#[derive(Debug, Subcommand)]
pub enum BaselineCommand {
    /// Store a solution with its metrics as the baseline that later ones are held against.
    Save(BaselineSaveArgs),
    /// Say what a solution changed against the baseline, in standard errors of the change.
    Diff(BaselineChangeArgs),
    /// Put a solution in the place of the baseline, and say what that changes.
    Update(BaselineChangeArgs),
}

/// `etalon baseline save`
#[derive(Debug, Args)]
pub struct BaselineSaveArgs {
    /// What is stored, and what judges it.
    #[command(flatten)]
    pub compare: CompareArgs,
    /// File of the baseline; it must not be there yet.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

/// `etalon baseline diff|update`
#[derive(Debug, Args)]
pub struct BaselineChangeArgs {
    /// The baseline.
    pub baseline: PathBuf,
    /// The solution that is held against it, and what judges both.
    #[command(flatten)]
    pub compare: CompareArgs,
}

/// `etalon bisect`: takes what `etalon check` takes.
#[derive(Debug, Args)]
pub struct BisectArgs {
    /// The check.
    #[command(flatten)]
    pub check: CheckArgs,
}
