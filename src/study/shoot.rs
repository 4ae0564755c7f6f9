//! Running the methods that shoot: from scratch or edit by edit, with snapshots on the way.

use crate::methods::MethodError;
use crate::methods::shooting::{Budget, End, Event, Params, Shooting};
use crate::raycast::KernelKind;
use crate::reference::Progress;
use crate::scene::Scene;
use crate::solution::Snapshot;
use std::ops::ControlFlow;

/// How states follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// Each state is solved as if there had been none before.
    FromScratch,
    /// The first state is solved from scratch, and every edit redistributes.
    Redistribution,
}

/// What is to be shot.
#[derive(Clone, Copy)]
pub struct ShootRequest<'a> {
    /// The scene with its edits.
    pub scene: &'a Scene,
    /// How states follow each other.
    pub course: Course,
    /// The last state.
    pub last: usize,
    /// Settings; states before the last are left at `params.before`.
    pub params: Params,
    /// Ray kernel.
    pub kernel: KernelKind,
    /// Seed of the rays.
    pub seed: u64,
}

/// When snapshots are taken, counted from the last edit; one more is taken where a state is left.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// After these numbers of shots; ascending.
    pub shots: Vec<u64>,
    /// Every so many seconds of computing.
    pub every: Option<f64>,
}

impl Default for Moments {
    /// Twelve to sixteen per decade of shots.
    fn default() -> Self {
        const STEPS: [u64; 16] = [10, 11, 12, 13, 15, 17, 20, 23, 26, 30, 35, 40, 50, 60, 70, 85];
        let decades = (0..6).map(|k| 10u64.pow(k));
        let later = decades.flat_map(|d| STEPS.map(|s| s * d));
        Self { shots: (0..10).chain(later).collect(), every: None }
    }
}

/// Shoots a scene to its last state; `take` is handed a snapshot at every moment and may refuse to go on. Returns the
/// solver with why it ended.
///
/// # Errors
/// What the solver refuses, and what `take` returns.
pub fn shoot<E: From<MethodError>>(
    request: &ShootRequest,
    moments: &Moments,
    progress: &dyn Progress,
    take: &mut dyn FnMut(Snapshot) -> Result<(), E>,
) -> Result<(Shooting, End), E> {
    let solver = begin(request)?;
    shoot_on(solver, request, moments, progress, take)
}

/// A solver on the first state that a course goes through.
///
/// # Errors
/// What the solver refuses.
pub fn begin(request: &ShootRequest) -> Result<Shooting, MethodError> {
    let first = match request.course {
        Course::FromScratch => request.last,
        Course::Redistribution => 0,
    };
    Ok(Shooting::open(request.scene, first, request.params, request.kernel, request.seed)?)
}

/// The same, going on with a solver that has begun.
///
/// # Errors
/// As [`shoot`].
pub fn shoot_on<E: From<MethodError>>(
    mut solver: Shooting,
    request: &ShootRequest,
    moments: &Moments,
    progress: &dyn Progress,
    take: &mut dyn FnMut(Snapshot) -> Result<(), E>,
) -> Result<(Shooting, End), E> {
    loop {
        let leaving = solver.state() < request.last;
        let mut now = request.params;
        if leaving {
            now.stop.unshot = request.params.before;
        }
        solver.set_params(now);
        progress.begin(&format!("shooting, state {}", solver.state()), None);
        let end = one_state(&mut solver, moments, progress, take)?;
        if !leaving {
            return Ok((solver, end));
        }
        solver.apply_next().map_err(|e| E::from(MethodError::Shooting(e)))?;
    }
}

/// Shoots one state with its snapshots.
fn one_state<E>(
    solver: &mut Shooting,
    moments: &Moments,
    progress: &dyn Progress,
    take: &mut dyn FnMut(Snapshot) -> Result<(), E>,
) -> Result<End, E> {
    let from = solver.costs();
    let mut failed = None;
    let mut taken = None;
    let mut ticks = 0.0;
    if moments.shots.first() == Some(&0) {
        take(snapshot(solver))?;
        taken = Some(from.shots);
    }
    let end = solver.run(Budget::default(), &mut |solver: &Shooting, event: &Event| {
        progress.advance(1);
        let (shots, seconds) = (event.costs.shots - from.shots, event.costs.seconds - from.seconds);
        let tick = moments.every.map_or(0.0, |t| (seconds / t).floor());
        if moments.shots.binary_search(&shots).is_err() && tick <= ticks {
            return ControlFlow::Continue(());
        }
        ticks = tick;
        taken = Some(event.costs.shots);
        match take(snapshot(solver)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(e) => {
                failed = Some(e);
                ControlFlow::Break(())
            }
        }
    });
    match failed {
        Some(e) => Err(e),
        None if taken != Some(solver.costs().shots) => take(snapshot(solver)).map(|()| end),
        None => Ok(end),
    }
}

fn snapshot(solver: &Shooting) -> Snapshot {
    let costs = solver.costs();
    let radiosity = solver.radiosity();
    Snapshot { edit: solver.state(), shots: costs.shots, rays: costs.rays, seconds: costs.seconds, radiosity }
}
