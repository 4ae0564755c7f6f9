//! Where an error comes from: its parts as lines of a table, as a chart, and beside them the reference's own noise.

use super::asked::is_reflected;
use super::chart::{Axis, Cell, Chart, Dot, Paint, Rule, Scale, Series, Shape, Unit};
use super::format::{is_known, percent, percent_estimate};
use crate::metrics::{Part, WorstPatch};
use crate::stats::Estimate;
use crate::study::Record;

/// The parts that could be told apart, with their names.
fn parts(record: &Record) -> Vec<(&'static str, &Part)> {
    let Some(split) = &record.split else { return Vec::new() };
    let parts = [
        ("solver", &split.solver),
        ("form factors", &split.form_factor),
        ("solver and form factors", &split.solver_and_form_factor),
        ("division into patches", &split.discretisation),
        ("form factors and division", &split.form_factor_and_discretisation),
    ];
    parts.into_iter().filter_map(|(name, part)| Some((name, part.as_ref()?))).collect()
}

/// (part, share of the light, interval, signed bias, worst patch) of every part that could be told apart.
pub(super) fn split_lines(record: &Record) -> Vec<[String; 5]> {
    parts(record).into_iter().map(|(name, p)| line(name, &p.rms, p.bias, p.worst.as_ref())).collect()
}

/// The same, and below it the whole error, where it is a share of the same light.
pub(super) fn budget_lines(record: &Record) -> Vec<[String; 5]> {
    let mut lines = split_lines(record);
    if !lines.is_empty() && !is_reflected(record) {
        let c = &record.comparison;
        lines.push(line("the whole error", &c.rms, c.bias.value, None));
    }
    lines
}

fn line(name: &str, rms: &Estimate, bias: f64, worst: Option<&WorstPatch>) -> [String; 5] {
    let rms = percent_estimate(rms, false);
    let bias = percent_estimate(&Estimate::exact(bias), true).value;
    let worst = worst.map_or(String::new(), |w| format!("worst patch {} on {}", w.patch, w.surface));
    [name.into(), rms.value, rms.interval.unwrap_or_default(), format!("bias {bias}"), worst]
}

/// How the parts are to be read.
pub(super) const READING: &str = "Each part is a difference of two solutions, patch by patch and with sign, as a share of \
    the reference's luminance (eq. 7). Biases add up to the bias of the whole; the errors themselves do not, since what \
    one part makes too bright another may make too dark.";

/// What share of the squared difference is noise of the reference; `None` where it states none, or where the error is of
/// reflected light, which the parts are not.
pub(super) fn noise_sentence(record: &Record) -> Option<String> {
    let (floor, rms) = (record.comparison.reference_noise_floor?, record.comparison.rms.value);
    let measured = floor * floor + rms * rms;
    let told = !is_reflected(record) && measured > 0.0 && is_known(&record.comparison.rms);
    told.then(|| {
        format!(
            "Noise of the reference: {}, which is {} of the squared difference as measured. It has been taken out of the \
             numbers and stands in their intervals.",
            percent(floor),
            percent(floor * floor / measured)
        )
    })
}

/// The budget as bars with their intervals, the noise of the reference as a line; `None` where there is no split.
pub(super) fn budget_chart(record: &Record) -> Option<Chart> {
    let parts = parts(record);
    if parts.is_empty() {
        return None;
    }
    let whole =
        (!is_reflected(record)).then_some(("the whole error", &record.comparison.rms, record.comparison.bias.value));
    let bars: Vec<(&str, &Estimate, f64)> =
        parts.iter().map(|(name, p)| (*name, &p.rms, p.bias)).chain(whole).filter(|(_, e, _)| is_known(e)).collect();
    let bar = |(k, (name, e, bias)): (usize, &(&str, &Estimate, f64))| {
        let [_, value, interval, bias_text, _] = line(name, e, *bias, None);
        let within = if interval.is_empty() { String::new() } else { format!(" ({interval})") };
        Dot {
            x: k as f64,
            y: e.value,
            std_err: e.std_err,
            interval: Some((e.low, e.high)),
            width: 0.62,
            hint: format!("{value}{within}, {bias_text}"),
            more: vec![Cell::Number(Some(*bias), Unit::Percent)],
            ..Dot::default()
        }
    };
    let dots: Vec<Dot> = bars.iter().enumerate().map(bar).collect();
    let floor = record.comparison.reference_noise_floor.filter(|f| *f > 0.0 && !is_reflected(record));
    let high = bars.iter().map(|(_, e, _)| e.high).chain(floor).fold(0.0, f64::max);
    let series = |name: &str, paint, dots| Series {
        name: name.into(),
        paint,
        dashed: false,
        shape: Shape::Bars,
        dots,
        fit: None,
    };
    let (of_parts, of_whole) = dots.split_at(parts.len().min(dots.len()));
    Some(Chart {
        stem: "budget".into(),
        title: "Where the error comes from".into(),
        caption: String::new(),
        x: Axis {
            title: "part of the error".into(),
            column: "part".into(),
            unit: Unit::Plain,
            scale: Scale::Names(bars.iter().map(|(name, ..)| name.to_string()).collect()),
        },
        y: Axis {
            title: "luminance error (eq. 7)".into(),
            column: "rms".into(),
            unit: Unit::Percent,
            scale: if high > 0.0 { Scale::up_to(high) } else { Scale::Linear { low: 0.0, high: 1.0, step: 1.0 } },
        },
        series: vec![
            series("parts", Paint::Method(0), of_parts.to_vec()),
            series("whole", Paint::Even, of_whole.to_vec()),
        ],
        rules: floor
            .map(|f| Rule { value: f, name: format!("noise of the reference: {}", percent(f)) })
            .into_iter()
            .collect(),
        more: vec![("bias".into(), "bias")],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{record, set, with_split};

    #[test]
    fn the_budget_names_its_parts_the_whole_and_the_noise() {
        let r = with_split();
        let lines = budget_lines(&r);
        let names: Vec<&str> = lines.iter().map(|l| l[0].as_str()).collect();
        assert_eq!(names, ["solver", "form factors", "division into patches", "the whole error"]);
        assert_eq!(lines[1][..4], ["form factors", "1.10 %", "1.00 to 1.20 %", "bias +0.400 %"].map(String::from));
        assert_eq!(lines[3][1], "1.341 %");
        // 0.00062^2 / (0.00062^2 + 0.013412^2).
        assert!(noise_sentence(&r).expect("a sentence").contains("0.0620 %, which is 0.213 % of the squared"));
    }

    #[test]
    fn the_charts_table_holds_the_records_numbers() {
        let table = String::from_utf8(budget_chart(&with_split()).expect("a chart").csv()).expect("text");
        assert_eq!(table.lines().next(), Some("series,part,rms,rms_std_err,rms_low,rms_high,bias"));
        let r = with_split();
        let part = r.split.and_then(|s| s.form_factor).expect("a part");
        let numbers = [part.rms.value, part.rms.std_err.expect("an error"), part.rms.low, part.rms.high, part.bias];
        let fields: Vec<&str> = table.lines().nth(2).expect("a line").split(',').collect();
        let read: Vec<f64> = fields[2..].iter().map(|f| f.parse().expect("a number")).collect();
        assert_eq!((&fields[..2], read.as_slice()), (&["parts", "form factors"][..], &numbers[..]));
        assert!(table.lines().nth(4).expect("a line").starts_with("whole,the whole error,0.013412,"), "{table}");
    }

    #[test]
    fn no_split_is_no_budget_and_reflected_light_is_no_whole() {
        assert!(budget_lines(&record()).is_empty() && budget_chart(&record()).is_none());
        let mut r = with_split();
        set(&mut r, "--reflected", "true");
        assert_eq!((budget_lines(&r).len(), noise_sentence(&r)), (3, None));
        assert!(budget_chart(&r).expect("a chart").rules.is_empty());
    }
}
