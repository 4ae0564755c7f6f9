//! Which charts the page has.

use crate::metrics::{Point, fit_rate};
use crate::report::chart::{Axis, Block, Cell, Chart, Dot, Fit, Paint, Rule, Scale, Series, Shape, Unit};
use crate::report::format::{confidence, count, percent, percent_estimate, percent_exact, significant};
use crate::stats::Estimate;
use crate::study::audit::{At, AuditRecord, Form};

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

/// Charts that do not depend on the clock.
pub(super) fn charts(record: &AuditRecord) -> Vec<Block> {
    [resolutions(record), ratios(record), rotations(record)].iter().flatten().filter_map(Block::of).collect()
}

/// The limit as a line across.
pub(super) fn limit(record: &AuditRecord) -> Vec<Rule> {
    let rule = |l| Rule { value: l, name: format!("limit {}", percent_exact(l)) };
    record.limit.map(rule).into_iter().collect()
}

pub(super) fn errors(title: &str, column: &str, scale: Scale) -> Axis {
    Axis { title: title.into(), column: column.into(), unit: Unit::Percent, scale }
}

/// Error and aliasing, as two series over what is varied.
fn pair(all: &[At], what: &dyn Fn(f64) -> String) -> [Series; 2] {
    let error = |a: &At| {
        let e = a.wrong.rms?;
        let shown = percent_estimate(&e, false);
        let within = shown.interval.map_or(String::new(), |i| format!(" ({i})"));
        Some(Dot {
            x: a.x,
            y: e.value,
            std_err: e.std_err,
            interval: Some((e.low, e.high)),
            hint: format!("{}{within} at {}", shown.value, what(a.x)),
            ..Dot::default()
        })
    };
    let aliasing = |a: &At| Dot {
        x: a.x,
        y: a.aliasing,
        hint: format!("{} at {}", percent(a.aliasing), what(a.x)),
        ..Dot::default()
    };
    let series = |name: &str, k, dots| Series {
        name: name.into(),
        paint: Paint::Method(k),
        dashed: false,
        shape: Shape::Line,
        dots,
        fit: None,
    };
    [
        series("error of reflected light (eq. 7)", 0, all.iter().filter_map(error).collect()),
        series("aliasing in the form factors", 1, all.iter().map(aliasing).collect()),
    ]
}

/// Both against resolution, with the fitted rate of aliasing.
fn resolutions(record: &AuditRecord) -> Option<Chart> {
    if record.resolutions.len() < 2 {
        return None;
    }
    let [error, mut aliasing] = pair(&record.resolutions, &|x| format!("resolution {x}"));
    let point = |a: &At| Point { x: a.x, error: Estimate::exact(a.aliasing), floor: None };
    let points: Vec<Point> = record.resolutions.iter().map(point).collect();
    // The record holds the exponent; where its line runs is told by the same fit.
    aliasing.fit = record.rate.and(fit_rate(&points, record.confidence)).map(|rate| {
        let at = |x: f64| (x, (rate.intercept + rate.slope.value * x.ln()).exp());
        let text = record.rate.map_or(String::new(), |r| format!("power {:.2}", r.value).replace('-', "\u{2212}"));
        Fit { ends: [at(rate.range.0), at(rate.range.1)], text }
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
        rules.push(Rule { value: e.value, name: format!("at infinite resolution {}", percent(e.value)) });
    }
    let caption = format!("What more pixels do, and what they cannot mend.{told}");
    Some(Chart {
        stem: "resolution".into(),
        title: "Error against resolution".into(),
        caption,
        x: Axis {
            title: "resolution, pixels along the top's edge".into(),
            column: "resolution".into(),
            unit: Unit::Count,
            scale: Scale::Log,
        },
        y: errors("error", "error", Scale::Log),
        series: vec![error, aliasing],
        rules,
        more: Vec::new(),
    })
}

/// The class of a number of pixels.
fn class_of(pixels: f64) -> usize {
    COVERED.iter().position(|c| pixels < c.0).unwrap_or(COVERED.len() - 1)
}

/// Hemi-cube over exact value for every receiver of the first source.
fn ratios(record: &AuditRecord) -> Option<Chart> {
    let source = record.sources.first()?;
    let seeing = || record.views.iter().filter(|v| v.point > 0.0);
    let mut series: Vec<Series> = (COVERED.iter().enumerate())
        .map(|(k, c)| Series {
            name: c.1.into(),
            paint: Paint::Pixels(k),
            dashed: false,
            shape: Shape::Dots,
            dots: Vec::new(),
            fit: None,
        })
        .collect();
    for v in seeing() {
        let ratio = v.cube / v.point;
        let hint = format!(
            "{} at {} m: patch {} on {}, {} pixels covered",
            significant(ratio, 3),
            significant(v.distance, 3),
            v.patch,
            v.surface,
            significant(v.pixels, 3)
        );
        let number = |x| Cell::Number(Some(x), Unit::Plain);
        let more = vec![
            Cell::Text(v.patch.to_string()),
            Cell::Text(v.surface.clone()),
            number(v.pixels),
            number(v.cube),
            number(v.point),
            number(ratio),
        ];
        let dot = Dot { x: v.distance, y: ratio.min(TOP_RATIO), hint, more, ..Dot::default() };
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
    Some(Chart {
        stem: "ratio".into(),
        title: "Counted over exact, against distance".into(),
        caption,
        x: Axis {
            title: "distance from the middle of the source, m".into(),
            column: "distance".into(),
            unit: Unit::Plain,
            scale: Scale::Log,
        },
        y: Axis {
            title: "hemi-cube / exact".into(),
            column: "drawn_ratio".into(),
            unit: Unit::Plain,
            scale: Scale::Linear { low: 0.0, high, step: if high > 2.0 { 0.5 } else { 0.25 } },
        },
        series,
        rules: vec![Rule { value: 1.0, name: String::new() }],
        more: [
            ("patch", "patch"),
            ("surface", "surface"),
            ("pixels", "pixels covered"),
            ("hemicube", "hemi-cube"),
            ("exact", "exact"),
            ("ratio", "hemi-cube / exact"),
        ]
        .map(|(column, words)| (column.into(), words))
        .to_vec(),
    })
}

/// Both under rotation about the normal.
fn rotations(record: &AuditRecord) -> Option<Chart> {
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
    Some(Chart {
        stem: "rotation".into(),
        title: "Error under rotation".into(),
        caption,
        x: Axis {
            title: "rotation, degrees".into(),
            column: "degrees".into(),
            unit: Unit::Plain,
            scale: Scale::Linear { low: 0.0, high: 90.0, step: 15.0 },
        },
        y: errors("error", "error", Scale::up_to(high)),
        series: series.to_vec(),
        rules: limit(record),
        more: Vec::new(),
    })
}

fn spread(all: &[At]) -> (f64, f64) {
    let values = || all.iter().filter_map(|a| a.wrong.rms).map(|e| e.value);
    (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max))
}
