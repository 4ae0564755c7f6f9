//! What a page of curves tells about its run.

use super::converge::Asked;
use super::{inputs, told};
use crate::cli::args::{Estimator, Kernel, Truth};
use crate::cli::values::StateChoice;
use crate::estimate::Plan;
use crate::io::StoredReference;
use crate::report::Phase;
use crate::report::curves::About;

/// Settings, provenance, notices and the command again.
pub fn about<'a>(
    asked: &Asked,
    scene: &str,
    references: impl Iterator<Item = &'a StoredReference>,
    timing: Vec<Phase>,
) -> About {
    let (mut provenance, mut notices) = (Vec::new(), Vec::new());
    for r in references {
        provenance.extend(of_reference(r, asked));
        let missed = asked.options.plan.target_error.is_some_and(|t| r.provenance.relative_error > t);
        if missed {
            let (name, error) = (name(r, asked), r.provenance.relative_error);
            notices.push(format!("The {name} did not reach the target error: {error:.2e}."));
        }
    }
    About {
        scene: scene.into(),
        confidence: asked.args.confidence.0,
        settings: settings(asked),
        provenance,
        notices,
        replay: replay(asked),
        timing,
    }
}

/// Which of the references it is.
fn name(r: &StoredReference, asked: &Asked) -> String {
    match asked.args.refine.is_empty() {
        true => format!("reference of state {}", r.stage.state),
        false => format!("reference of {} patches", r.stage.patch_count()),
    }
}

fn of_reference(r: &StoredReference, asked: &Asked) -> Vec<(String, String)> {
    let p = &r.provenance;
    let what = if asked.truth() == Truth::Continuous { "paths" } else { "rays" };
    let text = format!(
        "{} {what} per patch in {} randomisations, {} {}; relative error {:.2e} (one sigma); scene hash {}",
        inputs::thousands(p.rays_per_patch),
        p.randomisations,
        p.kernel,
        p.kernel_version,
        p.relative_error,
        &r.scene_hash[..r.scene_hash.len().min(16)]
    );
    vec![(name(r, asked), text)]
}

fn truth(truth: Truth) -> &'static str {
    match truth {
        Truth::PatchSystem => "patch-system",
        Truth::Continuous => "continuous",
    }
}

fn estimator(e: Estimator) -> &'static str {
    match e {
        Estimator::Auto => "auto",
        Estimator::Rays => "rays",
    }
}

/// Every option with its value; those at their default are said to be.
fn options(asked: &Asked) -> Vec<(&'static str, String, Option<String>)> {
    let (args, plan) = (asked.args, Plan::default());
    let refining = !args.refine.is_empty();
    let default_truth = if refining { Truth::Continuous } else { Truth::PatchSystem };
    let mut out: Vec<(&'static str, String, Option<String>)> = Vec::new();
    let text = |x: &str| x.to_string();
    out.extend(args.methods.iter().map(|m| ("--methods", m.clone(), None)));
    out.extend(args.series.iter().map(|s| ("--series", format!("{}={}", s.name, s.folder.display()), None)));
    if refining {
        let factors: Vec<String> = args.refine.iter().map(ToString::to_string).collect();
        out.push(("--refine", factors.join(","), None));
        let state = args.state.unwrap_or(StateChoice::Final);
        out.push(("--state", told::state(state), Some(told::state(StateChoice::Final))));
    }
    out.extend(args.max_edge.map(|e| ("--max-edge", e.to_string(), None)));
    match args.rays.target_error {
        Some(t) => out.push(("--target-error", t.0.to_string(), None)),
        None => out.push(("--rays", args.rays.rays.to_string(), Some(plan.rays.to_string()))),
    }
    let randomisations = (args.rays.randomisations.to_string(), plan.randomisations.to_string());
    out.push(("--randomisations", randomisations.0, Some(randomisations.1)));
    out.extend(args.rays.max_time.map(|t| ("--max-time", format!("{}s", t.0.as_secs_f64()), None)));
    out.push(("--seed", args.rays.seed.to_string(), Some(text("0"))));
    out.push(("--estimator", text(estimator(args.rays.estimator)), Some(text("auto"))));
    out.push(("--truth", text(truth(asked.truth())), Some(text(truth(default_truth)))));
    out.push(("--confidence", args.confidence.0.to_string(), Some(told::CONFIDENCE.to_string())));
    out.push(("--kernel", text(told::kernel(asked.kernel)), Some(text(told::kernel(Kernel::Auto)))));
    out
}

fn settings(asked: &Asked) -> Vec<(String, String)> {
    let shown = |(name, value, default): (&'static str, String, Option<String>)| {
        let value = match default {
            Some(d) if d != value => format!("{value} (instead of {d})"),
            _ => value,
        };
        (name.to_string(), value)
    };
    let mut out: Vec<(String, String)> = options(asked).into_iter().map(shown).collect();
    if asked.args.reflected {
        out.push(("--reflected".into(), "B - E".into()));
    }
    out
}

/// The command that repeats the run. Threads change nothing.
fn replay(asked: &Asked) -> String {
    let args = asked.args;
    let mut words = vec!["etalon converge".to_string(), told::quoted(&args.scene)];
    for (name, value, default) in options(asked) {
        if default.as_ref() != Some(&value) {
            words.push(format!("{name} {}", told::quoted(&value)));
        }
    }
    if args.reflected {
        words.push("--reflected".into());
    }
    words.push(format!("-o {}", told::quoted(&args.output.display().to_string())));
    words.join(" ")
}
