//! A folder that one process alone writes: claimed before the work, published whole after it.
//!
//! Beside the target `DIR` stands `DIR.part` for as long as somebody works on it, and after that only if there is
//! unfinished work to go on from. In it: `lock` (held while the process lives, with its number), `journal`, `new`
//! (the folder under construction) and `old` (what it replaces, where two folders cannot change places in one step).

mod lock;

pub use lock::end_claims;
pub(super) use lock::is_at;

use super::unfinished::Unfinished;
use super::{FileError, Files};
use lock::{LOCK, Locked, lock, release};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const JOURNAL: &str = "journal";
const NEW: &str = "new";
const OLD: &str = "old";

/// The sole right to write a folder; ends when dropped, or with the process.
#[derive(Debug)]
pub struct Claim {
    /// As the user names it.
    named: PathBuf,
    /// The same behind all links.
    target: PathBuf,
    /// The working folder beside it.
    part: PathBuf,
    /// A file whose presence shows that the target may be replaced.
    marker: &'static str,
    /// Locked. `None` where the file system has no locks.
    lock: Option<File>,
}

impl Claim {
    /// Claims a folder that is to hold `marker`. A folder that is there has to be empty or hold it already.
    ///
    /// # Errors
    /// If the target is something else, if another process has claimed it, or if nothing can be written there.
    pub fn take(named: &Path, marker: &'static str) -> Result<Self, FileError> {
        check_replaceable(named, marker)?;
        let target = resolve(named)?;
        let part = beside(&target);
        check_ours(named, &part)?;
        let failed = |e: io::Error| unwritable(named, &target, &e);
        let lock = lock(&part).map_err(failed)?;
        let lock = match lock {
            Locked::Held(file) => Some(file),
            Locked::Unsupported => None,
            Locked::ByAnother(pid) => return Err(claimed_by_another(named, pid.as_deref())),
        };
        let claim = Self { named: named.into(), target: target.clone(), part, marker, lock };
        claim.tidy().map_err(failed)?;
        Ok(claim)
    }

    /// True if there is, beside a target, what a process has left that was interrupted, or still works.
    pub fn is_begun(named: &Path) -> bool {
        fs::canonicalize(named).is_ok_and(|target| beside(&target).exists())
    }

    /// Where a journal of the work may stand.
    pub fn journal(&self) -> PathBuf {
        self.part.join(JOURNAL)
    }

    /// Writes the files and puts them where the target is, in one step; then nothing is left beside it.
    ///
    /// # Errors
    /// If a file cannot be written. The target is as it was.
    pub fn publish(self, files: &Files) -> Result<(), FileError> {
        check_replaceable(&self.named, self.marker)?;
        let published = match self.try_publish(files) {
            Err(e) if e.kind() == io::ErrorKind::StorageFull && self.make_room(files) => self.try_publish(files),
            result => result,
        };
        published.map_err(|e| unwritable(&self.named, &self.target, &e))?;
        let _ = fs::remove_file(self.journal());
        Ok(())
    }

    fn try_publish(&self, files: &Files) -> io::Result<()> {
        let new = self.part.join(NEW);
        let (unfinished, ()) = Unfinished::create(|| fs::create_dir(&new).map(|()| (new.clone(), ())))?;
        let written = files.iter().try_for_each(|(name, bytes)| write_through(&new.join(name), bytes));
        written
            .and_then(|()| unfinished.finish(|| self.put_in_place(&new)))
            .inspect_err(|_| drop(fs::remove_dir_all(&new)))
    }

    /// Gives up the journal if that surely makes room: a result that is stored is worth more than a promise of it.
    fn make_room(&self, files: &Files) -> bool {
        let needed: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
        let journal = File::options().write(true).open(self.journal());
        journal.is_ok_and(|f| f.metadata().is_ok_and(|m| m.len() > 2 * needed as u64) && f.set_len(0).is_ok())
    }

    fn put_in_place(&self, new: &Path) -> io::Result<()> {
        if self.target.exists() {
            if exchange(new, &self.target).is_err() {
                let old = self.part.join(OLD);
                fs::rename(&self.target, &old)?;
                fs::rename(new, &self.target).inspect_err(|_| drop(fs::rename(&old, &self.target)))?;
            }
        } else {
            fs::rename(new, &self.target)?;
        }
        sync_folder(self.target.parent());
        let _ = fs::remove_dir_all(new);
        let _ = fs::remove_dir_all(self.part.join(OLD));
        Ok(())
    }

    /// Clears away what a process that died left behind.
    fn tidy(&self) -> io::Result<()> {
        let old = self.part.join(OLD);
        if old.exists() && !self.target.exists() {
            fs::rename(&old, &self.target)?;
        }
        for leftover in [old, self.part.join(NEW)] {
            if leftover.exists() {
                fs::remove_dir_all(leftover)?;
            }
        }
        Ok(())
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        release(&self.part, self.lock.take());
    }
}

/// Refuses a target that is neither empty nor of the same kind.
pub(super) fn check_replaceable(target: &Path, marker: &str) -> Result<(), FileError> {
    let mut entries = match fs::read_dir(target) {
        Ok(entries) => entries,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(e) => {
            return Err(FileError::new(target, format!("is not a folder that can be written: {e}"))
                .mend("choose another place"));
        }
    };
    if target.join(marker).is_file() || entries.next().is_none() {
        return Ok(());
    }
    Err(FileError::new(target, format!("exists and holds something else (there is no {marker} in it)"))
        .mend("name a new folder; nothing was changed"))
}

/// The target behind all links; the folders above it are made.
fn resolve(named: &Path) -> Result<PathBuf, FileError> {
    if let Ok(real) = fs::canonicalize(named) {
        return Ok(real);
    }
    let Some(name) = named.file_name() else {
        return Err(FileError::new(named, "is not the name of a folder").mend("name a folder, such as -o reference"));
    };
    let parent = named.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(parent)
        .and_then(|()| fs::canonicalize(parent))
        .map(|p| p.join(name))
        .map_err(|e| unwritable(named, named, &e))
}

/// `DIR.part`, beside `DIR`.
fn beside(target: &Path) -> PathBuf {
    let mut name = target.file_name().unwrap_or_default().to_os_string();
    name.push(".part");
    target.with_file_name(name)
}

/// The working folder must not be somebody's own.
fn check_ours(named: &Path, part: &Path) -> Result<(), FileError> {
    let ours = |e: io::Result<fs::DirEntry>| {
        e.is_ok_and(|e| [LOCK, JOURNAL, NEW, OLD].iter().any(|n| e.file_name().to_str() == Some(n)))
    };
    let foreign = match fs::read_dir(part) {
        Ok(mut entries) => !entries.all(ours),
        Err(e) => e.kind() != io::ErrorKind::NotFound,
    };
    if !foreign {
        return Ok(());
    }
    Err(FileError::new(part, format!("holds something else, and is needed to write {}", named.display()))
        .mend("rename it, or name another folder; nothing was changed"))
}

fn claimed_by_another(named: &Path, pid: Option<&str>) -> FileError {
    let who = pid.map_or("another process".into(), |p| format!("another process (number {p})"));
    FileError::new(named, format!("is being written by {who}"))
        .mend("wait until it has ended, or name another folder; nothing was changed")
}

/// Why a target cannot be written, with the mend.
fn unwritable(named: &Path, target: &Path, e: &io::Error) -> FileError {
    let folder = target.parent().unwrap_or(target).display();
    let mend = match e.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "make room there and give the command again",
        io::ErrorKind::FileTooLarge => "raise the limit on the size of files (ulimit -f) and give the command again",
        _ => "choose another place",
    };
    FileError::new(named, format!("cannot be written in {folder}: {e}")).mend(mend)
}

fn write_through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Two folders change places, so that there is no moment without either.
#[cfg(target_os = "linux")]
fn exchange(a: &Path, b: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE)?)
}

#[cfg(not(target_os = "linux"))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Makes a rename last through a loss of power, where the system offers it.
fn sync_folder(folder: Option<&Path>) {
    let _ = folder.map(|f| File::open(f).and_then(|f| f.sync_all()));
}

#[cfg(test)]
mod tests;
