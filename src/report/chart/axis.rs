//! Axes: their ends, their marks, and what the marks say.

use crate::report::format::{count, percent, percent_exact, round_number, significant};

/// What is counted along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Unit {
    /// Fractions, shown as percentages.
    Percent,
    /// Whole numbers.
    Count,
    /// Anything else, with the unit in the title.
    Plain,
}

impl Unit {
    /// A mark's label.
    fn label(self, x: f64) -> String {
        let text = match self {
            Self::Percent => percent_exact(x),
            Self::Count if x >= 1e9 => format!("{}G", round_number(x / 1e9)),
            Self::Count if x >= 1e6 => format!("{}M", round_number(x / 1e6)),
            Self::Count if x >= 1e5 => format!("{}k", round_number(x / 1e3)),
            Self::Count if x >= 1.0 => count(x.round() as usize),
            Self::Count | Self::Plain => round_number(x),
        };
        text.replace('-', "\u{2212}")
    }

    /// A value as it is read.
    pub(in crate::report) fn value(self, x: f64) -> String {
        match self {
            Self::Percent => percent(x),
            Self::Count => count(x.round() as usize),
            Self::Plain => significant(x, 4),
        }
    }

    /// What the page's script calls it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Percent => "percent",
            Self::Count => "count",
            Self::Plain => "plain",
        }
    }
}

/// How values lie along an axis.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) enum Scale {
    /// Logarithmic, over what is drawn.
    Log,
    /// Linear between two ends, with a mark at every step.
    Linear { low: f64, high: f64, step: f64 },
    /// Names at 0, 1, 2, ...
    Names(Vec<String>),
}

impl Scale {
    /// Linear from 0, with some room above `high`.
    pub(in crate::report) fn up_to(high: f64) -> Self {
        Self::Linear { low: 0.0, high: 1.08 * high, step: round_step(1.08 * high) }
    }
}

/// An axis of a chart.
#[derive(Debug, Clone)]
pub(in crate::report) struct Axis {
    /// What it shows, with its unit.
    pub title: String,
    /// Column of the table.
    pub column: String,
    pub unit: Unit,
    pub scale: Scale,
}

/// A round step of which about five make up `high`.
pub(in crate::report) fn round_step(high: f64) -> f64 {
    let power = 10f64.powf((high / 5.0).log10().floor());
    power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= high / 5.0).unwrap_or(10.0)
}

/// Ends of a logarithmic axis on which all of `values` fit, with some room; only those above 0 count.
pub(super) fn log_ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let above = values.filter(|v| *v > 0.0 && super::is_finite(*v));
    let (low, high) = above.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
    // A single value stands in the middle of a decade.
    let room = if high / low < 3.0 { 2.0 } else { 1.25 };
    (high > 0.0).then_some((low / room, high * room))
}

/// An axis in its place, in units of the drawing.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    pub low: f64,
    pub high: f64,
    pub from: f64,
    pub to: f64,
    pub scale: Scale,
    pub unit: Unit,
}

impl Placed {
    pub(super) fn is_log(&self) -> bool {
        self.scale == Scale::Log
    }

    /// Place of a value; what lies beyond an end stands there.
    pub(super) fn place(&self, x: f64) -> f64 {
        let share = if self.is_log() {
            (x.max(self.low) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (x - self.low) / (self.high - self.low)
        };
        self.from + (self.to - self.from) * share.clamp(0.0, 1.0)
    }

    /// Marks: place, and the label of those that have one.
    pub(super) fn marks(&self) -> Vec<(f64, Option<String>)> {
        match &self.scale {
            Scale::Log => self.log_marks(),
            Scale::Names(names) => {
                names.iter().enumerate().map(|(k, n)| (self.place(k as f64), Some(n.clone()))).collect()
            }
            Scale::Linear { step, .. } => {
                let (first, last) = ((self.low / step - 1e-9).ceil() as i64, (self.high / step + 1e-9).floor() as i64);
                let mark = |k: i64| (self.place(k as f64 * step), Some(self.unit.label(k as f64 * step)));
                (first..=last).map(mark).collect()
            }
        }
    }

    fn log_marks(&self) -> Vec<(f64, Option<String>)> {
        let decades = (self.high / self.low).log10();
        let labelled: &[u32] = if decades < 1.2 {
            &[1, 2, 3, 5, 7]
        } else if decades < 3.0 {
            &[1, 2, 5]
        } else {
            &[1]
        };
        let first = self.low.log10().floor() as i32;
        let last = self.high.log10().ceil() as i32;
        let mark = |(power, digit): (i32, u32)| {
            let x = f64::from(digit) * 10f64.powi(power);
            let label = labelled.contains(&digit) && (decades < 9.0 || power % 2 == 0);
            (self.low <= x && x <= self.high).then(|| (self.place(x), label.then(|| self.unit.label(x))))
        };
        (first..=last).flat_map(|p| (1..10).map(move |d| (p, d))).filter_map(mark).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(low: f64, high: f64) -> Placed {
        Placed { low, high, from: 0.0, to: 200.0, scale: Scale::Log, unit: Unit::Count }
    }

    #[test]
    fn places_are_logarithms() {
        let axis = log(1.0, 100.0);
        let places = [0.0, 1.0, 10.0, 100.0, 1e9].map(|x| axis.place(x));
        assert!(places.iter().zip([0.0, 0.0, 100.0, 200.0, 200.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{places:?}");
        let labels: Vec<String> = axis.marks().into_iter().filter_map(|(_, l)| l).collect();
        assert_eq!(labels, ["1", "2", "5", "10", "20", "50", "100"]);
        assert_eq!(axis.marks().len(), 19);
    }

    #[test]
    fn linear_marks_are_round_and_few() {
        let scale = Scale::Linear { low: -0.03, high: 0.05, step: 0.02 };
        let axis = Placed { low: -0.03, high: 0.05, scale, unit: Unit::Percent, ..log(0.0, 0.0) };
        let labels: Vec<String> = axis.marks().into_iter().filter_map(|(_, l)| l).collect();
        assert_eq!(labels, ["\u{2212}2 %", "0 %", "2 %", "4 %"]);
        assert!((axis.place(0.01) - 100.0).abs() < 1e-9);
        assert_eq!([0.4, 5.125, 1.0].map(round_step), [0.1, 2.0, 0.2]);
    }

    #[test]
    fn nothing_above_zero_has_no_ends() {
        assert!(log_ends([0.0, -1.0, f64::MAX].into_iter()).is_none());
        let (low, high) = log_ends([0.0, 5.0].into_iter()).expect("ends");
        assert!((low * high - 25.0).abs() < 1e-12);
        assert_eq!([3e6, 2e5, 3000.0].map(|x| Unit::Count.label(x)), ["3M", "200k", "3,000"]);
        assert_eq!((Unit::Percent.label(0.003), Unit::Plain.label(0.02)), ("0.3 %".into(), "0.02".into()));
    }
}
