//! Intervals drawn against a common axis.

use crate::report::MetricLine;
use serde::Serialize;

/// An interval as places on the axis, percent of its length, ready for an SVG.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Bar {
    pub low: String,
    pub width: String,
    pub value: String,
    pub limit: Option<String>,
    /// The zero line of a signed metric.
    pub zero: Option<String>,
    /// The value lies beyond the axis on the right.
    pub beyond: bool,
}

/// Right end of the axis that all bars share, as a fraction: the limits and what is judged by them fit; without
/// limits everything does.
pub(super) fn axis_end(lines: &[MetricLine]) -> Option<f64> {
    let reach =
        |l: &MetricLine| Some(l.estimate?.high.abs().max(l.estimate?.low.abs()).max(l.limit_value.unwrap_or(0.0)));
    let largest = |all: bool| {
        let kept = lines.iter().filter(|l| is_error(l) && (all || l.limit_value.is_some()));
        kept.filter_map(reach).filter(|r| r.is_finite() && *r > 0.0).reduce(f64::max)
    };
    largest(false).or_else(|| largest(true)).map(|r| 1.2 * r)
}

/// True for errors of light, which share an axis; a share of the picture is none.
fn is_error(line: &MetricLine) -> bool {
    line.key != "visible"
}

/// The bar of one metric; `None` where there is no estimate or it is no error of light.
pub(super) fn bar(line: &MetricLine, end: f64) -> Option<Bar> {
    let e = line.estimate.filter(|_| is_error(line))?;
    let signed = line.key == "bias";
    let place = |x: f64| {
        let along = if signed { 0.5 + 0.5 * x / end } else { x / end };
        100.0 * along.clamp(0.0, 1.0)
    };
    let text = |x: f64| format!("{x:.2}");
    Some(Bar {
        low: text(place(e.low)),
        // A hair's breadth stays visible.
        width: text((place(e.high) - place(e.low)).max(0.4)),
        value: text(place(e.value)),
        limit: line.limit_value.map(|l| text(place(l))),
        zero: signed.then(|| text(50.0)),
        beyond: e.value > end,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Verdict;
    use crate::report::metric_lines;
    use crate::report::testing::{record, with_verdict};

    #[test]
    fn the_axis_holds_the_limit_and_what_it_judges() {
        let lines = metric_lines(&with_verdict(Verdict::Pass));
        let end = axis_end(&lines).expect("an axis");
        assert!((end - 0.06).abs() < 1e-12);
        let rms = bar(&lines[0], end).expect("bar");
        assert_eq!((rms.limit.as_deref(), rms.value.as_str(), rms.beyond), (Some("83.33"), "22.35", false));
        let reflected = bar(&lines[1], end).expect("bar");
        assert!(reflected.beyond && reflected.limit.is_none());
        let bias = bar(&lines[2], end).expect("bar");
        assert_eq!((bias.zero.as_deref(), bias.value.as_str()), (Some("50.00"), "52.60"));
    }

    #[test]
    fn without_a_limit_the_axis_holds_everything() {
        let lines = metric_lines(&record());
        let end = axis_end(&lines).expect("an axis");
        assert!(lines.iter().filter_map(|l| bar(l, end)).all(|b| !b.beyond));
        assert_eq!(axis_end(&[]), None);
    }
}
