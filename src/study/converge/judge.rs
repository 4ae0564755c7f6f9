//! Snapshots before the judge.

use super::{Curve, CurvePoint, MeshPoint, MeshSize};
use crate::metrics::{self, Comparison, MetricsError, Truth, compare, top1_noise_floor};
use crate::scene::Stage;
use crate::solution::{Radiosity, Replicates, Series, Snapshot};
use crate::study::Receivers;
use rayon::prelude::*;

/// A state of the scene with what its snapshots are held against.
#[derive(Debug, Clone)]
pub struct JudgedState {
    receivers: Receivers,
    reference: Truth,
    /// The reference of the state before; none before the first edit.
    before: Option<Truth>,
    top1_floor: Option<f64>,
    confidence: f64,
    reflected: bool,
}

impl JudgedState {
    /// The judge of one state: its reference, and that of the state before. Intervals two-sided at `confidence`; with
    /// `reflected`, metrics are of B - E.
    pub fn new(
        stage: &Stage,
        reference: &Replicates,
        before: Option<&Replicates>,
        confidence: f64,
        reflected: bool,
    ) -> Self {
        let receivers = Receivers::patches(stage);
        let reference = Truth::Sampled(reference.clone());
        let before = before.map(|b| Truth::Sampled(b.clone()));
        let surfaces: Vec<&str> = receivers.surfaces.iter().map(String::as_str).collect();
        let judged = receivers.judged(&surfaces);
        let top1_floor = before.as_ref().and_then(|b| top1_noise_floor(&reference, b, &judged, reflected));
        Self { receivers, reference, before, top1_floor, confidence, reflected }
    }

    /// `None` where the reference is dark.
    fn compare(&self, solution: &Radiosity) -> Result<Option<Comparison>, MetricsError> {
        let surfaces: Vec<&str> = self.receivers.surfaces.iter().map(String::as_str).collect();
        let judged: metrics::Judged = self.receivers.judged(&surfaces);
        let before = self.before.as_ref();
        match compare(solution, &self.reference, before, &judged, self.confidence, self.reflected) {
            Ok(comparison) => Ok(Some(comparison)),
            Err(MetricsError::DarkReference { .. }) => Ok(None),
            Err(e) => Err(e),
        }
    }

    fn point(&self, snapshot: &Snapshot, base: Base) -> Result<CurvePoint, MetricsError> {
        let comparison = self.compare(&snapshot.radiosity)?;
        let known = comparison.as_ref();
        Ok(CurvePoint {
            shots: snapshot.shots,
            rays: snapshot.rays,
            seconds: snapshot.seconds,
            shots_since_edit: snapshot.shots - base.shots,
            rays_since_edit: snapshot.rays - base.rays,
            seconds_since_edit: snapshot.seconds - base.seconds,
            rms: known.map(|c| c.rms),
            top1: known.and_then(|c| c.top1),
            noise_floor: known.and_then(|c| c.reference_noise_floor),
            top1_noise_floor: self.top1_floor,
        })
    }
}

/// What a series had cost when a state began.
#[derive(Debug, Clone, Copy, Default)]
struct Base {
    shots: u64,
    rays: u64,
    seconds: f64,
}

/// Judges every snapshot of a series; one curve for each state in it. `states` are by number of edits; those that the
/// series speaks of must be there.
///
/// # Errors
/// What the metrics refuse: radiosities that do not fit the state.
pub fn judge_series(series: &Series, states: &[Option<JudgedState>]) -> Result<Vec<Curve>, MetricsError> {
    let mut curves = Vec::new();
    let mut base = Base::default();
    for chunk in series.snapshots.chunk_by(|a, b| a.edit == b.edit) {
        let edit = chunk[0].edit;
        let state = states.get(edit).and_then(Option::as_ref).expect("a judge for every state of the series");
        let points = chunk.par_iter().map(|s| state.point(s, base)).collect::<Result<_, _>>()?;
        curves.push(Curve { method: series.name.clone(), edit, points });
        let last = &chunk[chunk.len() - 1];
        base = Base { shots: last.shots, rays: last.rays, seconds: last.seconds };
    }
    Ok(curves)
}

/// Judges a solution on one mesh of a refinement.
///
/// # Errors
/// As [`judge_series`].
pub fn judge_mesh(solution: &Radiosity, size: MeshSize, state: &JudgedState) -> Result<MeshPoint, MetricsError> {
    let comparison = state.compare(solution)?;
    let known = comparison.as_ref();
    Ok(MeshPoint { size, rms: known.map(|c| c.rms), noise_floor: known.and_then(|c| c.reference_noise_floor) })
}
