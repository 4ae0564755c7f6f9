//! What is wrong with a file, where, and how to mend it.

use std::fmt;
use std::path::{Path, PathBuf};

/// A file that cannot be read or written: one message that names file, place and mend.
#[derive(Debug)]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// Line, row or entry; empty for the file as a whole.
    pub place: String,
    /// What is wrong.
    pub problem: String,
    /// What to do about it; empty where it is plain.
    pub mend: String,
}

impl FileError {
    /// A problem with the file as a whole.
    pub fn new(path: &Path, problem: impl Into<String>) -> Self {
        Self { path: path.into(), place: String::new(), problem: problem.into(), mend: String::new() }
    }

    /// The same at a place in it.
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.place = place.into();
        self
    }

    /// The same with advice.
    pub fn mend(mut self, mend: impl Into<String>) -> Self {
        self.mend = mend.into();
        self
    }

    /// A failed system call on the file.
    pub fn system(path: &Path, doing: &str, error: &std::io::Error) -> Self {
        let mend = match error.kind() {
            std::io::ErrorKind::NotFound => "is the name right? there is no such file",
            std::io::ErrorKind::IsADirectory => "name a file, not a folder",
            std::io::ErrorKind::PermissionDenied => "allow it to be read, or copy it where it can be",
            _ => "",
        };
        Self::new(path, format!("cannot be {doing}: {error}")).mend(mend)
    }

    /// File and place, for the `place` field of a JSON error.
    pub fn whereabouts(&self) -> String {
        let separator = if self.place.is_empty() { "" } else { ", " };
        format!("{}{separator}{}", self.path.display(), self.place)
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}", self.whereabouts(), self.problem)?;
        if self.mend.is_empty() { Ok(()) } else { write!(f, "; {}", self.mend) }
    }
}

impl std::error::Error for FileError {}
