//! Scenes, and candidates run on them.

use super::Error;
use crate::io::scene::SceneOptions;
use crate::methods::Method;
use crate::raycast::KernelKind;
use crate::reference::Progress;
use crate::scene::{Finding, Scene, Stage};
use crate::solution::Radiosity;
use crate::study::{self, Session, SolveRequest};

/// Opens a scene file by its path, or a scene that comes with the program as `builtin:NAME`.
///
/// # Errors
/// [`Error::SceneFile`] with file, line, surface and mend.
pub fn open_scene(spec: &str) -> Result<Scene, Error> {
    Ok(crate::io::scene::open_scene(spec, &SceneOptions::default())?)
}

/// What the scene doctor finds in a state of a scene, the grave findings first.
///
/// # Errors
/// [`Error::Scene`] if the state cannot be set up.
pub fn examine_scene(scene: &Scene, state: usize) -> Result<Vec<Finding>, Error> {
    Ok(crate::doctor::examine(scene, &scene.at(state)?)?)
}

/// Runs one of the candidates that come with the program: `hemicube:resolution=200`, `gather:rays=4096`.
/// Returns radiosities per patch, W/m^2 per band.
///
/// # Errors
/// [`Error::Method`] for an unknown method or parameter, [`Error::Kernel`] without a ray kernel.
pub fn solve(stage: &Stage, method: &str, seed: u64) -> Result<Radiosity, Error> {
    let method: Method = method.parse()?;
    let session = Session::open(stage, KernelKind::Auto)?;
    let request = SolveRequest { method, form_factors: None, seed, per_element: false };
    Ok(study::solve(&session, &request, &Silent)?.radiosity)
}

/// Tells nobody.
pub(super) struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}
