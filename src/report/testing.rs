//! A real little record for the tests of reports: the room of `render::testing` under direct light.

use super::html::context::minus;
use crate::metrics::{
    Breakdown, Comparison, Decision, Judged, LimitOutcome, Part as ErrorPart, Split, Truth, Verdict, WorstPatch,
    break_down,
};
use crate::render::luminance;
use crate::render::testing::{direct_light, room};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, Stage};
use crate::solution::{Radiosity, Replicates};
use crate::stats::Estimate;
use crate::study::{Contributions, Part, Record, Setting, Source};

fn estimate(value: f64, half_width: f64) -> Estimate {
    Estimate { value, std_err: Some(half_width / 2.0), low: value - half_width, high: value + half_width }
}

/// The room by closed form against the room with lamps taken as points. Metrics are given, not computed here.
pub(crate) fn record() -> Record {
    let stage = room();
    let (reference, solution) = (direct_light(&stage, false), direct_light(&stage, true));
    let (y, y_solution) = (luminance(&stage.photometry, &reference), luminance(&stage.photometry, &solution));
    let mut order: Vec<usize> = (0..y.len()).collect();
    order.sort_by(|a, b| (y_solution[*b] - y[*b]).abs().total_cmp(&(y_solution[*a] - y[*a]).abs()));
    let worst = order[..10].iter().map(|&i| WorstPatch {
        patch: i,
        surface: stage.surface_name(i).into(),
        reference: y[i],
        solution: y_solution[i],
        difference: y_solution[i] - y[i],
        std_err: Some(0.004 * y[i] + 0.001),
    });
    let comparison = Comparison {
        confidence: 0.95,
        rms: estimate(0.013412, 0.0005),
        top1: None,
        rms_reflected: Some(estimate(0.0871, 0.0012)),
        bias: estimate(0.00312, 0.0004),
        per_band: ["r", "g", "b"].iter().map(|b| (b.to_string(), Some(estimate(0.0131, 0.0005)))).collect(),
        reference_noise_floor: Some(0.00062),
        solution_noise: None,
        emitter_share: 0.43,
        scale: None,
        scale_of_total: None,
        patches: stage.patch_count(),
        worst: worst.collect(),
    };
    Record {
        breakdown: Some(breakdown(&stage, &reference, &solution)),
        contributions: vec![contributions()],
        stage,
        before: None,
        reference,
        solution,
        solution_name: "point-lamps".into(),
        comparison,
        decision: None,
        split: None,
        as_seen: None,
        truth: "patch-system".into(),
        settings: vec![
            Setting::new(Part::Judgement, "--confidence", 0.95, 0.95),
            Setting::new(Part::Judgement, "--max-rms", 0.05, "none"),
            Setting::given(Part::Reference, "--kernel", "closed form"),
            Setting::new(Part::Reference, "--rays", 65_536, 16_384),
        ],
        provenance: vec![
            ("Program".into(), "etalon 0.1.0".into()),
            ("Reference".into(), "closed form, direct light only".into()),
        ],
        causes: Vec::new(),
        looks: Vec::new(),
        notices: vec!["surface \"red wall\": a notice of the scene".into()],
        findings: vec![finding()],
        replay: "etalon check point-lamps.csv --reference room.ref --max-rms 5%".into(),
    }
}

/// The real breakdown against twelve made-up replicates: what is reflected scatters by 0.3 %, each patch in a way of its
/// own.
fn breakdown(stage: &Stage, reference: &Radiosity, solution: &Radiosity) -> Breakdown {
    let scatter = |r: usize, k: usize| 0.003 * ((7 * r * r + 3 * r * (k / 3)) as f64).sin();
    let emission = stage.emissions();
    let noisy = |r: usize, k: usize, b: f64| b + (b - emission[k]) * scatter(r, k);
    let row = |r: usize| reference.values.iter().enumerate().map(|(k, b)| noisy(r, k, *b)).collect();
    let replicates = Replicates { bands: reference.bands, replicates: (0..12).map(row).collect() };
    let surfaces: Vec<&str> = (0..stage.patch_count()).map(|i| stage.surface_name(i)).collect();
    let objects: Vec<&str> = surfaces.iter().map(|s| if s.contains("wall") { "walls" } else { "rest" }).collect();
    let judged = Judged {
        areas: &stage.areas(),
        emission: &emission,
        surfaces: &surfaces,
        bands: &stage.photometry.bands,
        weights: &stage.photometry.weights,
    };
    break_down(solution, &Truth::Sampled(replicates), &judged, &objects, 0.95, false).expect("a breakdown")
}

/// Given, not computed: a patch that two surfaces light.
fn contributions() -> Contributions {
    let exact = |value: f64, std_err: f64| Estimate { std_err: Some(std_err), ..estimate(value, 2.0 * std_err) };
    let source = |name: &str, surfaces, form_factor, light: f64, handed_on: f64| Source {
        surface: name.into(),
        surfaces,
        form_factor,
        luminance: exact(light, 0.01 * light),
        share: Some(light / 1.25),
        handed_on: exact(handed_on, 0.001),
    };
    Contributions {
        receiver: 12,
        surface: "floor".into(),
        rays: 65_536,
        reference: exact(1.2504, 0.002),
        emission: 0.0,
        sources: vec![source("lamp", 1, 0.1, 1.0, 0.0), source("red wall", 1, 0.2, 0.2, 0.01)],
        others: Some(source("", 3, 0.05, 0.05, 0.0)),
        sum: exact(1.25, 0.002),
        difference: 0.05,
        handed_on: exact(0.01, 0.001),
        own: exact(0.04, 0.002),
    }
}

fn finding() -> Finding {
    Finding {
        kind: FindingKind::BuriedCentre,
        severity: Severity::Warning,
        place: Place { surfaces: vec!["floor".into()], patches: vec![12], ..Place::default() },
        what: "The middle of patch 12 lies inside the box.".into(),
        consequence: Some(Consequence {
            text: "A method that looks from there misses 0.31 of its light.".into(),
            value: 0.31,
            std_err: None,
            unit: "share".into(),
        }),
        mend: "Divide the floor along the box.".into(),
    }
}

/// The same with a limit that leads to the verdict.
pub(crate) fn with_verdict(verdict: Verdict) -> Record {
    let mut r = record();
    let (limit, rays_factor) = match verdict {
        Verdict::Pass => (0.05, None),
        Verdict::Fail => (0.01, None),
        Verdict::Inconclusive => (0.0135, Some(123.0)),
    };
    let estimate = r.comparison.rms;
    let outcome = LimitOutcome {
        metric: "rms".into(),
        limit,
        estimate,
        verdict,
        rays_factor,
        smallest_caught: Some(limit + 0.001),
    };
    r.decision = Some(Decision { verdict, limits: vec![outcome] });
    r
}

/// Gives a setting another value.
pub(crate) fn set(record: &mut Record, name: &str, value: &str) {
    record.settings.retain(|s| s.name != name);
    record.settings.push(Setting::given(Part::Judgement, name, value));
}

/// The same with the error split into its parts: given, not computed.
pub(crate) fn with_split() -> Record {
    let mut r = record();
    let worst = r.comparison.worst.first().cloned();
    let part = |rms: f64, half_width: f64, bias: f64| {
        Some(ErrorPart { rms: estimate(rms, half_width), bias, worst: worst.clone() })
    };
    r.split = Some(Split {
        solver: part(0.002, 0.0001, -0.001),
        form_factor: part(0.011, 0.001, 0.004),
        discretisation: part(0.006, 0.0004, 0.00012),
        ..Split::default()
    });
    r
}

/// Text with what the template does to it.
pub(super) fn shown(text: &str) -> String {
    let text = minus(text);
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\'' => out += "&#x27;",
            '/' => out += "&#x2f;",
            c => out.push(c),
        }
    }
    out
}

/// Every element that is opened is closed, in order.
pub(super) fn assert_well_formed(page: &str) {
    // Scripts are no markup, and style is none.
    let page = ["script", "style"].iter().fold(page.to_string(), |page, name| {
        let (begin, end) = (format!("<{name}"), format!("</{name}>"));
        page.split(&end).map(|part| part.split(&begin).next().expect("a part")).collect()
    });
    let void = ["meta", "img", "br", "!DOCTYPE"];
    let mut open: Vec<String> = Vec::new();
    let mut at = 0;
    while let Some(begin) = page[at..].find('<').map(|k| k + at) {
        if page[begin..].starts_with("<!--") {
            at = begin + page[begin..].find("-->").expect("an end of the comment");
            continue;
        }
        let end = begin + page[begin..].find('>').expect("an end of the tag");
        let tag = &page[begin + 1..end];
        let name: String =
            tag.trim_start_matches('/').chars().take_while(|c| !c.is_whitespace() && *c != '/').collect();
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "at {}", &page[begin.saturating_sub(200)..end]);
        } else if !tag.ends_with('/') && !void.contains(&name.as_str()) {
            open.push(name);
        }
        at = end;
    }
    assert!(open.is_empty(), "{open:?}");
}

/// What stands outside of the marked blocks.
pub(super) fn outside(page: &str) -> String {
    let mut out = String::new();
    let mut rest = page;
    while let Some(begin) = rest.find("<!-- wall-clock: begin") {
        out += &rest[..begin];
        let end = "<!-- wall-clock: end -->";
        rest = &rest[begin + rest[begin..].find(end).expect("an end") + end.len()..];
    }
    out + rest
}
