//! An audit of hemi-cubes as a page: the verdict, what it means, why, where, and what would mend it.

mod charts;
mod cures;
mod maps;
mod page;
mod sources;
#[cfg(test)]
mod tests;

use super::{Artifact, Phase, ReportError};
use crate::io::image::png;
use crate::render::{Raster, View};
use crate::scene::Stage;
use crate::study::audit::AuditRecord;

/// Name of the page in its folder.
pub const AUDIT_PAGE: &str = "index.html";

/// A picture that goes with an audit: the unfolded item buffer of a patch.
#[derive(Debug, Clone, PartialEq)]
pub struct AuditPicture {
    /// File name in the folder.
    pub name: String,
    /// What is shown.
    pub caption: String,
    /// The pixels.
    pub image: Raster,
}

/// What a page shows beside the record.
#[derive(Debug, Clone, Copy)]
pub struct AuditExtras<'a> {
    /// The scene that was audited.
    pub stage: &'a Stage,
    /// What the cameras see; no error maps without.
    pub views: &'a [View],
    /// Unfolded item buffers.
    pub pictures: &'a [AuditPicture],
    /// Wall-clock times.
    pub timing: &'a [Phase],
}

/// The page, which needs nothing but itself, and beside it every picture as PNG.
///
/// # Errors
/// [`ReportError::Shape`] for a record of another scene; [`ReportError::Image`] or [`ReportError::Page`], which no
/// data provokes.
pub fn audit_files(record: &AuditRecord, extras: &AuditExtras) -> Result<Vec<Artifact>, ReportError> {
    let stage = extras.stage;
    let (found, patches, bands) = (record.receivers.len(), stage.patch_count(), stage.band_count());
    if found != patches {
        return Err(ReportError::Shape { what: "audit", found, patches, bands });
    }
    let maps = maps::maps(record, stage, extras.views);
    let of_maps = maps.iter().flat_map(|v| &v.figures).map(|f| (f.file.clone(), &f.raster));
    let of_cubes = extras.pictures.iter().map(|p| (p.name.clone(), &p.image));
    let encode = |(name, r): (String, &Raster)| -> Result<Artifact, ReportError> {
        Ok(Artifact::new(name, png(r.width, r.height, &r.rgba)?))
    };
    let pictures = of_maps.chain(of_cubes).map(encode).collect::<Result<Vec<_>, _>>()?;
    let page = page::Page::new(record, extras, &maps);
    let mut files = vec![Artifact::new(AUDIT_PAGE, page::render(&page, &pictures)?)];
    files.extend(page.chart_files());
    files.extend(pictures);
    Ok(files)
}
