//! A real little record for the tests of reports: the room of `render::testing` under direct light.

use crate::metrics::{Comparison, Decision, LimitOutcome, Verdict, WorstPatch};
use crate::render::luminance;
use crate::render::testing::{direct_light, room};
use crate::stats::Estimate;
use crate::study::{Record, Setting};

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
        patches: stage.patch_count(),
        worst: worst.collect(),
    };
    Record {
        stage,
        reference,
        solution,
        solution_name: "point-lamps".into(),
        comparison,
        decision: None,
        truth: "patch-system".into(),
        settings: vec![
            Setting { name: "--confidence".into(), value: "0.95".into(), is_default: true },
            Setting { name: "--max-rms".into(), value: "0.05".into(), is_default: false },
        ],
        provenance: vec![
            ("Program".into(), "etalon 0.1.0".into()),
            ("Reference".into(), "closed form, direct light only".into()),
        ],
        notices: vec!["surface \"red wall\": a notice of the scene".into()],
        findings: Vec::new(),
        replay: "etalon check point-lamps.csv --reference room.ref --max-rms 5%".into(),
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
    let outcome = LimitOutcome { metric: "rms".into(), limit, estimate: r.comparison.rms, verdict, rays_factor };
    r.decision = Some(Decision { verdict, limits: vec![outcome] });
    r
}

/// Gives a setting another value.
pub(crate) fn set(record: &mut Record, name: &str, value: &str) {
    record.settings.retain(|s| s.name != name);
    record.settings.push(Setting { name: name.into(), value: value.into(), is_default: false });
}
