//! What `--form-factors` and `--patch-system` add to a comparison: where the error comes from.

use super::bench::names_reference;
use crate::cli::args::CompareArgs;
use crate::cli::exit::Failure;
use crate::cli::values::PerLevel;
use crate::io::{StoredReference, read_form_factors_of};
use crate::metrics::Split;
use crate::scene::Stage;
use crate::solution::{Radiosity, TruthLevel};
use crate::study::{Against, Beside, Receivers, split_error};
use std::path::Path;

/// Refuses options that do not go together, before any work.
pub fn check(args: &CompareArgs) -> Result<(), Failure> {
    let asked = [(&args.form_factors, "--form-factors"), (&args.patch_system, "--patch-system")];
    for (_, name) in asked.iter().filter(|(path, _)| path.is_some()) {
        if args.per == PerLevel::Element {
            return Err(Failure::input(format!("{name} splits the error per patch; leave --per element out")));
        }
        if !names_reference(&args.reference) {
            return Err(Failure::input(format!(
                "{name} needs a reference directory to judge by, and {} is none; see `etalon reference`",
                args.reference.display()
            )));
        }
    }
    Ok(())
}

/// The parts of the error; `None` where nothing was given to tell them apart.
pub fn split(
    args: &CompareArgs,
    stage: &Stage,
    solution: &Radiosity,
    against: &Against,
    receivers: &Receivers,
    confidence: f64,
) -> Result<Option<Split>, Failure> {
    let Against::Reference(reference) = against else { return Ok(None) };
    if args.form_factors.is_none() && args.patch_system.is_none() {
        return Ok(None);
    }
    let form_factors = args.form_factors.as_deref().map(|f| read_form_factors_of(f, stage)).transpose()?;
    let patch_system = args.patch_system.as_deref().map(|path| patch_system(path, reference)).transpose()?;
    let beside = Beside { form_factors: form_factors.as_ref(), patch_system: patch_system.as_ref() };
    let split = split_error(stage, solution, against, &beside, receivers, confidence);
    split.map(Some).map_err(|e| Failure::input(e.to_string()))
}

/// The level below a continuous reference, of the same scene.
fn patch_system(path: &Path, reference: &StoredReference) -> Result<StoredReference, Failure> {
    let refused = |why: &str| {
        let message = format!("--patch-system {}: {why}", path.display());
        Err(Failure::input(message).at(path.display().to_string()))
    };
    if reference.provenance.truth != TruthLevel::Continuous {
        return refused(
            "--reference holds the patch system already; judge by a continuous reference, or leave this out",
        );
    }
    let system = StoredReference::read(path)?;
    if system.provenance.truth != TruthLevel::PatchSystem {
        return refused("this reference is of the continuous problem; compute one with --truth patch-system");
    }
    if system.scene_hash != reference.scene_hash {
        return refused("this reference is of another scene, state or discretisation than --reference");
    }
    if let Some(c) = system.self_check.failures().next() {
        return refused(&format!("it failed its own self-check of {} ({}); compute a sound one", c.name, c.finding));
    }
    Ok(system)
}
