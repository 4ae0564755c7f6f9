//! An audit as a page.
use super::{Artifact, Phase, ReportError};
use crate::render::{Raster, View};
use crate::scene::Stage;
use crate::study::audit::AuditRecord;
pub struct AuditPicture {
    pub name: String,
    pub caption: String,
    pub image: Raster,
}
pub struct AuditExtras<'a> {
    pub stage: &'a Stage,
    pub views: &'a [View],
    pub pictures: &'a [AuditPicture],
    pub timing: &'a [Phase],
}
pub fn audit_files(_record: &AuditRecord, extras: &AuditExtras) -> Result<Vec<Artifact>, ReportError> {
    Ok(extras
        .pictures
        .iter()
        .map(|p| Artifact {
            name: p.name.clone(),
            bytes: crate::io::image::png(p.image.width, p.image.height, &p.image.rgba).unwrap_or_default(),
        })
        .collect())
}
