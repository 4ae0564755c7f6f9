//! What exporters take and give.

use crate::io::atomic;
use crate::render::View;
use crate::study::Record;
use std::path::{Path, PathBuf};

/// A file to be written, or text to be printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Artifact {
    /// File name within the report's folder.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

impl Artifact {
    pub(super) fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), bytes: bytes.into() }
    }
}

/// How long a phase took: the only wall-clock data a report may hold, in a marked block of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// What was done.
    pub name: String,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// What a report may show beside the record. Nothing of it is needed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Extras<'a> {
    /// What the cameras see; no pictures without.
    pub views: &'a [View],
    /// Wall-clock times.
    pub timing: &'a [Phase],
}

/// One output format.
pub trait Exporter {
    /// The record in this format.
    ///
    /// # Errors
    /// [`ReportError`] where the record cannot be shown in this format.
    fn export(&self, record: &Record, extras: &Extras) -> Result<Vec<Artifact>, ReportError>;
}

/// Why a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// Radiosities that do not belong to the scene.
    #[error("the {what} has {found} values, but the scene has {patches} patches with {bands} bands")]
    Shape {
        /// Reference or solution.
        what: &'static str,
        /// Values it has.
        found: usize,
        /// Patches of the scene.
        patches: usize,
        /// Bands of the scene.
        bands: usize,
    },
    /// A format that shows verdicts, and there is none.
    #[error("a JUnit file shows limits, and none was given; give --max-rms or --max-top1")]
    NoVerdict,
    /// A picture could not be encoded.
    #[error(transparent)]
    Image(#[from] crate::io::image::ImageError),
    /// The page could not be filled in.
    #[error("the page could not be filled in: {0}")]
    Page(#[from] minijinja::Error),
    /// The JSON could not be written.
    #[error("the JSON could not be written: {0}")]
    Json(#[from] serde_json::Error),
    /// The JUnit file could not be written.
    #[error("the JUnit file could not be written: {0}")]
    JUnit(#[from] quick_junit::SerializeError),
    /// A file of a report folder is of another format.
    #[error("has format {found}; this version reads {wanted}")]
    Format {
        /// Its format.
        found: String,
        /// The format that can be read.
        wanted: &'static str,
    },
    /// A file of a report folder cannot be read.
    #[error("cannot be read: {0}")]
    NotARecord(serde_json::Error),
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] atomic::WriteError),
}

/// Refuses records whose radiosities do not belong to their scene.
pub(super) fn check_shape(record: &Record) -> Result<(), ReportError> {
    let (patches, bands) = (record.stage.patch_count(), record.stage.band_count());
    for (what, r) in [("reference", &record.reference), ("solution", &record.solution)] {
        let errors = r.std_err.as_ref().map_or(r.values.len(), Vec::len);
        for found in [r.values.len(), errors] {
            if r.bands != bands || found != patches * bands {
                return Err(ReportError::Shape { what, found, patches, bands });
            }
        }
    }
    Ok(())
}

/// Writes artifacts into a folder, which is made where it is missing. Returns their paths, in order.
///
/// # Errors
/// [`ReportError::Write`] names the file and the mend; each file is whole or not there.
pub fn save(folder: &Path, artifacts: &[Artifact]) -> Result<Vec<PathBuf>, ReportError> {
    atomic::create_folder(folder)?;
    let write = |a: &Artifact| {
        let path = folder.join(&a.name);
        atomic::write(&path, &a.bytes).map(|()| path).map_err(ReportError::from)
    };
    artifacts.iter().map(write).collect()
}
