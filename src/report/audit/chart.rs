//! One chart of the page as SVG, in the page's own colours: light or dark as the reader has it.

use crate::report::curves::axis::{LogAxis, Unit};
use crate::report::format::{percent_exact, round_number};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Size, in units of the drawing.
const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 380.0;
/// Room around the axes.
const LEFT: f64 = 70.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 56.0;
/// Beyond so many points they are dots without bars, each place drawn once.
const CROWD: usize = 60;
/// Width of a letter and height of a line of labels, about.
const LETTER: f64 = 6.6;
const LINE: f64 = 14.0;

/// One axis.
#[derive(Debug, Clone, Copy)]
pub(super) enum Axis {
    /// Logarithmic, over what is drawn.
    Log(Unit),
    /// Linear between two ends, with a mark at every step.
    Linear { low: f64, high: f64, step: f64, unit: Unit },
}

/// A point with its interval, if it has one, and its label.
#[derive(Debug, Clone)]
pub(super) struct Dot {
    pub x: f64,
    pub y: f64,
    pub interval: Option<(f64, f64)>,
    pub label: Option<String>,
    /// What a reader sees who points at it.
    pub hint: String,
}

/// Points of one colour.
#[derive(Debug, Clone, Default)]
pub(super) struct Series {
    pub name: String,
    /// Class of its colour: `k0`, `k1`, ...
    pub class: String,
    pub dots: Vec<Dot>,
    /// Joined by a line.
    pub joined: bool,
    /// Ends of a fitted line, dotted.
    pub fit: Option<[(f64, f64); 2]>,
}

/// A chart to be drawn.
#[derive(Debug, Clone)]
pub(super) struct Chart {
    pub name: String,
    pub x: Axis,
    pub y: Axis,
    pub x_title: String,
    pub y_title: String,
    pub series: Vec<Series>,
    /// Lines across: value and what it is.
    pub rules: Vec<(f64, String)>,
}

/// An axis in its place.
enum Placed {
    Log(LogAxis, Unit),
    Linear { low: f64, high: f64, step: f64, unit: Unit, from: f64, to: f64 },
}

impl Placed {
    fn new(axis: Axis, values: impl Iterator<Item = f64>, from: f64, to: f64) -> Option<Self> {
        Some(match axis {
            Axis::Log(unit) => Self::Log(LogAxis::over(values, from, to)?, unit),
            Axis::Linear { low, high, step, unit } => Self::Linear { low, high, step, unit, from, to },
        })
    }

    fn place(&self, x: f64) -> f64 {
        match self {
            Self::Log(axis, _) => axis.place(x.max(axis.low)),
            Self::Linear { low, high, from, to, .. } => from + (to - from) * ((x - low) / (high - low)).clamp(0.0, 1.0),
        }
    }

    fn marks(&self) -> Vec<(f64, Option<String>)> {
        match self {
            Self::Log(axis, unit) => axis.marks(*unit),
            Self::Linear { low, high, step, unit, .. } => {
                let count = ((high - low) / step + 1e-9).floor() as u32;
                let value = |k: u32| low + f64::from(k) * step;
                let label = |x: f64| match unit {
                    Unit::Percent => percent_exact(x),
                    _ => round_number(x),
                };
                (0..=count).map(|k| (self.place(value(k)), Some(label(value(k))))).collect()
            }
        }
    }
}

impl Chart {
    /// The drawing; `None` where no point can be placed.
    pub(super) fn svg(&self) -> Option<String> {
        let dots = || self.series.iter().flat_map(|s| &s.dots);
        dots().next()?;
        let x = Placed::new(self.x, dots().map(|d| d.x), LEFT, WIDTH - RIGHT)?;
        let ends = dots().flat_map(|d| {
            let (low, high) = d.interval.unwrap_or((d.y, d.y));
            // An interval may reach far down: it is cut where it would press the chart together.
            [d.y, low.max(0.4 * d.y), high.min(2.5 * d.y)]
        });
        let rules = self.rules.iter().map(|r| r.0);
        let y = Placed::new(self.y, ends.chain(rules), HEIGHT - BOTTOM, TOP)?;
        let mut out = format!(
            "<svg class=\"chart\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">\n",
            escaped(&self.name)
        );
        self.grid(&x, &y, &mut out);
        for series in &self.series {
            draw(series, &x, &y, &mut out);
        }
        self.labels(&x, &y, &mut out);
        out += "</svg>";
        Some(out)
    }

    fn grid(&self, x: &Placed, y: &Placed, out: &mut String) {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for (at, label) in x.marks() {
            let class = if label.is_some() { "mark" } else { "mark faint" };
            let _ = writeln!(out, "<path class=\"{class}\" d=\"M{at:.1} {TOP}V{bottom}\"/>");
            if let Some(label) = label {
                let _ = writeln!(out, "<text class=\"m\" x=\"{at:.1}\" y=\"{:.1}\">{label}</text>", bottom + 18.0);
            }
        }
        for (at, label) in y.marks() {
            let class = if label.is_some() { "mark" } else { "mark faint" };
            let _ = writeln!(out, "<path class=\"{class}\" d=\"M{LEFT} {at:.1}H{right}\"/>");
            if let Some(label) = label {
                let _ = writeln!(out, "<text class=\"e\" x=\"{:.1}\" y=\"{:.1}\">{label}</text>", LEFT - 8.0, at + 4.5);
            }
        }
        for (value, name) in &self.rules {
            let at = y.place(*value);
            let _ = writeln!(
                out,
                "<path class=\"limit\" d=\"M{LEFT} {at:.1}H{right}\"/>\n<text class=\"e name\" x=\"{:.1}\" \
                 y=\"{:.1}\">{}</text>",
                right - 4.0,
                at - 5.0,
                escaped(name)
            );
        }
        let _ = writeln!(
            out,
            "<path class=\"axis\" d=\"M{LEFT} {TOP}V{bottom}H{right}\"/>\n\
             <text class=\"m name\" x=\"{:.1}\" y=\"{:.1}\">{}</text>\n\
             <text class=\"m name\" transform=\"translate(15 {:.1}) rotate(-90)\">{}</text>",
            0.5 * (LEFT + right),
            bottom + 42.0,
            escaped(&self.x_title),
            0.5 * (TOP + bottom),
            escaped(&self.y_title)
        );
    }

    /// Labels beside their points: on the side that is free, and none where no side is.
    fn labels(&self, x: &Placed, y: &Placed, out: &mut String) {
        let dots = || self.series.iter().flat_map(|s| &s.dots);
        let box_of = |cx: f64, cy: f64, half: f64| [cx - half, cx + half, cy - 6.0, cy + 6.0];
        let mut taken: Vec<[f64; 4]> = dots().map(|d| box_of(x.place(d.x), y.place(d.y), 6.0)).collect();
        taken.extend(self.rules.iter().map(|(value, name)| {
            let (at, width) = (y.place(*value), LETTER * name.chars().count() as f64);
            [WIDTH - RIGHT - width, WIDTH - RIGHT, at - LINE - 4.0, at + 1.0]
        }));
        for dot in dots() {
            let Some(label) = &dot.label else { continue };
            let (px, py, width) = (x.place(dot.x), y.place(dot.y), LETTER * label.chars().count() as f64);
            let sides = [
                ("", px + 9.0, py),
                ("e", px - 9.0, py),
                ("m", px, py - 15.0),
                ("m", px, py + 15.0),
                ("", px + 6.0, py - 13.0),
                ("", px + 6.0, py + 13.0),
                ("e", px - 6.0, py - 13.0),
                ("e", px - 6.0, py + 13.0),
                ("", px + 9.0, py - 26.0),
                ("", px + 9.0, py + 26.0),
            ];
            let place = |(class, at, cy): (&'static str, f64, f64)| {
                let left = match class {
                    "m" => at - 0.5 * width,
                    "e" => at - width,
                    _ => at,
                };
                let own = [left, left + width, cy - 0.5 * LINE, cy + 0.5 * LINE];
                let inside = own[0] > LEFT && own[1] < WIDTH - 2.0 && own[2] > 0.0 && own[3] < HEIGHT - BOTTOM;
                let free = |b: &[f64; 4]| own[1] < b[0] || b[1] < own[0] || own[3] < b[2] || b[3] < own[2];
                (inside && taken.iter().all(free)).then_some((class, at, cy, own))
            };
            if let Some((class, at, cy, own)) = sides.into_iter().find_map(place) {
                taken.push(own);
                let y = cy + 4.5;
                let _ =
                    writeln!(out, "<text class=\"{class} tag\" x=\"{at:.1}\" y=\"{y:.1}\">{}</text>", escaped(label));
            }
        }
    }
}

fn draw(series: &Series, x: &Placed, y: &Placed, out: &mut String) {
    let _ = writeln!(out, "<g class=\"{}\">", series.class);
    let at = |d: &Dot| (x.place(d.x), y.place(d.y));
    if series.joined && series.dots.len() > 1 {
        let path: Vec<String> = series.dots.iter().map(|d| format!("{:.1} {:.1}", at(d).0, at(d).1)).collect();
        let _ = writeln!(out, "<path class=\"line\" d=\"M{}\"/>", path.join("L"));
    }
    if let Some([a, b]) = series.fit {
        let (a, b) = ((x.place(a.0), y.place(a.1)), (x.place(b.0), y.place(b.1)));
        let _ = writeln!(out, "<path class=\"fit\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>", a.0, a.1, b.0, b.1);
    }
    if series.dots.len() > CROWD {
        let halves = |d: &Dot| ((2.0 * at(d).0).round() as i64, (2.0 * at(d).1).round() as i64);
        let places: BTreeSet<(i64, i64)> = series.dots.iter().map(halves).collect();
        let path: String = places.iter().map(|(a, b)| format!("M{} {}h0", 0.5 * *a as f64, 0.5 * *b as f64)).collect();
        let _ = writeln!(out, "<path class=\"crowd\" d=\"{path}\"/>");
    } else {
        for d in &series.dots {
            let (px, py) = at(d);
            if let Some((low, high)) = d.interval.filter(|(low, high)| high > low) {
                let _ = writeln!(out, "<path class=\"bar\" d=\"M{px:.1} {:.1}V{:.1}\"/>", y.place(low), y.place(high));
            }
            let hint = escaped(&d.hint);
            let _ = writeln!(out, "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"4.2\"><title>{hint}</title></circle>");
        }
    }
    *out += "</g>\n";
}

/// Text that cannot be markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(x: f64, y: f64, label: &str) -> Dot {
        Dot { x, y, interval: Some((0.9 * y, 1.1 * y)), label: Some(label.into()), hint: label.into() }
    }

    fn chart(dots: Vec<Dot>) -> Chart {
        Chart {
            name: "<b>".into(),
            x: Axis::Log(Unit::Plain),
            y: Axis::Log(Unit::Percent),
            x_title: "s".into(),
            y_title: "error".into(),
            series: vec![Series { class: "k0".into(), dots, ..Series::default() }],
            rules: vec![(0.01, "limit".into())],
        }
    }

    #[test]
    fn points_labels_and_the_limit_are_drawn() {
        let svg = chart(vec![dot(1.0, 0.1, "one & all"), dot(10.0, 0.01, "two")]).svg().expect("a chart");
        assert_eq!(svg.matches("<circle").count(), 2);
        for part in [">one &amp; all</text>", ">two</text>", "class=\"limit\"", ">limit</text>", "&lt;b&gt;"] {
            assert!(svg.contains(part), "{part}: {svg}");
        }
    }

    #[test]
    fn labels_do_not_cover_each_other() {
        let crowd: Vec<Dot> = (0..30).map(|k| dot(1.0 + 1e-3 * f64::from(k), 0.1, "the same place")).collect();
        let svg = chart(crowd).svg().expect("a chart");
        let shown = svg.matches("tag\"").count();
        assert!((1..=10).contains(&shown), "{shown}");
    }

    #[test]
    fn a_crowd_is_one_path_and_nothing_is_no_chart() {
        let svg = chart((0..500).map(|_| dot(2.0, 0.1, "x")).collect()).svg().expect("a chart");
        assert!(!svg.contains("<circle") && svg.matches("h0").count() == 1);
        assert!(chart(Vec::new()).svg().is_none());
        let linear = Axis::Linear { low: 0.0, high: 90.0, step: 15.0, unit: Unit::Plain };
        let svg = Chart { x: linear, ..chart(vec![dot(45.0, 0.1, "x")]) }.svg().expect("a chart");
        assert!(svg.contains(">75</text>") && svg.contains("cx=\"335.0\""), "{svg}");
    }
}
