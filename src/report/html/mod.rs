//! One self-contained page: no network, no fonts, nothing but the file.

mod bars;
mod budget;
mod charts;
pub(super) mod context;
mod findings;
mod groups;
pub(super) mod pictures;
mod seen;
mod settings;
mod sources;

use super::artifact::check_shape;
use super::chart;
use super::figures::{ViewFigures, figures};
use super::json::{record_file, timing_file};
use super::layers::exr_layers;
use super::scene3d::{self, Parts, scene_view};
use super::template::{filled, inlined};
use super::{Artifact, Exporter, Extras, ReportError};
use crate::io::image::png;
use crate::study::Record;
use crate::view::Camera;
use context::Page;
use minijinja::context;

/// Name of the page in its folder.
pub const PAGE_NAME: &str = "report.html";

/// The page and what it is put together from.
const TEMPLATES: [(&str, &str); 11] = [
    ("page.html", include_str!("page/page.html.j2")),
    ("style.css", include_str!("page/style.css")),
    ("macros.html", include_str!("page/macros.html.j2")),
    ("numbers.html", include_str!("page/numbers.html.j2")),
    ("seen.html", include_str!("page/seen.html.j2")),
    ("where.html", include_str!("page/where.html.j2")),
    ("why.html", include_str!("page/why.html.j2")),
    ("how.html", include_str!("page/how.html.j2")),
    ("budget.html", include_str!("page/budget.html.j2")),
    chart::TEMPLATE,
    chart::STYLE,
];

/// The report folder: the page, the finished record as `record.json`, each picture as PNG, each view as EXR; `timing.json`
/// where times are given.
#[derive(Debug, Clone, Copy, Default)]
pub struct HtmlReport;

impl Exporter for HtmlReport {
    fn export(&self, record: &Record, extras: &Extras) -> Result<Vec<Artifact>, ReportError> {
        check_shape(record)?;
        let views = figures(record, extras.views)?;
        let pictures = encode(&views)?;
        let page = Page::new(record, &views, extras.timing);
        let mut files = vec![Artifact::new(PAGE_NAME, render(&page, &pictures, viewer(record, extras)?.as_ref())?)];
        files.push(record_file(record)?);
        if !extras.timing.is_empty() {
            files.push(timing_file(extras.timing)?);
        }
        files.extend(chart::files(page.all_charts()));
        files.extend(pictures);
        for (view, shown) in extras.views.iter().zip(&views) {
            files.push(Artifact::new(format!("{}.exr", shown.stem), exr_layers(record, &view.visibility)?));
        }
        Ok(files)
    }
}

/// Every picture as PNG, under its name in the folder.
fn encode(views: &[ViewFigures]) -> Result<Vec<Artifact>, ReportError> {
    let all = views.iter().flat_map(|v| v.figures.iter().map(move |f| (v, f)));
    let one = |(v, f): (&ViewFigures, &super::Figure)| {
        let bytes = png(f.raster.width, f.raster.height, &f.raster.rgba)?;
        Ok(Artifact::new(pictures::picture_name(&v.stem, f.kind), bytes))
    };
    all.map(one).collect()
}

/// The scene to turn, through the cameras of the pictures.
fn viewer(record: &Record, extras: &Extras) -> Result<Option<Parts>, ReportError> {
    let seen: Vec<Camera> = extras.views.iter().map(|v| v.visibility.camera().clone()).collect();
    let cameras = if seen.is_empty() { &record.stage.cameras } else { &seen };
    Ok(scene_view(record, cameras).map(|v| Parts::of(&v)).transpose()?)
}

/// Fills in the page; everything that is not markup of the template is escaped.
fn render(page: &Page, pictures: &[Artifact], viewer: Option<&Parts>) -> Result<String, ReportError> {
    let uris = inlined(pictures);
    let library = chart::Library::for_charts(page.all_charts().next().is_some());
    let templates = TEMPLATES.into_iter().chain(scene3d::TEMPLATES);
    filled(templates, "page.html", context! { page, uris, viewer, library })
}

#[cfg(test)]
mod tests;
