//! Histograms as places on a drawing: percent of its width from the left, percent of its height from the top.

use super::context::minus;
use crate::metrics::{Breakdown, Histogram, NoiseTest};
use crate::report::asked::{Level, is_reflected};
use crate::report::format::{confidence, count, percent, percent_exact, round_number, significant};
use crate::study::Record;
use serde::Serialize;

/// Room for the bar of what lies beyond either end, percent of the width.
const END: f64 = 8.0;
/// Marks along either axis, about.
const MARKS: f64 = 4.0;

#[derive(Debug, Serialize)]
pub(super) struct Chart {
    pub id: &'static str,
    pub title: &'static str,
    pub caption: String,
    pub bars: Vec<ChartBar>,
    /// What noise alone would look like, as an SVG path.
    pub curve: Option<String>,
    pub curve_name: String,
    /// Places from the left with their labels.
    pub x_marks: Vec<(String, String)>,
    /// Places from the top with their labels.
    pub y_marks: Vec<(String, String)>,
    pub x_title: &'static str,
    pub y_title: &'static str,
}

#[derive(Debug, Serialize)]
pub(super) struct ChartBar {
    pub x: String,
    pub y: String,
    pub width: String,
    pub height: String,
    /// `cold` below, `even` about, `warm` above what is right.
    pub class: &'static str,
    /// What a reader sees who points at it.
    pub hint: String,
}

/// The two histograms of a record, where there is something to show.
pub(super) fn charts(record: &Record) -> Vec<Chart> {
    let Some(breakdown) = &record.breakdown else { return Vec::new() };
    let errors = breakdown.errors.as_ref().map(|h| of_errors(record, breakdown, h));
    let noise = breakdown.noise.as_ref().filter(|n| n.tested > 0).map(|n| of_noise(record, n));
    errors.into_iter().chain(noise).collect()
}

fn of_errors(record: &Record, breakdown: &Breakdown, shares: &Histogram) -> Chart {
    let frame = Frame { shares, expected: None, unit: 100.0, suffix: " %", even: 0.5 * shares.width };
    let light = if is_reflected(record) { "reflected luminance" } else { "luminance" };
    let middle = shares.bins[shares.bins.len() / 2];
    let caption = format!(
        "Solution minus reference, as a share of the reference's root-mean-square {light} ({} W/m\u{b2}). {} of the \
         area errs by less than {}; red is too bright, blue too dark.",
        significant(breakdown.reference_rms, 4),
        percent(middle),
        percent_exact(0.5 * shares.width)
    );
    frame.draw("errors", "How large the errors are", caption, "% of the reference's luminance")
}

fn of_noise(record: &Record, noise: &NoiseTest) -> Chart {
    let (shares, even) = (&noise.shares, noise.single.threshold);
    let frame = Frame { shares, expected: Some(&noise.expected), unit: 1.0, suffix: "", even };
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
    let mut chart = frame.draw("noise", "Error or noise?", caption, "standard errors");
    chart.curve_name = format!("noise alone (Student t, {} degrees of freedom)", noise.freedom);
    chart
}

/// A histogram with its axes.
struct Frame<'a> {
    shares: &'a Histogram,
    expected: Option<&'a Histogram>,
    /// What labels are multiplied by.
    unit: f64,
    suffix: &'static str,
    /// Bins within this of 0 are nothing to be shown in colour.
    even: f64,
}

impl Frame<'_> {
    fn draw(&self, id: &'static str, title: &'static str, caption: String, x_title: &'static str) -> Chart {
        let top = self.top();
        Chart {
            id,
            title,
            caption: minus(&caption),
            bars: self.bars(top),
            curve: self.expected.map(|e| self.curve(e, top)),
            curve_name: String::new(),
            x_marks: self.x_marks(),
            y_marks: marks(top).map(|y| (place(100.0 * (1.0 - y / top)), minus(&label(100.0 * y, " %")))).collect(),
            x_title,
            y_title: "share of the area",
        }
    }

    /// Upper end of the axis of shares: what is highest fits.
    fn top(&self) -> f64 {
        let of = |h: &Histogram| h.bins.iter().copied().fold(h.below.max(h.above), f64::max);
        1.06 * of(self.shares).max(self.expected.map_or(0.0, of))
    }

    /// Room at either end, percent.
    fn end(&self) -> f64 {
        if self.shares.below + self.shares.above > 0.0 { END } else { 0.0 }
    }

    /// Place of an edge.
    fn x(&self, edge: f64) -> f64 {
        let bins = self.shares.bins.len() as f64;
        self.end() + (100.0 - 2.0 * self.end()) * edge / bins
    }

    fn bars(&self, top: f64) -> Vec<ChartBar> {
        let (edges, last) = (self.shares.edges(), self.shares.bins.len());
        let value = |x: f64| self.signed(x * self.unit);
        let bin = |(k, share): (usize, &f64)| {
            let (low, high) = (edges[k], edges[k + 1]);
            let hint = format!("{} to {}{}: {} of the area", value(low), value(high), self.suffix, percent(*share));
            self.bar([self.x(k as f64), self.x(k as f64 + 1.0)], *share, top, self.class(low, high), hint)
        };
        let beyond = |share: f64, class, word: &str, edge: f64, from: f64| {
            let hint = format!("{word} {}{}: {} of the area", value(edge), self.suffix, percent(share));
            self.bar([from, from + 0.6 * END], share, top, class, hint)
        };
        let mut bars: Vec<ChartBar> = self.shares.bins.iter().enumerate().map(bin).collect();
        if self.end() > 0.0 {
            bars.insert(0, beyond(self.shares.below, "cold", "below", edges[0], 0.0));
            bars.push(beyond(self.shares.above, "warm", "above", edges[last], 100.0 - 0.6 * END));
        }
        bars.retain(|b| b.height != "0");
        bars
    }

    fn bar(&self, [from, to]: [f64; 2], share: f64, top: f64, class: &'static str, hint: String) -> ChartBar {
        // A hair's breadth between bars, and what is there at all stays visible.
        let height = if share > 0.0 { (100.0 * share / top).max(0.5) } else { 0.0 };
        ChartBar {
            x: place(from + 0.1),
            width: place(to - from - 0.2),
            y: place(100.0 - height),
            height: place(height),
            class,
            hint: minus(&hint),
        }
    }

    fn class(&self, low: f64, high: f64) -> &'static str {
        let middle = 0.5 * (low + high);
        if middle.abs() <= self.even {
            "even"
        } else if middle < 0.0 {
            "cold"
        } else {
            "warm"
        }
    }

    /// A step for each bin.
    fn curve(&self, expected: &Histogram, top: f64) -> String {
        let mut path = String::new();
        for (k, share) in expected.bins.iter().enumerate() {
            let (y, verb) = (place(100.0 - 100.0 * share / top), if k == 0 { "M" } else { "V" });
            let (from, to) = (place(self.x(k as f64)), place(self.x(k as f64 + 1.0)));
            path += &if k == 0 { format!("{verb}{from} {y}H{to}") } else { format!("{verb}{y}H{to}") };
        }
        path
    }

    fn x_marks(&self) -> Vec<(String, String)> {
        let half = 0.5 * self.shares.width * self.shares.bins.len() as f64;
        let at = |x: f64| place(self.x((x + half) / self.shares.width));
        let positive: Vec<f64> = marks(half).filter(|x| *x > 0.0).collect();
        let negative = positive.iter().rev().map(|x| -x);
        let all = negative.chain(std::iter::once(0.0)).chain(positive.iter().copied());
        let mut shown: Vec<(String, String)> = all.map(|x| (at(x), minus(&self.signed(x * self.unit)))).collect();
        if self.end() > 0.0 {
            shown.insert(0, (place(0.3 * END), "less".into()));
            shown.push((place(100.0 - 0.3 * END), "more".into()));
        }
        shown
    }

    fn signed(&self, x: f64) -> String {
        // Sums of bin widths carry rounding errors about 0.
        let clean = if x.abs() < 1e-9 * self.shares.width * self.unit { 0.0 } else { x };
        format!("{}{}", if clean > 0.0 { "+" } else { "" }, round_number(clean))
    }
}

/// Round numbers from 0 to `end`, about [`MARKS`] steps.
fn marks(end: f64) -> impl Iterator<Item = f64> {
    let power = 10f64.powf((end / MARKS).log10().floor());
    let step = power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= end / MARKS).unwrap_or(10.0);
    (0..).map(move |k| f64::from(k) * step).take_while(move |x| *x <= end * (1.0 + 1e-9))
}

fn label(x: f64, suffix: &str) -> String {
    format!("{}{suffix}", round_number(x))
}

/// A place with two decimals, none where they are zero.
fn place(x: f64) -> String {
    round_number((100.0 * x).round() / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histogram() -> Histogram {
        // Three bins of 2 % about 0: a quarter each, and a quarter above.
        Histogram { first: -0.03, width: 0.02, bins: vec![0.25, 0.25, 0.25], below: 0.0, above: 0.25 }
    }

    #[test]
    fn bars_stand_where_their_values_are() {
        let shares = histogram();
        let frame = Frame { shares: &shares, expected: None, unit: 100.0, suffix: " %", even: 0.01 };
        let chart = frame.draw("errors", "t", String::new(), "%");
        let bars: Vec<(&str, &str, &str)> =
            chart.bars.iter().map(|b| (b.x.as_str(), b.class, b.height.as_str())).collect();
        assert_eq!(
            bars,
            [("8.1", "cold", "94.34"), ("36.1", "even", "94.34"), ("64.1", "warm", "94.34"), ("95.3", "warm", "94.34")]
        );
        assert_eq!(chart.bars[0].hint, "\u{2212}3 to \u{2212}1\u{202f}%: 25.0\u{202f}% of the area");
        assert_eq!(chart.bars[3].hint, "above +3\u{202f}%: 25.0\u{202f}% of the area");
        let zero = chart.x_marks.iter().find(|(_, l)| l == "0").expect("a mark");
        assert_eq!(zero.0, "50");
    }

    #[test]
    fn the_curve_has_the_heights_of_what_is_expected() {
        let shares = histogram();
        let expected = Histogram { bins: vec![0.1, 0.8, 0.1], above: 0.0, ..shares.clone() };
        let frame = Frame { shares: &shares, expected: Some(&expected), unit: 1.0, suffix: "", even: 2.0 };
        let top = frame.top();
        assert!((top - 1.06 * 0.8).abs() < 1e-12);
        assert_eq!(frame.curve(&expected, top), "M8 88.21H36V5.66H64V88.21H92");
    }

    #[test]
    fn marks_are_round_and_few() {
        let of = |end: f64| marks(end).collect::<Vec<_>>();
        assert_eq!(of(0.4), [0.0, 0.1, 0.2, 0.30000000000000004, 0.4]);
        assert_eq!(of(5.125), [0.0, 2.0, 4.0]);
        assert_eq!(of(1.0).len(), 3);
    }
}
