//! One drawing: errors on logarithmic axes, as SVG that needs nothing from outside.

use super::axis::{LogAxis, Unit};
use crate::metrics::{Point, Rate};
use std::fmt::Write;

/// Size of the drawing without its legend, pixels.
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 440.0;
/// Room around the axes.
const LEFT: f64 = 76.0;
const RIGHT: f64 = 22.0;
const TOP: f64 = 46.0;
const BOTTOM: f64 = 58.0;
/// Room for points at no cost, which no logarithm has.
const GUTTER: f64 = 46.0;
/// Height of a line of the legend.
const LEGEND: f64 = 21.0;
/// Beyond so many points a curve is drawn without bars, and with small marks.
const CROWD: usize = 40;
/// A noise floor so many times below the least error is not drawn to scale.
const FAR_BELOW: f64 = 50.0;
/// Letters of a name in the legend.
const LETTERS: usize = 76;
/// Colours that stay apart for colour-blind readers [Okabe & Ito 2008].
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b58900", "#56b4e9", "#4d4d4d"];

/// A curve to be drawn.
#[derive(Debug, Clone)]
pub(super) struct PlotLine {
    pub name: String,
    pub points: Vec<Point>,
    /// Its power law, drawn dotted and named in the legend.
    pub rate: Option<Rate>,
    /// Number of its colour.
    pub colour: usize,
    /// Drawn with dashes.
    pub dashed: bool,
}

/// A drawing to be made.
#[derive(Debug, Clone)]
pub(super) struct Plot {
    pub title: String,
    pub x_title: String,
    pub y_title: String,
    pub x_unit: Unit,
    pub lines: Vec<PlotLine>,
    /// Noise floor of the reference.
    pub floor: Option<f64>,
}

/// Both axes, and where points at no cost stand.
struct Frame {
    x: LogAxis,
    y: LogAxis,
    gutter: Option<f64>,
}

impl Plot {
    /// The drawing; `None` where no point can be placed.
    pub(super) fn svg(&self) -> Option<String> {
        let frame = self.frame()?;
        let height = HEIGHT + LEGEND * self.lines.len() as f64 + 8.0;
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
             height=\"{height}\" role=\"img\" font-family=\"ui-sans-serif, system-ui, 'Segoe UI', Roboto, 'Helvetica \
             Neue', Arial, sans-serif\" font-size=\"12.5\" fill=\"#1c2024\">\n<title>{}</title>\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" rx=\"10\" fill=\"#ffffff\"/>\n",
            escaped(&self.title)
        );
        let _ = writeln!(
            out,
            "<text x=\"{LEFT}\" y=\"27\" font-size=\"15\" font-weight=\"600\">{}</text>",
            escaped(&self.title)
        );
        self.grid(&frame, &mut out);
        self.floor(&frame, &mut out);
        for line in &self.lines {
            draw(line, &frame, &mut out);
        }
        for (k, line) in self.lines.iter().enumerate() {
            legend(line, HEIGHT + LEGEND * (k as f64 + 0.5), &mut out);
        }
        out += "</svg>\n";
        Some(out)
    }

    fn frame(&self) -> Option<Frame> {
        let points = || self.lines.iter().flat_map(|l| &l.points);
        let at_no_cost = points().any(|p| p.x <= 0.0);
        let left = if at_no_cost { LEFT + GUTTER } else { LEFT };
        let x = LogAxis::over(points().map(|p| p.x), left, WIDTH - RIGHT)?;
        // An interval may reach far down: it is cut where it would press the curve together.
        let deep = |p: &Point| p.error.low.max(0.3 * p.error.value);
        let ends = points().flat_map(|p| [p.error.value, deep(p), p.error.high.min(3.0 * p.error.value)]);
        // A floor far below every error would press the curves together: it is named at the lower end.
        let least = points().map(|p| p.error.value).filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
        let floor = self.floor.filter(|f| *f * FAR_BELOW >= least);
        let y = LogAxis::over(ends.chain(floor), HEIGHT - BOTTOM, TOP)?;
        Some(Frame { x, y, gutter: at_no_cost.then_some(LEFT + 0.4 * GUTTER) })
    }

    fn grid(&self, f: &Frame, out: &mut String) {
        let (left, right, top, bottom) = (LEFT, WIDTH - RIGHT, TOP, HEIGHT - BOTTOM);
        for (x, label) in f.x.marks(self.x_unit) {
            let _ = writeln!(out, "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"{}\"/>", grey(label.is_some()));
            if let Some(label) = label {
                let _ = writeln!(
                    out,
                    "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                    bottom + 18.0
                );
            }
        }
        for (y, label) in f.y.marks(Unit::Percent) {
            let _ = writeln!(out, "<path d=\"M{left} {y:.1}H{right}\" stroke=\"{}\"/>", grey(label.is_some()));
            if let Some(label) = label {
                let (x, y) = (left - 8.0, y + 4.0);
                let _ = writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{label}</text>");
            }
        }
        if let Some(x) = f.gutter {
            let from = f.x.from;
            let _ = writeln!(
                out,
                "<rect x=\"{left}\" y=\"{top}\" width=\"{GUTTER}\" height=\"{:.1}\" fill=\"#f4f2ee\"/>\n\
                 <path d=\"M{from:.1} {top}V{bottom}\" stroke=\"#c9c5bd\"/>\n\
                 <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">0</text>",
                bottom - top,
                bottom + 18.0
            );
        }
        let _ = writeln!(
            out,
            "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"#5b636b\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#3d444b\">{}</text>\n\
             <text transform=\"translate(18 {:.1}) rotate(-90)\" text-anchor=\"middle\" fill=\"#3d444b\">{}</text>",
            0.5 * (left + right),
            bottom + 42.0,
            escaped(&self.x_title),
            0.5 * (top + bottom),
            escaped(&self.y_title)
        );
    }

    fn floor(&self, f: &Frame, out: &mut String) {
        let Some(floor) = self.floor.filter(|v| *v > 0.0) else { return };
        let (y, right) = (f.y.place(floor), WIDTH - RIGHT);
        let below = if floor < f.y.low { " (below)" } else { "" };
        let _ = writeln!(
            out,
            "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#5b636b\" stroke-width=\"1.4\" stroke-dasharray=\"7 5\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#5b636b\" font-size=\"11.5\" stroke=\"#ffffff\" \
             stroke-width=\"3\" paint-order=\"stroke\">noise of the reference: {}{below}</text>",
            right - 6.0,
            y - 5.0,
            crate::report::format::percent(floor)
        );
    }
}

fn grey(labelled: bool) -> &'static str {
    if labelled { "#e0ddd6" } else { "#f1efeb" }
}

fn colour(line: &PlotLine) -> &'static str {
    COLOURS[line.colour % COLOURS.len()]
}

fn dashes(line: &PlotLine) -> &'static str {
    if line.dashed { " stroke-dasharray=\"6 4\"" } else { "" }
}

/// Band, fit, line, bars and marks of one curve.
fn draw(line: &PlotLine, f: &Frame, out: &mut String) {
    // An error of 0, its noise taken out, stands at the lower end: its interval still says something.
    let mut points: Vec<&Point> = line.points.iter().filter(|p| p.error.high > 0.0).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    let x = |p: &Point| if p.x > 0.0 { f.x.place(p.x) } else { f.gutter.unwrap_or(f.x.from) };
    // What reaches to 0 or below ends at the axis.
    let y = |v: f64| f.y.place(v.max(f.y.low));
    let paint = colour(line);
    let _ = writeln!(out, "<g stroke=\"{paint}\" fill=\"{paint}\">");
    if points.len() > 1 {
        let upper = points.iter().map(|p| format!("{:.1} {:.1}", x(p), y(p.error.high)));
        let lower = points.iter().rev().map(|p| format!("{:.1} {:.1}", x(p), y(p.error.low)));
        let band: Vec<String> = upper.chain(lower).collect();
        let _ = writeln!(out, "<path d=\"M{}Z\" stroke=\"none\" fill-opacity=\"0.14\"/>", band.join("L"));
        let path: Vec<String> = points.iter().map(|p| format!("{:.1} {:.1}", x(p), y(p.error.value))).collect();
        let (path, dashes) = (path.join("L"), dashes(line));
        let _ =
            writeln!(out, "<path d=\"M{path}\" fill=\"none\" stroke-width=\"1.8\" stroke-linejoin=\"round\"{dashes}/>");
    }
    if let Some(rate) = &line.rate {
        let at = |x: f64| (f.x.place(x), f.y.place((rate.intercept + rate.slope.value * x.ln()).exp()));
        let ((x0, y0), (x1, y1)) = (at(rate.range.0), at(rate.range.1));
        let _ = writeln!(
            out,
            "<path d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\" stroke-width=\"1.1\" stroke-dasharray=\"1.5 3\" fill=\"none\"/>"
        );
    }
    let crowded = points.len() > CROWD;
    for p in points {
        let (px, py) = (x(p), y(p.error.value));
        if !crowded && p.error.high > p.error.low {
            let _ = writeln!(
                out,
                "<path d=\"M{px:.1} {:.1}V{:.1}\" stroke-width=\"1.2\"/>",
                y(p.error.low),
                y(p.error.high)
            );
        }
        mark(line, px, py, if crowded { 1.8 } else { 3.6 }, out);
    }
    *out += "</g>\n";
}

/// A mark of its own shape for each colour: curves stay apart in black and white.
fn mark(line: &PlotLine, x: f64, y: f64, r: f64, out: &mut String) {
    let corners = |list: &[(f64, f64)]| {
        let list: Vec<String> = list.iter().map(|(a, b)| format!("{:.1} {:.1}", x + r * a, y + r * b)).collect();
        format!("<path d=\"M{}Z\" stroke=\"none\"/>", list.join("L"))
    };
    let shape = match line.colour % 4 {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r}\" stroke=\"none\"/>"),
        1 => corners(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
        2 => corners(&[(0.0, -1.25), (1.15, 0.9), (-1.15, 0.9)]),
        _ => corners(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
    };
    let _ = writeln!(out, "{shape}");
}

fn legend(line: &PlotLine, y: f64, out: &mut String) {
    let (paint, dashes) = (colour(line), dashes(line));
    let _ = writeln!(
        out,
        "<g stroke=\"{paint}\" fill=\"{paint}\"><path d=\"M{LEFT} {y:.1}h30\" stroke-width=\"1.8\"{dashes}/>"
    );
    mark(line, LEFT + 15.0, y, 3.6, out);
    let mut name: String = line.name.chars().take(LETTERS).collect();
    if name.len() < line.name.len() {
        name.push('\u{2026}');
    }
    let slope = line
        .rate
        .as_ref()
        .map_or(String::new(), |r| format!(" <tspan fill=\"#5b636b\">slope {}</tspan>", escaped(&slope_text(r))));
    let _ = writeln!(
        out,
        "</g><text x=\"{:.1}\" y=\"{:.1}\"><title>{}</title>{}{slope}</text>",
        LEFT + 40.0,
        y + 4.0,
        escaped(&line.name),
        escaped(&name)
    );
}

/// A slope with its interval: `-1.02 (-1.10 to -0.94)`.
pub(super) fn slope_text(rate: &Rate) -> String {
    let s = &rate.slope;
    let places = if s.high - s.low < 0.02 { 4 } else { 2 };
    format!("{:.places$} ({:.places$} to {:.places$})", s.value, s.low, s.high).replace('-', "\u{2212}")
}

/// Text that cannot be markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::fit_rate;
    use crate::stats::Estimate;

    fn plot(name: &str) -> Plot {
        let point = |x: f64, v: f64| Point {
            x,
            error: Estimate { value: v, std_err: Some(0.02 * v), low: 0.95 * v, high: 1.05 * v },
            floor: Some(1e-3),
        };
        let points: Vec<Point> =
            [(0.0, 0.9), (1.0, 0.5), (10.0, 0.05), (100.0, 0.005)].map(|(x, v)| point(x, v)).to_vec();
        let rate = fit_rate(&points, 0.95);
        let lines = vec![PlotLine { name: name.into(), points, rate, colour: 1, dashed: false }];
        let text = String::from;
        let (title, x_title, y_title) = (text("After edit 1"), text("shots"), text("error"));
        Plot { title, x_title, y_title, x_unit: Unit::Count, lines, floor: Some(1e-3) }
    }

    #[test]
    fn all_that_is_asked_for_is_drawn() {
        let svg = plot("mine").svg().expect("a drawing");
        for part in
            ["noise of the reference: 0.100 %", "stroke-dasharray=\"7 5\"", "slope \u{2212}1.00", ">0</text>", "mine"]
        {
            assert!(svg.contains(part), "{part}\n{svg}");
        }
        // Four marks and the legend's.
        assert_eq!(svg.matches("stroke=\"none\"/>").count(), 5);
    }

    #[test]
    fn a_name_stays_text() {
        let svg = plot("<script>&\"").svg().expect("a drawing");
        assert!(!svg.contains("<script") && svg.contains("&lt;script&gt;&amp;&quot;"));
    }

    #[test]
    fn nothing_to_place_is_no_drawing() {
        let mut p = plot("mine");
        p.lines[0].points.truncate(1);
        assert!(p.svg().is_none());
    }
}
