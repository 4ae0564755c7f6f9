//! What is shown: a scene at its state with the radiosities of its patches or elements.

use crate::cli::args::RenderArgs;
use crate::cli::commands::inputs;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::values::{PerLevel, StateChoice};
use crate::io::{SolutionFormat, StoredReference, is_reference, read_solution};
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::Receivers;
use crate::view::Viewer;
use std::path::Path;

/// A scene with what is shown of it.
#[derive(Clone)]
pub(super) struct Subject {
    /// The scene at its state.
    pub stage: Stage,
    /// Patches or elements.
    pub receivers: Receivers,
    /// True if values belong to elements.
    pub per_element: bool,
    /// What is shown; `None` for the patches alone.
    pub radiosity: Option<Radiosity>,
    /// What the exposure is fitted to where it is not what is shown: the reference.
    pub yardstick: Option<Radiosity>,
    /// Where the radiosities come from.
    pub name: String,
}

impl Subject {
    /// Reads the scene, and unless `bare` the radiosities.
    pub(super) fn read(args: &RenderArgs, bare: bool, console: &Console) -> Result<Self, Failure> {
        let per_element = args.per == PerLevel::Element;
        let source = Path::new(&args.scene);
        let reference = if is_reference(source) { Some(reference(args, source, console)?) } else { None };
        let stage = match &reference {
            Some(r) => r.stage.clone(),
            None => scene(args, console)?,
        };
        let receivers = if per_element { Receivers::elements(&stage) } else { Receivers::patches(&stage) };
        let own = reference.as_ref().map(|r| means(r, source, per_element)).transpose()?;
        let given = args.solution.as_deref().map(|p| solution(p, &stage, &receivers, per_element)).transpose()?;
        if own.is_none() && given.is_none() && !bare {
            return Err(Failure::input(format!(
                "{0} says what stands there, not how bright it is: give --solution FILE (from `etalon solve {0} \
                 --method gather -o FILE`), name a reference directory instead, or ask for --style items",
                args.scene
            ))
            .at(args.scene.clone()));
        }
        let name = args.solution.as_ref().map_or_else(|| args.scene.clone(), |p| p.display().to_string());
        let (radiosity, yardstick) = if given.is_some() { (given, own) } else { (own, None) };
        let subject = Self { stage, receivers, per_element, radiosity, yardstick, name };
        match args.lamp.as_slice() {
            [lamp] => subject.lit(lamp.0, args.viewing.efficacy.0),
            _ => Ok(subject),
        }
    }

    /// The same with all light times the factor that gives the brightest lamp this luminance, cd/m^2.
    pub(super) fn lit(&self, luminance: f64, efficacy: f64) -> Result<Self, Failure> {
        let bands = self.receivers.photometry.bands.len();
        let brightest = (0..self.receivers.areas.len())
            .filter(|i| self.receivers.areas[*i] > 0.0)
            .map(|i| self.receivers.photometry.luminance(&self.receivers.emission[i * bands..(i + 1) * bands]))
            .fold(0.0, f64::max);
        if brightest <= 0.0 {
            return Err(Failure::input("--lamp: nothing in this scene emits light; leave it out"));
        }
        let factor = luminance / Viewer::luminance_of(efficacy, brightest);
        let mut lit = self.clone();
        for b in lit.radiosity.iter_mut().chain(&mut lit.yardstick) {
            b.values.iter_mut().chain(b.std_err.iter_mut().flatten()).for_each(|x| *x *= factor);
        }
        Ok(lit)
    }
}

fn scene(args: &RenderArgs, console: &Console) -> Result<Stage, Failure> {
    let path = Path::new(&args.scene);
    if path.is_file() && path.extension().is_some_and(|e| e != "toml") && SolutionFormat::of(path).is_ok() {
        return Err(Failure::input(format!(
            "{0} is a solution, which has no shape: write `etalon render SCENE --solution {0} -o ...`",
            args.scene
        ))
        .at(args.scene.clone()));
    }
    let scene = inputs::scene(&args.scene, args.max_edge, console)?;
    inputs::stage_of(&scene, args.state.unwrap_or(StateChoice::Final))
}

fn reference(args: &RenderArgs, folder: &Path, console: &Console) -> Result<StoredReference, Failure> {
    if args.state.is_some() || args.max_edge.is_some() {
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
fn means(reference: &StoredReference, folder: &Path, per_element: bool) -> Result<Radiosity, Failure> {
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
fn solution(path: &Path, stage: &Stage, receivers: &Receivers, per_element: bool) -> Result<Radiosity, Failure> {
    let foreign = || {
        let message = format!(
            "{}: this solution says it was computed for another scene, state or discretisation than \"{}\" in state \
             {}; name the scene it belongs to (and its --state, --max-edge)",
            path.display(),
            stage.name,
            stage.state
        );
        Failure::input(message).at(path.display().to_string())
    };
    if is_reference(path) {
        let reference = StoredReference::read(path)?;
        return if reference.scene_hash == stage.hash() {
            means(&reference, path, per_element)
        } else {
            Err(foreign())
        };
    }
    let file = read_solution(path)?;
    if file.scene_hash.as_ref().is_some_and(|h| *h != stage.hash()) {
        return Err(foreign());
    }
    Ok(file.fit(&receivers.photometry.bands, &receivers.present())?)
}
