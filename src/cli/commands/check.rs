//! `etalon compare` and `etalon check`

use super::report::{Stopwatch, write_report};
use super::{check_residual, inputs, split, told};
use crate::cli::args::{CheckArgs, CompareArgs, Kernel, OnInconclusive, Truth};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::PerLevel;
use crate::io::{SolutionFile, StoredReference, atomic, is_reference, read_solution};
use crate::metrics::{Limits, Verdict};
use crate::report::{Exporter, Extras, JUnit, Markdown, json_object, text_summary};
use crate::scene::Stage;
use crate::solution::{Radiosity, TruthLevel};
use crate::study::{
    self, Against, Contributions, Question, Receivers, Record, Rows, Session, anonymous_stage, break_down, judge,
};
use crate::view::{Photometry, Primaries};
use std::io::IsTerminal;
use std::path::Path;

/// So many of the worst patches are explained by what lights them.
const EXPLAINED: usize = 5;

/// `etalon compare`: metrics, no verdict.
pub fn compare(args: &CompareArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    if args.residual.residual {
        return check_residual::compare(args, kernel, console);
    }
    let record = run(&Asked { args, limits: None, on_inconclusive: None, kernel }, console)?;
    show(&record, console)?;
    Ok(exit::DONE)
}

/// `etalon check`: metrics, limits, verdict.
pub fn check(args: &CheckArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    if args.compare.residual.residual {
        return check_residual::check(args, kernel, console);
    }
    let limits = limits(args)?;
    args.junit.as_deref().map(inputs::check_writable).transpose()?;
    let asked = Asked { args: &args.compare, limits: Some(limits), on_inconclusive: args.on_inconclusive, kernel };
    let record = run(&asked, console)?;
    if let Some(path) = &args.junit {
        write_only(path, &JUnit, &record)?;
    }
    show(&record, console)?;
    let decision = record.decision.as_ref().map(|d| exit_code(d.verdict, args.on_inconclusive));
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

/// What a verdict ends the program with.
pub fn exit_code(verdict: Verdict, on_inconclusive: Option<OnInconclusive>) -> u8 {
    match (verdict, on_inconclusive) {
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
pub enum Input {
    Reference(Box<StoredReference>),
    Solution(SolutionFile),
}

impl Input {
    /// Reads what a path names.
    pub fn read(path: &Path) -> Result<Self, Failure> {
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

/// What was asked for, checked.
pub struct Asked<'a> {
    pub args: &'a CompareArgs,
    pub limits: Option<Limits>,
    pub on_inconclusive: Option<OnInconclusive>,
    pub kernel: Kernel,
}

/// Reads everything, judges, and writes the files asked for.
fn run(asked: &Asked, console: &Console) -> Result<Record, Failure> {
    let (args, limits) = (asked.args, asked.limits);
    let mut watch = Stopwatch::start();
    args.markdown.as_deref().map(inputs::check_writable).transpose()?;
    args.report.as_deref().map(atomic::check_folder).transpose()?;
    if !(0.0..1.0).contains(&args.confidence.0) || args.confidence.0 == 0.0 {
        return Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example"));
    }
    split::check(args)?;
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
    watch.lap("reading");
    let question = Question { limits, confidence: args.confidence.0, reflected: args.reflected, per_element };
    let judgement = judge(&solution, &against, before.as_ref(), &receivers, &question)?;
    let confidence = judgement.comparison.confidence;
    let split = split::split(args, &stage, &solution, &against, &receivers, confidence)?;
    let by_patch = if per_element { by_patch(&solution, &stage) } else { solution.clone() };
    let mut record = Record {
        solution_name: args.solution.display().to_string(),
        truth,
        decision: judgement.decision,
        comparison: judgement.comparison,
        breakdown: None,
        split,
        contributions: Vec::new(),
        findings: told::findings(&against),
        notices: told::notices(args, &against),
        settings: told::settings(asked, &against),
        provenance: told::provenance(&against, &stage),
        replay: told::replay(asked),
        reference: patch_means(&against, &stage, per_element),
        solution: by_patch,
        stage,
    };
    watch.lap("judging");
    if let Some(path) = &args.markdown {
        write_only(path, &Markdown, &record)?;
    }
    if let Some(folder) = &args.report {
        let stage = record.stage.clone();
        let session = open(&stage, asked.kernel, console)?;
        record.breakdown = Some(break_down(&solution, &against, &receivers, &question)?);
        record.contributions = explain(session.as_ref(), &record, &against, &solution, per_element);
        watch.lap("casting the rows of the worst again");
        write_report(folder, &record, session.as_ref(), watch)?;
    }
    Ok(record)
}

/// Kernels on the judged scene; `None` where there is no geometry.
pub fn open<'a>(stage: &'a Stage, kernel: Kernel, console: &Console) -> Result<Option<Session<'a>>, Failure> {
    let session = || inputs::session(stage, inputs::kernel_kind(kernel), console);
    (!stage.facets.is_empty()).then(session).transpose()
}

/// What lights the worst, where there are rays to be cast for it.
pub fn explain(
    session: Option<&Session>,
    record: &Record,
    against: &Against,
    solution: &Radiosity,
    elements: bool,
) -> Vec<Contributions> {
    let (Some(session), Against::Reference(reference)) = (session, against) else { return Vec::new() };
    if reference.provenance.truth != TruthLevel::PatchSystem {
        return Vec::new();
    }
    let worst: Vec<usize> = record.comparison.worst.iter().take(EXPLAINED).map(|w| w.patch).collect();
    let confidence = record.comparison.confidence;
    let rows = Rows { receivers: &worst, elements, solution, sources: &record.solution, confidence };
    study::contributions(session, reference, &rows)
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

/// A solution as it fits the receivers of a stage.
pub fn fit(path: &Path, input: Input, to: &Receivers, per_element: bool, stage: &Stage) -> Result<Radiosity, Failure> {
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
