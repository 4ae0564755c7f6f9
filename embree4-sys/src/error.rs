//! Why a library is refused.

use std::path::PathBuf;

/// Why a library cannot be used. The path is the one that was asked for.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The system's loader refuses the file.
    #[error("the system cannot load it: {why}")]
    NotLoadable {
        /// The library.
        path: PathBuf,
        /// What the loader says.
        why: String,
    },
    /// A function is missing: not an Embree 4 library.
    #[error("it has no function {symbol}, so it is not an Embree 4")]
    MissingSymbol {
        /// The library.
        path: PathBuf,
        /// First function that is missing.
        symbol: &'static str,
    },
    /// Embree, but not version 4.
    #[error("it is Embree {found}, version 4 is needed")]
    WrongVersion {
        /// The library.
        path: PathBuf,
        /// Its version.
        found: String,
    },
    /// It cannot trace a ray.
    #[error("it fails at {doing}: {what}")]
    Broken {
        /// The library.
        path: PathBuf,
        /// What was tried.
        doing: &'static str,
        /// What came of it.
        what: String,
    },
    /// It lays its structs out in a way this crate does not know.
    #[error("its memory layout is unknown: {what}")]
    UnknownLayout {
        /// The library.
        path: PathBuf,
        /// What is not where it should be.
        what: String,
    },
    /// Another library serves this process already.
    #[error("this process already uses {loaded}")]
    AnotherIsLoaded {
        /// The library.
        path: PathBuf,
        /// The one in use.
        loaded: PathBuf,
    },
}

impl LoadError {
    /// The library that was asked for.
    pub fn path(&self) -> &PathBuf {
        match self {
            Self::NotLoadable { path, .. }
            | Self::MissingSymbol { path, .. }
            | Self::WrongVersion { path, .. }
            | Self::Broken { path, .. }
            | Self::UnknownLayout { path, .. }
            | Self::AnotherIsLoaded { path, .. } => path,
        }
    }
}
