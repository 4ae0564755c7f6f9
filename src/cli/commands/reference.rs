//! `etalon reference`

use super::inputs;
use crate::cli::args::{ReferenceArgs, Truth};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::interrupt;
use crate::io::{Claim, FileError, Found, StoredReference};
use crate::raycast::{KernelInfo, KernelKind, open_kernels};
use crate::reference::Options;
use crate::scene::{Scene, Stage};
use crate::solution::TruthLevel;
use crate::solver::bounds::Bracket;
use crate::study::{self, KeptWork, Session};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Confidence of the bounds.
const CONFIDENCE: f64 = 0.95;

/// The file that marks a folder as a reference.
pub const MARKER: &str = "reference.json";

pub fn run(args: &ReferenceArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let options = Options { plan: inputs::plan(&args.rays)?, seed: args.rays.seed };
    let scene = inputs::scene(&args.scene.scene, args.scene.max_edge, console)?;
    let stage = inputs::stage_of(&scene, args.scene.state)?;
    args.bounds.as_deref().map(inputs::check_writable).transpose()?;
    if args.print_key {
        let kernels = open_kernels(kernel, &stage)?;
        let key = study::reference_key(&stage, &options, kernels.kernel.info(), level(args.truth));
        console.result(&key, &json!({ "key": key, "scene": stage.name, "scene_hash": stage.hash() }));
        return Ok(exit::DONE);
    }
    if let Some(stored) = already_there(args, &stage, &options, kernel, console)? {
        let text = text(&stored, &args.output, "is already there in");
        console.result(&text, &summary(&stored, begin.elapsed().as_secs_f64(), true));
        return Ok(exit::DONE);
    }
    let claim = Claim::take(&args.output, MARKER)?;
    let session = inputs::session(&stage, kernel, console)?;
    if args.truth == Truth::Continuous {
        if args.bounds.is_some() {
            return Err(Failure::input("--bounds are those of the patch system: leave out --truth continuous"));
        }
        if !stage.lights.is_empty() {
            let message = "point lights are not taken by --truth continuous in this version: only by the patch system";
            return Err(Failure::input(message).at(args.scene.scene.clone()));
        }
        return continuous(args, &scene, &session, &options, claim, begin, console);
    }
    let work = open_work(&claim, &session, &options, console)?;
    let armed = arm(&work);
    let (mut stored, reference) = study::reference_on(&session, &options, console, work.kept())?;
    stored.findings = inputs::findings(&scene, &stage, console)?;
    console.end();
    let seconds = begin.elapsed().as_secs_f64();
    // Should the result find no room, the work is not lost.
    let rows = work.flush();
    claim.publish(&stored.files(seconds)).map_err(|e| keep_in_mind(e, rows))?;
    drop(armed);
    if let Some(path) = &args.bounds {
        let bracket = reference.bracket(&stage, CONFIDENCE)?;
        inputs::write(path, &bounds_csv(&stage, &bracket))?;
        let widest = widest(&stage, &bracket);
        console.notice(&format!(
            "bounds of all radiosities: {}, at most {widest:.2e} of the brightest apart",
            path.display()
        ));
    }
    Ok(finish(args, &stored, reference.missed_target, seconds, console))
}

/// The continuous problem, by paths. Nothing of an interrupted run is kept: sums of paths are no counts.
fn continuous(
    args: &ReferenceArgs,
    scene: &Scene,
    session: &Session,
    options: &Options,
    claim: Claim,
    begin: Instant,
    console: &Console,
) -> Result<u8, Failure> {
    let (mut stored, missed_target) = study::continuous_reference(session, options, console)?;
    stored.findings = inputs::findings(scene, session.stage(), console)?;
    console.end();
    let seconds = begin.elapsed().as_secs_f64();
    claim.publish(&stored.files(seconds))?;
    Ok(finish(args, &stored, missed_target, seconds, console))
}

/// Says what came of it.
fn finish(args: &ReferenceArgs, stored: &StoredReference, missed_target: bool, seconds: f64, console: &Console) -> u8 {
    if missed_target {
        console.notice(&format!("the target error was not reached: {:.2e}", stored.provenance.relative_error));
    }
    console.result(&text(stored, &args.output, "written to"), &summary(stored, seconds, false));
    explain_failures(stored, console);
    if stored.self_check.passed() { exit::DONE } else { exit::SELF_CHECK }
}

/// The reference that is stored already, if it answers what is asked.
fn already_there(
    args: &ReferenceArgs,
    stage: &Stage,
    options: &Options,
    kernel: KernelKind,
    console: &Console,
) -> Result<Option<StoredReference>, Failure> {
    if args.force || args.bounds.is_some() || !args.output.join(MARKER).is_file() {
        return Ok(None);
    }
    let again = |why: String| {
        console.notice(&format!("{}: {why}; it is computed again", args.output.display()));
        Ok(None)
    };
    let stored = match StoredReference::read(&args.output) {
        Ok(stored) => stored,
        Err(e) => return again(format!("the reference there cannot be used ({})", e.problem)),
    };
    let kernels = open_kernels(kernel, stage)?;
    let kernel = kernels.kernel.info();
    let level = level(args.truth);
    match study::falls_short(&stored, stage, options, kernel, level) {
        None => {
            if level == TruthLevel::PatchSystem {
                forget_journal(&args.output, stage, kernel, options);
            }
            Ok(Some(stored))
        }
        Some(lack) => again(format!("the reference there has {lack}")),
    }
}

fn level(truth: Truth) -> TruthLevel {
    match truth {
        Truth::PatchSystem => TruthLevel::PatchSystem,
        Truth::Continuous => TruthLevel::Continuous,
    }
}

/// A run that died after storing its reference leaves its journal: nobody needs it any more. Where that cannot be
/// removed, or somebody is at work, it stays.
fn forget_journal(output: &Path, stage: &Stage, kernel: &KernelInfo, options: &Options) {
    if Claim::is_begun(output)
        && let Ok(claim) = Claim::take(output, MARKER)
    {
        let _ = KeptWork::forget(&claim.journal(), stage, kernel, options);
    }
}

/// Opens the journal of this run beside the target, and says what an earlier one has left.
pub(super) fn open_work(
    claim: &Claim,
    session: &Session,
    options: &Options,
    console: &Console,
) -> Result<Arc<KeptWork>, Failure> {
    let path = claim.journal();
    let work = KeptWork::open(&path, session, options)
        .map_err(|e| FileError::system(&path, "read and changed", &e).mend("remove it, or name another folder"))?;
    match work.found() {
        Found::Nothing => {}
        Found::Records(rows) => {
            let rows = inputs::thousands(*rows);
            let of = work.total().map_or(String::new(), |t| format!(" of {}", inputs::thousands(t)));
            console.notice(&format!("going on from an interrupted run: {rows}{of} rows are there already"));
        }
        Found::Other => {
            console.notice("an interrupted run with other settings was there; it is dropped, all rows are cast anew");
        }
    }
    Ok(Arc::new(work))
}

/// An interruption keeps the finished rows and says how many there are.
pub(super) fn arm(work: &Arc<KeptWork>) -> interrupt::Armed {
    let work = work.clone();
    interrupt::before_dying(move || {
        let rows = work.flush();
        let there = work.is_there();
        let lost = work.trouble().map_or(String::new(), |t| format!(" ({t})"));
        match (rows, there) {
            (0, _) => format!("no row was finished yet{lost}; the same command begins again"),
            (_, false) => "the reference was complete already, and is written".into(),
            (_, true) => {
                let of = work.total().map_or(String::new(), |t| format!(" of {}", inputs::thousands(t)));
                let rows = inputs::thousands(rows);
                format!("{rows}{of} rows are kept{lost}; the same command goes on from there")
            }
        }
    })
}

fn keep_in_mind(mut e: FileError, rows: u64) -> FileError {
    if rows > 0 {
        e.mend += &format!(" ({} rows of it are kept)", inputs::thousands(rows));
    }
    e
}

/// Low and high of every band of the patches present.
fn bounds_csv(stage: &Stage, bracket: &Bracket) -> Vec<u8> {
    let bands = &stage.photometry.bands;
    let mut out = String::from("patch");
    bands.iter().for_each(|b| out += &format!(",{b}_low,{b}_high"));
    for i in (0..stage.patch_count()).filter(|i| stage.patches[*i].is_present()) {
        out += &format!("\n{i}");
        for k in i * bands.len()..(i + 1) * bands.len() {
            out += &format!(",{},{}", bracket.low[k], bracket.high[k]);
        }
    }
    (out + "\n").into_bytes()
}

/// The widest bracket, as a share of the highest bound.
fn widest(stage: &Stage, bracket: &Bracket) -> f64 {
    debug_assert_eq!(bracket.low.len(), stage.patch_count() * stage.band_count());
    let brightest = bracket.high.iter().copied().fold(0.0, f64::max);
    let widest = bracket.high.iter().zip(&bracket.low).map(|(h, l)| h - l).fold(0.0, f64::max);
    if brightest > 0.0 { widest / brightest } else { 0.0 }
}

/// Says on stderr which self-checks failed.
pub fn explain_failures(stored: &StoredReference, console: &Console) {
    for c in stored.self_check.failures() {
        console.notice(&format!("the reference failed its self-check of {}: {}", c.name, c.finding));
    }
}

fn summary(r: &StoredReference, seconds: f64, already_there: bool) -> Value {
    let mut json = serde_json::to_value(&r.provenance).expect("provenance serialises");
    let more = json!({
        "scene": r.stage.name, "scene_hash": r.scene_hash, "state": r.stage.state, "patches": r.stage.patch_count(),
        "waves": r.waves, "passed_self_check": r.self_check.passed(), "self_check": r.self_check.checks,
        "already_there": already_there, "seconds": seconds,
    });
    if let (Value::Object(json), Value::Object(more)) = (&mut json, more) {
        json.extend(more);
    }
    json
}

fn text(r: &StoredReference, output: &Path, what: &str) -> String {
    let p = &r.provenance;
    let mut text = format!(
        "reference of {} ({} patches, state {}) {what} {}\n\
         {} {} per patch in {} randomisations ({} {}): relative error {:.2e} (one sigma, norm of eq. 7)",
        r.stage.name,
        r.stage.patch_count(),
        r.stage.state,
        output.display(),
        inputs::thousands(p.rays_per_patch),
        if p.truth == TruthLevel::Continuous { "paths" } else { "rays" },
        p.randomisations,
        p.kernel,
        p.kernel_version,
        p.relative_error,
    );
    for c in &r.self_check.checks {
        text += &format!("\n  {} {}: {}", if c.passed { "ok    " } else { "FAILED" }, c.name, c.finding);
    }
    text
}
