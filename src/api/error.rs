//! The one error of the library's front.

use crate::io::FileError;
use crate::io::scene::SceneFileError;
use crate::methods::MethodError;
use crate::raycast::KernelError;
use crate::reference::ReferenceError;
use crate::scene::SceneError;
use crate::study::JudgeError;

/// Why something cannot be done. Each message names the place and the mend.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scene file, or a mesh it names, cannot be read.
    #[error(transparent)]
    SceneFile(#[from] SceneFileError),
    /// A scene cannot be set up in a state.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A ray kernel cannot be had.
    #[error(transparent)]
    Kernel(#[from] KernelError),
    /// A reference cannot be computed.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// A file or folder cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A method cannot run.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// A solution cannot be judged.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// No limit was given, or one that is no fraction above or at 0.
    #[error("a limit is a fraction of at least 0, and one is needed at least: Limits::rms(0.05)")]
    NoLimit,
    /// The reference failed its own self-check and must not judge.
    #[error("the reference failed its self-check of {check}: {finding}; mend the scene and compute it again")]
    Untrusted {
        /// The check that failed.
        check: String,
        /// What it found.
        finding: String,
    },
}
