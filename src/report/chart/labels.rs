//! Labels beside their points: on the side that is free, and none where no side is.

use super::svg::{BOTTOM, Frame, HEIGHT, LEFT, RIGHT, WIDTH, escaped};
use super::{Chart, Dot};
use std::fmt::Write;

/// Width of a letter and height of a line, about.
const LETTER: f64 = 6.6;
const LINE: f64 = 14.0;

/// Left, right, top, bottom.
type Box = [f64; 4];

pub(super) fn labels(chart: &Chart, f: &Frame, out: &mut String) {
    let box_of = |cx: f64, cy: f64, half: f64| [cx - half, cx + half, cy - 6.0, cy + 6.0];
    let mut taken: Vec<Box> = chart.dots().map(|d| box_of(f.x(d.x), f.y.place(d.y), 6.0)).collect();
    taken.extend(chart.rules.iter().map(|r| {
        let (at, width) = (f.y.place(r.value), LETTER * r.name.chars().count() as f64);
        [WIDTH - RIGHT - width, WIDTH - RIGHT, at - LINE - 4.0, at + 1.0]
    }));
    for dot in chart.dots() {
        let Some(label) = &dot.label else { continue };
        let Some((anchor, x, y, own)) = place(dot, label, f, &taken) else { continue };
        taken.push(own);
        let _ = writeln!(
            out,
            "<text class=\"tag\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
            y + 4.5,
            escaped(label)
        );
    }
}

/// The first free place about a point.
fn place(dot: &Dot, label: &str, f: &Frame, taken: &[Box]) -> Option<(&'static str, f64, f64, Box)> {
    let (px, py, width) = (f.x(dot.x), f.y.place(dot.y), LETTER * label.chars().count() as f64);
    let sides = [
        ("start", px + 9.0, py),
        ("end", px - 9.0, py),
        ("middle", px, py - 15.0),
        ("middle", px, py + 15.0),
        ("start", px + 6.0, py - 13.0),
        ("start", px + 6.0, py + 13.0),
        ("end", px - 6.0, py - 13.0),
        ("end", px - 6.0, py + 13.0),
        ("start", px + 9.0, py - 26.0),
        ("start", px + 9.0, py + 26.0),
    ];
    sides.into_iter().find_map(|(anchor, at, cy)| {
        let left = match anchor {
            "middle" => at - 0.5 * width,
            "end" => at - width,
            _ => at,
        };
        let own = [left, left + width, cy - 0.5 * LINE, cy + 0.5 * LINE];
        let inside = own[0] > LEFT && own[1] < WIDTH - 2.0 && own[2] > 0.0 && own[3] < HEIGHT - BOTTOM;
        let free = |b: &Box| own[1] < b[0] || b[1] < own[0] || own[3] < b[2] || b[3] < own[2];
        (inside && taken.iter().all(free)).then_some((anchor, at, cy, own))
    })
}
