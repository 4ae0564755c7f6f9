//! Scenes with light: a scene and a solution, or a reference, which holds both.

use super::inputs;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::values::StateChoice;
use crate::io::{SolutionFormat, StoredReference, is_reference, read_solution};
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::Receivers;
use crate::study::envmap::Light;
use std::path::Path;

/// A scene at a state with the radiosities of its patches.
pub struct Lit {
    /// What stands there.
    pub stage: Stage,
    /// Radiosities, by replicate where they come from a reference.
    pub light: Light,
}

impl Lit {
    /// Reads a scene (or a reference directory) and its solution; a solution of a reference that is named first is its own.
    pub fn read(
        source: &str,
        given: Option<&Path>,
        state: Option<StateChoice>,
        max_edge: Option<f64>,
        console: &Console,
    ) -> Result<Self, Failure> {
        let path = Path::new(source);
        if is_reference(path) {
            let own = reference(path, state, max_edge, console)?;
            return match given {
                Some(other) => Self::of(own.stage, other),
                None => Ok(Self { stage: own.stage.clone(), light: from_reference(&own, source) }),
            };
        }
        let stage = scene(source, state, max_edge, console)?;
        match given {
            Some(given) => Self::of(stage, given),
            None => Err(Failure::input(format!(
                "{source} says what stands there, not how bright it is: give --solution FILE (from `etalon solve {source} \
                 --method gather -o FILE`), or a reference directory"
            ))
            .at(source)),
        }
    }

    fn of(stage: Stage, given: &Path) -> Result<Self, Failure> {
        let name = given.display().to_string();
        if is_reference(given) {
            let other = StoredReference::read(given)?;
            if other.scene_hash != stage.hash() {
                return Err(foreign(given, &stage));
            }
            let light = from_reference(&other, &name);
            return Ok(Self { stage, light });
        }
        let b = solution(given, &stage, &Receivers::patches(&stage), false)?;
        Ok(Self { light: Light::exact(b.bands, b.values, format!("radiosities of {name}")), stage })
    }
}

fn from_reference(reference: &StoredReference, name: &str) -> Light {
    Light { radiosities: reference.patches.clone(), source: format!("radiosities of the reference {name}") }
}

/// A scene at its state; a solution in its place is told apart.
pub fn scene(
    spec: &str,
    state: Option<StateChoice>,
    max_edge: Option<f64>,
    console: &Console,
) -> Result<Stage, Failure> {
    let path = Path::new(spec);
    if path.is_file() && path.extension().is_some_and(|e| e != "toml") && SolutionFormat::of(path).is_ok() {
        return Err(Failure::input(format!(
            "{spec} is a solution, which has no shape: write SCENE --solution {spec} in its place"
        ))
        .at(spec));
    }
    let scene = inputs::scene(spec, max_edge, console)?;
    inputs::stage_of(&scene, state.unwrap_or(StateChoice::Final))
}

/// A stored reference; what it failed is told.
pub fn reference(
    folder: &Path,
    state: Option<StateChoice>,
    max_edge: Option<f64>,
    console: &Console,
) -> Result<StoredReference, Failure> {
    if state.is_some() || max_edge.is_some() {
        return Err(Failure::input(format!(
            "{}: a reference holds one state and one division; leave --state and --max-edge out",
            folder.display()
        ))
        .at(folder.display().to_string()));
    }
    let reference = StoredReference::read(folder)?;
    tell_failures(&reference, folder, console);
    Ok(reference)
}

fn tell_failures(reference: &StoredReference, folder: &Path, console: &Console) {
    for check in reference.self_check.failures() {
        console.notice(&format!(
            "{}: this reference failed its self-check of {}: {}",
            folder.display(),
            check.name,
            check.finding
        ));
    }
}

/// Means of a reference at the level asked for.
pub fn means(reference: &StoredReference, folder: &Path, per_element: bool) -> Result<Radiosity, Failure> {
    match &reference.elements {
        _ if !per_element => Ok(reference.patches.mean()),
        Some(elements) => Ok(elements.mean()),
        None => Err(Failure::input(format!(
            "{}: this reference holds no element values: its scene has one element per patch; use --per patch",
            folder.display()
        ))
        .at(folder.display().to_string())),
    }
}

/// A solution that belongs to the stage.
pub fn solution(path: &Path, stage: &Stage, receivers: &Receivers, per_element: bool) -> Result<Radiosity, Failure> {
    if is_reference(path) {
        let reference = StoredReference::read(path)?;
        return if reference.scene_hash == stage.hash() {
            means(&reference, path, per_element)
        } else {
            Err(foreign(path, stage))
        };
    }
    let file = read_solution(path)?;
    if file.scene_hash.as_ref().is_some_and(|h| *h != stage.hash()) {
        return Err(foreign(path, stage));
    }
    Ok(file.fit(&receivers.photometry.bands, &receivers.present())?)
}

fn foreign(path: &Path, stage: &Stage) -> Failure {
    let message = format!(
        "{}: this solution says it was computed for another scene, state or discretisation than \"{}\" in state {}; name \
         the scene it belongs to (and its --state, --max-edge)",
        path.display(),
        stage.name,
        stage.state
    );
    Failure::input(message).at(path.display().to_string())
}
