//! What a record tells about its run: settings with their defaults, provenance, notices, the command again.

use super::check::Asked;
use super::inputs;
use crate::cli::args::{CompareArgs, Kernel, OnInconclusive, Truth};
use crate::cli::values::{PerLevel, StateChoice};
use crate::estimate::{Estimator, Plan};
use crate::reference::Options;
use crate::scene::{Finding, Stage};
use crate::solution::{Provenance, TruthLevel};
use crate::study::{Against, Part, Setting};

/// Confidence without being asked.
pub const CONFIDENCE: f64 = 0.95;
/// That of the continuous problem.
const PATHS: &str = "paths";

/// What the scene doctor found when the reference was made.
pub fn findings(against: &Against) -> Vec<Finding> {
    match against {
        Against::Reference(r) => r.findings.clone(),
        Against::Solution(_) => Vec::new(),
    }
}

/// Where the reference comes from and what it found about itself.
pub fn provenance(against: &Against, stage: &Stage) -> Vec<(String, String)> {
    let mut out = vec![
        ("scene".to_string(), stage.name.clone()),
        ("scene hash".to_string(), if stage.facets.is_empty() { "(none)".into() } else { stage.hash() }),
    ];
    if let Against::Reference(r) = against {
        let p = &r.provenance;
        let rays = inputs::thousands(p.rays_per_patch);
        out.push(("rays per patch".into(), format!("{rays} in {} independent randomisations", p.randomisations)));
        out.push(("rays in all".into(), inputs::thousands(p.rays)));
        out.push(("rays that escaped".into(), inputs::thousands(p.escapes)));
        out.push(("rays that met a back".into(), inputs::thousands(p.back_hits)));
        let set = p.instruction_set.as_ref().map_or(String::new(), |s| format!(" ({s})"));
        out.push(("ray kernel".into(), format!("{} {}{set}", p.kernel, p.kernel_version)));
        out.push(("computed by".into(), format!("etalon {}", p.version)));
        for c in &r.self_check.checks {
            out.push((format!("self-check: {}", c.name), c.finding.clone()));
        }
    }
    out
}

/// Things the reader has to know.
pub fn notices(args: &CompareArgs, against: &Against) -> Vec<String> {
    let mut out = Vec::new();
    match against {
        Against::Solution(_) if args.scene.is_none() => {
            out.push("no scene given: every patch weighs alike; --scene SCENE brings areas and photometry".into());
        }
        Against::Solution(_) => {}
        Against::Reference(r) => {
            for c in r.self_check.failures() {
                out.push(format!("the reference failed its self-check of {}: {}", c.name, c.finding));
            }
        }
    }
    out
}

/// Every setting in force, of the judgement and of the reference.
pub fn settings(asked: &Asked, against: &Against) -> Vec<Setting> {
    let args = asked.args;
    let of = Part::Judgement;
    let mut out = vec![Setting::given(of, "--reference", args.reference.display())];
    let limit = |l: Option<f64>| l.map_or(NONE.to_string(), |l| l.to_string());
    if asked.limits.is_some() {
        out.push(Setting::new(of, "--max-rms", limit(asked.limits.and_then(|l| l.max_rms)), NONE));
        out.push(Setting::new(of, "--max-top1", limit(asked.limits.and_then(|l| l.max_top1)), NONE));
        out.push(Setting::new(of, "--on-inconclusive", on_inconclusive(asked.on_inconclusive), "exit 3"));
    }
    let path = |p: &Option<std::path::PathBuf>| p.as_ref().map_or(NONE.to_string(), |p| p.display().to_string());
    out.push(Setting::new(of, "--before", path(&args.before), NONE));
    out.push(Setting::new(of, "--form-factors", path(&args.form_factors), NONE));
    out.push(Setting::new(of, "--patch-system", path(&args.patch_system), NONE));
    out.push(Setting::new(of, "--confidence", args.confidence.0, CONFIDENCE));
    out.push(Setting::new(of, "--reflected", args.reflected, false));
    out.push(Setting::new(of, "--per", level(args.per), level(PerLevel::Patch)));
    let truth = args.truth.map_or("as the reference holds", truth);
    out.push(Setting::new(of, "--truth", truth, "as the reference holds"));
    out.push(Setting::new(of, "--scene", args.scene.as_deref().unwrap_or(NONE), NONE));
    if args.scene.is_some() {
        out.push(Setting::new(of, "--state", state(args.state), state(StateChoice::Final)));
        let edge = args.max_edge.map_or("as the scene says".to_string(), |e| format!("{e} m"));
        out.push(Setting::new(of, "--max-edge", edge, "as the scene says"));
    }
    out.push(Setting::new(of, "--kernel", kernel(asked.kernel), kernel(Kernel::Auto)));
    if let Against::Reference(r) = against {
        out.extend(of_reference(&r.provenance, &r.stage));
    }
    out
}

/// The settings that made a reference.
pub fn of_reference(p: &Provenance, stage: &Stage) -> Vec<Setting> {
    let (of, plan, options) = (Part::Reference, Plan::default(), Options::default());
    vec![
        Setting::given(of, "state", format!("{} edits applied", stage.state)),
        Setting::new(of, "--truth", p.truth.name(), TruthLevel::default().name()),
        Setting::new(of, "--rays", p.rays_per_patch, plan.rays),
        Setting::new(of, "--randomisations", p.randomisations, plan.randomisations),
        Setting::new(of, "--seed", p.seed, options.seed),
        match p.truth {
            TruthLevel::PatchSystem => Setting::new(of, "--estimator", &p.estimator, Estimator::Auto.name()),
            TruthLevel::Continuous => Setting::given(of, "estimator", PATHS),
        },
        Setting::given(of, "--kernel", &p.kernel),
        Setting::given(of, "enclosure", p.enclosure),
    ]
}

const NONE: &str = "none";

fn level(per: PerLevel) -> &'static str {
    if per == PerLevel::Element { "element" } else { "patch" }
}

pub(super) fn state(state: StateChoice) -> String {
    match state {
        StateChoice::Initial => "initial".into(),
        StateChoice::Final => "final".into(),
        StateChoice::After(k) => k.to_string(),
    }
}

fn truth(truth: Truth) -> &'static str {
    match truth {
        Truth::PatchSystem => "patch-system",
        Truth::Continuous => "continuous",
    }
}

fn on_inconclusive(choice: Option<OnInconclusive>) -> &'static str {
    match choice {
        None => "exit 3",
        Some(OnInconclusive::Pass) => "pass",
        Some(OnInconclusive::Fail) => "fail",
    }
}

/// Name of a kernel as on the command line.
pub fn kernel(kernel: Kernel) -> &'static str {
    match kernel {
        Kernel::Auto => "auto",
        Kernel::Embree => "embree",
        Kernel::Builtin => "builtin",
        Kernel::Embree4Rs => "embree4-rs",
    }
}

/// The command that repeats the run.
pub fn replay(asked: &Asked) -> String {
    let (args, limits) = (asked.args, asked.limits);
    let mut words = vec!["etalon".to_string(), if limits.is_some() { "check" } else { "compare" }.into()];
    words.push(quoted(&args.solution.display().to_string()));
    let mut option = |name: &str, value: Option<String>| {
        if let Some(v) = value {
            words.push(format!("{name} {}", quoted(&v)));
        }
    };
    option("--reference", Some(args.reference.display().to_string()));
    option("--before", args.before.as_ref().map(|p| p.display().to_string()));
    option("--form-factors", args.form_factors.as_ref().map(|p| p.display().to_string()));
    option("--patch-system", args.patch_system.as_ref().map(|p| p.display().to_string()));
    option("--scene", args.scene.clone());
    let has_scene = args.scene.is_some();
    option("--state", (has_scene && args.state != StateChoice::Final).then(|| state(args.state)));
    option("--max-edge", args.max_edge.filter(|_| has_scene).map(|e| e.to_string()));
    option("--truth", args.truth.map(|t| truth(t).to_string()));
    option("--max-rms", limits.and_then(|l| l.max_rms).map(|x| x.to_string()));
    option("--max-top1", limits.and_then(|l| l.max_top1).map(|x| x.to_string()));
    option("--on-inconclusive", asked.on_inconclusive.map(|c| on_inconclusive(Some(c)).to_string()));
    option("--confidence", (args.confidence.0 != CONFIDENCE).then(|| args.confidence.0.to_string()));
    option("--per", (args.per == PerLevel::Element).then(|| "element".to_string()));
    option("--kernel", (asked.kernel != Kernel::Auto).then(|| kernel(asked.kernel).to_string()));
    option("--report", args.report.as_ref().map(|p| p.display().to_string()));
    if args.reflected {
        words.push("--reflected".into());
    }
    words.join(" ")
}

/// A word a shell takes as one.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:%=,".contains(c);
    if word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
