//! `etalon compare` and `etalon check`

use super::bench::{Bench, by_patch, patch_means};
use super::report::{Stopwatch, write_report};
use super::{check_residual, inputs, limits, looks, split, told};
use crate::cli::args::{Causes, CheckArgs, CompareArgs, Kernel, OnInconclusive};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::atomic;
use crate::metrics::{Limits, Metric, Truth, Verdict, Viewing};
use crate::render::{View, Visibility, fit_camera, luminance, resized, views};
use crate::report::{Exporter, Extras, JUnit, Markdown, json_object, one_line, text_summary};
use crate::scene::Stage;
use crate::solution::{Radiosity, TruthLevel};
use crate::study::{
    self, Against, Before, Cause, CauseOptions, Contributions, Look, Question, Record, Rows, Session, break_down,
    causes, judge,
};
use std::io::IsTerminal;
use std::path::Path;

/// So many of the worst patches are explained by what lights them.
const EXPLAINED: usize = 5;

/// `etalon compare`: metrics, no verdict.
pub fn compare(args: &CompareArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    if args.residual.residual {
        return check_residual::compare(args, kernel, console);
    }
    let record = run(&Asked { args, check: None, limits: None, until_decided: false, kernel }, console)?;
    show(&record, console)?;
    Ok(exit::DONE)
}

/// `etalon check`: metrics, limits, verdict.
pub fn check(args: &CheckArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    if args.compare.residual.residual {
        return check_residual::check(args, kernel, console);
    }
    let record = checked(args, args.until_decided, kernel, console)?;
    show(&record, console)?;
    let decision = record.decision.as_ref().map(|d| exit_code(d.verdict, args.on_inconclusive));
    Ok(decision.unwrap_or(exit::DONE))
}

/// A finished check, its files written.
pub fn checked(args: &CheckArgs, until_decided: bool, kernel: Kernel, console: &Console) -> Result<Record, Failure> {
    let limits = limits::given(args)?;
    args.junit.as_deref().map(inputs::check_writable).transpose()?;
    if let Some(folder) = &args.save_reference {
        atomic::check_folder(folder)?;
    }
    let asked = Asked { args: &args.compare, check: Some(args), limits: Some(limits), until_decided, kernel };
    let record = run(&asked, console)?;
    if let Some(path) = &args.junit {
        write_only(path, &JUnit, &record)?;
    }
    Ok(record)
}

/// What a verdict ends the program with.
pub fn exit_code(verdict: Verdict, on_inconclusive: Option<OnInconclusive>) -> u8 {
    match (verdict, on_inconclusive) {
        (Verdict::Pass, _) | (Verdict::Inconclusive, Some(OnInconclusive::Pass)) => exit::DONE,
        (Verdict::Fail, _) | (Verdict::Inconclusive, Some(OnInconclusive::Fail)) => exit::FAIL,
        (Verdict::Inconclusive, None) => exit::INCONCLUSIVE,
    }
}

/// Prints a finished record: everything, or with `--quiet` the one line a log needs.
pub fn show(record: &Record, console: &Console) -> Result<(), Failure> {
    let colour = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let text = if console.is_quiet() { one_line(record) } else { text_summary(record, colour) };
    console.result(text.trim_end(), &json_object(record)?);
    Ok(())
}

fn write_only(path: &Path, exporter: &dyn Exporter, record: &Record) -> Result<(), Failure> {
    for artifact in exporter.export(record, &Extras::default())? {
        inputs::write(path, &artifact.bytes)?;
    }
    Ok(())
}

/// Width and height of the pictures of a comment, pixels.
const THUMBNAIL: [u32; 2] = [216, 162];
/// Rays through a pixel of these, along each side.
const THUMBNAIL_SAMPLES: u32 = 3;

/// The text, and its picture beside it where there is geometry to be seen.
fn write_markdown(
    path: &Path,
    record: &Record,
    stage: &Stage,
    kernel: Kernel,
    console: &Console,
) -> Result<(), Failure> {
    let session = open(stage, kernel, console)?;
    let view = session.map(|s| {
        let tracer = s.tracer();
        let fitted = stage.cameras.is_empty();
        let camera = stage.cameras.first().cloned().unwrap_or_else(|| fit_camera(&tracer));
        let camera = resized(&camera, fitted, THUMBNAIL);
        View { visibility: Visibility::cast(&tracer, &camera, THUMBNAIL_SAMPLES), fitted }
    });
    let picture = path.with_extension("png");
    let markdown = Markdown { picture: picture.file_name().unwrap_or_default().to_string_lossy().into_owned() };
    let files = markdown.export(record, &Extras { views: view.as_slice(), timing: &[] })?;
    for (file, target) in files.iter().zip([path, &picture]) {
        inputs::write(target, &file.bytes)?;
    }
    Ok(())
}

/// What was asked for, checked.
pub struct Asked<'a> {
    pub args: &'a CompareArgs,
    /// Everything of a check; `None` for a mere comparison.
    pub check: Option<&'a CheckArgs>,
    pub limits: Option<Limits>,
    /// Better references while a limit is open.
    pub until_decided: bool,
    pub kernel: Kernel,
}

/// Reads everything, judges, and writes the files asked for.
fn run(asked: &Asked, console: &Console) -> Result<Record, Failure> {
    let (args, kernel) = (asked.args, asked.kernel);
    let mut watch = Stopwatch::start();
    args.markdown.as_deref().map(inputs::check_writable).transpose()?;
    args.report.as_deref().map(atomic::check_folder).transpose()?;
    let mut bench = Bench::read(args, asked.limits.is_some(), console)?;
    let baseline = asked.check.and_then(|c| c.limits.baseline.as_deref());
    let baseline = baseline.map(|path| limits::baseline(path, &bench, args)).transpose()?;
    watch.lap("reading");
    let mut question = Question {
        limits: asked.limits.clone(),
        confidence: args.confidence.0,
        reflected: args.reflected,
        per_element: bench.per_element,
        baseline: baseline.as_ref().map(study::Baseline::radiosity),
        viewing: None,
    };
    let stage = bench.stage.clone();
    let looks_at_it = args.report.is_some() || asked.limits.as_ref().is_some_and(|l| l.has(Metric::Visible));
    let session = if looks_at_it { open(&stage, kernel, console)? } else { None };
    let seen = session.as_ref().map_or(Vec::new(), |s| views(&s.tracer()));
    question.viewing = look(asked, &bench, &seen)?;
    watch.lap("casting the pictures");
    let (judgement, looks) = match asked.check.filter(|_| asked.until_decided) {
        Some(check) => looks::until_decided(check, &mut bench, &mut question, kernel, console)?,
        None => {
            let judgement = judge(&bench.solution, &bench.against, bench.before.as_ref(), &bench.receivers, &question)?;
            (judgement, Vec::new())
        }
    };
    let confidence = judgement.comparison.confidence;
    let judgement_verdict = judgement.decision.as_ref().map(|d| d.verdict);
    let split = split::split(args, &bench.stage, &bench.solution, &bench.against, &bench.receivers, confidence)?;
    let mut record = Record {
        solution_name: args.solution.display().to_string(),
        truth: bench.truth.clone(),
        decision: judgement.decision,
        comparison: judgement.comparison,
        breakdown: None,
        split,
        as_seen: judgement.as_seen,
        contributions: Vec::new(),
        findings: told::findings(&bench.against),
        notices: notices(asked, &bench, &looks),
        causes: likely_causes(asked, &bench, judgement_verdict, console)?,
        looks,
        settings: told::settings(asked, &bench.against),
        provenance: told::provenance(&bench.against, &bench.stage),
        replay: told::replay(asked),
        reference: patch_means(&bench.against, &bench.stage, bench.per_element),
        solution: if bench.per_element { by_patch(&bench.solution, &bench.stage) } else { bench.solution.clone() },
        stage: bench.stage.clone(),
        before: shown_before(args.before.as_deref(), &bench),
    };
    watch.lap("judging");
    if let Some(path) = &args.markdown {
        write_markdown(path, &record, &bench.stage, kernel, console)?;
    }
    if let Some(folder) = &args.report {
        record.breakdown = Some(break_down(&bench.solution, &bench.against, &bench.receivers, &question)?);
        record.contributions = explain(session.as_ref(), &record, &bench.against, &bench.solution, bench.per_element);
        watch.lap("casting the rows of the worst again");
        write_report(folder, &record, &seen, watch)?;
    }
    Ok(record)
}

/// Who looks at the judged scene, where there are pictures of it; adapted to the reference.
fn look(asked: &Asked, bench: &Bench, views: &[View]) -> Result<Option<Viewing>, Failure> {
    if views.is_empty() {
        return match asked.limits.as_ref().is_some_and(|l| l.has(Metric::Visible)) {
            true => Err(Failure::input(
                "--max-visible looks at pictures of the scene, and there is none here; give --scene, or a reference that \
                 holds its scene",
            )),
            false => Ok(None),
        };
    }
    let mean = match bench.against.truth(bench.per_element)? {
        Truth::Sampled(r) => r.mean(),
        Truth::Given(b) => b,
    };
    let (photometry, looking) = (&bench.receivers.photometry, &asked.args.looking);
    let onlooker = looking.viewing.onlooker(looking.tone);
    let luminances = luminance(photometry, &mean);
    Ok(Some(study::viewing(&onlooker, &bench.stage, bench.per_element, views, &bench.receivers, &luminances)))
}

/// What stood there before the edit, where a reference tells.
fn shown_before(path: Option<&Path>, bench: &Bench) -> Option<Before> {
    let Some(Against::Reference(r)) = &bench.before else { return None };
    Some(Before { name: path?.display().to_string(), reference: r.patches.mean(), stage: r.stage.clone() })
}

/// What the reader has to know beside the numbers.
fn notices(asked: &Asked, bench: &Bench, looks: &[Look]) -> Vec<String> {
    let mut out = told::notices(asked.args, &bench.against);
    out.extend(bench.notices.iter().cloned());
    out.extend(looks::told(looks));
    out
}

/// The mistakes that the error looks like, where they are asked for: patches of a patch-system reference with geometry.
fn likely_causes(
    asked: &Asked,
    bench: &Bench,
    verdict: Option<Verdict>,
    console: &Console,
) -> Result<Vec<Cause>, Failure> {
    let wanted = match asked.args.causes {
        Causes::Never => false,
        Causes::Always => true,
        Causes::Auto => verdict == Some(Verdict::Fail),
    };
    let Some(reference) = bench.reference().filter(|r| r.provenance.truth == TruthLevel::PatchSystem) else {
        return Ok(Vec::new());
    };
    if !wanted || bench.per_element {
        return Ok(Vec::new());
    }
    let session = open(&bench.stage, asked.kernel, console)?;
    Ok(session.map_or(Vec::new(), |s| causes(&s, reference, &bench.solution, &CauseOptions::default())))
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
