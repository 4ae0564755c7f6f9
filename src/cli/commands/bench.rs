//! What is judged and what judges, read and fitted to each other.

use super::{brought, inputs, split};
use crate::cli::args::{CompareArgs, Truth};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::values::PerLevel;
use crate::io::{
    SolutionFile, StoredReference, certified, certified_names, is_mesh_values, is_reference, read_solution,
};
use crate::scene::Stage;
use crate::solution::{Radiosity, TruthLevel};
use crate::study::{Against, Receivers, anonymous_stage};
use crate::view::{Photometry, Primaries};
use std::path::Path;

/// References that come with the program are named so.
const BUILTIN: &str = "builtin:";

/// True if a path names a reference and not a solution.
pub fn names_reference(path: &Path) -> bool {
    is_reference(path) || path.to_str().is_some_and(|p| p.starts_with(BUILTIN))
}

/// Solution, reference and scene, fitted to each other.
pub struct Bench {
    /// The truth the reference holds, by name.
    pub truth: String,
    /// The scene at the judged state.
    pub stage: Stage,
    /// Who is judged.
    pub receivers: Receivers,
    /// What is judged.
    pub solution: Radiosity,
    /// By what.
    pub against: Against,
    /// The state before the change.
    pub before: Option<Against>,
    /// Elements instead of patches.
    pub per_element: bool,
    /// What the reader has to know of how the solution was read.
    pub notices: Vec<String>,
}

impl Bench {
    /// Reads everything that a comparison names. One that judges takes no reference that failed its own self-check.
    pub fn read(args: &CompareArgs, judging: bool, console: &Console) -> Result<Self, Failure> {
        if !(0.0..1.0).contains(&args.confidence.0) || args.confidence.0 == 0.0 {
            return Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example"));
        }
        split::check(args)?;
        let reference = Input::read(&args.reference)?.trusted(&args.reference, judging)?;
        let truth = check_truth(args, &reference)?;
        let stage = stage(args, &reference, console)?;
        let per_element = args.per == PerLevel::Element;
        let mut receivers = if per_element { Receivers::elements(&stage) } else { Receivers::patches(&stage) };
        let (solution, notices) = solution(args, &stage, &mut receivers)?;
        let against = match reference {
            Input::Reference(r) => Against::Reference(r),
            Input::Solution(s) => Against::Solution(s.fit(&receivers.photometry.bands, &receivers.present())?),
        };
        let before = args.before.as_deref().map(|path| before(path, &receivers, judging)).transpose()?;
        Ok(Self { truth, stage, receivers, solution, against, before, per_element, notices })
    }

    /// The reference, where it is one and not a solution.
    pub fn reference(&self) -> Option<&StoredReference> {
        match &self.against {
            Against::Reference(r) => Some(r),
            Against::Solution(_) => None,
        }
    }
}

/// Either a stored reference or a solution, as a path names it.
pub enum Input {
    Reference(Box<StoredReference>),
    Solution(SolutionFile),
}

impl Input {
    /// Reads what a path names.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let builtin = path.to_str().and_then(|p| p.strip_prefix(BUILTIN));
        if let Some(name) = builtin {
            let stored = certified(name).ok_or_else(|| {
                let names = certified_names().join(", ");
                Failure::input(format!("no reference comes with the program for \"{name}\"; there are: {names}"))
                    .at(path.display().to_string())
            })?;
            Ok(Self::Reference(Box::new(stored?)))
        } else if is_reference(path) {
            Ok(Self::Reference(Box::new(StoredReference::read(path)?)))
        } else {
            Ok(Self::Solution(read_solution(path)?))
        }
    }

    /// A reference that judges must have passed its self-check.
    pub fn trusted(self, path: &Path, judging: bool) -> Result<Self, Failure> {
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

/// The solution as radiosities of the receivers. Patches that it has no value for (`--skip-unmatched`) take no part.
fn solution(args: &CompareArgs, stage: &Stage, receivers: &mut Receivers) -> Result<(Radiosity, Vec<String>), Failure> {
    let (path, brought) = (&args.solution, &args.brought);
    if stage.facets.is_empty() || args.per == PerLevel::Element {
        if is_mesh_values(path) || brought.changes_anything() {
            let message = format!(
                "{}: a solution on a mesh of its own or in other units is judged per patch of a scene; give --scene and \
                 leave out --per element, or convert it with `etalon convert`",
                path.display()
            );
            return Err(Failure::input(message).at(path.display().to_string()));
        }
        let per_element = args.per == PerLevel::Element;
        return Ok((fit(path, Input::read(path)?, receivers, per_element, stage)?, Vec::new()));
    }
    let brought = brought::radiosity(path, brought, stage)?;
    for (area, matched) in receivers.areas.iter_mut().zip(&brought.matched) {
        if !matched {
            *area = 0.0;
        }
    }
    Ok((brought.radiosity, brought.notices))
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
pub fn patch_means(against: &Against, stage: &Stage, per_element: bool) -> Radiosity {
    match against {
        Against::Reference(r) => r.patches.mean(),
        Against::Solution(b) if per_element => by_patch(b, stage),
        Against::Solution(b) => b.clone(),
    }
}

/// Area-weighted means of the elements of each patch.
pub fn by_patch(elements: &Radiosity, stage: &Stage) -> Radiosity {
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
