//! The two tables every report shows, built once: metrics, and the worst patches.

use super::asked::{Level, is_reflected};
use super::format::{column, is_known, percent, percent_estimate, percent_exact, places, significant};
use crate::metrics::{LimitOutcome, Verdict, WorstPatch};
use crate::render::luminance_std_err;
use crate::stats::Estimate;
use crate::study::Record;

/// One metric as text, with the numbers it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct MetricLine {
    /// Name as in the JSON: `rms`, `top1`, ...
    pub key: String,
    /// Name for people.
    pub name: String,
    /// What it means, in plain words.
    pub meaning: &'static str,
    /// Value with unit.
    pub value: String,
    /// Interval with unit; `None` for an exact number.
    pub interval: Option<String>,
    /// Limit with unit, where one was given.
    pub limit: Option<String>,
    /// What became of the limit.
    pub verdict: Option<Verdict>,
    /// The number itself; `None` for shares and noise, which have no interval.
    pub estimate: Option<Estimate>,
    /// The limit itself.
    pub limit_value: Option<f64>,
}

/// One of the worst patches as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorstLine {
    /// Number of the patch, or of the element where elements are judged.
    pub number: usize,
    /// Name of its surface.
    pub surface: String,
    /// Luminance of the reference.
    pub reference: String,
    /// Luminance of the solution.
    pub solution: String,
    /// Solution - reference.
    pub difference: String,
    /// Difference relative to the reference; `None` where that is black.
    pub relative: Option<String>,
    /// Difference in standard errors of both sides; `None` where nobody states one.
    pub in_std_errs: Option<String>,
}

const RMS: &str = "Area-weighted root-mean-square difference of luminance, relative to the reference (eq. 7)";
const TOP1: &str = "Eq. 7 over the 1 % of patches that change most";
const REFLECTED: &str = "Eq. 7 on reflected light alone, emission left out";
const BIAS: &str = "Light in excess (+) or missing (\u{2212}) over the whole scene";
const VISIBLE: &str = "Share of the picture that is off by more than one step of the display, of 255";
const BAND: &str = "Eq. 7 in this band alone";
const FLOOR: &str =
    "What eq. 7 would read for a perfect solution from the reference's own noise; already taken out above";
const SOLUTION_NOISE: &str = "Noise that the solution states of itself; never part of the verdict";
const SHARE: &str = "Share of patches that emit in what the error is measured against";

/// All metrics of a record, in order of display.
pub fn metric_lines(record: &Record) -> Vec<MetricLine> {
    let c = &record.comparison;
    let of = |key: &str, name: &str, meaning, e: &Estimate| judged(record, key, name, meaning, e);
    let mut lines = Vec::new();
    if is_reflected(record) {
        lines.push(of("rms", "Error of reflected light", REFLECTED, &c.rms));
    } else {
        lines.push(of("rms", "Luminance error", RMS, &c.rms));
    }
    // A limit on what could not be had still has a line.
    let top1 = c.top1.as_ref().or(outcome(record, "top1").map(|o| &o.estimate));
    lines.extend(top1.map(|e| of("top1", "Error where most changes", TOP1, e)));
    if !is_reflected(record) {
        lines.extend(c.rms_reflected.iter().map(|e| of("rms_reflected", "Error of reflected light", REFLECTED, e)));
    }
    lines.push(of("bias", "Bias", BIAS, &c.bias));
    if c.per_band.len() > 1 {
        let band = |(name, e): &(String, Option<Estimate>)| {
            let (key, name) = (format!("per_band.{name}"), format!("Error in band {name}"));
            Some(of(&key, &name, BAND, e.as_ref()?))
        };
        lines.extend(c.per_band.iter().filter_map(band));
    }
    lines.extend(record.as_seen.iter().map(|s| of("visible", "Visible error", VISIBLE, &s.share)));
    // Limits by name: on places, on what has no line of its own.
    let own: Vec<String> = lines.iter().map(|l| l.key.clone()).collect();
    let named = record.decision.iter().flat_map(|d| &d.limits).filter(|o| !own.contains(&o.metric));
    lines.extend(named.map(|o| judged(record, &o.metric, &name_of(&o.metric), meaning_of(&o.metric), &o.estimate)));
    lines.extend(c.reference_noise_floor.map(|f| plain("reference_noise_floor", "Noise of the reference", FLOOR, f)));
    lines.extend(c.solution_noise.map(|f| plain("solution_noise", "Noise of the solution", SOLUTION_NOISE, f)));
    lines.push(plain("emitter_share", "Share of emitters", SHARE, c.emitter_share));
    lines
}

/// Name of a limit's metric for people.
fn name_of(key: &str) -> String {
    let (metric, place) = key.split_once('@').map_or((key, None), |(m, p)| (m, Some(p)));
    let what = match metric {
        "rms" => "Error",
        "worst" => "Worst patch",
        "energy" => "Light in excess or missing",
        "worse" => "Growth of error over the baseline",
        "visible" => "Visible error",
        other => other,
    };
    place.map_or(what.into(), |p| format!("{what}, {}", p.replacen(':', " ", 1)))
}

fn meaning_of(key: &str) -> &'static str {
    match key.split('@').next() {
        Some("worst") => "Largest difference of any patch, relative to the reference there",
        Some("energy") => "Size of the bias: light in excess or missing",
        Some("visible") => VISIBLE,
        Some("worse") => "Eq. 7 less eq. 7 of the baseline, judged by the same replicates",
        _ => "Eq. 7 in this place alone",
    }
}

fn outcome<'a>(record: &'a Record, metric: &str) -> Option<&'a LimitOutcome> {
    record.decision.iter().flat_map(|d| &d.limits).find(|l| l.metric == metric)
}

fn judged(record: &Record, key: &str, name: &str, meaning: &'static str, e: &Estimate) -> MetricLine {
    let outcome = outcome(record, key);
    let e = outcome.map_or(e, |o| &o.estimate);
    let shown = percent_estimate(e, key == "bias" || key == "worse");
    MetricLine {
        key: key.into(),
        name: name.into(),
        meaning,
        value: shown.value,
        interval: shown.interval,
        limit: outcome.map(|o| percent_exact(o.limit)),
        verdict: outcome.map(|o| o.verdict),
        estimate: is_known(e).then_some(*e),
        limit_value: outcome.map(|o| o.limit),
    }
}

fn plain(key: &str, name: &str, meaning: &'static str, fraction: f64) -> MetricLine {
    MetricLine {
        key: key.into(),
        name: name.into(),
        meaning,
        value: percent(fraction),
        interval: None,
        limit: None,
        verdict: None,
        estimate: None,
        limit_value: None,
    }
}

/// Title of the table of the worst, with what its numbers are.
pub(super) fn worst_title(record: &Record) -> String {
    let light = if is_reflected(record) { "reflected luminance" } else { "luminance" };
    format!("Worst {} ({light}, W/m\u{b2})", Level::of(record).nouns())
}

/// The worst patches of a record.
pub fn worst_lines(record: &Record) -> Vec<WorstLine> {
    // The record holds errors of patches; those of elements are not known.
    let own = match Level::of(record) {
        Level::Patch => luminance_std_err(&record.stage.photometry, &record.solution).values,
        Level::Element => Vec::new(),
    };
    let worst = &record.comparison.worst;
    let of = |get: fn(&WorstPatch) -> f64| -> Vec<f64> { worst.iter().map(get).collect() };
    let (reference, solution, difference) = (of(|w| w.reference), of(|w| w.solution), of(|w| w.difference));
    // Both sides to a place at which they differ.
    let fine = places(&difference).map(|p| p.saturating_sub(2));
    let both = places(&[reference.clone(), solution.clone()].concat()).map(|p| p.max(fine.unwrap_or(0)));
    let (references, solutions) = (column(&reference, both, false), column(&solution, both, false));
    let differences = column(&difference, places(&difference), true);
    let line = |(k, w): (usize, &WorstPatch)| {
        let error = w.std_err.map(|e| e.hypot(own.get(w.patch).copied().flatten().unwrap_or(0.0)));
        WorstLine {
            number: w.patch,
            surface: w.surface.clone(),
            reference: references[k].clone(),
            solution: solutions[k].clone(),
            difference: differences[k].clone(),
            relative: (w.reference != 0.0).then(|| signed_percent(w.difference / w.reference)),
            in_std_errs: error.filter(|e| *e > 0.0).map(|e| with_sign(w.difference / e)),
        }
    };
    worst.iter().enumerate().map(line).collect()
}

fn signed_percent(x: f64) -> String {
    format!("{}{}", if x > 0.0 { "+" } else { "" }, percent(x))
}

fn with_sign(x: f64) -> String {
    format!("{}{}", if x > 0.0 { "+" } else { "" }, significant(x, 2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{record, set, with_verdict};

    #[test]
    fn a_limit_stands_in_the_line_of_its_metric_only() {
        let lines = metric_lines(&with_verdict(Verdict::Fail));
        let limits: Vec<_> = lines.iter().map(|l| (l.key.as_str(), l.limit.as_deref())).collect();
        assert_eq!(limits[0], ("rms", Some("1 %")));
        assert!(limits[1..].iter().all(|(_, l)| l.is_none()), "{limits:?}");
    }

    #[test]
    fn what_is_not_there_is_left_out() {
        let mut r = record();
        r.comparison.rms_reflected = None;
        r.comparison.reference_noise_floor = None;
        r.comparison.per_band.truncate(1);
        let keys: Vec<String> = metric_lines(&r).into_iter().map(|l| l.key).collect();
        assert_eq!(keys, ["rms", "bias", "emitter_share"]);
    }

    #[test]
    fn judged_without_emission_the_main_line_says_so_and_stands_alone() {
        let mut r = record();
        set(&mut r, "--reflected", "true");
        let lines = metric_lines(&r);
        assert_eq!((lines[0].key.as_str(), lines[0].name.as_str()), ("rms", "Error of reflected light"));
        assert!(lines.iter().all(|l| l.key != "rms_reflected"));
        assert_eq!(worst_title(&r), "Worst patches (reflected luminance, W/m\u{b2})");
    }

    #[test]
    fn a_limit_on_what_is_not_known_has_its_line() {
        let mut r = with_verdict(Verdict::Inconclusive);
        let limit = &mut r.decision.as_mut().expect("decided").limits[0];
        limit.metric = "top1".into();
        limit.estimate = Estimate { value: 0.0, std_err: None, low: 0.0, high: f64::MAX };
        let line = metric_lines(&r).into_iter().find(|l| l.key == "top1").expect("a line");
        assert_eq!((line.value.as_str(), line.limit.as_deref(), line.estimate), ("unknown", Some("1.35 %"), None));
    }

    #[test]
    fn what_differs_little_is_shown_to_the_place_where_it_differs() {
        let mut r = record();
        r.comparison.worst.truncate(1);
        let w = &mut r.comparison.worst[0];
        (w.reference, w.solution, w.difference) = (2.0, 2.0003561, 0.0003561);
        let line = worst_lines(&r).remove(0);
        assert_eq!((line.reference.as_str(), line.solution.as_str()), ("2.00000", "2.00036"));
        assert_eq!(line.difference, "+0.0003561");
    }

    #[test]
    fn differences_are_counted_in_errors_of_both_sides() {
        let mut r = record();
        let w = &mut r.comparison.worst[0];
        (w.difference, w.std_err) = (1.0, Some(0.3));
        let (patch, n) = (w.patch, r.solution.values.len());
        assert_eq!(worst_lines(&r)[0].in_std_errs.as_deref(), Some("+3.3"));
        let mut errors = vec![0.0; n];
        errors[3 * patch..3 * patch + 3].fill(0.4);
        r.solution.std_err = Some(errors);
        assert_eq!(worst_lines(&r)[0].in_std_errs.as_deref(), Some("+2.0"));
        r.comparison.worst[0].std_err = None;
        assert_eq!(worst_lines(&r)[0].in_std_errs, None);
    }
}
