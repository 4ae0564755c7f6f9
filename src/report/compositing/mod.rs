//! An audit of compositing as a page: the verdict, edges, lights, clusters, the picture against rays, after Nakamae and
//! others (1989).

mod charts;
mod page;
mod pictures;
mod rows;
mod tables;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod words;

pub use super::gallery::PagePicture as CompositingPicture;

use super::gallery::encoded;
use super::{Artifact, Phase, ReportError};
use crate::study::compositing::CompositingRecord;

/// Name of the page in its folder.
pub const COMPOSITING_PAGE: &str = "index.html";

/// What a page shows beside the record.
#[derive(Debug, Clone, Copy)]
pub struct CompositingExtras<'a> {
    /// Pictures. Where one stands follows from its name: `shaded`, `rays`, `off`, `edges-*` with `edges-rays` last, anything
    /// else at the end.
    pub pictures: &'a [CompositingPicture],
    /// Wall-clock times.
    pub timing: &'a [Phase],
}

/// Files of the audit: the page, which needs nothing but itself, drawings (.svg) and tables (.csv) of its charts, the
/// pictures (.png).
///
/// # Errors
/// [`ReportError::Image`] for a picture whose pixels do not fit its size; [`ReportError::Page`], which no data provokes.
pub fn compositing_files(record: &CompositingRecord, extras: &CompositingExtras) -> Result<Vec<Artifact>, ReportError> {
    let pictures = encoded(extras.pictures)?;
    let page = page::Page::new(record, extras);
    let mut files = vec![Artifact::new(COMPOSITING_PAGE, page::render(&page, &pictures)?)];
    files.extend(page.chart_files());
    files.extend(pictures);
    Ok(files)
}
