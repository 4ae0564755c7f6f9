//! Which charts the page has.

use super::chart::{Axis, Chart, Dot, Series};
use crate::metrics::{Point, fit_rate};
use crate::report::curves::axis::Unit;
use crate::report::format::{confidence, count, percent, percent_exact, significant};
use crate::report::html::context::minus;
use crate::stats::Estimate;
use crate::study::audit::{At, AuditRecord, Form};
use serde::Serialize;

/// Ratios are drawn up to this; those beyond stand at the upper end.
const TOP_RATIO: f64 = 3.0;
/// Classes of pixels covered: upper ends and what they are called.
const COVERED: [(f64, &str); 5] = [
    (1.0, "less than a pixel"),
    (4.0, "1 to 4 pixels"),
    (16.0, "4 to 16"),
    (100.0, "16 to 100"),
    (f64::INFINITY, "100 and more"),
];

/// A chart with its words.
#[derive(Debug, Serialize)]
pub(super) struct ChartBlock {
    pub id: &'static str,
    pub title: String,
    pub caption: String,
    pub svg: String,
    /// (colour class, name), where there is more than one.
    pub legend: Vec<(String, String)>,
}

fn block(id: &'static str, caption: String, chart: &Chart) -> Option<ChartBlock> {
    let named = chart.series.iter().filter(|s| !s.dots.is_empty() && !s.name.is_empty());
    let legend: Vec<(String, String)> = named.map(|s| (s.class.clone(), minus(&s.name))).collect();
    Some(ChartBlock { id, title: chart.name.clone(), caption: minus(&caption), svg: chart.svg()?, legend })
}

/// Charts that do not depend on the clock.
pub(super) fn charts(record: &AuditRecord) -> Vec<ChartBlock> {
    [resolutions(record), ratios(record), rotations(record)].into_iter().flatten().collect()
}

fn limit(record: &AuditRecord) -> Vec<(f64, String)> {
    record.limit.map(|l| (l, format!("limit {}", percent_exact(l)))).into_iter().collect()
}

fn judged(x: f64, e: &Estimate, hint: String) -> Dot {
    Dot { x, y: e.value, interval: Some((e.low, e.high)), label: None, hint }
}

/// Error and aliasing, as two series over what is varied.
fn pair(all: &[At], what: &dyn Fn(f64) -> String) -> [Series; 2] {
    let error = |a: &At| a.wrong.rms.map(|e| judged(a.x, &e, format!("{}: {}", what(a.x), percent(e.value))));
    let aliasing = |a: &At| Dot {
        x: a.x,
        y: a.aliasing,
        interval: None,
        label: None,
        hint: format!("{}: {}", what(a.x), percent(a.aliasing)),
    };
    let series = |name: &str, class: &str, dots| Series {
        name: name.into(),
        class: class.into(),
        dots,
        joined: true,
        fit: None,
    };
    [
        series("error of reflected light (eq. 7)", "k0", all.iter().filter_map(error).collect()),
        series("aliasing in the form factors", "k1", all.iter().map(aliasing).collect()),
    ]
}

/// Both against resolution, with the fitted rate of aliasing.
fn resolutions(record: &AuditRecord) -> Option<ChartBlock> {
    if record.resolutions.len() < 2 {
        return None;
    }
    let [error, mut aliasing] = pair(&record.resolutions, &|x| format!("resolution {x}"));
    let point = |a: &At| Point { x: a.x, error: Estimate::exact(a.aliasing), floor: None };
    let points: Vec<Point> = record.resolutions.iter().map(point).collect();
    // The record holds the exponent; where its line runs is told by the same fit.
    aliasing.fit = record.rate.and(fit_rate(&points, record.confidence)).map(|rate| {
        let at = |x: f64| (x, (rate.intercept + rate.slope.value * x.ln()).exp());
        [at(rate.range.0), at(rate.range.1)]
    });
    let told = record.rate.map_or(String::new(), |r| {
        format!(
            " Aliasing goes as the power {:.2} of the resolution ({:.2} to {:.2}, at {}; dotted).",
            r.value,
            r.low,
            r.high,
            confidence(record.confidence)
        )
    });
    let mut rules = limit(record);
    if let Some(e) = record.infinite.rms.filter(|e| e.value > 0.0) {
        rules.push((e.value, format!("at infinite resolution {}", percent(e.value))));
    }
    let caption = format!("What more pixels do, and what they cannot mend.{told}");
    let chart = Chart {
        name: "Error against resolution".into(),
        x: Axis::Log(Unit::Count),
        y: Axis::Log(Unit::Percent),
        x_title: "resolution, pixels along the top's edge".into(),
        y_title: "error".into(),
        series: vec![error, aliasing],
        rules,
    };
    block("resolution", caption, &chart)
}

/// The class of a number of pixels.
fn class_of(pixels: f64) -> usize {
    COVERED.iter().position(|c| pixels < c.0).unwrap_or(COVERED.len() - 1)
}

/// Hemi-cube over exact value for every receiver of the first source.
fn ratios(record: &AuditRecord) -> Option<ChartBlock> {
    let source = record.sources.first()?;
    let seeing = || record.views.iter().filter(|v| v.point > 0.0);
    let mut series: Vec<Series> = (COVERED.iter().enumerate())
        .map(|(k, c)| Series { name: c.1.into(), class: format!("p{k}"), ..Series::default() })
        .collect();
    for v in seeing() {
        let ratio = v.cube / v.point;
        let hint = format!("patch {} on {}: {}", v.patch, v.surface, significant(ratio, 3));
        let dot = Dot { x: v.distance, y: ratio.min(TOP_RATIO), interval: None, label: None, hint };
        series[class_of(v.pixels)].dots.push(dot);
    }
    let above = seeing().filter(|v| v.cube / v.point > TOP_RATIO).count();
    let unseen = record.views.iter().filter(|v| v.point == 0.0 && v.cube > 0.0).count();
    let highest = seeing().map(|v| v.cube / v.point).fold(1.0, f64::max).min(TOP_RATIO);
    let high = if highest <= 1.45 { 1.5 } else { (2.0 * highest + 0.2).ceil() / 2.0 };
    let mut caption = format!(
        "Form factor to \u{201c}{}\u{201d} by the hemi-cube over the exact value at the centre: one dot a receiver, \
         coloured by the pixels that the source covers there. 1 is right, 0 is missed.",
        source.source.name
    );
    if record.form == Form::Shooter {
        caption += " Pixels are those that a hemi-cube at the receiver would give it.";
    }
    if above > 0 {
        caption += &format!(" {} stand at the upper end and lie above.", count(above));
    }
    if unseen > 0 {
        caption += &format!(" {} more count it and do not see it.", count(unseen));
    }
    let chart = Chart {
        name: "Counted over exact, against distance".into(),
        x: Axis::Log(Unit::Plain),
        y: Axis::Linear { low: 0.0, high, step: if high > 2.0 { 0.5 } else { 0.25 }, unit: Unit::Plain },
        x_title: "distance from the middle of the source, m".into(),
        y_title: "hemi-cube / exact".into(),
        series,
        rules: vec![(1.0, String::new())],
    };
    block("ratio", caption, &chart)
}

/// Both under rotation about the normal.
fn rotations(record: &AuditRecord) -> Option<ChartBlock> {
    if record.rotations.len() < 2 {
        return None;
    }
    let series = pair(&record.rotations, &|x| format!("{} degrees", significant(x, 3)));
    let values = || series.iter().flat_map(|s| &s.dots).map(|d| d.y);
    let high = values().chain(record.limit).fold(0.0, f64::max);
    if high == 0.0 {
        return None;
    }
    let (least, most) = spread(&record.rotations);
    let caption = format!(
        "Every hemi-cube turned alike about its normal: the error of reflected light lies between {} and {}, by chance \
         of how the pixels fall.",
        percent(least),
        percent(most)
    );
    let step = step(1.1 * high);
    let chart = Chart {
        name: "Error under rotation".into(),
        x: Axis::Linear { low: 0.0, high: 90.0, step: 15.0, unit: Unit::Plain },
        y: Axis::Linear { low: 0.0, high: step * (1.1 * high / step).ceil(), step, unit: Unit::Percent },
        x_title: "rotation, degrees".into(),
        y_title: "error".into(),
        series: series.to_vec(),
        rules: limit(record),
    };
    block("rotation", caption, &chart)
}

fn spread(all: &[At]) -> (f64, f64) {
    let values = || all.iter().filter_map(|a| a.wrong.rms).map(|e| e.value);
    (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max))
}

/// A round step of which about four make up `high`.
fn step(high: f64) -> f64 {
    let power = 10f64.powf((high / 4.0).log10().floor());
    power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= high / 4.0).unwrap_or(10.0)
}
