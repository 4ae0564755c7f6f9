//! `etalon report`, and writing a report folder.

use super::check::open;
use crate::cli::args::Kernel;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::FileError;
use crate::render::{View, views};
use crate::report::{
    Exporter, Extras, HtmlReport, PAGE_NAME, Phase, RECORD_NAME, TIMING_NAME, read_record, read_timing, save,
};
use crate::study::Record;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Times the phases of a run, one after the other.
pub struct Stopwatch {
    since: Instant,
    phases: Vec<Phase>,
}

impl Stopwatch {
    /// Starts with the first phase.
    pub fn start() -> Self {
        Self { since: Instant::now(), phases: Vec::new() }
    }

    /// The phase that ends here; the next one begins.
    pub fn lap(&mut self, name: &str) {
        self.phases.push(Phase { name: name.into(), seconds: self.since.elapsed().as_secs_f64() });
        self.since = Instant::now();
    }
}

/// `etalon report DIR`: makes the page of a finished run again, the same to the byte.
pub fn run(folder: &Path, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let path = folder.join(RECORD_NAME);
    let bytes = std::fs::read(&path).map_err(|e| {
        FileError::system(&path, "read", &e).mend("DIR is a folder that check --report, compare --report or demo wrote")
    })?;
    let record = read_record(&bytes).map_err(|e| {
        FileError::new(&path, e.to_string())
            .mend("it is damaged, or another version wrote it: run `etalon check --report` again")
    })?;
    let timing = timing(&folder.join(TIMING_NAME))?;
    let session = open(&record.stage, kernel, console)?;
    let seen = session.map_or(Vec::new(), |s| views(&s.tracer()));
    let page = write(folder, &record, &seen, &timing)?;
    console.result(&page.display().to_string(), &json!({ "report": page }));
    Ok(exit::DONE)
}

/// The clock of the run, where the folder keeps it.
fn timing(path: &Path) -> Result<Vec<Phase>, Failure> {
    let Ok(bytes) = std::fs::read(path) else { return Ok(Vec::new()) };
    read_timing(&bytes).map_err(|e| FileError::new(path, e.to_string()).mend("delete it: only times are lost").into())
}

/// Writes the report folder of a record; returns the page's path.
pub fn write_report(folder: &Path, record: &Record, views: &[View], watch: Stopwatch) -> Result<PathBuf, Failure> {
    write(folder, record, views, &watch.phases)
}

/// A comparison without a scene has no geometry to show, hence no views.
fn write(folder: &Path, record: &Record, views: &[View], timing: &[Phase]) -> Result<PathBuf, Failure> {
    let artifacts = HtmlReport.export(record, &Extras { views, timing })?;
    save(folder, &artifacts)?;
    Ok(folder.join(PAGE_NAME))
}
