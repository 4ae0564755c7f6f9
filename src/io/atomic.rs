//! Files that are whole or not there: written beside their target, then renamed.

use super::claim::is_at;
use super::unfinished::Unfinished;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Names of temporary files begin and end like this.
const PREFIX: &str = ".etalon-";
const SUFFIX: &str = ".part";

/// Why a file could not be written. The target is as it was before.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The folder is not there.
    #[error("cannot write {target}: there is no folder {folder}; create it first")]
    NoFolder {
        /// File that was to be written.
        target: PathBuf,
        /// Folder it was to stand in.
        folder: PathBuf,
    },
    /// What should be the folder is a file.
    #[error("cannot write {target}: {folder} is not a folder; choose another place")]
    NotAFolder {
        /// File that was to be written.
        target: PathBuf,
        /// What stands where the folder should.
        folder: PathBuf,
    },
    /// What should be a file is a folder.
    #[error("cannot write {target}: it is a folder; name a file in it")]
    IsAFolder {
        /// File that was to be written.
        target: PathBuf,
    },
    /// The system does not allow it.
    #[error("cannot write {target}: no permission to write in {folder}; choose another place")]
    Denied {
        /// File that was to be written.
        target: PathBuf,
        /// Folder it was to stand in.
        folder: PathBuf,
    },
    /// There is no room.
    #[error("cannot write {target}: {source}; make room there, or choose another place; nothing was left behind")]
    Full {
        /// File that was to be written.
        target: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The medium failed.
    #[error("cannot write {target}: {source}; choose another place; nothing was left behind")]
    Failed {
        /// File that was to be written.
        target: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

impl WriteError {
    /// The file that was to be written.
    pub fn target(&self) -> &Path {
        match self {
            Self::NoFolder { target, .. }
            | Self::NotAFolder { target, .. }
            | Self::IsAFolder { target }
            | Self::Denied { target, .. }
            | Self::Full { target, .. }
            | Self::Failed { target, .. } => target,
        }
    }
}

/// Writes a whole file, or leaves what was there.
///
/// # Errors
/// [`WriteError`] names the file, what stands in the way and what to do.
pub fn write(target: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_with(target, |out| out.write_all(bytes))
}

/// Writes a file as `fill` produces it; if that fails, what was there stays.
///
/// Devices and pipes are written to directly: there is nothing to keep whole, and a rename would replace them.
///
/// # Errors
/// As [`write()`]; errors of `fill` come back as [`WriteError::Failed`].
pub fn write_with(target: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), WriteError> {
    // A link stays a link: what it points to is replaced.
    let real = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
    let known = fs::metadata(&real).ok();
    let done = match &known {
        Some(m) if m.is_dir() => return Err(WriteError::IsAFolder { target: target.into() }),
        Some(m) if !m.is_file() => into_device(&real, fill),
        _ => beside(&real, known.map(|m| m.permissions()), fill),
    };
    done.map_err(|e| explain(target, &real, e))
}

/// Makes a folder and those above it.
///
/// # Errors
/// As [`write()`].
pub fn create_folder(folder: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(folder).map_err(|e| match e.kind() {
        io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
            WriteError::NotAFolder { target: folder.into(), folder: first_file(folder).into() }
        }
        _ => explain(folder, folder, e),
    })
}

fn into_device(target: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(File::options().write(true).open(target)?);
    fill(&mut out)?;
    out.flush()
}

fn beside(
    target: &Path,
    permissions: Option<fs::Permissions>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    if let Some(p) = permissions.or_else(ordinary_permissions) {
        builder.permissions(p);
    }
    // The temporary file removes itself on every way out but the last.
    let (unfinished, file) = Unfinished::create(|| held(&builder, folder_of(target)))?;
    let mut out = BufWriter::new(file);
    fill(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.as_file().sync_all()?;
    unfinished.finish(|| file.persist(target).map(drop).map_err(|e| e.error))
}

/// A temporary file that is locked for as long as it is written: what is not locked is left over.
fn held(builder: &tempfile::Builder, folder: &Path) -> io::Result<(PathBuf, NamedTempFile)> {
    loop {
        let file = builder.tempfile_in(folder)?;
        match file.as_file().try_lock() {
            // Somebody may have taken it for a leftover before it was locked.
            Ok(()) if !is_at(file.as_file(), file.path()) => {}
            Err(TryLockError::WouldBlock) => {}
            Ok(()) | Err(TryLockError::Error(_)) => return Ok((file.path().to_path_buf(), file)),
        }
    }
}

/// Fails where [`write()`] would fail for want of a folder, of permission or of a file that can be replaced; leaves
/// everything as it is, but for temporary files that dead processes have left beside the target.
///
/// # Errors
/// As [`write()`].
pub fn check(target: &Path) -> Result<(), WriteError> {
    let real = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
    let checked = match fs::metadata(&real) {
        Ok(m) if m.is_dir() => return Err(WriteError::IsAFolder { target: target.into() }),
        // A pipe must not be opened twice: whoever reads it would take the first end for the end.
        Ok(m) if !m.is_file() => Ok(()),
        _ => probe(folder_of(&real)),
    };
    checked.map_err(|e| explain(target, &real, e))
}

/// Fails where a folder could not be made and filled. Makes nothing.
///
/// # Errors
/// As [`create_folder`].
pub fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let there = folder.ancestors().find(|p| p.exists() || p.as_os_str().is_empty()).unwrap_or(folder);
    let there = if there.as_os_str().is_empty() { Path::new(".") } else { there };
    if !there.is_dir() {
        return Err(WriteError::NotAFolder { target: folder.into(), folder: there.into() });
    }
    probe(there).map_err(|e| explain(folder, &there.join("x"), e))
}

/// Makes a temporary file and takes it away again.
fn probe(folder: &Path) -> io::Result<()> {
    sweep(folder);
    Unfinished::create(|| held(tempfile::Builder::new().prefix(PREFIX).suffix(SUFFIX), folder)).map(drop)
}

/// Removes temporary files that nobody holds any more.
fn sweep(folder: &Path) {
    let is_ours = |name: &str| name.starts_with(PREFIX) && name.ends_with(SUFFIX);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|e| e.file_name().to_str().is_some_and(is_ours)) {
        let path = entry.path();
        if File::open(&path).is_ok_and(|f| f.try_lock().is_ok()) {
            let _ = fs::remove_file(path);
        }
    }
}

/// What a file gets that is simply created; the process's mask still applies.
#[cfg(unix)]
fn ordinary_permissions() -> Option<fs::Permissions> {
    Some(std::os::unix::fs::PermissionsExt::from_mode(0o666))
}

#[cfg(not(unix))]
fn ordinary_permissions() -> Option<fs::Permissions> {
    None
}

fn folder_of(target: &Path) -> &Path {
    target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The uppermost part of a path that is not a folder.
fn first_file(path: &Path) -> &Path {
    path.ancestors().filter(|p| p.is_file()).last().unwrap_or(path)
}

fn explain(target: &Path, real: &Path, source: io::Error) -> WriteError {
    let (target, folder) = (target.to_path_buf(), folder_of(real).to_path_buf());
    if folder.exists() && !folder.is_dir() || source.kind() == io::ErrorKind::NotADirectory {
        return WriteError::NotAFolder { target, folder: first_file(&folder).into() };
    }
    match source.kind() {
        io::ErrorKind::NotFound if !folder.exists() => WriteError::NoFolder { target, folder },
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => WriteError::Denied { target, folder },
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            WriteError::Full { target, source }
        }
        _ => WriteError::Failed { target, source },
    }
}

#[cfg(test)]
mod tests;
