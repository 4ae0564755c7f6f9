//! `etalon converge --refine`: the same scene on finer and finer meshes.

use super::converge::{Asked, announce_kernel, check_lights, tell};
use super::{converge_told, inputs};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::StateChoice;
use crate::io::{StoredReference, atomic};
use crate::report::curves::{MeshReport, mesh_files, mesh_json, mesh_text};
use crate::report::{Phase, save};
use crate::scene::{Scene, Stage};
use crate::solution::Series;
use crate::study::converge::{JudgedState, MeshCurve, MeshSize, Run, judge_mesh, refined, run_method};
use std::time::Instant;

/// One mesh.
struct Mesh {
    factor: u32,
    scene: Scene,
    stage: Stage,
}

pub fn run(asked: &Asked, console: &Console) -> Result<u8, Failure> {
    let args = asked.args;
    if let Some(e) = asked.entries.iter().find(|e| e.variants.len() != 1) {
        return Err(Failure::input(format!(
            "--refine takes one run of each method, not {}: name it once for each value",
            e.name
        )));
    }
    // All meshes first: what is too fine is known before the work.
    let meshes = meshes(asked, console)?;
    atomic::create_folder(&args.output)?;
    announce_kernel(asked, &meshes[0].stage, console)?;
    let judge = asked.judge(console);
    let mut curves: Vec<MeshCurve> =
        asked.entries.iter().map(|e| MeshCurve { method: e.name.clone(), points: Vec::new() }).collect();
    let (mut timing, mut references): (Vec<Phase>, Vec<StoredReference>) = (Vec::new(), Vec::new());
    for mesh in &meshes {
        let folder = args.output.join(format!("reference-x{}", mesh.factor));
        let (stored, phase) = judge.obtain(&mesh.scene, &mesh.stage, &folder)?;
        timing.push(phase);
        let state = JudgedState::new(&mesh.stage, &stored.patches, None, args.confidence.0, args.reflected);
        let size = MeshSize::of(&mesh.stage, mesh.factor);
        for (entry, curve) in asked.entries.iter().zip(&mut curves) {
            let begin = Instant::now();
            let kernel = inputs::kernel_kind(asked.kernel);
            let stages = std::slice::from_ref(&mesh.stage);
            let run = Run { scene: &mesh.scene, stages, kernel, seed: args.rays.seed };
            for Series { snapshots, .. } in run_method(&run, entry, console)? {
                // Where a method leaves several snapshots, the last is its solution.
                if let Some(last) = snapshots.last() {
                    curve.points.push(judge_mesh(&last.radiosity, size, &state)?);
                }
            }
            let name = format!("{} at {}\u{d7}", entry.name, mesh.factor);
            timing.push(Phase { name, seconds: begin.elapsed().as_secs_f64() });
        }
        references.push(stored);
    }
    console.end();
    let name = references.first().map_or(String::new(), |r| r.stage.name.clone());
    let report = MeshReport { about: converge_told::about(asked, &name, references.iter(), timing), curves };
    save(&args.output, &mesh_files(&report)?)?;
    tell(&args.output, &mesh_text(&report), mesh_json(&report), console);
    Ok(exit::DONE)
}

/// Every mesh, laid out.
fn meshes(asked: &Asked, console: &Console) -> Result<Vec<Mesh>, Failure> {
    let args = asked.args;
    let scene = inputs::scene(&args.scene, args.max_edge, console)?;
    let mut meshes: Vec<Mesh> = Vec::new();
    for factor in &args.refine {
        if meshes.iter().any(|m| m.factor == *factor) {
            return Err(Failure::input(format!("--refine names {factor} twice; give each factor once")));
        }
        let finer = refined(&scene, *factor)?;
        let stage = inputs::stage_of(&finer, args.state.unwrap_or(StateChoice::Final))?;
        meshes.push(Mesh { factor: *factor, scene: finer, stage });
    }
    let stages: Vec<Stage> = meshes.iter().take(1).map(|m| m.stage.clone()).collect();
    check_lights(asked, &stages)?;
    Ok(meshes)
}
