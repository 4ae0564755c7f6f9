//! What several commands read: scenes, states, kernels, plans, matrices.

use crate::cli::args::{self, Kernel, RayArgs, SceneArgs};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::values::StateChoice;
use crate::doctor;
use crate::estimate::{Estimator, Plan};
use crate::io::atomic;
use crate::io::scene::{Look, SceneOptions, Shapes, open_scene, open_with_look, read_lighting};
use crate::raycast::KernelKind;
use crate::scene::{Appearance, Finding, FindingKind, Scene, Severity, Stage};
use crate::study::Session;
use std::path::Path;

/// The kernel asked for.
pub fn kernel_kind(kernel: Kernel) -> KernelKind {
    match kernel {
        Kernel::Auto => KernelKind::Auto,
        Kernel::Embree => KernelKind::Embree,
        Kernel::Builtin => KernelKind::Builtin,
        Kernel::Embree4Rs => KernelKind::Embree4Rs,
    }
}

/// Reads a scene and lays out one state of it.
pub fn stage(args: &SceneArgs, console: &Console) -> Result<Stage, Failure> {
    let scene = scene(&args.scene, args.max_edge, console)?;
    stage_of(&scene, args.state)
}

/// Reads a scene, telling its notices.
pub fn scene(spec: &str, max_edge: Option<f64>, console: &Console) -> Result<Scene, Failure> {
    let scene = open(spec, max_edge)?;
    scene.notices.iter().for_each(|n| console.notice(n));
    Ok(scene)
}

/// Reads a scene; its notices are for the caller to tell.
pub fn open(spec: &str, max_edge: Option<f64>) -> Result<Scene, Failure> {
    if max_edge.is_some_and(|e| !(e > 0.0 && e.is_finite())) {
        return Err(Failure::input("--max-edge must be a length above 0, in metres"));
    }
    Ok(open_scene(spec, &SceneOptions { max_edge_override: max_edge })?)
}

/// Reads a scene with what only pictures show, telling its notices.
pub fn scene_with_look(spec: &str, max_edge: Option<f64>, console: &Console) -> Result<(Scene, Look), Failure> {
    if max_edge.is_some_and(|e| !(e > 0.0 && e.is_finite())) {
        return Err(Failure::input("--max-edge must be a length above 0, in metres"));
    }
    let (scene, look) = open_with_look(spec, &SceneOptions { max_edge_override: max_edge })?;
    scene.notices.iter().for_each(|n| console.notice(n));
    Ok((scene, look))
}

/// An appearance with the words of a lighting file over it, if there is one.
pub fn lighting(file: Option<&Path>, base: Appearance, shapes: &dyn Shapes) -> Result<Appearance, Failure> {
    match file {
        Some(file) => Ok(read_lighting(file, shapes.bands())?.over(&base, shapes)?),
        None => Ok(base),
    }
}

/// What the scene doctor finds; says on stderr how many findings are grave.
pub fn findings(scene: &Scene, stage: &Stage, console: &Console) -> Result<Vec<Finding>, Failure> {
    let findings = doctor::examine(scene, stage)?;
    let told = |f: &&Finding| f.severity > Severity::Note && f.kind != FindingKind::Import;
    let mut kinds: Vec<&str> = findings.iter().filter(told).map(|f| f.kind.name()).collect();
    let count = kinds.len();
    kinds.dedup();
    if count > 0 {
        let kinds = kinds.join(", ");
        console.notice(&format!("the scene doctor has {count} grave findings ({kinds}); see `etalon scene check`"));
    }
    Ok(findings)
}

/// Lays out a state.
pub fn stage_of(scene: &Scene, choice: StateChoice) -> Result<Stage, Failure> {
    let state = match choice {
        StateChoice::Initial => 0,
        StateChoice::Final => scene.edits.len(),
        StateChoice::After(k) => scene.state_named(&k.to_string())?,
    };
    Ok(scene.at(state)?)
}

/// Opens the kernels, and says when the fast one is missing.
pub fn session<'a>(stage: &'a Stage, kind: KernelKind, console: &Console) -> Result<Session<'a>, Failure> {
    let session = Session::open(stage, kind)?;
    let kernel = session.kernel();
    session.notice().into_iter().for_each(|n| console.notice(n));
    console.detail(&format!("kernel {} {}", kernel.name, kernel.version));
    console.detail(if session.is_enclosure() { "the scene is closed" } else { "the scene is open" });
    Ok(session)
}

/// The plan that the ray options describe.
pub fn plan(rays: &RayArgs) -> Result<Plan, Failure> {
    if rays.target_error.is_some_and(|t| t.0 == 0.0) {
        return Err(Failure::input("--target-error must be above 0: no number of rays reaches 0"));
    }
    Ok(Plan {
        rays: rays.rays,
        randomisations: rays.randomisations,
        target_error: rays.target_error.map(|t| t.0),
        max_time: rays.max_time.map(|t| t.0),
        estimator: estimator(rays.estimator),
    })
}

/// The estimator asked for.
pub fn estimator(choice: args::Estimator) -> Estimator {
    match choice {
        args::Estimator::Auto => Estimator::Auto,
        args::Estimator::Rays => Estimator::Rays,
    }
}

/// Writes a result file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    atomic::write(path, bytes).map_err(|e| Failure::input(e.to_string()).at(path.display().to_string()))
}

/// Fails before the work if a result could not be written after it.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    atomic::check(path).map_err(|e| Failure::input(e.to_string()).at(path.display().to_string()))
}

/// "1 234 567", for people.
pub fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().map(|g| std::str::from_utf8(g).unwrap_or("")).collect();
    groups.join(" ")
}
