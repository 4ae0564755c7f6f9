//! Logarithmic axes: their ends, their marks, and what the marks say.

use crate::report::format::{count, percent_exact, round_number};

/// What stands at the marks.
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
        match self {
            Self::Percent => percent_exact(x),
            Self::Count if x >= 1e9 => format!("{}G", round_number(x / 1e9)),
            Self::Count if x >= 1e6 => format!("{}M", round_number(x / 1e6)),
            Self::Count if x >= 1e5 => format!("{}k", round_number(x / 1e3)),
            Self::Count if x >= 1.0 => count(x.round() as usize),
            Self::Count | Self::Plain => round_number(x),
        }
    }
}

/// A logarithmic axis over some pixels.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) struct LogAxis {
    /// Ends in the quantity shown.
    pub low: f64,
    pub high: f64,
    /// Where they stand, pixels.
    pub from: f64,
    pub to: f64,
}

impl LogAxis {
    /// An axis on which all of `values` fit, with some room; only those above 0 count. `None` without any.
    pub(in crate::report) fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Option<Self> {
        let (low, high) = values
            .filter(|v| *v > 0.0 && v.is_finite())
            .fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
        if high == 0.0 {
            return None;
        }
        // A single value stands in the middle of a decade.
        let room = if high / low < 3.0 { 2.0 } else { 1.25 };
        Some(Self { low: low / room, high: high * room, from, to })
    }

    /// Place of a value, pixels; what lies beyond an end stands there.
    pub(in crate::report) fn place(&self, x: f64) -> f64 {
        let share = ((x / self.low).ln() / (self.high / self.low).ln()).clamp(0.0, 1.0);
        self.from + (self.to - self.from) * share
    }

    /// Marks: place, and the label of those that have one.
    pub(in crate::report) fn marks(&self, unit: Unit) -> Vec<(f64, Option<String>)> {
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
            (self.low <= x && x <= self.high).then(|| (self.place(x), label.then(|| unit.label(x))))
        };
        (first..=last).flat_map(|p| (1..10).map(move |d| (p, d))).filter_map(mark).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_logarithms() {
        let axis = LogAxis { low: 1.0, high: 100.0, from: 0.0, to: 200.0 };
        let places = [0.0, 1.0, 10.0, 100.0, 1e9].map(|x| axis.place(x));
        assert!(places.iter().zip([0.0, 0.0, 100.0, 200.0, 200.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{places:?}");
        let labels: Vec<String> = axis.marks(Unit::Count).into_iter().filter_map(|(_, l)| l).collect();
        assert_eq!(labels, ["1", "2", "5", "10", "20", "50", "100"]);
        assert_eq!(axis.marks(Unit::Count).len(), 19);
    }

    #[test]
    fn nothing_above_zero_is_no_axis() {
        assert!(LogAxis::over([0.0, -1.0].into_iter(), 0.0, 1.0).is_none());
        let one = LogAxis::over([0.0, 5.0].into_iter(), 0.0, 1.0).expect("an axis");
        assert!((one.place(5.0) - 0.5).abs() < 1e-12);
        assert_eq!([3e6, 2e5, 3000.0].map(|x| Unit::Count.label(x)), ["3M", "200k", "3,000"]);
        assert_eq!((Unit::Percent.label(0.003), Unit::Plain.label(0.02)), ("0.3 %".into(), "0.02".into()));
    }
}
