//! `etalon report`, and writing a report folder.

use super::inputs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::FileError;
use crate::raycast::KernelKind;
use crate::render::views;
use crate::report::{Exporter, Extras, HtmlReport, PAGE_NAME, save};
use crate::study::Record;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::path::{Path, PathBuf};

/// The finished record, from which the page can be made again.
const RUN: &str = "run.json";
/// Its format.
const FORMAT: &str = "etalon-run/1";

#[derive(Serialize, Deserialize)]
struct Run<R> {
    format: String,
    record: R,
}

/// `etalon report DIR`: makes the page of a finished run again.
pub fn run(folder: &Path, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let path = folder.join(RUN);
    let bytes = std::fs::read(&path).map_err(|e| {
        FileError::system(&path, "read", &e).mend("DIR is a folder that check --report, compare --report or demo wrote")
    })?;
    let run: Run<Record> = serde_json::from_slice(&bytes)
        .map_err(|e| FileError::new(&path, format!("is not a finished run: {e}")).at(format!("line {}", e.line())))?;
    if run.format != FORMAT {
        return Err(FileError::new(&path, format!("has format {}", run.format))
            .mend(format!("this version reads {FORMAT}"))
            .into());
    }
    let page = write_report(folder, &run.record, kernel, console)?;
    console.result(&page.display().to_string(), &json!({ "report": page }));
    Ok(exit::DONE)
}

/// Writes the report folder of a record; returns the page's path.
pub fn write_report(folder: &Path, record: &Record, kernel: KernelKind, console: &Console) -> Result<PathBuf, Failure> {
    // A comparison without a scene has no geometry to show.
    let seen = if record.stage.facets.is_empty() {
        Vec::new()
    } else {
        views(&inputs::session(&record.stage, kernel, console)?.tracer())
    };
    let artifacts = HtmlReport.export(record, &Extras { views: &seen, timing: &[] })?;
    save(folder, &artifacts)?;
    let run = Run { format: FORMAT.into(), record };
    let mut bytes = serde_json::to_vec(&run).map_err(|e| Failure::input(e.to_string()))?;
    bytes.push(b'\n');
    inputs::write(&folder.join(RUN), &bytes)?;
    Ok(folder.join(PAGE_NAME))
}
