//! Whole folders that are there or not.

use super::claim::Claim;
use super::{FileError, Files};
use std::path::Path;

/// Writes a folder of files. An existing folder is replaced only if it is empty or holds `marker`, a file that
/// shows it to be of the same kind; anything else stays untouched.
///
/// # Errors
/// If the target is something else, is being written by another process, or cannot be written.
pub fn write_folder(target: &Path, files: &Files, marker: &'static str) -> Result<(), FileError> {
    Claim::take(target, marker)?.publish(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

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
