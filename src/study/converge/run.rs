//! Running methods through the states of a scene.

use super::Entry;
use crate::methods::{Method, MethodError, shooting};
use crate::raycast::{KernelError, KernelKind};
use crate::reference::{Progress, ReferenceError, check_size};
use crate::scene::{Scene, Stage};
use crate::solution::{Series, Snapshot};
use crate::study::{Course, Moments, Session, ShootRequest, SolveRequest, shoot, solve};
use std::time::Instant;

/// What every method of a run shares.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// The scene with its edits.
    pub scene: &'a Scene,
    /// Its states that are run through, in order.
    pub stages: &'a [Stage],
    /// Ray kernel.
    pub kernel: KernelKind,
    /// Seed of ray-cast methods.
    pub seed: u64,
}

/// Why a method could not be run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The method refuses.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// No kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
    /// More rays or patches than can be counted.
    #[error(transparent)]
    Size(#[from] ReferenceError),
}

/// Runs every variant of a method through all states: one series each, all of the same name. Seconds are those of
/// the method alone: kernels are open before the clock starts.
///
/// # Errors
/// What the method or its kernel refuses.
pub fn run_method(run: &Run, entry: &Entry, progress: &dyn Progress) -> Result<Vec<Series>, RunError> {
    let series = |method: &Method| {
        let snapshots = match method {
            Method::Gather(_) | Method::Hemicube(_) => from_scratch(run, *method, progress)?,
            Method::Progressive(p) => shot_by_shot(run, Course::FromScratch, *p, progress)?,
            Method::Redistribution(p) => shot_by_shot(run, Course::Redistribution, *p, progress)?,
        };
        Ok(Series { name: entry.name.clone(), snapshots })
    };
    entry.variants.iter().map(series).collect()
}

/// A method that knows nothing of edits: each state is solved anew, one snapshot each.
fn from_scratch(run: &Run, method: Method, progress: &dyn Progress) -> Result<Vec<Snapshot>, RunError> {
    let (mut rays, mut seconds) = (0, 0.0);
    let mut snapshots = Vec::new();
    for stage in run.stages {
        if let Method::Gather(p) = &method {
            check_size(stage, &p.plan())?;
        }
        let session = Session::open(stage, run.kernel)?;
        let request = SolveRequest { method, form_factors: None, seed: run.seed, per_element: false };
        let begin = Instant::now();
        let radiosity = solve(&session, &request, progress)?.radiosity;
        seconds += begin.elapsed().as_secs_f64();
        rays += rays_of(&method, stage);
        snapshots.push(Snapshot { edit: stage.state, shots: 0, rays, seconds, radiosity });
    }
    Ok(snapshots)
}

/// A method that shoots, with a snapshot at every moment of a curve.
fn shot_by_shot(
    run: &Run,
    course: Course,
    params: shooting::Params,
    progress: &dyn Progress,
) -> Result<Vec<Snapshot>, RunError> {
    // From scratch each state is a run of its own; with redistribution the last one goes through them all.
    let ends: &[Stage] = match course {
        Course::FromScratch => run.stages,
        Course::Redistribution => &run.stages[run.stages.len().saturating_sub(1)..],
    };
    let mut snapshots: Vec<Snapshot> = Vec::new();
    for end in ends {
        let (shots, rays, seconds) = snapshots.last().map_or((0, 0, 0.0), |s| (s.shots, s.rays, s.seconds));
        let request =
            ShootRequest { scene: run.scene, course, last: end.state, params, kernel: run.kernel, seed: run.seed };
        shoot(&request, &Moments::default(), progress, &mut |s| {
            snapshots.push(Snapshot { shots: shots + s.shots, rays: rays + s.rays, seconds: seconds + s.seconds, ..s });
            Ok::<(), MethodError>(())
        })?;
    }
    Ok(snapshots)
}

/// Rays that a solve of this stage casts.
fn rays_of(method: &Method, stage: &Stage) -> u64 {
    let present = stage.patches.iter().filter(|p| p.is_present()).count() as u64;
    match method {
        Method::Gather(p) => {
            let plan = p.plan();
            present * plan.rays_per_randomisation() * u64::from(plan.randomisations)
        }
        Method::Hemicube(_) | Method::Progressive(_) | Method::Redistribution(_) => 0,
    }
}
