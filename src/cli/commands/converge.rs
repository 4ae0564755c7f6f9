//! `etalon converge SCENE`: run, judge, fit, draw.

use super::converge_references::Judge;
use super::{converge_refine, converge_told, inputs};
use crate::cli::args::{ConvergeArgs, Kernel, Truth};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::{FileError, StoredReference, atomic, read_series};
use crate::methods::MethodError;
use crate::reference::Options;
use crate::render::views;
use crate::report::curves::{
    CURVES_PAGE, CurvesReport, Film, Filmed, Pictures, Shown, convergence_files, convergence_json, convergence_text,
    film, pictures,
};
use crate::report::{Phase, save};
use crate::scene::Stage;
use crate::solution::Series;
use crate::study::Session;
use crate::study::converge::{
    Entry, EntryError, JudgedState, RefineError, Run, RunError, digest, join, judge_series, parse_methods, run_method,
};
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;

impl From<EntryError> for Failure {
    fn from(e: EntryError) -> Self {
        Self::input(e.to_string())
    }
}

impl From<RunError> for Failure {
    fn from(e: RunError) -> Self {
        Self::input(e.to_string())
    }
}

impl From<RefineError> for Failure {
    fn from(e: RefineError) -> Self {
        Self::input(e.to_string())
    }
}

/// What was asked for, checked.
pub struct Asked<'a> {
    pub args: &'a ConvergeArgs,
    pub kernel: Kernel,
    pub entries: Vec<Entry>,
    pub options: Options,
}

pub fn run(args: &ConvergeArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let asked = check(args, kernel)?;
    if !args.refine.is_empty() {
        return converge_refine::run(&asked, console);
    }
    let scene = inputs::scene(&args.scene, args.max_edge, console)?;
    let stages = (0..=scene.edits.len()).map(|k| scene.at(k)).collect::<Result<Vec<Stage>, _>>()?;
    check_lights(&asked, &stages)?;
    let mut all: Vec<Series> =
        args.series.iter().map(|s| read_series(&s.folder, &s.name, &stages)).collect::<Result<_, _>>()?;
    let mut timing = Vec::new();
    let references = references(&asked, &scene, &stages, &all, &mut timing, console)?;
    let run = Run { scene: &scene, stages: &stages, kernel: inputs::kernel_kind(kernel), seed: args.rays.seed };
    let mut own = Vec::new();
    for entry in &asked.entries {
        let begin = Instant::now();
        own.extend(run_method(&run, entry, console)?);
        timing.push(Phase { name: entry.name.clone(), seconds: begin.elapsed().as_secs_f64() });
    }
    own.append(&mut all);
    let begin = Instant::now();
    let states = judged_states(&asked, &stages, &references);
    let mut curves = Vec::new();
    for series in &own {
        curves.extend(judge_series(series, &states)?);
    }
    console.end();
    timing.push(Phase { name: "judging".into(), seconds: begin.elapsed().as_secs_f64() });
    let curves = join(curves);
    let digest = digest(&curves, args.confidence.0);
    let pictures = painted(&asked, &stages, &references, &own)?;
    let about = converge_told::about(&asked, &scene.name, references.iter().flatten(), timing);
    let film = filmed(&stages, &references, &own)?;
    let report = CurvesReport { about, curves, digest, pictures, film };
    save(&args.output, &convergence_files(&report)?)?;
    tell(&args.output, &convergence_text(&report), convergence_json(&report), console);
    Ok(exit::DONE)
}

/// Pictures through the first camera, of the state without edits or of every state after one.
fn painted(
    asked: &Asked,
    stages: &[Stage],
    references: &[Option<StoredReference>],
    series: &[Series],
) -> Result<Vec<Pictures>, Failure> {
    if asked.args.pictures.is_empty() {
        return Ok(Vec::new());
    }
    let kernel = inputs::kernel_kind(asked.kernel);
    let mut seen = Vec::new();
    for (stage, reference) in stages.iter().zip(references) {
        let view = views(&Session::open(stage, kernel)?.tracer()).into_iter().next();
        seen.push(reference.as_ref().zip(view).map(|(r, view)| (r.patches.mean(), view)));
    }
    let shown = |k: usize| {
        let (reference, view) = seen.get(k)?.as_ref()?;
        Some(Shown { stage: &stages[k], reference, view })
    };
    let first = usize::from(stages.len() > 1);
    let mut all = Vec::new();
    for k in first..stages.len() {
        if let Some(now) = shown(k) {
            all.push(pictures(now, k.checked_sub(1).and_then(shown), series, &asked.args.pictures)?);
        }
    }
    Ok(all)
}

/// The way of every series to the reference of the last state that has one.
fn filmed(
    stages: &[Stage],
    references: &[Option<StoredReference>],
    series: &[Series],
) -> Result<Option<Film>, Failure> {
    let of_state = |k: usize| series.iter().flat_map(|s| &s.snapshots).any(|s| s.edit == k);
    let mut judged = stages.iter().zip(references).filter_map(|(stage, r)| Some((stage, r.as_ref()?)));
    let Some((stage, reference)) = judged.rfind(|(stage, _)| of_state(stage.state)) else { return Ok(None) };
    Ok(film(Filmed { stage, reference: &reference.patches.mean() }, series)?)
}

/// Prints the summary and where the page is.
pub fn tell(output: &Path, text: &str, mut json: Value, console: &Console) {
    let page = output.join(CURVES_PAGE);
    json["report"] = json!(page);
    console.result(&format!("{text}\nwritten to {}", page.display()), &json);
}

/// Refuses what can be refused before any work.
fn check<'a>(args: &'a ConvergeArgs, kernel: Kernel) -> Result<Asked<'a>, Failure> {
    if args.methods.is_none() && args.series.is_empty() {
        return Err(Failure::input("nothing to judge: give --methods, --series NAME=DIR, or both"));
    }
    check_confidence(args.confidence.0)?;
    if !args.refine.is_empty() && args.truth == Some(Truth::PatchSystem) {
        return Err(Failure::input(
            "--refine needs the continuous truth: each mesh has a patch system of its own; leave out --truth",
        ));
    }
    let estimator = inputs::estimator(args.rays.estimator);
    let entries = args.methods.as_deref().map_or(Ok(Vec::new()), |m| parse_methods(m, estimator))?;
    let mut names: Vec<&str> = entries.iter().map(|e| e.name.as_str()).collect();
    for series in &args.series {
        if names.contains(&series.name.as_str()) {
            return Err(Failure::input(format!(
                "two curves are called {}; give each --series its own name",
                series.name
            )));
        }
        names.push(&series.name);
    }
    let options = Options { plan: inputs::plan(&args.rays)?, seed: args.rays.seed };
    atomic::check_folder(&args.output)?;
    Ok(Asked { args, kernel, entries, options })
}

/// Refuses what is no confidence.
pub fn check_confidence(confidence: f64) -> Result<(), Failure> {
    match confidence > 0.0 && confidence < 1.0 {
        true => Ok(()),
        false => Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example")),
    }
}

/// Point lights are not for every part of the program: that is known before hours of work.
pub fn check_lights(asked: &Asked, stages: &[Stage]) -> Result<(), Failure> {
    let Some(lights) = stages.iter().map(|s| s.lights.len()).find(|n| *n > 0) else { return Ok(()) };
    if !asked.entries.is_empty() {
        return Err(MethodError::PointLights(lights).into());
    }
    if asked.truth() == Truth::Continuous {
        let message = "point lights are not taken by --truth continuous in this version: only by the patch system";
        return Err(Failure::input(message).at(asked.args.scene.clone()));
    }
    Ok(())
}

impl Asked<'_> {
    /// The truth in force.
    pub fn truth(&self) -> Truth {
        let default = if self.args.refine.is_empty() { Truth::PatchSystem } else { Truth::Continuous };
        self.args.truth.unwrap_or(default)
    }

    /// How references are made.
    pub fn judge<'a>(&self, console: &'a Console) -> Judge<'a> {
        let kernel = inputs::kernel_kind(self.kernel);
        Judge { options: self.options, truth: self.truth(), kernel, console }
    }
}

/// References of the states that are judged, and of those before them.
fn references(
    asked: &Asked,
    scene: &crate::scene::Scene,
    stages: &[Stage],
    series: &[Series],
    timing: &mut Vec<Phase>,
    console: &Console,
) -> Result<Vec<Option<StoredReference>>, Failure> {
    let judged = |k: usize| !asked.entries.is_empty() || series.iter().flat_map(|s| &s.snapshots).any(|s| s.edit == k);
    let needed = |k: usize| judged(k) || (k + 1 < stages.len() && judged(k + 1));
    atomic::create_folder(&asked.args.output)?;
    announce_kernel(asked, &stages[0], console)?;
    let judge = asked.judge(console);
    let mut out = Vec::new();
    for (k, stage) in stages.iter().enumerate() {
        if !needed(k) {
            out.push(None);
            continue;
        }
        let folder = asked.args.output.join(format!("reference-{k}"));
        let (stored, phase) = judge.obtain(scene, stage, &folder)?;
        timing.push(phase);
        out.push(Some(stored));
    }
    Ok(out)
}

/// Says once what the user should know about the kernel.
pub fn announce_kernel(asked: &Asked, stage: &Stage, console: &Console) -> Result<(), Failure> {
    inputs::session(stage, inputs::kernel_kind(asked.kernel), console).map(drop)
}

fn judged_states(asked: &Asked, stages: &[Stage], references: &[Option<StoredReference>]) -> Vec<Option<JudgedState>> {
    let of = |k: usize| references.get(k).and_then(Option::as_ref).map(|r| &r.patches);
    let state = |(k, stage): (usize, &Stage)| {
        let before = k.checked_sub(1).and_then(of);
        Some(JudgedState::new(stage, of(k)?, before, asked.args.confidence.0, asked.args.reflected))
    };
    stages.iter().enumerate().map(state).collect()
}

/// A file of curves, or of anything else, that cannot be read.
pub fn unreadable(path: &Path, place: String, problem: String) -> FileError {
    FileError::new(path, problem).at(place).mend("DIR is a folder that `etalon converge` wrote")
}
