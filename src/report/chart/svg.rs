//! The drawing for print: SVG that needs nothing from outside, on white.

use super::axis::{Placed, log_ends};
use super::draw::draw;
use super::labels::labels;
use super::legend::Legend;
use super::{Chart, Scale, Shape};
use std::fmt::Write;

/// Size of the drawing without its legend.
pub(super) const WIDTH: f64 = 720.0;
pub(super) const HEIGHT: f64 = 440.0;
/// Room around the axes.
pub(super) const LEFT: f64 = 76.0;
pub(super) const RIGHT: f64 = 22.0;
pub(super) const TOP: f64 = 46.0;
pub(super) const BOTTOM: f64 = 58.0;
/// Room for points at no cost, which no logarithm has.
const GUTTER: f64 = 46.0;
/// A line across so many times below the least value is not drawn to scale.
const FAR_BELOW: f64 = 50.0;
/// Letters of the title.
const TITLE: usize = 84;

/// Ends of both axes: where a logarithmic one would lie, if there can be one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub x_log: Option<(f64, f64)>,
    pub y_log: Option<(f64, f64)>,
}

/// Both axes, and where points at no cost stand.
pub(super) struct Frame {
    pub x: Placed,
    pub y: Placed,
    pub gutter: Option<f64>,
}

impl Frame {
    /// Place along the x axis; points at no cost stand in the margin.
    pub(super) fn x(&self, x: f64) -> f64 {
        if x > 0.0 || !self.x.is_log() { self.x.place(x) } else { self.gutter.unwrap_or(self.x.from) }
    }
}

/// Ends of logarithmic axes; `None` where no point can be placed on the axes as they are.
pub(super) fn ends(chart: &Chart) -> Option<Ends> {
    chart.dots().next()?;
    let negative = chart.dots().any(|d| d.x < 0.0) || chart.has_bars();
    let x_log = if negative { None } else { log_ends(chart.dots().map(|d| d.x)) };
    // An interval may reach far: it is cut where it would press the chart together.
    let ends = chart.dots().flat_map(|d| {
        let (low, high) = d.interval.unwrap_or((d.y, d.y));
        [d.y, low.max(0.3 * d.y), if d.y > 0.0 { high.min(3.0 * d.y) } else { 0.0 }]
    });
    // What lies far below every value would press the chart together: it is named at the lower end.
    let least = chart.dots().map(|d| d.y).filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
    let rules = chart.rules.iter().map(|r| r.value).filter(|v| *v * FAR_BELOW >= least);
    let y_log = log_ends(ends.chain(rules));
    let missing = (chart.x.scale == Scale::Log && x_log.is_none()) || (chart.y.scale == Scale::Log && y_log.is_none());
    (!missing).then_some(Ends { x_log, y_log })
}

fn placed(axis: &super::Axis, log: Option<(f64, f64)>, from: f64, to: f64) -> Option<Placed> {
    let (low, high) = match &axis.scale {
        Scale::Log => log?,
        Scale::Linear { low, high, .. } => (*low, *high),
        Scale::Names(names) => (-0.6, names.len() as f64 - 0.4),
    };
    Some(Placed { low, high, from, to, scale: axis.scale.clone(), unit: axis.unit })
}

impl Chart {
    fn frame(&self) -> Option<Frame> {
        let ends = ends(self)?;
        let at_no_cost = self.x.scale == Scale::Log && self.dots().any(|d| d.x <= 0.0);
        let left = if at_no_cost { LEFT + GUTTER } else { LEFT };
        Some(Frame {
            x: placed(&self.x, ends.x_log, left, WIDTH - RIGHT)?,
            y: placed(&self.y, ends.y_log, HEIGHT - BOTTOM, TOP)?,
            gutter: at_no_cost.then_some(LEFT + 0.4 * GUTTER),
        })
    }

    /// The drawing; `None` where no point can be placed.
    pub(in crate::report) fn svg(&self) -> Option<String> {
        let frame = self.frame()?;
        let legend = Legend::of(self);
        let height = HEIGHT + legend.height();
        let title = escaped(&self.title);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
             height=\"{height}\" role=\"img\" font-family=\"ui-sans-serif, system-ui, 'Segoe UI', Roboto, 'Helvetica \
             Neue', Arial, sans-serif\" font-size=\"12.5\" fill=\"#1c2024\">\n<title>{title}</title>\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" rx=\"10\" fill=\"#ffffff\"/>\n\
             <text x=\"{LEFT}\" y=\"27\" font-size=\"15\" font-weight=\"600\">{}</text>\n",
            escaped(&cut(&self.title, TITLE))
        );
        self.grid(&frame, &mut out);
        let (bars, others): (Vec<_>, Vec<_>) = self.series.iter().partition(|s| s.shape == Shape::Bars);
        bars.into_iter().for_each(|s| draw(s, &frame, &mut out));
        self.rules(&frame, &mut out);
        others.into_iter().for_each(|s| draw(s, &frame, &mut out));
        labels(self, &frame, &mut out);
        legend.draw(&mut out);
        out += "</svg>\n";
        Some(out)
    }

    fn grid(&self, f: &Frame, out: &mut String) {
        let (left, right, top, bottom) = (LEFT, WIDTH - RIGHT, TOP, HEIGHT - BOTTOM);
        let named = matches!(self.x.scale, Scale::Names(_));
        for (x, label) in f.x.marks() {
            if !named {
                let _ = writeln!(out, "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"{}\"/>", grey(label.is_some()));
            }
            let lines = label.map_or(Vec::new(), |l| if named { two_lines(&l) } else { vec![l] });
            for (k, line) in lines.iter().enumerate() {
                let y = bottom + 18.0 + 15.0 * k as f64;
                let _ =
                    writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{}</text>", escaped(line));
            }
        }
        for (y, label) in f.y.marks() {
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
        self.titles(out);
    }

    /// The axes' lines and names.
    fn titles(&self, out: &mut String) {
        let (left, right, top, bottom) = (LEFT, WIDTH - RIGHT, TOP, HEIGHT - BOTTOM);
        let _ = writeln!(
            out,
            "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"#5b636b\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#3d444b\">{}</text>\n\
             <text transform=\"translate(18 {:.1}) rotate(-90)\" text-anchor=\"middle\" fill=\"#3d444b\">{}</text>",
            0.5 * (left + right),
            bottom + 48.0,
            escaped(&self.x.title),
            0.5 * (top + bottom),
            escaped(&self.y.title)
        );
    }

    /// Lines across, with what they are.
    fn rules(&self, f: &Frame, out: &mut String) {
        for rule in &self.rules {
            let (y, right) = (f.y.place(rule.value), WIDTH - RIGHT);
            let below = if rule.value < f.y.low { " (below)" } else { "" };
            let _ = writeln!(
                out,
                "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#5b636b\" stroke-width=\"1.4\" stroke-dasharray=\"7 5\"/>"
            );
            if !rule.name.is_empty() {
                let _ = writeln!(
                    out,
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#5b636b\" font-size=\"11.5\" \
                     stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\">{}{below}</text>",
                    right - 6.0,
                    y - 5.0,
                    escaped(&rule.name)
                );
            }
        }
    }
}

fn grey(labelled: bool) -> &'static str {
    if labelled { "#e0ddd6" } else { "#f1efeb" }
}

/// A name on two lines, broken where it is most even.
fn two_lines(name: &str) -> Vec<String> {
    let middle = name.len() / 2;
    let blank = name.match_indices(' ').map(|(k, _)| k).min_by_key(|k| k.abs_diff(middle));
    match blank.filter(|_| name.len() > 14) {
        Some(k) => vec![name[..k].to_string(), name[k + 1..].to_string()],
        None => vec![name.to_string()],
    }
}

/// The first letters of a text.
pub(super) fn cut(text: &str, letters: usize) -> String {
    let mut short: String = text.chars().take(letters).collect();
    if short.len() < text.len() {
        short.push('\u{2026}');
    }
    short
}

/// Text that cannot be markup. Control characters, which XML has not, are shown as such.
pub(super) fn escaped(text: &str) -> String {
    let text = crate::report::format::printable(text);
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
