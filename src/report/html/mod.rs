//! One self-contained page: no network, no fonts, nothing but the file.

mod bars;
mod context;

use super::artifact::check_shape;
use super::figures::{ViewFigures, figures};
use super::layers::exr_layers;
use super::{Artifact, Exporter, Extras, ReportError, json_object};
use crate::io::image::png;
use crate::study::Record;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use context::Page;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, context};
use serde_json::json;
use std::collections::BTreeMap;

/// Name of the page in its folder.
pub const PAGE_NAME: &str = "report.html";

const TEMPLATE: &str = include_str!("page.html.j2");

/// The report folder: the page, its data as `record.json`, each picture as PNG, each view as EXR; `timing.json`
/// where times are given.
#[derive(Debug, Clone, Copy, Default)]
pub struct HtmlReport;

impl Exporter for HtmlReport {
    fn export(&self, record: &Record, extras: &Extras) -> Result<Vec<Artifact>, ReportError> {
        check_shape(record)?;
        let views = figures(record, extras.views)?;
        let pictures = encode(&views)?;
        let page = Page::new(record, &views, extras.timing);
        let mut files = vec![Artifact::new(PAGE_NAME, render(&page, &pictures)?)];
        files.push(json_file("record.json", &record_json(record, &views)?)?);
        if !extras.timing.is_empty() {
            files.push(json_file("timing.json", &timing_json(extras))?);
        }
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
        Ok(Artifact::new(context::picture_name(&v.stem, f.kind), bytes))
    };
    all.map(one).collect()
}

/// Fills in the page; everything that is not markup of the template is escaped.
fn render(page: &Page, pictures: &[Artifact]) -> Result<String, ReportError> {
    let uri = |a: &Artifact| (a.name.clone(), format!("data:image/png;base64,{}", STANDARD.encode(&a.bytes)));
    let uris: BTreeMap<String, String> = pictures.iter().map(uri).collect();
    let mut env = Environment::new();
    env.set_auto_escape_callback(|_| AutoEscape::Html);
    env.set_undefined_behavior(UndefinedBehavior::Strict);
    env.set_trim_blocks(true);
    env.set_lstrip_blocks(true);
    Ok(env.template_from_str(TEMPLATE)?.render(context! { page, uris })?)
}

/// The page's data, times left out, with the numbers it was made of.
fn record_json(record: &Record, views: &[ViewFigures]) -> Result<serde_json::Value, ReportError> {
    let page = serde_json::to_value(Page::new(record, views, &[]))?;
    Ok(json!({ "format": "etalon-report/1", "comparison": json_object(record)?, "page": page }))
}

fn timing_json(extras: &Extras) -> serde_json::Value {
    let phases: Vec<_> = extras.timing.iter().map(|p| json!({ "phase": p.name, "seconds": p.seconds })).collect();
    json!({ "format": "etalon-timing/1", "phases": phases })
}

fn json_file(name: &str, value: &serde_json::Value) -> Result<Artifact, ReportError> {
    let mut text = serde_json::to_string_pretty(value)?;
    text.push('\n');
    Ok(Artifact::new(name, text))
}

#[cfg(test)]
mod tests;
