//! How states, errors and costs are called.

use crate::metrics::{Rate, Reached};
use crate::report::format::{count, significant};
use crate::study::converge::{Axis, Metric, Noise};

/// "Before the first edit", "After edit 2".
pub(super) fn state_name(edit: usize, last: usize) -> String {
    match (edit, last) {
        (0, 0) => "The scene".into(),
        (0, _) => "Before the first edit".into(),
        (k, _) => format!("After edit {k}"),
    }
}

/// What an error is called.
pub(super) fn metric_name(metric: Metric) -> &'static str {
    match metric {
        Metric::Rms => "luminance error (eq. 7)",
        Metric::Top1 => "error of the 1 % that change most",
    }
}

/// The same where room is short.
pub(super) fn metric_short(metric: Metric) -> &'static str {
    match metric {
        Metric::Rms => "eq. 7",
        Metric::Top1 => "top 1 %",
    }
}

/// What is said of two sides.
pub(super) fn noise_word(noise: Noise) -> &'static str {
    match noise {
        Noise::Apart => "apart",
        Noise::Within => "within the noise",
    }
}

/// A cost at which a level is reached; in brackets with confidence.
pub(super) fn cost(reached: Reached, axis: Axis) -> String {
    let text = |x: f64| if axis.is_clock() { format!("{} s", significant(x, 3)) } else { count(x.round() as usize) };
    match (reached.by_value, reached.with_confidence) {
        (None, _) => "not reached".into(),
        (Some(x), None) => format!("{} (not sure)", text(x)),
        (Some(x), Some(y)) if x == y => text(x),
        (Some(x), Some(y)) => format!("{} ({})", text(x), text(y)),
    }
}

/// A slope with its interval: `-1.02 (-1.10 to -0.94)`.
pub(super) fn slope_text(rate: &Rate) -> String {
    let s = &rate.slope;
    let places = if s.high - s.low < 0.02 { 4 } else { 2 };
    format!("{:.places$} ({:.places$} to {:.places$})", s.value, s.low, s.high).replace('-', "\u{2212}")
}
