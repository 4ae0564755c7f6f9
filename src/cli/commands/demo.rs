//! `etalon demo`: the whole chain on the Cornell box.

use super::check::explain;
use super::reference::{MARKER, explain_failures};
use super::report::{Stopwatch, write_report};
use super::{inputs, told};
use crate::cli::args::Kernel;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::StateChoice;
use crate::estimate::{Estimator, Plan};
use crate::io::{BandNames, SolutionFormat, atomic, write_folder, write_solution};
use crate::methods::Method;
use crate::metrics::{Limits, Verdict};
use crate::reference::Options;
use crate::render::{luminance, views};
use crate::report::text_summary;
use crate::scene::Stage;
use crate::solution::Provenance;
use crate::study::{
    self, Against, Onlooker, Part, Question, Receivers, Record, Setting, SolveRequest, break_down, judge,
};
use serde_json::json;
use std::io::IsTerminal;
use std::path::Path;
use std::time::Instant;

const SCENE: &str = "builtin:cornell-box";
const METHOD: &str = "hemicube:resolution=100";
/// Limit on eq. 7 that the demo puts to the hemi-cube.
const MAX_RMS: f64 = 0.02;
/// Rays per patch of its reference.
const RAYS: u64 = 16_384;

pub fn run(output: &Path, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let mut watch = Stopwatch::start();
    let kind = inputs::kernel_kind(kernel);
    atomic::create_folder(output)?;
    let scene = inputs::scene(SCENE, None, console)?;
    let stage = inputs::stage_of(&scene, StateChoice::Final)?;
    let session = inputs::session(&stage, kind, console)?;
    let options = Options { plan: Plan { rays: RAYS, estimator: Estimator::Auto, ..Plan::default() }, seed: 0 };
    let (mut stored, _) = study::reference(&session, &options, console)?;
    stored.findings = inputs::findings(&scene, &stage, console)?;
    let judged_in = begin.elapsed().as_secs_f64();
    write_folder(&output.join("reference"), &stored.files(judged_in), MARKER)?;
    explain_failures(&stored, console);
    watch.lap("computing the reference");

    let method: Method = METHOD.parse()?;
    let request = SolveRequest { method, form_factors: None, seed: 0, per_element: false };
    let outcome = study::solve(&session, &request, console)?;
    console.end();
    let receivers = Receivers::patches(&stage);
    let (hash, present) = (stage.hash(), receivers.present());
    let names = BandNames { scene: &stage.name, scene_hash: &hash, bands: &stage.photometry.bands, present: &present };
    let solution = output.join("hemicube.csv");
    inputs::write(&solution, &write_solution(&outcome.radiosity, names, SolutionFormat::Csv))?;
    watch.lap("hemi-cubes");

    let limits = Limits::rms(MAX_RMS);
    let seen = views(&session.tracer());
    let luminances = luminance(&stage.photometry, &stored.patches.mean());
    let viewing = study::viewing(&Onlooker::default(), &stage, false, &seen, &receivers, &luminances);
    let question = Question {
        limits: Some(limits),
        confidence: told::CONFIDENCE,
        reflected: true,
        viewing: Some(viewing),
        ..Question::default()
    };
    let against = Against::Reference(Box::new(stored));
    let judgement = judge(&outcome.radiosity, &against, None, &receivers, &question)?;
    let verdict = judgement.decision.as_ref().map(|d| d.verdict);
    let breakdown = break_down(&outcome.radiosity, &against, &receivers, &question)?;
    let Against::Reference(stored) = &against else { unreachable!("made five lines above") };
    let mut record = Record {
        solution_name: method.to_string(),
        truth: stored.provenance.truth.name().into(),
        decision: judgement.decision,
        comparison: judgement.comparison,
        split: None,
        as_seen: judgement.as_seen,
        breakdown: Some(breakdown),
        contributions: Vec::new(),
        causes: Vec::new(),
        looks: Vec::new(),
        findings: told::findings(&against),
        notices: Vec::new(),
        settings: settings(&method, kernel, &stored.provenance, &stage),
        provenance: told::provenance(&against, &stage),
        replay: replay(output),
        reference: stored.patches.mean(),
        solution: outcome.radiosity.clone(),
        stage: stage.clone(),
        before: None,
    };
    watch.lap("judging");
    record.contributions = explain(Some(&session), &record, &against, &outcome.radiosity, false);
    watch.lap("casting the rows of the worst again");
    let page = write_report(output, &record, &seen, watch)?;
    let seconds = begin.elapsed().as_secs_f64();
    let colour = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let text = format!(
        "{}\n\nreport: {}\n(the whole chain took {seconds:.1} s, {judged_in:.1} s of it for the reference)",
        text_summary(&record, colour).trim_end(),
        page.display()
    );
    let verdict = verdict.unwrap_or(Verdict::Inconclusive);
    console.result(
        &text,
        &json!({ "verdict": verdict, "report": page, "rms": record.comparison.rms, "seconds": seconds }),
    );
    Ok(exit::DONE)
}

fn settings(method: &Method, kernel: Kernel, reference: &Provenance, stage: &Stage) -> Vec<Setting> {
    let mut out = vec![
        Setting::new(Part::Judgement, "--max-rms", MAX_RMS, "none"),
        Setting::new(Part::Judgement, "--confidence", told::CONFIDENCE, told::CONFIDENCE),
        Setting::new(Part::Judgement, "--reflected", true, false),
        Setting::new(Part::Judgement, "--kernel", told::kernel(kernel), told::kernel(Kernel::Auto)),
        Setting::given(Part::Solution, "--method", method),
        Setting::new(Part::Solution, "--seed", 0, 0),
    ];
    out.extend(told::of_reference(reference, stage));
    out
}

fn replay(output: &Path) -> String {
    let folder = output.display();
    format!(
        "etalon reference {SCENE} --rays {RAYS} -o {folder}/reference && etalon solve {SCENE} --method {METHOD} -o \
         {folder}/hemicube.csv && etalon check {folder}/hemicube.csv --reference {folder}/reference --reflected \
         --max-rms {MAX_RMS} --report {folder}"
    )
}
