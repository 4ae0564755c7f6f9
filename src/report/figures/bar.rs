//! Colour bars, and what a scale leaves out.

use super::Unit;
use crate::render::{LinearRgb, Scale, to_srgb8};
use crate::report::format::{round_number, significant};

/// Colours along a drawn bar.
const BAR_STOPS: usize = 25;

/// A colour bar.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColourBar {
    /// Colours at equal steps from left to right, as `#rrggbb`.
    pub colours: Vec<String>,
    /// (place in percent, label).
    pub ticks: Vec<(String, String)>,
    /// Unit of the labels.
    pub unit: &'static str,
}

/// What a caption says of values that a scale does not reach.
pub(in crate::report) fn beyond_range(scale: &Scale) -> String {
    if scale.beyond > 0.0 {
        let share = significant(100.0 * scale.beyond, 2);
        format!(" {share} % of the area lies beyond the range and has its end colours.")
    } else {
        String::new()
    }
}

/// The bar of a scale.
pub(in crate::report) fn colour_bar(scale: &Scale, unit: Unit) -> ColourBar {
    let tick = |t: &crate::render::Tick| (round_number(100.0 * t.at), label(unit.1 * t.value, scale.low()));
    ColourBar {
        colours: scale.stops(BAR_STOPS).into_iter().map(hex).collect(),
        ticks: scale.ticks().iter().map(tick).collect(),
        unit: unit.0,
    }
}

/// A mark's label; signed on scales that reach below zero.
fn label(value: f64, low: f64) -> String {
    let plus = if value > 0.0 && low < 0.0 { "+" } else { "" };
    format!("{plus}{}", round_number(value))
}

fn hex(colour: LinearRgb) -> String {
    let [r, g, b] = colour.map(to_srgb8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
