//! Findings: what the numbers of an audit mean, in words, each with the numbers it stands on.

use super::record::{AuditRecord, CureRun, Form, SourceAudit};
use crate::audit::Cause;
use crate::metrics::Verdict;
use crate::stats::Estimate;
use serde::Serialize;
use serde_json::{Value, json};

/// A finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// What it is about: `error`, `cause`, `source`, `beats`, `mend`, `fingerprint`, `self-check`.
    pub about: String,
    /// In words.
    pub text: String,
    /// The numbers.
    pub data: Value,
}

impl Finding {
    fn new(about: &str, text: String, data: Value) -> Self {
        Self { about: about.into(), text, data }
    }
}

/// All findings, the weightiest first.
pub(super) fn of(record: &AuditRecord) -> Vec<Finding> {
    let mut all = vec![error(record), cause(record)];
    all.extend(fingerprint(record));
    for (k, source) in record.sources.iter().enumerate() {
        all.push(of_source(record, source));
        all.extend(beat(source));
        all.extend(mend(record, k));
    }
    all.push(overall_mend(record));
    all.extend(record.self_check_failures.iter().map(|f| {
        Finding::new("self-check", format!("the judge failed its own check of {f}: believe none of this"), json!({}))
    }));
    all
}

/// A share in per cent, with as many digits as it deserves.
fn percent(x: f64) -> String {
    let p = 100.0 * x;
    match p.abs() {
        a if a >= 9.95 => format!("{p:.0} %"),
        a if a >= 0.995 => format!("{p:.1} %"),
        a if a >= 0.0995 => format!("{p:.2} %"),
        0.0 => "0 %".into(),
        _ => format!("{p:.1e} %"),
    }
}

fn interval(e: Option<Estimate>) -> String {
    match e {
        Some(e) if e.low == e.high => percent(e.value),
        Some(e) => format!("{} ({} to {})", percent(e.value), percent(e.low), percent(e.high)),
        None => "not defined (the reference is dark)".into(),
    }
}

fn error(record: &AuditRecord) -> Finding {
    let who = match (&record.theirs, record.form) {
        (Some(file), _) => format!("the form factors of {file} bring"),
        (None, Form::Receiver) => format!("a hemi-cube of resolution {} at every patch brings", record.resolution),
        (None, Form::Shooter) => {
            format!("progressive refinement with a hemi-cube of resolution {} at the shooter brings", record.resolution)
        }
    };
    let verdict = match (record.verdict, record.limit) {
        (Some(Verdict::Pass), Some(l)) => format!(": within the limit of {}", percent(l)),
        (Some(Verdict::Fail), Some(l)) => format!(": beyond the limit of {}", percent(l)),
        (Some(Verdict::Inconclusive), Some(l)) => {
            format!(": whether that is within the limit of {} cannot be told from this reference", percent(l))
        }
        _ => String::new(),
    };
    let text = format!(
        "{who} an error of {} to the reflected light (eq. 7), {} over the 1 % of the patches that receive most{verdict}",
        interval(record.wrong.rms),
        interval(record.wrong.top1)
    );
    Finding::new("error", text, json!({ "rms": record.wrong.rms, "top1": record.wrong.top1, "limit": record.limit }))
}

fn cause(record: &AuditRecord) -> Finding {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| record.alone[*b].total_cmp(&record.alone[*a]));
    let of = |k: usize| {
        let off = record.without[k].rms.map_or("?".into(), |e| percent(e.value));
        format!("{} {} (switched off: {off} left)", Cause::ALL[k].name(), percent(record.alone[k]))
    };
    let text = format!(
        "by cause, carried through all bounces: {}, {}, {}; at infinite resolution {} would be left",
        of(order[0]),
        of(order[1]),
        of(order[2]),
        record.infinite.rms.map_or("?".into(), |e| percent(e.value))
    );
    let by_cause =
        |k: usize| json!({ "cause": Cause::ALL[k].name(), "alone": record.alone[k], "without": record.without[k].rms });
    let data = json!({ "causes": order.map(by_cause), "infinite_resolution": record.infinite.rms });
    Finding::new("cause", text, data)
}

fn of_source(record: &AuditRecord, s: &SourceAudit) -> Finding {
    let seen = &s.seen;
    let [least, middle, most] = seen.pixels;
    let mut text = format!(
        "source \"{}\" brings {} of error at the first bounce, mostly {}: {} patches see it, {:.1} to {:.1} m away",
        s.source.name,
        percent(s.source.error),
        s.main_cause.name(),
        seen.receivers,
        seen.distance[0],
        seen.distance[2]
    );
    let pixels = |x: f64| if x < 10.0 { format!("{x:.2}") } else { format!("{x:.0}") };
    let who = if record.form == Form::Shooter { "they cover" } else { "it covers" };
    text +=
        &format!(", where {who} {} to {} pixels (half of them below {})", pixels(least), pixels(most), pixels(middle));
    if seen.missed + seen.doubled + seen.less_than_half > 0 {
        text += &format!(
            "; {} miss it altogether, {} count less than half of it, {} count it double or more",
            seen.missed, seen.less_than_half, seen.doubled
        );
    }
    if let Some(worst) = seen.worst.first() {
        text += &format!(
            "; the worst is patch {} on {}: form factor {:.3e} instead of {:.3e}, by {}",
            worst.patch,
            worst.surface,
            worst.cube,
            worst.mean,
            worst.main_cause.name()
        );
        if record.form == Form::Receiver && worst.main_cause == Cause::Aliasing {
            text += &format!(" ({} pixels instead of {})", pixels(worst.counted), pixels(worst.pixels));
        }
    }
    let data = json!({
        "source": s.source.name, "error": s.source.error, "by_cause": s.source.by_cause, "main_cause": s.main_cause,
        "receivers": seen.receivers, "missed": seen.missed, "less_than_half": seen.less_than_half,
        "doubled": seen.doubled, "pixels": seen.pixels, "distance": seen.distance, "ratio": seen.ratio,
        "worst": seen.worst,
    });
    Finding::new("source", text, data)
}

fn beat(s: &SourceAudit) -> Option<Finding> {
    let b = s.seen.beats.first()?;
    let text = format!(
        "the count of \"{}\" beats across {}: a wave of {:.2} m ({:.1} patches) along its {} axis holds {} of a \
         variation of {}",
        s.source.name,
        b.surface,
        b.period,
        b.patches,
        if b.axis == 0 { "first" } else { "second" },
        percent(b.share),
        percent(b.spread)
    );
    Some(Finding::new("beats", text, json!({ "source": s.source.name, "beats": s.seen.beats })))
}

/// What brings one source below the limit.
fn mend(record: &AuditRecord, k: usize) -> Option<Finding> {
    let (limit, s) = (record.limit?, &record.sources[k]);
    if s.source.error <= limit || record.cures.is_empty() {
        return None;
    }
    let by_pixels = s.resolution_by_pixels.map_or(String::new(), |r| {
        format!(" (by the pixels it covers alone, counting would need a resolution of about {r})")
    });
    let text = match s.mended_by.map(|c| &record.cures[c]) {
        Some(c) => format!(
            "source \"{}\": {} brings its error from {} to {} in {}{by_pixels}",
            s.source.name,
            c.words,
            percent(s.source.error),
            percent(c.by_source[k]),
            cost(c, record)
        ),
        None => format!(
            "source \"{}\": no cure that was run brings its error below {}; the best leaves {}{by_pixels}",
            s.source.name,
            percent(limit),
            percent(record.cures.iter().map(|c| c.by_source[k]).fold(f64::INFINITY, f64::min))
        ),
    };
    Some(Finding::new("mend", text, json!({ "source": s.source.name, "cure": s.mended_by })))
}

/// What brings the whole solution below the limit, or closest.
fn overall_mend(record: &AuditRecord) -> Finding {
    let value = |c: &CureRun| c.wrong.rms.map_or(f64::INFINITY, |e| e.value);
    let best = record.cures.iter().min_by(|a, b| value(a).total_cmp(&value(b)));
    let passing = record.cures.iter().find(|c| c.verdict == Some(Verdict::Pass));
    let text = match (passing, best) {
        (Some(c), _) => {
            format!("cheapest that passes: {}: {} in {}", c.words, interval(c.wrong.rms), cost(c, record))
        }
        (None, Some(c)) if record.limit.is_some() => format!(
            "no cure that was run passes; closest: {}: {} in {}",
            c.words,
            interval(c.wrong.rms),
            cost(c, record)
        ),
        (None, Some(c)) => {
            format!("best of the cures that were run: {}: {} in {}", c.words, interval(c.wrong.rms), cost(c, record))
        }
        (None, None) => "no cures were run".into(),
    };
    Finding::new("mend", text, json!({ "passing": passing.map(|c| &c.cure), "best": best.map(|c| &c.cure) }))
}

/// The time of a cure, also against the hemi-cube as it is.
fn cost(c: &CureRun, record: &AuditRecord) -> String {
    let plain = record.cures.iter().find(|c| c.cure == crate::audit::Cure::None).map_or(0.0, |c| c.seconds);
    if plain > 0.0 {
        format!("{:.2} s, {:.1} times that of the hemi-cube as it is", c.seconds, c.seconds / plain)
    } else {
        format!("{:.2} s", c.seconds)
    }
}

fn fingerprint(record: &AuditRecord) -> Option<Finding> {
    let f = record.fingerprint.as_ref()?;
    Some(Finding::new("fingerprint", f.to_string(), json!(f)))
}
