//! The verdict in one sentence, and what the reader has to be warned of.

use super::asked::{Level, is_reflected};
use super::format::{confidence, is_known, percent, percent_estimate, percent_exact, significant};
use crate::metrics::{Comparison, LimitOutcome, Scale, Verdict};
use crate::stats::Estimate;
use crate::study::{Cause, Record};

/// The verdict as a word and a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Headline {
    /// The verdict; `None` when no limit was given.
    pub verdict: Option<Verdict>,
    /// PASS, FAIL, INCONCLUSIVE or COMPARED.
    pub word: &'static str,
    /// One sentence with the numbers it rests on.
    pub sentence: String,
}

/// Share of the denominator of eq. 7 above which emitters hide what is reflected.
const EMITTERS_DOMINATE: f64 = 0.5;

/// The verdict of a record in one sentence.
pub fn headline(record: &Record) -> Headline {
    let name = &record.solution_name;
    let confidence = confidence(record.comparison.confidence);
    let Some(decision) = &record.decision else {
        let what = differs(&record.comparison.rms, &confidence);
        let light = if is_reflected(record) { "reflected luminance" } else { "luminance" };
        let sentence = format!("{name} differs from the reference by {what} in {light}; no limit was given.");
        return Headline { verdict: None, word: "COMPARED", sentence };
    };
    let verb = match decision.verdict {
        Verdict::Pass => "passes",
        Verdict::Fail => "fails",
        Verdict::Inconclusive => "is not decided",
    };
    // A verdict rests on the limits that share it.
    let deciding = decision.limits.iter().filter(|l| l.verdict == decision.verdict);
    let reasons: Vec<String> = deciding.map(|l| limit_reason(record, l)).collect();
    let sentence = format!("{name} {verb}: {}.", reasons.join("; "));
    Headline { verdict: Some(decision.verdict), word: verdict_word(decision.verdict), sentence }
}

/// The verdict in capitals.
pub(super) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "PASS",
        Verdict::Fail => "FAIL",
        Verdict::Inconclusive => "INCONCLUSIVE",
    }
}

/// What became of one limit, as a clause.
pub(super) fn limit_reason(record: &Record, outcome: &LimitOutcome) -> String {
    let (subject, limit) = (limit_subject(record, &outcome.metric), percent_exact(outcome.limit));
    if !is_known(&outcome.estimate) {
        return format!("{subject} is not known, so the limit of {limit} stays open");
    }
    let what = differs(&outcome.estimate, &confidence(record.comparison.confidence));
    match outcome.verdict {
        Verdict::Pass => format!("{subject} is {what}, within the limit of {limit}{}", caught(outcome)),
        Verdict::Fail => format!("{subject} is {what}, beyond the limit of {limit}"),
        Verdict::Inconclusive => {
            format!("{subject} is {what}, too close to the limit of {limit} to tell{}", more_rays(outcome.rays_factor))
        }
    }
}

/// What a passed limit might have let through.
fn caught(outcome: &LimitOutcome) -> String {
    match outcome.smallest_caught {
        Some(least) if is_known(&outcome.estimate) => format!(" (one of {} would have failed)", percent(least)),
        _ => String::new(),
    }
}

/// What a limit is on, as the subject of a clause.
fn limit_subject(record: &Record, metric: &str) -> String {
    let error = if is_reflected(record) { "its error of reflected luminance" } else { "its luminance error" };
    match metric {
        "rms" => error.into(),
        "top1" => format!("{error} on the 1 % of {} that change most", Level::of(record).nouns()),
        other => subject_elsewhere(other, is_reflected(record), Level::of(record).noun()),
    }
}

/// What a limit by name is on: metric and place.
fn subject_elsewhere(key: &str, reflected: bool, noun: &str) -> String {
    let (metric, place) = key.split_once('@').map_or((key, None), |(m, p)| (m, Some(p)));
    let light = if reflected { "reflected luminance" } else { "luminance" };
    let what = match metric {
        "rms" => format!("its error of {light}"),
        "worst" => format!("its worst {noun}, relative to the reference there,"),
        "energy" => "its light in excess or missing".into(),
        "worse" => "its growth of error over the baseline".into(),
        "visible" => "the share of the picture where its error is seen".into(),
        other => format!("its {other}"),
    };
    match place.and_then(|p| p.split_once(':')) {
        None => what,
        Some(("band", name)) => format!("{what} in band {name}").replace(light, "radiosity"),
        Some((kind, name)) => format!("{what} on {kind} \"{name}\""),
    }
}

fn more_rays(factor: Option<f64>) -> String {
    match factor {
        Some(f) if f.is_finite() => format!(" (about {} times the rays would)", whole_up(f)),
        _ => String::new(),
    }
}

/// Rounded up to two figures.
fn whole_up(x: f64) -> String {
    let unit = 10f64.powf((x.max(1.0).log10() - 1.0).floor().max(0.0));
    super::format::count(((x / unit).ceil() * unit) as usize)
}

fn differs(e: &Estimate, confidence: &str) -> String {
    let shown = percent_estimate(e, false);
    match shown.interval {
        Some(i) => format!("{} ({confidence} interval {i})", shown.value),
        None => shown.value,
    }
}

/// What the reader has to know before trusting the number: (title, text).
pub fn warnings(record: &Record) -> Vec<(String, String)> {
    let mut all: Vec<(String, String)> = record.causes.first().map(cause_found).into_iter().collect();
    let c = &record.comparison;
    if c.emitter_share > EMITTERS_DOMINATE && !is_reflected(record) {
        let reflected = c.rms_reflected.as_ref().map_or_else(
            || "nothing is reflected in this scene".into(),
            |e| format!("on reflected light alone it is {}", percent_estimate(e, false).value),
        );
        let text = format!(
            "Emitters hold {} of what the error is measured against, so errors of the reflected light hardly show in \
             it: {reflected}. Judge that with --reflected.",
            percent(c.emitter_share)
        );
        all.push(("The lamps outshine the rest".into(), text));
    }
    if record.causes.is_empty() {
        all.extend(scale_warning(c, is_reflected(record)));
    }
    if let (Some(floor), Some(decision)) = (c.reference_noise_floor, &record.decision)
        && let Some(tight) = decision.limits.iter().map(|l| l.limit).reduce(f64::min)
        && floor > tight
    {
        let text = format!(
            "The reference's own noise is {}, more than the limit of {}. The debiased error can still be judged, but \
             a reference with more rays would say more.",
            percent(floor),
            percent_exact(tight)
        );
        all.push(("The reference is noisier than the limit".into(), text));
    }
    all
}

/// The mistake that the error looks like.
fn cause_found(cause: &Cause) -> (String, String) {
    let mut letters = cause.sentence.chars();
    let first = letters.next().map_or(String::new(), |c| c.to_uppercase().to_string());
    let text = format!(
        "{first}{}. This explains {} of the squared error; {} are left.",
        letters.as_str(),
        percent(cause.explains),
        percent(cause.left)
    );
    ("The likely cause".into(), text)
}

/// A factor that explains most of the error is what a developer looks at first.
fn scale_warning(c: &Comparison, judged_reflected: bool) -> Option<(String, String)> {
    // What a factor of all light leaves says nothing about an error of the reflected part alone.
    let explains = |s: &&Scale| !judged_reflected && s.explains(c.rms.value);
    let total = c.scale_of_total.as_ref().filter(explains).map(|s| (s, "The solution"));
    let reflected = || {
        let rms = c.rms_reflected?.value;
        c.scale.as_ref().filter(|s| s.explains(rms)).map(|s| (s, "The reflected light of the solution"))
    };
    let (scale, what) = total.or_else(reflected)?;
    let f = &scale.factor;
    let interval = if f.high > f.low {
        format!(" ({} interval {} to {})", confidence(c.confidence), significant(f.low, 5), significant(f.high, 5))
    } else {
        String::new()
    };
    let left = scale.rms_after.map_or(String::new(), |r| format!("; without that factor {} are left", percent(r)));
    let named = scale.named.as_ref().map_or(String::new(), |n| format!(". The ratio is {n}"));
    let text = format!("{what} is {} times the reference{interval}{left}{named}.", significant(f.value, 4));
    Some(("One factor explains most of the error".into(), text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{record, set, with_verdict};

    #[test]
    fn each_verdict_says_why_in_one_sentence() {
        let pass = headline(&with_verdict(Verdict::Pass)).sentence;
        assert_eq!(
            pass,
            "point-lamps passes: its luminance error is 1.341 % (95 % interval 1.291 to 1.391 %), within the limit of 5 % \
             (one of 5.10 % would have failed)."
        );
        let fail = headline(&with_verdict(Verdict::Fail));
        assert!(fail.sentence.contains("beyond the limit of 1 %") && fail.word == "FAIL", "{}", fail.sentence);
        let open = headline(&with_verdict(Verdict::Inconclusive)).sentence;
        assert!(open.contains("too close to the limit of 1.35 % to tell (about 130 times the rays would)"), "{open}");
        let mut compared = record();
        compared.decision = None;
        assert!(headline(&compared).sentence.ends_with("no limit was given."));
    }

    #[test]
    fn a_failing_limit_alone_speaks_for_the_failure() {
        let mut r = with_verdict(Verdict::Fail);
        let mut kept = with_verdict(Verdict::Pass).decision.expect("decided").limits.remove(0);
        kept.metric = "top1".into();
        r.decision.as_mut().expect("decided").limits.push(kept);
        let sentence = headline(&r).sentence;
        assert!(!sentence.contains("change most"), "{sentence}");
    }

    #[test]
    fn a_limit_that_nothing_is_known_of_stays_open() {
        let mut r = with_verdict(Verdict::Inconclusive);
        let limit = &mut r.decision.as_mut().expect("decided").limits[0];
        limit.estimate = Estimate { value: 0.0, std_err: None, low: 0.0, high: f64::MAX };
        let sentence = headline(&r).sentence;
        assert_eq!(
            sentence,
            "point-lamps is not decided: its luminance error is not known, so the limit of 1.35 % stays open."
        );
    }

    #[test]
    fn what_is_judged_without_emission_says_so() {
        let mut r = with_verdict(Verdict::Pass);
        set(&mut r, "--reflected", "true");
        r.comparison.emitter_share = 0.987;
        assert!(headline(&r).sentence.contains("its error of reflected luminance is"));
        assert!(warnings(&r).is_empty());
    }

    #[test]
    fn bright_lamps_are_warned_of() {
        let mut r = record();
        r.comparison.emitter_share = 0.49;
        assert!(warnings(&r).is_empty());
        r.comparison.emitter_share = 0.987;
        let w = warnings(&r);
        assert!(w[0].1.contains("98.7 %") && w[0].1.contains("on reflected light alone it is"), "{w:?}");
    }
}
