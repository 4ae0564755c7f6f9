//! One series of a drawing: band, line, bars, marks.

use super::svg::{BOTTOM, Frame, HEIGHT, escaped};
use super::{Dot, Paint, Series, Shape};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Beyond so many points a line is drawn without bars, and with small marks.
const CROWD: usize = 40;
/// Beyond so many points that are not joined they are one path, each place drawn once.
const THRONG: usize = 400;

pub(super) fn draw(series: &Series, f: &Frame, out: &mut String) {
    let paint = series.paint.hex();
    let _ = writeln!(out, "<g stroke=\"{paint}\" fill=\"{paint}\">");
    match series.shape {
        Shape::Line => line(series, f, out),
        Shape::Dots => dots(series, f, out),
        Shape::Bars => series.dots.iter().for_each(|d| bar(d, f, out)),
        Shape::Steps => steps(series, f, out),
    }
    fit(series, f, out);
    *out += "</g>\n";
}

/// What reaches to 0 or below ends at the axis.
fn y(f: &Frame, value: f64) -> f64 {
    f.y.place(if f.y.is_log() { value.max(f.y.low) } else { value })
}

fn points(list: impl Iterator<Item = (f64, f64)>) -> String {
    list.map(|(x, y)| format!("{x:.1} {y:.1}")).collect::<Vec<_>>().join("L")
}

pub(super) fn dashes(series: &Series) -> &'static str {
    match (series.dashed, series.paint.is_again()) {
        (true, _) => " stroke-dasharray=\"6 4\"",
        (false, true) => " stroke-dasharray=\"2 3\"",
        (false, false) => "",
    }
}

fn line(series: &Series, f: &Frame, out: &mut String) {
    // An error of 0, its noise taken out, stands at the lower end: its interval still says something.
    let mut dots: Vec<&Dot> =
        series.dots.iter().filter(|d| d.y > 0.0 || d.interval.is_some_and(|i| i.1 > 0.0)).collect();
    dots.sort_by(|a, b| a.x.total_cmp(&b.x));
    if dots.len() > 1 {
        if dots.iter().any(|d| d.interval.is_some()) {
            let end = |d: &Dot, upper: bool| d.interval.map_or(d.y, |(low, high)| if upper { high } else { low });
            let upper = dots.iter().map(|d| (f.x(d.x), y(f, end(d, true))));
            let lower = dots.iter().rev().map(|d| (f.x(d.x), y(f, end(d, false))));
            let band = points(upper.chain(lower));
            let _ = writeln!(out, "<path d=\"M{band}Z\" stroke=\"none\" fill-opacity=\"0.14\"/>");
        }
        let path = points(dots.iter().map(|d| (f.x(d.x), y(f, d.y))));
        let dashes = dashes(series);
        let _ =
            writeln!(out, "<path d=\"M{path}\" fill=\"none\" stroke-width=\"1.8\" stroke-linejoin=\"round\"{dashes}/>");
    }
    let crowded = dots.len() > CROWD;
    for d in dots {
        if !crowded {
            whisker(d, f, out);
        }
        mark(series.paint, f.x(d.x), y(f, d.y), if crowded { 1.8 } else { 3.6 }, &d.hint, out);
    }
}

fn fit(series: &Series, f: &Frame, out: &mut String) {
    let Some(fit) = &series.fit else { return };
    let path = points(fit.ends.iter().map(|(a, b)| (f.x(*a), y(f, *b))));
    let _ = writeln!(out, "<path d=\"M{path}\" stroke-width=\"1.1\" stroke-dasharray=\"1.5 3\" fill=\"none\"/>");
}

fn dots(series: &Series, f: &Frame, out: &mut String) {
    if series.dots.len() > THRONG {
        let halves = |d: &Dot| ((2.0 * f.x(d.x)).round() as i64, (2.0 * y(f, d.y)).round() as i64);
        let places: BTreeSet<(i64, i64)> = series.dots.iter().map(halves).collect();
        let path: String = places.iter().map(|(a, b)| format!("M{} {}h0", 0.5 * *a as f64, 0.5 * *b as f64)).collect();
        let _ = writeln!(
            out,
            "<path fill=\"none\" stroke-width=\"3.6\" stroke-linecap=\"round\" stroke-opacity=\"0.6\" d=\"{path}\"/>"
        );
        return;
    }
    for d in &series.dots {
        whisker(d, f, out);
        mark(series.paint, f.x(d.x), y(f, d.y), if series.dots.len() > CROWD { 2.2 } else { 3.8 }, &d.hint, out);
    }
}

fn bar(d: &Dot, f: &Frame, out: &mut String) {
    let (from, to) = (f.x(d.x - 0.5 * d.width), f.x(d.x + 0.5 * d.width));
    let bottom = HEIGHT - BOTTOM;
    // What is there at all stays visible.
    let top = if d.y > 0.0 { y(f, d.y).min(bottom - 1.0) } else { bottom };
    let gap = (0.06 * (to - from)).min(1.0);
    let _ = writeln!(
        out,
        "<rect x=\"{:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" stroke=\"none\"><title>{}</title></rect>",
        from + gap,
        to - from - 2.0 * gap,
        bottom - top,
        escaped(&d.hint)
    );
    if let Some((low, high)) = d.interval.filter(|(low, high)| high > low) {
        let (x, low, high) = (0.5 * (from + to), y(f, low), y(f, high));
        let _ = writeln!(
            out,
            "<path d=\"M{x:.1} {low:.1}V{high:.1}M{:.1} {low:.1}h12M{:.1} {high:.1}h12\" stroke=\"#1c2024\" \
             stroke-width=\"1.4\" fill=\"none\"/>",
            x - 6.0,
            x - 6.0
        );
    }
}

fn steps(series: &Series, f: &Frame, out: &mut String) {
    let step = |d: &Dot| {
        let (from, to, y) = (f.x(d.x - 0.5 * d.width), f.x(d.x + 0.5 * d.width), y(f, d.y));
        format!("{from:.1} {y:.1}H{to:.1}")
    };
    let path: Vec<String> = series.dots.iter().map(step).collect();
    let _ =
        writeln!(out, "<path d=\"M{}\" fill=\"none\" stroke-width=\"1.6\" stroke-linejoin=\"round\"/>", path.join("L"));
}

fn whisker(d: &Dot, f: &Frame, out: &mut String) {
    if let Some((low, high)) = d.interval.filter(|(low, high)| high > low) {
        let _ = writeln!(out, "<path d=\"M{:.1} {:.1}V{:.1}\" stroke-width=\"1.2\"/>", f.x(d.x), y(f, low), y(f, high));
    }
}

/// A mark of its own shape for each colour; pointing at it in a viewer says what it is.
pub(super) fn mark(paint: Paint, x: f64, y: f64, r: f64, hint: &str, out: &mut String) {
    let title = if hint.is_empty() { String::new() } else { format!("<title>{}</title>", escaped(hint)) };
    let corners = |list: &[(f64, f64)]| {
        let path = points(list.iter().map(|(a, b)| (x + r * a, y + r * b)));
        format!("<path d=\"M{path}Z\" stroke=\"none\">{title}</path>")
    };
    let shape = match paint.mark() {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r}\" stroke=\"none\">{title}</circle>"),
        1 => corners(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
        2 => corners(&[(0.0, -1.25), (1.15, 0.9), (-1.15, 0.9)]),
        3 => corners(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
        4 => corners(&[(0.0, 1.25), (1.15, -0.9), (-1.15, -0.9)]),
        _ => corners(&[
            (-0.4, -1.2),
            (0.4, -1.2),
            (0.4, -0.4),
            (1.2, -0.4),
            (1.2, 0.4),
            (0.4, 0.4),
            (0.4, 1.2),
            (-0.4, 1.2),
            (-0.4, 0.4),
            (-1.2, 0.4),
            (-1.2, -0.4),
            (-0.4, -0.4),
        ]),
    };
    let _ = writeln!(out, "{shape}");
}
