//! What a record tells about its run: settings with their defaults, provenance, notices, the command again.

use super::check::Asked;
use super::inputs;
use crate::cli::args::{CompareArgs, Kernel, LookingArgs, OnInconclusive, Truth};
use crate::cli::values::{Fraction, PerLevel, StateChoice};
use crate::estimate::{Estimator, Plan};
use crate::metrics::Verdict;
use crate::reference::Options;
use crate::scene::{Finding, Stage};
use crate::solution::{Provenance, TruthLevel};
use crate::study::{Against, Onlooker, Part, Setting};
use crate::view::Surround;

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
    if let Some(check) = asked.check {
        let fraction = |f: Option<Fraction>| f.map_or(NONE.to_string(), |f| f.0.to_string());
        out.push(Setting::new(of, "--max-rms", fraction(check.max_rms), NONE));
        out.push(Setting::new(of, "--max-top1", fraction(check.max_top1), NONE));
        out.push(Setting::new(of, "--max-worst", fraction(check.limits.max_worst), NONE));
        out.push(Setting::new(of, "--max-energy", fraction(check.limits.max_energy), NONE));
        out.push(Setting::new(of, "--max-visible", fraction(check.limits.max_visible), NONE));
        let named: Vec<String> = check.limits.named.iter().map(ToString::to_string).collect();
        out.push(Setting::new(of, "--limit", if named.is_empty() { NONE.into() } else { named.join(", ") }, NONE));
        let baseline = check.limits.baseline.as_ref().map_or(NONE.to_string(), |p| p.display().to_string());
        out.push(Setting::new(of, "--baseline", baseline, NONE));
        out.push(Setting::new(of, "--max-worse", fraction(check.limits.max_worse), NONE));
        out.push(Setting::new(of, "--until-decided", asked.until_decided, false));
        out.push(Setting::new(of, "--on-inconclusive", on_inconclusive(check.on_inconclusive), "exit 3"));
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
    out.extend(looking(&args.looking).map(|(name, value, default)| Setting::new(of, name, value, default)));
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

/// Options of looking: name, value, default.
fn looking(args: &LookingArgs) -> [(&'static str, String, String); 5] {
    let (v, usual) = (&args.viewing, Onlooker::default());
    let given = v.onlooker(args.tone);
    let surround = |s: Surround| format!("{s:?}").to_lowercase();
    [
        ("--tone", args.tone.name().into(), usual.operator.name().into()),
        ("--display", given.display.name, usual.display.name),
        ("--surround", surround(given.surround), surround(usual.surround)),
        ("--efficacy", given.efficacy.to_string(), usual.efficacy.to_string()),
        ("--adapt", given.adapt.map_or(BY_PICTURE.into(), |a| a.to_string()), BY_PICTURE.into()),
    ]
}

const BY_PICTURE: &str = "by the picture";
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

/// A fraction for people: 97.5 %.
pub(super) fn percent(x: f64) -> String {
    let text = format!("{:.3}", 100.0 * x);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// A verdict in a word.
pub(super) fn verdict(v: Verdict) -> &'static str {
    match v {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Inconclusive => "inconclusive",
    }
}

/// The command that repeats the run.
pub fn replay(asked: &Asked) -> String {
    let (args, check) = (asked.args, asked.check);
    let mut words = vec!["etalon".to_string(), if check.is_some() { "check" } else { "compare" }.into()];
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
    if let Some(c) = check {
        let fraction = |f: Option<Fraction>| f.map(|f| f.0.to_string());
        option("--max-rms", fraction(c.max_rms));
        option("--max-top1", fraction(c.max_top1));
        option("--max-worst", fraction(c.limits.max_worst));
        option("--max-energy", fraction(c.limits.max_energy));
        option("--max-visible", fraction(c.limits.max_visible));
        c.limits.named.iter().for_each(|l| option("--limit", Some(l.to_string())));
        option("--baseline", c.limits.baseline.as_ref().map(|p| p.display().to_string()));
        option("--max-worse", fraction(c.limits.max_worse));
        option("--on-inconclusive", c.on_inconclusive.map(|c| on_inconclusive(Some(c)).to_string()));
    }
    option("--confidence", (args.confidence.0 != CONFIDENCE).then(|| args.confidence.0.to_string()));
    option("--per", (args.per == PerLevel::Element).then(|| "element".to_string()));
    for (name, value, default) in looking(&args.looking) {
        option(name, (value != default).then_some(value));
    }
    option("--kernel", (asked.kernel != Kernel::Auto).then(|| kernel(asked.kernel).to_string()));
    option("--report", args.report.as_ref().map(|p| p.display().to_string()));
    if args.reflected {
        words.push("--reflected".into());
    }
    if asked.until_decided {
        words.push("--until-decided".into());
    }
    words.join(" ")
}

/// A word a shell takes as one.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:%=,".contains(c);
    if word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
