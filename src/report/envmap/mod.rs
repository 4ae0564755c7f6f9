//! An audit of environment maps as a page: the verdict, what the error is made of, what it depends on, pictures, after Greene (1986).

mod charts;
mod clock;
mod page;
mod parts;
mod pictures;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod words;

pub use super::gallery::PagePicture as EnvmapPicture;

use super::gallery::encoded;
use super::{Artifact, Phase, ReportError};
use crate::study::envmap::EnvmapRecord;

/// Name of the page in its folder.
pub const ENVMAP_PAGE: &str = "index.html";

/// What a page shows beside the record.
#[derive(Debug, Clone, Copy)]
pub struct EnvmapExtras<'a> {
    /// Pictures, in order within each group. Where one stands follows from its name: `world-*`, `footprints-*`,
    /// `sphere-{diffuse,half,mirror}-{map,rays,off}`, `object-{map,hybrid,rays,off}`, anything else at the end.
    pub pictures: &'a [EnvmapPicture],
    /// Wall-clock times.
    pub timing: &'a [Phase],
}

/// Files of the audit: the page, which needs nothing but itself, drawings (.svg) and tables (.csv) of its charts, the
/// pictures (.png).
///
/// # Errors
/// [`ReportError::Image`] for a picture whose pixels do not fit its size; [`ReportError::Page`], which no data provokes.
pub fn envmap_files(record: &EnvmapRecord, extras: &EnvmapExtras) -> Result<Vec<Artifact>, ReportError> {
    let pictures = encoded(extras.pictures)?;
    let page = page::Page::new(record, extras);
    let mut files = vec![Artifact::new(ENVMAP_PAGE, page::render(&page, &pictures)?)];
    files.extend(page.chart_files());
    files.extend(pictures);
    Ok(files)
}
