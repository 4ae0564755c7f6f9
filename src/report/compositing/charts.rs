//! Charts of the error of edges: by sub-scanlines and by scale.

use super::rows::estimate;
use crate::report::chart::{Block, Chart, Dot, Fit, Series, Unit};
use crate::report::format::{count, round_number, significant};
use crate::report::plots::{axis, chart, columns, count_cell, dot, errors, limit, line, percent_cell};
use crate::study::compositing::{CompositingRecord, EdgeRow};

/// Power of the guide: that of the trapezoids of [NINT89 eq. 1] where what they sum is smooth.
const ORDER: f64 = 2.0;

/// Charts that have points. None of them depends on the clock.
pub(super) fn charts(record: &CompositingRecord) -> Vec<Block> {
    [antialiasing(record), scales(record)].iter().flatten().filter_map(Block::of).collect()
}

fn lines(n: u32) -> String {
    format!("{} {}", count(n as usize), if n == 1 { "sub-scanline" } else { "sub-scanlines" })
}

/// An error at `x` with what else is known of its picture.
fn edge(x: f64, r: &EdgeRow) -> Dot {
    let place = format!("at {}, scale {}", lines(r.sub_scanlines), round_number(r.scale));
    let more = vec![percent_cell(Some(r.off_by_a_step)), count_cell(r.segments), count_cell(r.bytes)];
    Dot { more, ..dot(x, &estimate(&r.error), &place) }
}

fn more() -> Vec<(String, &'static str)> {
    columns(&[("off_by_a_step", "pixels off by a step"), ("segments", "segments"), ("bytes", "bytes")])
}

/// From the first point that has an error, down as far as points go.
fn guide(dots: &[Dot]) -> Option<Fit> {
    let known = || dots.iter().filter(|d| d.x > 0.0 && d.y > 0.0);
    let first = known().min_by(|a, b| a.x.total_cmp(&b.x))?;
    let (far, least) = known().fold((first.x, first.y), |(x, y), d| (x.max(d.x), y.min(d.y)));
    // A line that leaves the axes would be bent at their end.
    let x = far.min(first.x * (first.y / least).powf(1.0 / ORDER));
    let ends = [(first.x, first.y), (x, first.y * (first.x / x).powf(ORDER))];
    (x > first.x).then(|| Fit { ends, text: "dotted: second order".into() })
}

/// At scale 1, against the number of sub-scanlines.
fn antialiasing(record: &CompositingRecord) -> Option<Chart> {
    let dots: Vec<Dot> = record.edges.iter().map(|r| edge(f64::from(r.sub_scanlines), r)).collect();
    let fit = guide(&dots);
    let mut caption = String::from("One colour a face, against rays; intervals are those of 95 %.");
    if let Some(rate) = record.rate {
        caption += &format!(" The error falls with the power {} of their number.", significant(rate, 3));
    }
    let x = axis("sub-scanlines per scanline", "sub_scanlines", Unit::Count);
    let title = "Error of edges against sub-scanlines";
    let all = vec![Series { fit, ..line("edges", 0, dots) }];
    let mut chart = chart("antialiasing", title, caption, [x, errors()], all)?;
    (chart.rules, chart.more) = (limit(record.limit), more());
    Some(chart)
}

/// Against the scale, one line for each number of sub-scanlines; at scale 1 the errors of the other chart.
fn scales(record: &CompositingRecord) -> Option<Chart> {
    let mut counts: Vec<u32> = record.scaled.iter().map(|r| r.sub_scanlines).collect();
    counts.sort_unstable();
    counts.dedup();
    let of = |(k, n): (usize, &u32)| {
        let both = record.edges.iter().chain(&record.scaled);
        let mut rows: Vec<&EdgeRow> = both.filter(|r| r.sub_scanlines == *n).collect();
        rows.sort_by(|a, b| a.scale.total_cmp(&b.scale));
        let all = rows.into_iter().map(|r| edge(r.scale, r)).collect();
        line(&lines(*n), k, all)
    };
    let all = counts.iter().enumerate().map(of).collect();
    let caption =
        "The same scans drawn at other sizes, without another pass for visibility, each against rays of its size.";
    let x = axis("scale in both directions", "scale", Unit::Plain);
    let mut chart = chart("scales", "Error of edges against scale", caption.into(), [x, errors()], all)?;
    (chart.rules, chart.more) = (limit(record.limit), more());
    Some(chart)
}
