//! The lock of a working folder: held while its process lives, gone with it.

use super::JOURNAL;
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Name of the locked file.
pub(super) const LOCK: &str = "lock";
/// Attempts to lock a file that others remove at the same moment.
const ATTEMPTS: usize = 20;

/// Working folders of this process.
static CLAIMED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Gives a working folder up.
pub(super) fn release(part: &Path, lock: Option<File>) {
    let mut claimed = CLAIMED.lock().unwrap_or_else(PoisonError::into_inner);
    leave(part);
    claimed.remove(part);
    drop(lock);
}

/// Ends all claims of a program that is about to die, as dropping them would; no other can begin.
pub fn end_claims() {
    let claimed = CLAIMED.lock().unwrap_or_else(PoisonError::into_inner);
    claimed.iter().for_each(|part| leave(part));
    std::mem::forget(claimed);
}

/// Removes the working folder, unless there is a journal in it.
fn leave(part: &Path) {
    if !part.join(JOURNAL).exists() {
        let _ = fs::remove_file(part.join(LOCK));
        let _ = fs::remove_dir(part);
    }
}

pub(super) enum Locked {
    Held(File),
    ByAnother(Option<String>),
    Unsupported,
}

/// Locks the working folder, which is made where it is missing.
pub(super) fn lock(part: &Path) -> io::Result<Locked> {
    let mut claimed = CLAIMED.lock().unwrap_or_else(PoisonError::into_inner);
    let locked = try_lock(part)?;
    if !matches!(locked, Locked::ByAnother(_)) {
        claimed.insert(part.into());
    }
    Ok(locked)
}

fn try_lock(part: &Path) -> io::Result<Locked> {
    let path = part.join(LOCK);
    for _ in 0..ATTEMPTS {
        match fs::create_dir(part) {
            Err(e) if e.kind() != io::ErrorKind::AlreadyExists => return Err(e),
            _ => {}
        }
        let file = match File::options().read(true).write(true).create(true).truncate(false).open(&path) {
            // Its owner has just removed it.
            Err(e) if e.kind() == io::ErrorKind::NotFound => continue,
            file => file?,
        };
        match file.try_lock() {
            Ok(()) if is_at(&file, &path) => return note_owner(file).map(Locked::Held),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let pid = fs::read_to_string(&path).ok().map(|p| p.trim().to_string()).filter(|p| !p.is_empty());
                return Ok(Locked::ByAnother(pid));
            }
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => return Ok(Locked::Unsupported),
            Err(TryLockError::Error(e)) => return Err(e),
        }
    }
    Ok(Locked::ByAnother(None))
}

fn note_owner(mut file: File) -> io::Result<File> {
    file.set_len(0)?;
    writeln!(file, "{}", std::process::id())?;
    Ok(file)
}

/// True if the open file is still the one at the path, and not one that its last owner has removed.
#[cfg(unix)]
pub(in crate::io) fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |m: fs::Metadata| (m.dev(), m.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(open), Ok(there)) => identity(open) == identity(there),
        _ => false,
    }
}

#[cfg(not(unix))]
pub(in crate::io) fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}
