//! Stevens' curves as a chart [TR93 fig. 4].

use super::chart::{Axis, Block, Chart, Dot, Paint, Scale, Series, Shape, Unit, files};
use super::{Artifact, ReportError};
use crate::study::validate::BrightnessCurve;

/// Ends and marks of the axis of luminance, dB.
const DECIBELS: Scale = Scale::Linear { low: 0.0, high: 100.0, step: 10.0 };

/// The drawing and its table.
///
/// # Errors
/// [`ReportError`], which no data provokes.
pub fn brightness_files(curves: &[BrightnessCurve]) -> Result<Vec<Artifact>, ReportError> {
    let series = |(k, curve): (usize, &BrightnessCurve)| Series {
        name: format!("background of {} dB", curve.background),
        paint: Paint::Method(k),
        dashed: false,
        shape: Shape::Line,
        dots: curve.points.iter().map(dot).collect(),
        fit: None,
    };
    let chart = Chart {
        stem: "brightness".into(),
        title: "Brightness before backgrounds".into(),
        caption: "After Stevens and Stevens: the eye is adapted to the background; 0 dB is 1e-10 lamberts.".into(),
        x: Axis {
            title: "luminance of the target, dB".into(),
            column: "target_db".into(),
            unit: Unit::Plain,
            scale: DECIBELS,
        },
        y: Axis { title: "brightness, brils".into(), column: "brils".into(), unit: Unit::Plain, scale: Scale::Log },
        series: curves.iter().enumerate().map(series).collect(),
        rules: Vec::new(),
        more: Vec::new(),
    };
    Ok(files(&Block::of(&chart).into_iter().collect::<Vec<_>>()))
}

fn dot(point: &(f64, f64)) -> Dot {
    let (x, y) = *point;
    Dot { x, y, ..Dot::default() }
}
