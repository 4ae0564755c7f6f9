//! The legend below a drawing: as many names in a line as fit.

use super::draw::{dashes, mark};
use super::svg::{HEIGHT, LEFT, RIGHT, WIDTH, cut, escaped};
use super::{Chart, Series, Shape};
use std::fmt::Write;

/// Height of a line.
const LINE: f64 = 21.0;
/// Letters of a name, and width of one, about.
const LETTERS: usize = 76;
const LETTER: f64 = 6.7;
/// Width of the mark with its room, and room after the name.
const MARK: f64 = 40.0;
const GAP: f64 = 22.0;

/// Entries with their places.
pub(super) struct Legend<'a> {
    entries: Vec<(&'a Series, f64, f64)>,
    lines: usize,
}

impl<'a> Legend<'a> {
    pub(super) fn of(chart: &'a Chart) -> Self {
        let (mut x, mut lines, mut entries) = (LEFT, 0, Vec::new());
        for s in chart.series.iter().filter(|s| !s.name.is_empty() && !s.dots.is_empty()) {
            let slope = s.fit.as_ref().map_or(0, |f| f.text.chars().count() + 1);
            let width = MARK + LETTER * (s.name.chars().count().min(LETTERS) + slope) as f64;
            if lines == 0 || x + width > WIDTH - RIGHT {
                (x, lines) = (LEFT, lines + 1);
            }
            entries.push((s, x, HEIGHT + LINE * (lines as f64 - 0.5) + 4.0));
            x += width + GAP;
        }
        Self { entries, lines }
    }

    pub(super) fn height(&self) -> f64 {
        if self.lines == 0 { 0.0 } else { LINE * self.lines as f64 + 12.0 }
    }

    pub(super) fn draw(&self, out: &mut String) {
        for (s, x, y) in &self.entries {
            let (paint, dashes) = (s.paint.hex(), dashes(s));
            let _ = writeln!(out, "<g stroke=\"{paint}\" fill=\"{paint}\">");
            if matches!(s.shape, Shape::Line | Shape::Steps) {
                let _ = writeln!(out, "<path d=\"M{x:.1} {y:.1}h30\" stroke-width=\"1.8\"{dashes}/>");
            }
            match s.shape {
                Shape::Bars => {
                    let _ = writeln!(
                        out,
                        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"18\" height=\"11\" stroke=\"none\"/>",
                        x + 6.0,
                        y - 5.5
                    );
                }
                Shape::Steps => {}
                Shape::Line | Shape::Dots => mark(s.paint, x + 15.0, *y, 3.6, "", out),
            }
            let slope = s
                .fit
                .as_ref()
                .map_or(String::new(), |f| format!(" <tspan fill=\"#5b636b\">{}</tspan>", escaped(&f.text)));
            let _ = writeln!(
                out,
                "</g><text x=\"{:.1}\" y=\"{:.1}\"><title>{}</title>{}{slope}</text>",
                x + MARK,
                y + 4.0,
                escaped(&s.name),
                escaped(&cut(&s.name, LETTERS))
            );
        }
    }
}
