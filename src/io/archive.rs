//! A folder's files as one zip archive, with the same bytes every time.

use super::{FileError, Files};
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;

/// The archive: deflated, with a fixed date.
pub(super) fn zip(files: &Files) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated)
        .compression_level(Some(9))
        .last_modified_time(zip::DateTime::default());
    for (name, bytes) in files {
        zip.start_file(name.as_str(), options).expect("memory is writable");
        zip.write_all(bytes).expect("memory is writable");
    }
    zip.finish().expect("memory is writable").into_inner()
}

/// Files by name, undone.
pub(super) fn unzip(path: &Path, bytes: &[u8]) -> Result<BTreeMap<String, Vec<u8>>, FileError> {
    let broken = |e: &dyn std::fmt::Display| {
        FileError::new(path, format!("is not a readable archive: {e}")).mend("is it cut off? get it again")
    };
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| broken(&e))?;
    let mut files = BTreeMap::new();
    for k in 0..zip.len() {
        let mut file = zip.by_index(k).map_err(|e| broken(&e))?;
        let name = file.name().map_err(|e| broken(&e))?.to_string();
        let mut content = Vec::new();
        file.read_to_end(&mut content).map_err(|e| broken(&e))?;
        files.insert(name, content);
    }
    Ok(files)
}
