//! `etalon setup`.

use clap::Subcommand;

/// `etalon setup ...`
#[derive(Debug, Subcommand)]
pub enum SetupCommand {
    /// Find an Embree 4, or fetch the pinned one into the user data folder.
    Embree,
}
