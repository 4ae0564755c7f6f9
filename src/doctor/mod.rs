//! The scene doctor: what is wrong with a scene, or costly, or merely worth knowing.
//!
//! Bad geometry gives confident nonsense: a floor upside down heats the house. The doctor reads the skin of a
//! scene (which edges are joined, which are free) and casts a million rays of its own in double precision; what
//! both say together becomes [`Finding`]s with place, consequence and mend. Same scene, same findings, on any
//! machine.

mod backs;
mod centres;
mod contact;
mod gaps;
mod lamps;
mod opening;
mod probe;
mod shape;
mod shared;
mod skin;
mod text;
mod weld;
mod winding;

#[cfg(test)]
mod testing;

use crate::scene::{Finding, FindingKind, Place, Scene, SceneError, Severity, SharedArea, Stage};
use opening::Opening;
use probe::Probe;
use skin::Skin;

/// What the examinations work on.
struct Patient<'a> {
    stage: &'a Stage,
    skin: Skin,
    openings: Vec<Opening>,
    probe: Probe,
}

/// Examines a scene in one state: every finding, the grave ones first, in a fixed order.
///
/// # Errors
/// As [`Scene::at`], for scenes that were changed after reading.
pub fn examine(scene: &Scene, stage: &Stage) -> Result<Vec<Finding>, SceneError> {
    let shared = scene.shared_areas(stage.state)?;
    let mut findings = imports(scene, &shared);
    findings.extend(shared.iter().map(shared::finding));
    findings.extend(examine_stage(stage));
    findings.sort_by_key(|f| (std::cmp::Reverse(f.severity), f.kind));
    Ok(findings)
}

/// Everything that can be seen from one stage alone.
fn examine_stage(stage: &Stage) -> Vec<Finding> {
    let skin = Skin::of(stage);
    let openings = opening::openings(&skin);
    let probe = Probe::cast(stage, &openings);
    let patient = Patient { stage, skin, openings, probe };
    let turned = winding::turned(&patient);
    let mut findings = shape::units(stage);
    findings.extend(shape::slivers(stage));
    findings.extend(contact::findings(stage));
    findings.extend(centres::findings(&patient, &turned));
    findings.extend(winding::findings(&patient, &turned));
    findings.extend(backs::findings(&patient, &turned));
    findings.extend(gaps::findings(&patient, &turned));
    findings.extend(gaps::junctions(&patient));
    findings.extend(lamps::findings(&patient));
    findings
}

/// What was mended while reading. Shared areas are told by findings of their own.
fn imports(scene: &Scene, shared: &[SharedArea]) -> Vec<Finding> {
    let told: Vec<String> = shared.iter().map(SharedArea::notice).collect();
    let finding = |notice: &String| Finding {
        kind: FindingKind::Import,
        severity: Severity::Warning,
        place: Place::default(),
        what: notice.clone(),
        consequence: None,
        mend: "mend the file, or leave it so: the scene is read as said here".into(),
    };
    scene.notices.iter().filter(|n| !told.contains(n)).map(finding).collect()
}
