//! Files and folders that stand beside results while these are written: known to the whole program, so that an
//! interrupted one takes them away and breaks off no rename.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn all() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Something temporary; known as such while this lives.
#[derive(Debug)]
pub(super) struct Unfinished {
    path: PathBuf,
}

impl Unfinished {
    /// Makes it and notes where it is, in one step.
    pub(super) fn create<T>(make: impl FnOnce() -> io::Result<(PathBuf, T)>) -> io::Result<(Self, T)> {
        let mut all = all();
        let (path, made) = make()?;
        all.insert(path.clone());
        Ok((Self { path }, made))
    }

    /// Runs the rename that makes a result of it: [`abandon`] waits for its end, or it never begins.
    pub(super) fn finish<R>(self, rename: impl FnOnce() -> R) -> R {
        let mut all = all();
        let result = rename();
        all.remove(&self.path);
        drop(all);
        result
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        all().remove(&self.path);
    }
}

/// Removes everything unfinished; from then on nothing can be begun or finished. For the last moments of a program
/// that was interrupted: results are there as a whole or not at all.
pub fn abandon() {
    let all = all();
    for path in all.iter() {
        // Whatever cannot be removed now is removed by the next run.
        let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    }
    std::mem::forget(all);
}
