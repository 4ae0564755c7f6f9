//! `etalon completions` and `etalon man`.

use clap::Args;
use clap_complete::Shell;
use std::path::PathBuf;

/// `etalon completions`
#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// Shell that the script is for.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// `etalon man`
#[derive(Debug, Args)]
pub struct ManArgs {
    /// Folder of the pages; made if it is not there.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
}
