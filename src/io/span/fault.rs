//! What is wrong with an intermediate image or its file, and where in it.

use crate::io::FileError;
use std::path::Path;

/// A fault not yet tied to a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    pub place: String,
    pub problem: String,
    pub mend: &'static str,
}

const AGAIN: &str = "scan the scene again, or copy the file again from where it is whole";

/// The bytes are not what was written.
pub(super) fn damaged(place: impl Into<String>, problem: impl Into<String>) -> Fault {
    Fault { place: place.into(), problem: problem.into(), mend: AGAIN }
}

/// The image does not fit together.
pub(super) fn unsound<T>(place: impl Into<String>, problem: impl Into<String>) -> Result<T, Fault> {
    Err(damaged(place, problem))
}

impl Fault {
    pub(super) fn in_file(self, path: &Path) -> FileError {
        FileError::new(path, self.problem).at(self.place).mend(self.mend)
    }
}
