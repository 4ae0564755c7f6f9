//! `etalon solve --method progressive|redistribution`

use super::inputs;
use crate::cli::args::SolveArgs;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::PerLevel;
use crate::io::{BandNames, FileError, SeriesWriter, SolutionFormat, write_solution};
use crate::methods::shooting::{End, Energy, Params, Saved, Shooting};
use crate::methods::{Method, MethodError};
use crate::raycast::KernelKind;
use crate::scene::{Scene, Stage};
use crate::solution::Snapshot;
use crate::study::{Course, Moments, Receivers, ShootRequest, begin, shoot_on};
use serde_json::{Value, json};
use std::path::Path;

pub fn run(
    args: &SolveArgs,
    method: &Method,
    params: Params,
    format: SolutionFormat,
    kernel: KernelKind,
    console: &Console,
) -> Result<u8, Failure> {
    check(args)?;
    let scene = inputs::scene(&args.scene.scene, args.scene.max_edge, console)?;
    let stage = inputs::stage_of(&scene, args.scene.state)?;
    let course = match method {
        Method::Redistribution(_) => Course::Redistribution,
        _ => Course::FromScratch,
    };
    let request = ShootRequest { scene: &scene, course, last: stage.state, params, kernel, seed: args.seed };
    let mut writer = args.snapshots.as_deref().map(|f| SeriesWriter::create(f, SolutionFormat::Csv)).transpose()?;
    let mut keep = Keep { scene: &scene, writer: writer.as_mut(), stage: None };
    let begun = match args.resume.as_deref().filter(|f| f.exists()) {
        Some(file) => resume(file, &request)?,
        None => begin(&request)?,
    };
    let (solver, end) = shoot_on(begun, &request, &moments(args), console, &mut |s| keep.add(&s))?;
    console.end();
    if let Some(file) = &args.resume {
        let saved = solver.save().map_err(MethodError::from)?;
        inputs::write(file, &serde_json::to_vec(&saved).map_err(|e| Failure::input(e.to_string()))?)?;
    }
    let (radiosity, receivers) = match args.per {
        PerLevel::Patch => (solver.radiosity(), Receivers::patches(&stage)),
        PerLevel::Element => (solver.element_radiosity(), Receivers::elements(&stage)),
    };
    let (hash, present) = (stage.hash(), receivers.present());
    let names = BandNames { scene: &stage.name, scene_hash: &hash, bands: &stage.photometry.bands, present: &present };
    inputs::write(&args.output, &write_solution(&radiosity, names, format))?;
    let (text, json) = (words(&solver, end, method, args), described(&solver, end, method, args));
    console.result(&text, &json);
    Ok(exit::DONE)
}

/// A solver as an earlier run has left it.
fn resume(file: &Path, request: &ShootRequest) -> Result<Shooting, Failure> {
    let place = || file.display().to_string();
    let wrong = |what: String| Failure::input(format!("{}: {what}", place())).at(place());
    let mend = "go on with what it was saved from, or delete it to begin anew";
    let bytes = std::fs::read(file).map_err(|e| wrong(format!("cannot be read: {e}")))?;
    let saved: Saved = serde_json::from_slice(&bytes)
        .map_err(|e| wrong(format!("is no state of a solver that can be gone on from ({e}); {mend}")))?;
    let ShootRequest { scene, params, kernel, seed, .. } = *request;
    let solver = Shooting::restore(scene, params, kernel, seed, &saved).map_err(|e| wrong(format!("{e}; {mend}")))?;
    if solver.state() > request.last {
        return Err(wrong(format!(
            "stands at state {}, after the one asked for ({}); {mend}",
            solver.state(),
            request.last
        )));
    }
    Ok(solver)
}

/// Refuses what shooting has no use for.
fn check(args: &SolveArgs) -> Result<(), Failure> {
    if args.form_factors.is_some() || args.save_form_factors.is_some() {
        return Err(Failure::input(
            "a method that shoots makes its form factors shot by shot: --form-factors and --save-form-factors are for \
             gather and hemicube",
        ));
    }
    args.resume.as_deref().map(inputs::check_writable).transpose()?;
    if !args.snapshot_shots.is_sorted() {
        return Err(Failure::input("--snapshot-shots must ascend: 1,2,5,10"));
    }
    Ok(())
}

fn moments(args: &SolveArgs) -> Moments {
    let every = args.snapshot_every.map(|t| t.0.as_secs_f64());
    match (&args.snapshots, args.snapshot_shots.is_empty()) {
        (None, _) => Moments { shots: Vec::new(), every: None },
        (_, true) => Moments { every, ..Moments::default() },
        (_, false) => Moments { shots: args.snapshot_shots.clone(), every },
    }
}

/// Where snapshots go.
struct Keep<'a> {
    scene: &'a Scene,
    writer: Option<&'a mut SeriesWriter>,
    /// The state of the last snapshot.
    stage: Option<Stage>,
}

/// Why shooting with snapshots ends.
enum Ended {
    Method(MethodError),
    Failure(Failure),
}

impl From<MethodError> for Ended {
    fn from(e: MethodError) -> Self {
        Self::Method(e)
    }
}

impl From<Ended> for Failure {
    fn from(e: Ended) -> Self {
        match e {
            Ended::Method(e) => e.into(),
            Ended::Failure(f) => f,
        }
    }
}

impl From<FileError> for Ended {
    fn from(e: FileError) -> Self {
        Self::Failure(e.into())
    }
}

impl Keep<'_> {
    fn add(&mut self, snapshot: &Snapshot) -> Result<(), Ended> {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        if self.stage.as_ref().is_none_or(|s| s.state != snapshot.edit) {
            self.stage = Some(self.scene.at(snapshot.edit).map_err(|e| Ended::Failure(e.into()))?);
        }
        let Some(stage) = &self.stage else { return Ok(()) };
        let (hash, present) = (stage.hash(), Receivers::patches(stage).present());
        let bands = &stage.photometry.bands;
        writer.add(snapshot, BandNames { scene: &stage.name, scene_hash: &hash, bands, present: &present })?;
        Ok(())
    }
}

fn words(solver: &Shooting, end: End, method: &Method, args: &SolveArgs) -> String {
    let (costs, stage) = (solver.costs(), solver.stage());
    let patches = stage.patches.iter().filter(|p| p.is_present()).count();
    let mut text = format!(
        "{method} on {} (state {}, {patches} patches, {} elements): {} shots, of them {} redistributing, {} rays; \
         {:.2e} of the power unshot, energy balanced to {:.0e}",
        stage.name,
        solver.state(),
        stage.elements.len(),
        inputs::thousands(costs.shots),
        inputs::thousands(costs.redistributions),
        inputs::thousands(costs.rays),
        solver.unshot_share(),
        solver.energy().gap(),
    );
    let left: usize = solver.log().iter().map(|entry| entry.patches.len()).sum();
    if left > 0 {
        text += &format!("; {left} patches are still to be redistributed");
    }
    if end == End::Spent && solver.unshot_share() > solver.params().stop.unshot {
        text += "; stopped before it converged";
    }
    text + &format!("; written to {}", args.output.display())
}

fn described(solver: &Shooting, end: End, method: &Method, args: &SolveArgs) -> Value {
    let (costs, stage, energy) = (solver.costs(), solver.stage(), solver.energy());
    let log: Vec<Value> = solver
        .log()
        .iter()
        .map(|e| {
            let power: Vec<f64> =
                (0..stage.band_count()).map(|c| e.patches.iter().map(|(_, q)| q[c]).sum::<f64>()).collect();
            let (patch, power_moved) = e.largest.unzip();
            json!({
                "state": e.state, "edits": e.edits, "patches": e.patches.len(), "power": power,
                "largest": { "patch": patch, "power": power_moved },
            })
        })
        .collect();
    json!({
        "scene": stage.name, "scene_hash": stage.hash(), "state": solver.state(), "method": method.to_string(),
        "kernel": solver.kernel().name, "patches": stage.patch_count(), "elements": stage.elements.len(),
        "end": match end {
            End::Converged => "converged",
            End::Accurate => "accurate",
            End::Spent => "spent",
            End::Stopped => "stopped",
        },
        "shots": costs.shots, "redistributions": costs.redistributions, "spared": costs.spared, "rays": costs.rays,
        "unshot": solver.unshot_share(), "error_bound": solver.error_bound(), "energy": energy_told(&energy), "log": log,
        "output": args.output, "snapshots": args.snapshots, "seconds": costs.seconds,
    })
}

/// W per band.
fn energy_told(e: &Energy) -> Value {
    json!({
        "emitted": e.emitted, "absorbed": e.absorbed, "unshot": e.unshot, "escaped": e.escaped, "backs": e.backs,
        "excess": e.excess, "left_behind": e.left_behind, "gap": e.gap(),
    })
}
