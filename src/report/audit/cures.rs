//! What would mend it: every cure that was run, by its cost. All of this depends on the clock.

use super::charts::{errors, limit};
use crate::audit::Cure;
use crate::report::chart::{Axis, Block, Cell, Chart, Dot, Paint, Scale, Series, Shape, Unit};
use crate::report::format::{count, percent, percent_estimate, significant};
use crate::report::html::context::{class, minus};
use crate::report::number::{Number, number};
use crate::study::audit::{AuditRecord, CureRun};
use serde::Serialize;

/// Letters of a source's name above its column.
const LETTERS: usize = 24;

/// The cure table.
#[derive(Debug, Serialize)]
pub(super) struct Cures {
    /// Names of the sources that have a column each.
    pub sources: Vec<String>,
    pub rows: Vec<CureRow>,
    pub chart: Option<Block>,
    /// True where nothing was replaced by closed forms: then no points of exact visibility.
    pub any_points: bool,
}

/// A cure.
#[derive(Debug, Serialize)]
pub(super) struct CureRow {
    pub words: String,
    /// It is the hemi-cube as it is.
    pub plain: bool,
    pub rms: Number,
    pub top1: Number,
    pub class: &'static str,
    pub word: &'static str,
    pub seconds: String,
    pub times: String,
    pub hemicubes: String,
    pub pixels: String,
    pub points: String,
    /// What it leaves of each source's error, and whether that is within the limit.
    pub left: Vec<(String, bool)>,
}

/// The table; `None` where no cures were run.
pub(super) fn cures(record: &AuditRecord) -> Option<Cures> {
    if record.cures.is_empty() {
        return None;
    }
    Some(Cures {
        sources: record.sources.iter().map(|s| shortened(&s.source.name)).collect(),
        rows: record.cures.iter().map(|c| row(c, record)).collect(),
        chart: chart(record),
        any_points: record.cures.iter().any(|c| c.points > 0),
    })
}

/// A name that fits over a column.
fn shortened(name: &str) -> String {
    let short: String = name.chars().take(LETTERS).collect();
    if short.len() < name.len() { format!("{short}\u{2026}") } else { short }
}

fn row(c: &CureRun, record: &AuditRecord) -> CureRow {
    let plain = record.cures.iter().find(|c| c.cure == Cure::None).map(|c| c.seconds).filter(|s| *s > 0.0);
    let within = |e: f64| record.limit.is_some_and(|l| e <= l);
    CureRow {
        words: c.words.clone(),
        plain: c.cure == Cure::None,
        rms: number(c.wrong.rms.as_ref()),
        top1: number(c.wrong.top1.as_ref()),
        class: class(c.verdict),
        word: super::page::chip(c.verdict),
        seconds: significant(c.seconds, 3),
        times: plain.map_or(String::new(), |p| significant(c.seconds / p, 2)),
        hemicubes: count(c.hemicubes),
        pixels: count(c.pixels as usize),
        points: if c.points > 0 { count(c.points) } else { String::new() },
        left: c.by_source.iter().map(|e| (minus(&percent(*e)), within(*e))).collect(),
    }
}

/// What a cure is called where room is short.
fn tag(cure: &Cure) -> String {
    match cure {
        Cure::None => "as it is".into(),
        Cure::Resolution { resolution } => format!("resolution {resolution}"),
        Cure::Rotation => "turned".into(),
        Cure::Jitter => "jittered".into(),
        Cure::Subdivision { cells, .. } => format!("{cells} x {cells} parts"),
        Cure::Analytic { .. } => "closed forms".into(),
        Cure::SubdivisionAndAnalytic { cells, .. } => format!("closed forms, {cells} x {cells} parts"),
    }
}

/// Error against seconds.
fn chart(record: &AuditRecord) -> Option<Block> {
    let dot = |c: &CureRun| {
        let e = c.wrong.rms.filter(|e| e.value > 0.0)?;
        let shown = percent_estimate(&e, false);
        let within = shown.interval.map_or(String::new(), |i| format!(" ({i})"));
        let cost = |n: usize| Cell::Number(Some(n as f64), Unit::Count);
        Some(Dot {
            x: c.seconds,
            y: e.value,
            std_err: e.std_err,
            interval: Some((e.low, e.high)),
            label: Some(tag(&c.cure)),
            hint: format!("{}{within} in {} s: {}", shown.value, significant(c.seconds, 3), c.words),
            more: vec![Cell::Text(c.words.clone()), cost(c.hemicubes), cost(c.pixels as usize), cost(c.points)],
            ..Dot::default()
        })
    };
    let of = |plain: bool| record.cures.iter().filter(move |c| (c.cure == Cure::None) == plain).filter_map(dot);
    let series = |name: &str, k, dots| Series {
        name: name.into(),
        paint: Paint::Method(k),
        dashed: false,
        shape: Shape::Dots,
        dots,
        fit: None,
    };
    let caption = "Every dot is a run of the mended solver, judged like the hemi-cube itself; bars are the intervals. \
                   Lower is better, further left is cheaper.";
    Block::of(&Chart {
        stem: "cures".into(),
        title: "Error against cost".into(),
        caption: caption.into(),
        x: Axis {
            title: "seconds for the form factors".into(),
            column: "seconds".into(),
            unit: Unit::Plain,
            scale: Scale::Log,
        },
        y: errors("error of reflected light (eq. 7)", "error", Scale::Log),
        series: vec![series("as it is", 1, of(true).collect()), series("mended", 0, of(false).collect())],
        rules: limit(record),
        more: [("cure", "what is done"), ("hemicubes", "hemi-cubes"), ("pixels", "pixels"), ("points", "exact points")]
            .map(|(column, words)| (column.into(), words))
            .to_vec(),
    })
}
