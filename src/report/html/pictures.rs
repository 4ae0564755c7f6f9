//! The pictures of a view with their words, bars and marks.

use super::context::minus;
use crate::report::figures::{Figure, ViewFigures};
use crate::report::format::round_number;
use crate::report::{ColourBar, Mark};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct ViewBlock {
    pub title: String,
    pub fitted: bool,
    pub exr: String,
    pub figures: Vec<FigureBlock>,
}

#[derive(Debug, Serialize)]
pub(super) struct FigureBlock {
    pub id: String,
    pub kind: &'static str,
    pub title: &'static str,
    pub caption: String,
    pub alt: String,
    /// Name of the picture in the report's folder.
    pub file: String,
    pub width: u32,
    pub height: u32,
    pub bar: Option<BarBlock>,
    pub marks: Vec<MarkBlock>,
}

#[derive(Debug, Clone, Serialize)]
pub(in crate::report) struct BarBlock {
    pub stops: Vec<(String, String)>,
    pub ticks: Vec<(String, String)>,
    pub unit: &'static str,
}

#[derive(Debug, Serialize)]
pub(super) struct MarkBlock {
    pub rank: usize,
    pub number: usize,
    pub x: String,
    pub y: String,
    pub radius: String,
    pub font: String,
    /// False where a worse patch is so near that two labels would cover each other: a dot has to do.
    pub labelled: bool,
}

/// Name of a picture in the report's folder.
pub(super) fn picture_name(stem: &str, kind: &str) -> String {
    format!("{stem}-{kind}.png")
}

pub(super) fn view_block(view: &ViewFigures) -> ViewBlock {
    ViewBlock {
        title: view.camera.clone(),
        fitted: view.fitted,
        exr: format!("{}.exr", view.stem),
        figures: view.figures.iter().map(|f| figure_block(view, f)).collect(),
    }
}

fn figure_block(view: &ViewFigures, figure: &Figure) -> FigureBlock {
    FigureBlock {
        id: format!("{}-{}", view.stem, figure.kind),
        kind: figure.kind,
        title: figure.title,
        caption: minus(&figure.caption),
        alt: format!("{} seen by camera {}", figure.title, view.camera),
        file: picture_name(&view.stem, figure.kind),
        width: figure.raster.width,
        height: figure.raster.height,
        bar: figure.bar.as_ref().map(bar_block),
        // One picture with numbers is enough; the others are to be looked at.
        marks: if figure.kind == "difference" { mark_blocks(view, figure.raster.width) } else { Vec::new() },
    }
}

/// Labels sized to the picture, worst first.
fn mark_blocks(view: &ViewFigures, width: u32) -> Vec<MarkBlock> {
    let radius = f64::from(width) / 72.0;
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let mut block = |m: &Mark| {
        let free = kept.iter().all(|(x, y)| (x - m.x).hypot(y - m.y) > 2.0 * radius);
        if free {
            kept.push((m.x, m.y));
        }
        MarkBlock {
            rank: m.rank,
            number: m.number,
            x: format!("{:.1}", m.x),
            y: format!("{:.1}", m.y),
            radius: format!("{:.1}", if free { radius } else { 0.35 * radius }),
            font: format!("{:.1}", 1.2 * radius),
            labelled: free,
        }
    };
    view.marks.iter().map(&mut block).collect()
}

pub(in crate::report) fn bar_block(bar: &ColourBar) -> BarBlock {
    let last = bar.colours.len().max(2) - 1;
    let stop = |(k, colour): (usize, &String)| (round_number(100.0 * k as f64 / last as f64), colour.clone());
    BarBlock {
        stops: bar.colours.iter().enumerate().map(stop).collect(),
        ticks: bar.ticks.iter().map(|(at, label)| (at.clone(), minus(label))).collect(),
        unit: bar.unit,
    }
}
