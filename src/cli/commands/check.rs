//! `etalon compare` and `etalon check`

use super::inputs;
use super::report::write_report;
use crate::cli::args::{CheckArgs, CompareArgs, Kernel, OnInconclusive, Truth};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::PerLevel;
use crate::io::{SolutionFile, StoredReference, atomic, is_reference, read_solution};
use crate::metrics::{Decision, Limits, Verdict};
use crate::raycast::KernelKind;
use crate::report::{Exporter, Extras, JUnit, Markdown, json_object, text_summary};
use crate::scene::Stage;
use crate::solution::{Radiosity, TruthLevel};
use crate::study::{Against, Question, Receivers, Record, Setting, anonymous_stage, judge};
use crate::view::{Photometry, Primaries};
use std::io::IsTerminal;
use std::path::Path;

/// `etalon compare`: metrics, no verdict.
pub fn compare(args: &CompareArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let record = run(args, None, inputs::kernel_kind(kernel), console)?;
    show(&record, console)?;
    Ok(exit::DONE)
}

/// `etalon check`: metrics, limits, verdict.
pub fn check(args: &CheckArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let limits = limits(args)?;
    args.junit.as_deref().map(inputs::check_writable).transpose()?;
    let record = run(&args.compare, Some(limits), inputs::kernel_kind(kernel), console)?;
    if let Some(path) = &args.junit {
        write_only(path, &JUnit, &record)?;
    }
    show(&record, console)?;
    let decision = record.decision.as_ref().map(|d| exit_code(d, args.on_inconclusive));
    Ok(decision.unwrap_or(exit::DONE))
}

fn limits(args: &CheckArgs) -> Result<Limits, Failure> {
    let limits = Limits { max_rms: args.max_rms.map(|f| f.0), max_top1: args.max_top1.map(|f| f.0) };
    if limits == Limits::default() {
        return Err(Failure::input("a check needs at least one limit: give --max-rms, --max-top1, or both"));
    }
    if limits.max_top1.is_some() && args.compare.before.is_none() {
        return Err(Failure::input(
            "--max-top1 needs --before: the reference (or solution) of the state before the change",
        ));
    }
    Ok(limits)
}

fn exit_code(decision: &Decision, on_inconclusive: Option<OnInconclusive>) -> u8 {
    match (decision.verdict, on_inconclusive) {
        (Verdict::Pass, _) | (Verdict::Inconclusive, Some(OnInconclusive::Pass)) => exit::DONE,
        (Verdict::Fail, _) | (Verdict::Inconclusive, Some(OnInconclusive::Fail)) => exit::FAIL,
        (Verdict::Inconclusive, None) => exit::INCONCLUSIVE,
    }
}

fn show(record: &Record, console: &Console) -> Result<(), Failure> {
    let colour = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    console.result(text_summary(record, colour).trim_end(), &json_object(record)?);
    Ok(())
}

fn write_only(path: &Path, exporter: &dyn Exporter, record: &Record) -> Result<(), Failure> {
    for artifact in exporter.export(record, &Extras::default())? {
        inputs::write(path, &artifact.bytes)?;
    }
    Ok(())
}

/// Either a stored reference or a solution, as a path names it.
enum Input {
    Reference(Box<StoredReference>),
    Solution(SolutionFile),
}

impl Input {
    fn read(path: &Path) -> Result<Self, Failure> {
        if is_reference(path) {
            Ok(Self::Reference(Box::new(StoredReference::read(path)?)))
        } else {
            Ok(Self::Solution(read_solution(path)?))
        }
    }

    /// A reference that judges must have passed its self-check.
    fn trusted(self, path: &Path, judging: bool) -> Result<Self, Failure> {
        if let Self::Reference(r) = &self
            && judging
            && let Some(c) = r.self_check.failures().next()
        {
            return Err(Failure::input(format!(
                "{}: this reference failed its own self-check of {} ({}); compute a sound one",
                path.display(),
                c.name,
                c.finding
            ))
            .at(path.display().to_string()));
        }
        Ok(self)
    }
}

/// Reads everything, judges, and writes the files asked for.
fn run(args: &CompareArgs, limits: Option<Limits>, kernel: KernelKind, console: &Console) -> Result<Record, Failure> {
    args.markdown.as_deref().map(inputs::check_writable).transpose()?;
    args.report.as_deref().map(atomic::check_folder).transpose()?;
    if !(0.0..1.0).contains(&args.confidence.0) || args.confidence.0 == 0.0 {
        return Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example"));
    }
    let reference = Input::read(&args.reference)?.trusted(&args.reference, limits.is_some())?;
    let truth = check_truth(args, &reference)?;
    let stage = stage(args, &reference, console)?;
    let per_element = args.per == PerLevel::Element;
    let receivers = if per_element { Receivers::elements(&stage) } else { Receivers::patches(&stage) };
    let solution = fit(&args.solution, Input::read(&args.solution)?, &receivers, per_element, &stage)?;
    let against = match reference {
        Input::Reference(r) => Against::Reference(r),
        Input::Solution(s) => Against::Solution(s.fit(&receivers.photometry.bands, &receivers.present())?),
    };
    let before = args.before.as_deref().map(|path| before(path, &receivers, limits.is_some())).transpose()?;
    let confidence = args.confidence.0;
    let question = Question { limits, confidence, reflected: args.reflected, per_element };
    let judgement = judge(&solution, &against, before.as_ref(), &receivers, &question)?;
    let record = Record {
        reference: patch_means(&against, &stage, per_element),
        solution: if per_element { by_patch(&solution, &stage) } else { solution },
        solution_name: args.solution.display().to_string(),
        comparison: judgement.comparison,
        decision: judgement.decision,
        truth,
        settings: settings(args, limits.as_ref()),
        provenance: provenance(&against, &stage),
        notices: notices(args, &against),
        findings: match &against {
            Against::Reference(r) => r.findings.clone(),
            Against::Solution(_) => Vec::new(),
        },
        replay: replay(args, limits.as_ref()),
        stage,
    };
    if let Some(path) = &args.markdown {
        write_only(path, &Markdown, &record)?;
    }
    if let Some(folder) = &args.report {
        write_report(folder, &record, kernel, console)?;
    }
    Ok(record)
}

/// The truth the reference holds, by name; refuses another one being asked for.
fn check_truth(args: &CompareArgs, reference: &Input) -> Result<String, Failure> {
    let Input::Reference(r) = reference else { return Ok("solution".into()) };
    let held = r.provenance.truth;
    let asked = args.truth.map(|t| match t {
        Truth::PatchSystem => TruthLevel::PatchSystem,
        Truth::Continuous => TruthLevel::Continuous,
    });
    if asked.is_some_and(|a| a != held) {
        let (asked, held) = (asked.unwrap_or(held).name(), held.name());
        return Err(Failure::input(format!(
            "--truth {asked}: the reference {} holds {held}",
            args.reference.display()
        )));
    }
    Ok(held.name().into())
}

/// The judged stage: the reference's own, checked against `--scene`; or `--scene`; or nothing but a number.
fn stage(args: &CompareArgs, reference: &Input, console: &Console) -> Result<Stage, Failure> {
    let given = match &args.scene {
        Some(spec) => Some(inputs::stage_of(&inputs::scene(spec, args.max_edge, console)?, args.state)?),
        None => None,
    };
    match (reference, given) {
        (Input::Reference(r), Some(stage)) if stage.hash() != r.scene_hash => Err(Failure::input(format!(
            "the reference {} does not belong to scene \"{}\" in state {}: geometry, materials, discretisation or \
             state differ; compute it again with `etalon reference`",
            args.reference.display(),
            stage.name,
            stage.state
        ))),
        (Input::Reference(r), _) => Ok(r.stage.clone()),
        (Input::Solution(_), Some(stage)) => Ok(stage),
        (Input::Solution(s), None) => {
            s.check_complete()?;
            Ok(anonymous_stage(s.len(), guess_photometry(s)))
        }
    }
}

/// Without a scene: r, g, b (or three unnamed bands) are taken for Rec. 709, anything else weighs alike.
fn guess_photometry(s: &SolutionFile) -> Photometry {
    let rgb = Photometry::rec709();
    match &s.bands {
        Some(names) if *names == rgb.bands => rgb,
        None if s.width() == 3 => rgb,
        names => {
            let bands = names.clone().unwrap_or_else(|| (0..s.width()).map(|c| format!("band{c}")).collect());
            let weight = if s.width() == 1 { Primaries::Mono.weights()[0] } else { 1.0 / s.width() as f64 };
            Photometry { weights: vec![weight; bands.len()], bands }
        }
    }
}

fn fit(path: &Path, input: Input, to: &Receivers, per_element: bool, stage: &Stage) -> Result<Radiosity, Failure> {
    let file = match input {
        Input::Solution(file) => file,
        Input::Reference(r) => {
            let b = means(&r, per_element);
            if b.values.len() == to.areas.len() * to.photometry.bands.len() {
                return Ok(b);
            }
            let message = format!("{}: this reference is of another scene", path.display());
            return Err(Failure::input(message).at(path.display().to_string()));
        }
    };
    if let Some(hash) = &file.scene_hash
        && !stage.facets.is_empty()
        && *hash != stage.hash()
    {
        return Err(Failure::input(format!(
            "{}: this solution says it was computed for another scene, state or discretisation than the reference",
            path.display()
        ))
        .at(path.display().to_string()));
    }
    Ok(file.fit(&to.photometry.bands, &to.present())?)
}

fn before(path: &Path, receivers: &Receivers, judging: bool) -> Result<Against, Failure> {
    match Input::read(path)?.trusted(path, judging)? {
        Input::Reference(r) => Ok(Against::Reference(r)),
        Input::Solution(s) => Ok(Against::Solution(s.fit_before(&receivers.photometry.bands, receivers.areas.len())?)),
    }
}

/// Means of a reference at the level asked for.
fn means(r: &StoredReference, per_element: bool) -> Radiosity {
    match &r.elements {
        Some(e) if per_element => e.mean(),
        _ => r.patches.mean(),
    }
}

/// What pictures show of the reference: one value per patch.
fn patch_means(against: &Against, stage: &Stage, per_element: bool) -> Radiosity {
    match against {
        Against::Reference(r) => r.patches.mean(),
        Against::Solution(b) if per_element => by_patch(b, stage),
        Against::Solution(b) => b.clone(),
    }
}

/// Area-weighted means of the elements of each patch.
fn by_patch(elements: &Radiosity, stage: &Stage) -> Radiosity {
    let mut values = vec![0.0; stage.patch_count() * elements.bands];
    for (e, element) in stage.elements.iter().enumerate() {
        let i = element.patch as usize;
        let share = if stage.patches[i].is_present() { element.area / stage.patches[i].area } else { 0.0 };
        for (c, b) in elements.of(e).iter().enumerate() {
            values[i * elements.bands + c] += share * b;
        }
    }
    Radiosity { bands: elements.bands, values, std_err: None }
}

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
        out.push(("ray kernel".into(), format!("{} {}", p.kernel, p.kernel_version)));
        out.push(("seed".into(), p.seed.to_string()));
        out.push(("computed by".into(), format!("etalon {}", p.version)));
        for c in &r.self_check.checks {
            out.push((format!("self-check: {}", c.name), c.finding.clone()));
        }
    }
    out
}

fn notices(args: &CompareArgs, against: &Against) -> Vec<String> {
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

fn settings(args: &CompareArgs, limits: Option<&Limits>) -> Vec<Setting> {
    let setting = |name: &str, value: String, is_default: bool| Setting { name: name.into(), value, is_default };
    let mut out = vec![
        setting("--confidence", args.confidence.0.to_string(), args.confidence.0 == 0.95),
        setting(
            "--per",
            if args.per == PerLevel::Element { "element" } else { "patch" }.into(),
            args.per == PerLevel::Patch,
        ),
        setting("--reflected", args.reflected.to_string(), !args.reflected),
    ];
    for (name, limit) in
        [("--max-rms", limits.and_then(|l| l.max_rms)), ("--max-top1", limits.and_then(|l| l.max_top1))]
    {
        out.extend(limit.map(|l| setting(name, l.to_string(), false)));
    }
    out
}

/// The command that repeats the run.
fn replay(args: &CompareArgs, limits: Option<&Limits>) -> String {
    let mut words = vec!["etalon".to_string(), if limits.is_some() { "check" } else { "compare" }.into()];
    words.push(quoted(&args.solution.display().to_string()));
    let mut option = |name: &str, value: Option<String>| {
        if let Some(v) = value {
            words.push(format!("{name} {}", quoted(&v)));
        }
    };
    option("--reference", Some(args.reference.display().to_string()));
    option("--before", args.before.as_ref().map(|p| p.display().to_string()));
    option("--scene", args.scene.clone());
    option("--max-rms", limits.and_then(|l| l.max_rms).map(|x| x.to_string()));
    option("--max-top1", limits.and_then(|l| l.max_top1).map(|x| x.to_string()));
    option("--confidence", (args.confidence.0 != 0.95).then(|| args.confidence.0.to_string()));
    option("--per", (args.per == PerLevel::Element).then(|| "element".to_string()));
    if args.reflected {
        words.push("--reflected".into());
    }
    words.join(" ")
}

/// A word a shell takes as one.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:%=,".contains(c);
    if word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
