//! A small picture for a comment: reference, solution and difference side by side.

use super::figures::{Figure, figures};
use super::{Artifact, ReportError};
use crate::io::image::png;
use crate::render::{Raster, Sheet, View};
use crate::study::Record;

/// Pictures on it, by kind, with their titles.
const PANELS: [(&str, &str); 3] = [("reference", "Reference"), ("candidate", "Solution"), ("difference", "Difference")];

/// The picture as a file; `None` where nothing was seen.
///
/// # Errors
/// As [`figures`].
pub(super) fn thumbnail(record: &Record, views: &[View], name: &str) -> Result<Option<Artifact>, ReportError> {
    let all = figures(record, &views[..views.len().min(1)])?;
    let Some(view) = all.first() else { return Ok(None) };
    let find = |kind: &str| view.figures.iter().find(|f: &&Figure| f.kind == kind);
    let panels: Vec<(String, Raster)> =
        PANELS.iter().filter_map(|(kind, title)| Some((title.to_string(), find(kind)?.raster.clone()))).collect();
    let caption = find("difference").map_or(String::new(), |f| f.caption.clone());
    let sheet = Sheet { panels, bar: None, caption }.compose();
    Ok(Some(Artifact::new(name, png(sheet.width, sheet.height, &sheet.rgba)?)))
}
