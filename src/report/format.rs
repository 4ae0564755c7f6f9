//! Numbers as people read them.

use crate::stats::Estimate;

/// A number with its interval, both rounded to the same place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Shown {
    pub value: String,
    /// `None` for an exact number.
    pub interval: Option<String>,
}

/// Places after the point that show two figures of an uncertainty; `None` where plain notation would not do.
fn decimals(uncertainty: f64) -> Option<usize> {
    let places = 1.0 - uncertainty.log10().floor();
    (places.is_finite() && places <= 6.0).then_some(places.max(0.0) as usize)
}

/// Four significant figures, plain where that is short.
pub(super) fn number(x: f64) -> String {
    significant(x, 4)
}

/// `figures` significant figures, plain where that is short, else as 1.2e-7.
pub(super) fn significant(x: f64, figures: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { "0".into() } else { x.to_string() };
    }
    // Rounding first: 0.99996 has four figures as 1.000.
    let rounded: f64 = format!("{x:.*e}", figures - 1).parse().unwrap_or(x);
    let exponent = rounded.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        return format!("{x:.*e}", figures.min(3) - 1);
    }
    format!("{rounded:.*}", (figures as i32 - 1 - exponent).max(0) as usize)
}

/// Places after the point that show four figures of the largest number; `None` where plain notation would not do.
pub(super) fn places(numbers: &[f64]) -> Option<usize> {
    let largest = numbers.iter().filter(|x| x.is_finite()).fold(0.0, |m: f64, x| m.max(x.abs()));
    let exponent = largest.log10().floor();
    (-6.0..=6.0).contains(&exponent).then(|| (3.0 - exponent).max(0.0) as usize)
}

/// Numbers of one column, all to the same place; `sign` shows a plus.
pub(super) fn column(numbers: &[f64], places: Option<usize>, sign: bool) -> Vec<String> {
    let text = |x: f64| {
        let text = places.map_or_else(|| number(x), |p| format!("{x:.p$}"));
        // What rounds to nothing has no sign.
        let zero = is_zero(&text);
        let plain = if zero { text.trim_start_matches('-').to_string() } else { text };
        if sign && x > 0.0 && !zero { format!("+{plain}") } else { plain }
    };
    numbers.iter().map(|x| text(*x)).collect()
}

/// A standard error to the place of its column; two figures where the column has none.
pub(super) fn column_error(std_err: f64, places: Option<usize>) -> String {
    let Some(p) = places else { return significant(std_err, 2) };
    let text = format!("{std_err:.p$}");
    if is_zero(&text) && std_err > 0.0 { format!("<{}", round_number(10f64.powi(-(p as i32)))) } else { text }
}

/// A number with its sign and its standard error, both to the place of two figures of the error.
pub(super) fn with_error(value: f64, std_err: Option<f64>) -> String {
    let sign = |text: String| if value > 0.0 && !is_zero(&text) { format!("+{text}") } else { text };
    match std_err.filter(|e| *e > 0.0).and_then(|e| Some((e, decimals(e)?))) {
        Some((e, p)) => format!("{} \u{b1} {e:.p$}", sign(column(&[value], Some(p), false).remove(0))),
        None => sign(significant(value, 3)),
    }
}

fn is_zero(text: &str) -> bool {
    text.chars().all(|c| "-0.".contains(c))
}

/// A round number (a mark, a limit) without trailing zeros.
pub(super) fn round_number(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    // Ten figures keep what was typed and drop what binary fractions add.
    let cleaned: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    if (1e-4..1e7).contains(&cleaned.abs()) { cleaned.to_string() } else { format!("{cleaned:e}") }
}

/// A limit, as typed: 0.05 is `5 %`.
pub(super) fn percent_exact(x: f64) -> String {
    format!("{} %", round_number(100.0 * x))
}

/// A fraction as a percentage of three figures.
pub(super) fn percent(x: f64) -> String {
    format!("{} %", significant(100.0 * x, 3))
}

/// A confidence: at most two places.
pub(super) fn confidence(x: f64) -> String {
    let text = format!("{:.2}", 100.0 * x);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// False for an interval without end: a metric that could not be had.
pub(super) fn is_known(e: &Estimate) -> bool {
    [e.value, e.low, e.high].iter().all(|x| x.abs() < 1e300)
}

/// A fraction with its interval, as percentages; `sign` shows a plus.
pub(super) fn percent_estimate(e: &Estimate, sign: bool) -> Shown {
    if !is_known(e) {
        return Shown { value: "unknown".into(), interval: None };
    }
    let half_width = 50.0 * (e.high - e.low);
    let plain = |places: usize| move |x: f64| format!("{x:.places$}");
    let show: Box<dyn Fn(f64) -> String> = match decimals(half_width) {
        Some(places) if half_width > 0.0 => Box::new(plain(places)),
        _ => Box::new(|x| significant(x, 3)),
    };
    let with_sign = |x: f64| {
        let text = show(100.0 * x);
        // A negative number that rounds to nothing loses its sign.
        let zero = is_zero(&text);
        let text = if zero { text.trim_start_matches('-').to_string() } else { text };
        if sign && x > 0.0 && !zero { format!("+{text}") } else { text }
    };
    let interval = (e.high > e.low).then(|| format!("{} to {} %", with_sign(e.low), with_sign(e.high)));
    Shown { value: format!("{} %", with_sign(e.value)), interval }
}

/// A whole number in groups of three.
pub(super) fn count(n: usize) -> String {
    let digits = n.to_string();
    let grouped: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|c| std::str::from_utf8(c).ok()).collect();
    grouped.join(",")
}

/// Text without control characters: nothing in a name may steer a terminal.
pub(super) fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, low: f64, high: f64) -> Estimate {
        Estimate { value, std_err: Some(0.1), low, high }
    }

    #[test]
    fn value_and_interval_are_rounded_alike() {
        let s = percent_estimate(&estimate(0.013412, 0.012911, 0.013913), false);
        assert_eq!((s.value.as_str(), s.interval.as_deref()), ("1.341 %", Some("1.291 to 1.391 %")));
        let s = percent_estimate(&estimate(0.4, 0.2, 0.6), false);
        assert_eq!((s.value.as_str(), s.interval.as_deref()), ("40 %", Some("20 to 60 %")));
        let s = percent_estimate(&estimate(-0.0000001, -0.002, 0.0021), true);
        assert_eq!((s.value.as_str(), s.interval.as_deref()), ("0.00 %", Some("-0.20 to +0.21 %")));
    }

    #[test]
    fn exact_and_tiny_numbers() {
        let s = percent_estimate(&Estimate::exact(0.05), false);
        assert_eq!((s.value.as_str(), s.interval), ("5.00 %", None));
        assert_eq!(percent_estimate(&estimate(0.0, 0.0, 3e-11), false).interval.as_deref(), Some("0 to 3.00e-9 %"));
        let endless = Estimate { value: 0.0, std_err: None, low: 0.0, high: f64::MAX };
        assert_eq!(percent_estimate(&endless, false), Shown { value: "unknown".into(), interval: None });
        assert_eq!([0.95, 0.975, 0.99999, 1.0 - 0.05 / 3.0].map(confidence), ["95 %", "97.5 %", "100 %", "98.33 %"]);
        assert_eq!(percent(0.987), "98.7 %");
        assert_eq!(percent_exact(0.05), "5 %");
        assert_eq!(percent_exact(0.07), "7 %");
        assert_eq!(percent_exact(0.0125), "1.25 %");
    }

    #[test]
    fn four_figures() {
        let shown = [0.0, 1.0, 0.99996, 12.3456, 0.00012345, 1.2345e-9, -42.0, 1234567.0, 3.5e9].map(number);
        assert_eq!(shown, ["0", "1.000", "1.000", "12.35", "0.0001234", "1.23e-9", "-42.00", "1235000", "3.50e9"]);
        let shown = |x: &[f64], sign| column(x, places(x), sign);
        assert_eq!(shown(&[0.01245, -0.0089987, 0.0], true), ["+0.01245", "-0.00900", "0.00000"]);
        assert_eq!(shown(&[17.25, 0.5], false), ["17.25", "0.50"]);
        assert_eq!(shown(&[3e-9, f64::NAN], false), ["3.00e-9", "NaN"]);
        assert_eq!(column(&[-0.00004, 0.00004, 1.0], Some(4), true), ["0.0000", "0.0000", "+1.0000"]);
        assert_eq!([0.0139, 0.000086, 0.0].map(|e| column_error(e, Some(4))), ["0.0139", "0.0001", "0.0000"]);
        assert_eq!((column_error(0.00004, Some(4)), column_error(0.012345, None)), ("<0.0001".into(), "0.012".into()));
        assert_eq!(with_error(0.036_91, Some(0.0139)), "+0.037 \u{b1} 0.014");
        assert_eq!(with_error(-0.000_01, Some(0.02)), "0.000 \u{b1} 0.020");
        assert_eq!((with_error(-1.5, None), with_error(0.0, Some(0.0))), ("-1.50".into(), "0".into()));
        assert_eq!([0.1 + 0.2, 2e-9, -0.015].map(round_number), ["0.3", "2e-9", "-0.015"]);
        assert_eq!([0, 999, 1000, 12_700_000].map(count), ["0", "999", "1,000", "12,700,000"]);
    }

    #[test]
    fn escape_sequences_do_not_reach_a_terminal() {
        assert_eq!(printable("a\u{1b}[31mb\nc"), "a\u{fffd}[31mb\u{fffd}c");
    }
}
