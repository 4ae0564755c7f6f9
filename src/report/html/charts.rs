//! Histograms of a record as charts.

use crate::metrics::{Breakdown, Histogram, NoiseTest};
use crate::report::asked::{Level, is_reflected};
use crate::report::chart::{Axis, Block, Chart, Dot, Paint, Scale, Series, Shape, Unit, round_step};
use crate::report::format::{confidence, count, percent, percent_exact, round_number, significant};
use crate::report::html::context::minus;
use crate::study::Record;

/// The two histograms of a record, where there is something to show.
pub(super) fn charts(record: &Record) -> Vec<Block> {
    let Some(breakdown) = &record.breakdown else { return Vec::new() };
    let errors = breakdown.errors.as_ref().map(|h| of_errors(record, breakdown, h));
    let noise = breakdown.noise.as_ref().filter(|n| n.tested > 0).map(|n| of_noise(record, n));
    errors.iter().chain(&noise).filter_map(Block::of).collect()
}

fn of_errors(record: &Record, breakdown: &Breakdown, shares: &Histogram) -> Chart {
    let light = if is_reflected(record) { "reflected luminance" } else { "luminance" };
    let middle = shares.bins[shares.bins.len() / 2];
    let caption = format!(
        "Solution minus reference, as a share of the reference's root-mean-square {light} ({} W/m\u{b2}). {} of the \
         area errs by less than {}; red is too bright, blue too dark.",
        significant(breakdown.reference_rms, 4),
        percent(middle),
        percent_exact(0.5 * shares.width)
    );
    let x = Axis {
        title: "error, % of the reference's luminance".into(),
        column: "error".into(),
        unit: Unit::Percent,
        scale: Scale::Log,
    };
    let names = ["too dark", "about right", "too bright"];
    Frame { shares, even: 0.5 * shares.width, names }.chart("errors", "How large the errors are", caption, x)
}

fn of_noise(record: &Record, noise: &NoiseTest) -> Chart {
    let nouns = Level::of(record).nouns();
    let (single, family) = (&noise.single, &noise.family);
    let mut caption = format!(
        "{} of {} {nouns} lie beyond {} standard errors, where noise alone would put about {}; {} beyond {}, where it \
         would put {} on average ({} over all together, Sidak).",
        count(single.count),
        count(noise.tested),
        significant(single.threshold, 3),
        significant(single.expected, 2),
        count(family.count),
        significant(family.threshold, 3),
        significant(family.expected, 2),
        confidence(record.comparison.confidence),
    );
    if noise.exact_and_different > 0 {
        caption +=
            &format!(" {} more differ where the reference has no noise at all.", count(noise.exact_and_different));
    }
    caption += if family.count + noise.exact_and_different == 0 {
        " No single one stands out of the noise."
    } else {
        " Those are errors of the solution rather than noise of the reference."
    };
    let x = Axis {
        title: "error in standard errors of the reference".into(),
        column: "standard_errors".into(),
        unit: Unit::Plain,
        scale: Scale::Log,
    };
    let names = ["darker than noise", "within the noise", "brighter than noise"];
    let frame = Frame { shares: &noise.shares, even: single.threshold, names };
    let mut chart = frame.chart("noise", "Error or noise?", caption, x);
    chart.series.push(frame.expected(&noise.expected, noise.freedom));
    chart.y.scale = Scale::up_to(frame.highest().max(highest(&noise.expected)));
    chart
}

/// Highest share of a histogram.
fn highest(h: &Histogram) -> f64 {
    h.bins.iter().copied().fold(h.below.max(h.above), f64::max)
}

/// A histogram with the colours of its bins.
struct Frame<'a> {
    shares: &'a Histogram,
    /// Bins within this of 0 are nothing to be shown in colour.
    even: f64,
    /// What bins below, about and above 0 are called.
    names: [&'static str; 3],
}

impl Frame<'_> {
    fn chart(&self, stem: &str, title: &str, caption: String, x: Axis) -> Chart {
        let bins = self.shares.bins.len() as f64;
        let (half, room) = (0.5 * self.shares.width * bins, self.room());
        let scale = Scale::Linear { low: -half - room, high: half + room, step: round_step(2.0 * half) };
        let y = Axis {
            title: "share of the area".into(),
            column: "share".into(),
            unit: Unit::Percent,
            scale: Scale::up_to(self.highest()),
        };
        Chart {
            stem: stem.into(),
            title: title.into(),
            caption,
            series: self.bars(&x),
            x: Axis { scale, ..x },
            y,
            rules: Vec::new(),
            more: Vec::new(),
        }
    }

    fn highest(&self) -> f64 {
        highest(self.shares)
    }

    /// True if something lies beyond either end.
    fn is_open(&self) -> bool {
        self.shares.below + self.shares.above > 0.0
    }

    /// Room at either end for what lies beyond.
    fn room(&self) -> f64 {
        if self.is_open() { 0.1 * self.shares.width * self.shares.bins.len() as f64 } else { 0.0 }
    }

    /// Bars of three colours; those beyond the ends stand apart.
    fn bars(&self, x: &Axis) -> Vec<Series> {
        let (edges, width, room) = (self.shares.edges(), self.shares.width, self.room());
        let value = |v: f64| {
            // Sums of bin widths carry rounding errors about 0.
            let clean = if v.abs() < 1e-9 * width { 0.0 } else { v };
            let scaled = if x.unit == Unit::Percent { 100.0 * clean } else { clean };
            format!("{}{}", if clean > 0.0 { "+" } else { "" }, round_number(scaled))
        };
        let unit = if x.unit == Unit::Percent { " %" } else { " standard errors" };
        let bar = |span: (f64, f64), drawn: (f64, f64), share: f64, words: String| Dot {
            x: 0.5 * (drawn.0 + drawn.1),
            y: share,
            span: Some(span),
            width: drawn.1 - drawn.0,
            hint: minus(&format!("{} of the area: {words}{unit}", percent(share))),
            ..Dot::default()
        };
        let (first, last) = (edges[0], edges[edges.len() - 1]);
        let mut bars: Vec<Dot> = Vec::new();
        if self.is_open() {
            let drawn = (first - room, first - 0.4 * room);
            bars.push(bar((f64::NEG_INFINITY, first), drawn, self.shares.below, format!("below {}", value(first))));
        }
        bars.extend(self.shares.bins.iter().enumerate().map(|(k, share)| {
            let span = (edges[k], edges[k + 1]);
            bar(span, span, *share, format!("{} to {}", value(span.0), value(span.1)))
        }));
        if self.is_open() {
            let drawn = (last + 0.4 * room, last + room);
            bars.push(bar((last, f64::INFINITY), drawn, self.shares.above, format!("above {}", value(last))));
        }
        self.coloured(bars)
    }

    /// Bars by what they say.
    fn coloured(&self, bars: Vec<Dot>) -> Vec<Series> {
        let class = |x: f64| if x.abs() <= self.even { 1 } else { 2 * usize::from(x > 0.0) };
        let paints = [Paint::Cold, Paint::Even, Paint::Warm];
        let series = |k: usize| Series {
            name: self.names[k].into(),
            paint: paints[k],
            dashed: false,
            shape: Shape::Bars,
            dots: bars.iter().filter(|d| class(d.x) == k).cloned().collect(),
            fit: None,
        };
        (0..3).map(series).collect()
    }

    /// What noise alone would look like: a step for each bin.
    fn expected(&self, expected: &Histogram, freedom: f64) -> Series {
        let edges = expected.edges();
        let step = |(k, share): (usize, &f64)| Dot {
            x: 0.5 * (edges[k] + edges[k + 1]),
            y: *share,
            span: Some((edges[k], edges[k + 1])),
            width: expected.width,
            hint: format!("{} of the area by noise alone", percent(*share)),
            ..Dot::default()
        };
        Series {
            name: format!("noise alone (Student t, {freedom} degrees of freedom)"),
            paint: Paint::Ink,
            dashed: false,
            shape: Shape::Steps,
            dots: expected.bins.iter().enumerate().map(step).collect(),
            fit: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histogram() -> Histogram {
        // Three bins of 2 % about 0: a quarter each, and a quarter above.
        Histogram { first: -0.03, width: 0.02, bins: vec![0.25, 0.25, 0.25], below: 0.0, above: 0.25 }
    }

    fn frame(shares: &Histogram) -> Frame<'_> {
        Frame { shares, even: 0.01, names: ["dark", "right", "bright"] }
    }

    fn chart(shares: &Histogram) -> Chart {
        let axis = Axis { title: "%".into(), column: "error".into(), unit: Unit::Percent, scale: Scale::Log };
        frame(shares).chart("errors", "t", String::new(), axis)
    }

    #[test]
    fn bars_stand_where_their_values_are() {
        let shares = histogram();
        let chart = chart(&shares);
        let of = |k: usize| chart.series[k].dots.iter().map(|d| (d.x, d.y)).collect::<Vec<_>>();
        let wanted = [vec![(-0.0342, 0.0), (-0.02, 0.25)], vec![(0.0, 0.25)], vec![(0.02, 0.25), (0.0342, 0.25)]];
        for (k, wanted) in wanted.iter().enumerate() {
            assert_eq!(of(k).len(), wanted.len());
            assert!(of(k).iter().zip(wanted).all(|(a, b)| (a.0 - b.0).abs() < 1e-9 && a.1 == b.1), "{:?}", of(k));
        }
        assert_eq!(chart.series[0].dots[1].hint, "25.0\u{202f}% of the area: \u{2212}3 to \u{2212}1\u{202f}%");
        assert_eq!(chart.series[2].dots[1].hint, "25.0\u{202f}% of the area: above +3\u{202f}%");
        let table = String::from_utf8(chart.csv()).expect("text");
        assert!(table.starts_with("series,error_from,error_to,share\ndark,-inf,-0.03,0.0\n"), "{table}");
        assert!(table.ends_with("bright,0.03,inf,0.25\n"), "{table}");
    }

    #[test]
    fn the_curve_has_the_heights_of_what_is_expected() {
        let shares = histogram();
        let expected = Histogram { bins: vec![0.1, 0.8, 0.1], above: 0.0, ..shares.clone() };
        let curve = frame(&shares).expected(&expected, 7.0);
        assert_eq!(curve.dots.iter().map(|d| d.y).collect::<Vec<_>>(), [0.1, 0.8, 0.1]);
        assert_eq!(highest(&expected), 0.8);
        assert!(curve.name.contains("7 degrees"));
    }
}
