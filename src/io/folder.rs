//! Whole folders that are there or not: written beside their target, then renamed.

use super::{FileError, Files};
use std::fs;
use std::path::Path;

/// Writes a folder of files. An existing folder is replaced only if it is empty or holds `marker`, a file that
/// shows it to be of the same kind; anything else stays untouched.
pub fn write_folder(target: &Path, files: &Files, marker: &str) -> Result<(), FileError> {
    let failed = |doing: &'static str| move |e: std::io::Error| FileError::system(target, doing, &e);
    if target.exists() {
        check_replaceable(target, marker)?;
    }
    let parent = match target.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    fs::create_dir_all(parent).map_err(failed("created"))?;
    let fresh = tempfile::Builder::new().prefix(".etalon-").tempdir_in(parent).map_err(failed("written"))?;
    for (name, bytes) in files {
        super::atomic::write(&fresh.path().join(name), bytes).map_err(|e| FileError::new(target, e.to_string()))?;
    }
    make_readable(fresh.path()).map_err(failed("written"))?;
    // What stood there before is moved aside first and removed last.
    let aside = tempfile::Builder::new().prefix(".etalon-old-").tempdir_in(parent).map_err(failed("written"))?;
    if target.exists() {
        fs::rename(target, aside.path().join("old")).map_err(failed("replaced"))?;
    }
    fs::rename(fresh.keep(), target).map_err(failed("written"))
}

fn check_replaceable(target: &Path, marker: &str) -> Result<(), FileError> {
    let mut entries = fs::read_dir(target).map_err(|e| {
        FileError::new(target, format!("is not a folder that can be written: {e}")).mend("choose another place")
    })?;
    if target.join(marker).is_file() || entries.next().is_none() {
        return Ok(());
    }
    Err(FileError::new(target, format!("exists and holds something else (there is no {marker} in it)"))
        .mend("name a new folder; nothing was changed"))
}

/// Temporary folders are private; results are not.
#[cfg(unix)]
fn make_readable(folder: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(folder, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn make_readable(_: &Path) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_the_same_kind_are_replaced_and_others_kept() {
        let place = tempfile::tempdir().unwrap();
        let target = place.path().join("r");
        let files = |text: &str| vec![("mark".to_string(), text.as_bytes().to_vec())];
        write_folder(&target, &files("1"), "mark").unwrap();
        write_folder(&target, &files("2"), "mark").unwrap();
        assert_eq!(fs::read(target.join("mark")).unwrap(), b"2");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "something was left behind");
        let other = place.path().join("other");
        fs::create_dir(&other).unwrap();
        fs::write(other.join("thesis.tex"), "!").unwrap();
        assert!(write_folder(&other, &files("3"), "mark").unwrap_err().to_string().contains("holds something else"));
        assert!(other.join("thesis.tex").is_file());
    }
}
