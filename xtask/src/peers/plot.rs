//! Error against time as a picture: both axes logarithmic, a panel for each scene, a line for each tool.

use super::table::{Row, scenes};
use std::fmt::Write;

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 320.0;
const MARGIN: f64 = 56.0;
/// Colours that can be told apart by colour-blind readers (Okabe and Ito).
const COLOURS: [&str; 7] = ["#000000", "#e69f00", "#56b4e9", "#009e73", "#d55e00", "#cc79a7", "#0072b2"];

/// A logarithmic axis of whole decades.
struct Axis {
    low: i32,
    high: i32,
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>) -> Self {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        for v in values {
            low = low.min(v.log10().floor() as i32);
            high = high.max(v.log10().ceil() as i32);
        }
        if low > high { Self { low: 0, high: 1 } } else { Self { low, high: high.max(low + 1) } }
    }

    /// 0 at the low end, 1 at the high end.
    fn place(&self, value: f64) -> f64 {
        (value.log10() - f64::from(self.low)) / f64::from(self.high - self.low)
    }
}

/// The picture of all rows that have a time and an error above 0.
pub fn svg(rows: &[Row]) -> String {
    let names = scenes(rows);
    let mut tools: Vec<&str> = Vec::new();
    for (tool, ..) in names.iter().flat_map(|s| points(rows, s)) {
        if !tools.contains(&tool) {
            tools.push(tool);
        }
    }
    let (width, height) = (2.0 * WIDTH, (names.len().div_ceil(2) as f64) * HEIGHT + 30.0);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
    );
    for (k, name) in names.iter().enumerate() {
        let corner = ((k % 2) as f64 * WIDTH, (k / 2) as f64 * HEIGHT);
        panel(&mut out, corner, name, &points(rows, name), &tools);
    }
    for (k, tool) in tools.iter().enumerate() {
        let x = MARGIN + k as f64 * (width - MARGIN) / tools.len() as f64;
        let y = height - 12.0;
        let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"{}\"/>", y - 4.0, colour(k));
        let _ = writeln!(out, "<text x=\"{:.1}\" y=\"{y:.1}\">{}</text>", x + 8.0, escaped(tool));
    }
    out.push_str("</svg>\n");
    out
}

fn points<'a>(rows: &'a [Row], scene: &str) -> Vec<(&'a str, f64, f64)> {
    let here = rows.iter().filter(|r| r.scene == scene);
    let measured = here.filter_map(|r| Some((r.tool.as_str(), r.seconds?, r.rms?)));
    measured.filter(|&(_, s, e)| s > 0.0 && e > 0.0).collect()
}

fn panel(out: &mut String, corner: (f64, f64), name: &str, points: &[(&str, f64, f64)], tools: &[&str]) {
    let (time, error) = (Axis::over(points.iter().map(|p| p.1)), Axis::over(points.iter().map(|p| p.2)));
    let x = |s: f64| corner.0 + MARGIN + s * (WIDTH - MARGIN - 20.0);
    let y = |s: f64| corner.1 + HEIGHT - 46.0 - s * (HEIGHT - 80.0);
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" font-weight=\"bold\">{}</text>",
        x(0.0),
        y(1.0) - 10.0,
        escaped(name)
    );
    for decade in time.low..=time.high {
        let at = x(time.place(10f64.powi(decade)));
        rule(out, (at, y(0.0)), (at, y(1.0)));
        label(out, (at, y(0.0) + 16.0), "middle", &format!("1e{decade} s"));
    }
    for decade in error.low..=error.high {
        let at = y(error.place(10f64.powi(decade)));
        rule(out, (x(0.0), at), (x(1.0), at));
        label(out, (x(0.0) - 6.0, at + 4.0), "end", &format!("1e{decade}"));
    }
    label(out, (x(0.5), y(0.0) + 32.0), "middle", "wall time; upwards: RMS error of a form factor");
    for (k, tool) in tools.iter().enumerate() {
        let mut own: Vec<(f64, f64)> = points.iter().filter(|p| p.0 == *tool).map(|p| (p.1, p.2)).collect();
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        let places: Vec<(f64, f64)> = own.iter().map(|p| (x(time.place(p.0)), y(error.place(p.1)))).collect();
        let path: Vec<String> = places.iter().map(|p| format!("{:.1},{:.1}", p.0, p.1)).collect();
        let _ = writeln!(out, "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\"/>", path.join(" "), colour(k));
        for p in places {
            let _ = writeln!(out, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"{}\"/>", p.0, p.1, colour(k));
        }
    }
}

fn rule(out: &mut String, a: (f64, f64), b: (f64, f64)) {
    let ends = format!("x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\"", a.0, a.1, b.0, b.1);
    let _ = writeln!(out, "<line {ends} stroke=\"#dddddd\"/>");
}

fn label(out: &mut String, at: (f64, f64), anchor: &str, text: &str) {
    let _ = writeln!(out, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{text}</text>", at.0, at.1);
}

fn colour(k: usize) -> &'static str {
    COLOURS[k % COLOURS.len()]
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_bound_the_values_and_every_point_is_drawn() {
        let axis = Axis::over([0.02, 3.0].into_iter());
        assert_eq!((axis.low, axis.high), (-2, 1));
        assert!((axis.place(0.1) - 1.0 / 3.0).abs() < 1e-15);
        let row = |seconds, rms| Row { scene: "a<b".into(), tool: "t".into(), seconds, rms, ..Row::default() };
        let picture = svg(&[row(Some(1.0), Some(1e-3)), row(Some(2.0), Some(1e-4)), row(None, None)]);
        // Two points and the one in the legend.
        assert_eq!(picture.matches("<circle").count(), 3);
        assert!(picture.contains("a&lt;b"));
    }
}
