//! The state of a solver as plain numbers, to be stored and taken up again.
//!
//! Geometries are not in it: they are laid out again from the scene file, so edits made beside the file cannot be
//! saved.

use super::change::Change;
use super::geometry::Geometry;
use super::solver::luminous;
use super::version::{Version, describe};
use super::{Costs, Params, Shooting, ShootingError};
use crate::methods::PatchVectors;
use crate::raycast::{KernelInfo, KernelKind};
use crate::scene::{Edit, Scene};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Largest gap in the sums of sound data, relative to the most power ever emitted.
const SOUND: f64 = 1e-9;

/// What must be the same where a state is taken up again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// `Stage::hash` of every version of the geometry, oldest first, then of the scene as it stands.
    pub stages: Vec<String>,
    /// Settings of the form factors; those of order and stop may differ.
    pub factors: String,
    /// Seed of the rays.
    pub seed: u64,
    /// Name and version of the ray kernel.
    pub kernel: String,
}

/// The state of a solver. Power in W; a patch has `width` = channels x bands values of what it has shot, channel by
/// channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// What it belongs to.
    pub fingerprint: Fingerprint,
    /// State of the scene in which the solver was opened.
    pub opened: u64,
    /// State of the scene as it stands.
    pub state: u64,
    /// Power that has arrived: channels x (elements, then the places where power is lost) x bands.
    pub elements: Vec<f64>,
    /// Power that has arrived, channels x patches x bands.
    pub patches: Vec<f64>,
    /// Power shot in all versions together, patches x width.
    pub shot: Vec<f64>,
    /// State in which each version of the geometry came to stand, oldest first.
    pub version_states: Vec<u64>,
    /// Power shot in each version, versions x patches x width.
    pub version_shot: Vec<f64>,
    /// Estimated share of the power that is to be redistributed, versions x patches.
    pub version_weight: Vec<f64>,
    /// Lamps that shoot first, in their order.
    pub lamps: Vec<u64>,
    /// Strategy one is still in its first part.
    pub redistribute_first: bool,
    /// The rest of the log goes before anything else.
    pub drains: bool,
    /// Most luminous power ever emitted, W.
    pub brightest: f64,
    /// Shots, redistributions, spared patches, rays, receivers.
    pub costs: [u64; 5],
    /// Seconds of computing.
    pub seconds: f64,
}

impl Shooting {
    /// The state as plain numbers.
    ///
    /// # Errors
    /// Edits were made that the scene file does not have, or an object is selected.
    pub fn save(&self) -> Result<Saved, ShootingError> {
        self.nothing_selected()?;
        if self.own_edits > 0 {
            return Err(ShootingError::Unsaved(self.own_edits));
        }
        let versions = &self.versions;
        let Costs { shots, redistributions, spared, rays, receivers, seconds } = self.costs;
        Ok(Saved {
            fingerprint: self.fingerprint(),
            opened: self.opened as u64,
            state: self.state as u64,
            elements: self.field.planes.iter().flat_map(|p| p.elements.iter().copied()).collect(),
            patches: self.field.planes.iter().flat_map(|p| p.patches.iter().copied()).collect(),
            shot: self.shot.clone(),
            version_states: versions.iter().map(|v| v.state as u64).collect(),
            version_shot: versions.iter().flat_map(|v| v.shot.iter().copied()).collect(),
            version_weight: versions.iter().flat_map(|v| v.weight.iter().copied()).collect(),
            lamps: self.lamps.iter().map(|i| *i as u64).collect(),
            redistribute_first: self.redistribute_first,
            drains: self.drains,
            brightest: self.brightest,
            costs: [shots, redistributions, spared, rays, receivers],
            seconds,
        })
    }

    /// A solver in a saved state: it goes on bit by bit as the saved one would have.
    ///
    /// # Errors
    /// Data that is damaged or belongs to something else; else as [`Shooting::open`].
    pub fn restore(
        scene: &Scene,
        params: Params,
        kernel: KernelKind,
        seed: u64,
        saved: &Saved,
    ) -> Result<Self, ShootingError> {
        saved.check_states(scene)?;
        let mut solver = Self::open(scene, saved.opened as usize, params, kernel, seed)?;
        // What the numbers belong to comes before the numbers: another number of rays has others.
        let (had, has) = (&saved.fingerprint, solver.fingerprint());
        foreign("other form factors", had.factors == has.factors)?;
        foreign("another seed", had.seed == has.seed)?;
        foreign("another ray kernel", had.kernel == has.kernel)?;
        saved.check_sizes(&solver)?;
        solver.take_up(saved)?;
        foreign("another scene", had.stages == solver.fingerprint().stages)?;
        solver.check_sums()?;
        Ok(solver)
    }

    fn fingerprint(&self) -> Fingerprint {
        let Params { stop, ambient, strategy, threshold, ranking, before, .. } = Params::default();
        let factors = Params { stop, ambient, strategy, threshold, ranking, before, ..self.params };
        let stages = self.versions.iter().map(|v| &v.geometry.stage).chain([&self.stage]);
        let KernelInfo { name, version, .. } = self.kernel();
        Fingerprint {
            stages: stages.map(|s| s.hash()).collect(),
            factors: factors.written(),
            seed: self.seed,
            kernel: format!("{name} {version}"),
        }
    }

    /// Takes over all that was saved.
    fn take_up(&mut self, saved: &Saved) -> Result<(), ShootingError> {
        let (values, patches) = (self.shot.len(), self.stage.patch_count());
        self.state = saved.state as usize;
        self.stage = Arc::new(self.checked_stage(&self.scene, self.state)?);
        self.vectors = PatchVectors::of(&self.stage);
        let mut versions = Vec::new();
        for (k, state) in saved.version_states.iter().enumerate() {
            let stage = self.checked_stage(&self.scene, *state as usize)?;
            let mut version = Version::new(Arc::new(self.open_geometry(stage)?), *state as usize, values);
            version.shot.copy_from_slice(&saved.version_shot[k * values..][..values]);
            version.weight.copy_from_slice(&saved.version_weight[k * patches..][..patches]);
            versions.push(version);
        }
        self.versions = versions;
        self.link();
        let channels = self.field.channels();
        let (elements, received) = (saved.elements.len() / channels, saved.patches.len() / channels);
        for (k, plane) in self.field.planes.iter_mut().enumerate() {
            plane.elements.copy_from_slice(&saved.elements[k * elements..][..elements]);
            plane.patches.copy_from_slice(&saved.patches[k * received..][..received]);
        }
        self.shot.clone_from(&saved.shot);
        self.lamps = saved.lamps.iter().map(|i| *i as usize).collect();
        self.redistribute_first = saved.redistribute_first;
        self.drains = saved.drains;
        self.brightest = saved.brightest;
        let [shots, redistributions, spared, rays, receivers] = saved.costs;
        self.costs = Costs { shots, redistributions, spared, rays, receivers, seconds: saved.seconds };
        self.refresh(None);
        Ok(())
    }

    /// Says of every old version what differs from the newest, and orders its patches.
    fn link(&mut self) {
        let (width, bands, last) = (self.field.width(), self.field.bands, self.versions.len() - 1);
        let newest: Arc<Geometry> = self.newest().geometry.clone();
        for version in &mut self.versions[..last] {
            version.change = Some(Change::between(&version.geometry, &newest, 0));
            let since = &self.scene.edits[version.state..self.state];
            let moved = since.iter().filter(|e| !matches!(e, Edit::Material { .. }));
            version.edits = moved.map(|e| describe(e, &self.stage.materials)).collect();
            version.enqueue(width, bands, |power| luminous(&self.weights, power));
        }
    }

    /// Refuses numbers that cannot have come about: power that is nowhere, or twice.
    fn check_sums(&self) -> Result<(), ShootingError> {
        let (width, bands) = (self.field.width(), self.field.bands);
        let limit = SOUND * self.brightest;
        let differs = |a: f64, b: f64| (a - b).abs() > limit;
        let given = |c: usize| self.shot.iter().skip(c).step_by(width).sum::<f64>();
        let shot = |k: usize| self.versions.iter().map(|v| v.shot[k]).sum::<f64>();
        let mut agree = (0..self.shot.len()).all(|k| !differs(shot(k), self.shot[k]));
        let mut kept = true;
        for (channel, plane) in self.field.planes.iter().enumerate() {
            let (mut arrived, mut all) = (vec![0.0; plane.patches.len()], vec![0.0; bands]);
            for (k, power) in plane.elements.chunks_exact(bands).enumerate() {
                all.iter_mut().zip(power).for_each(|(sum, p)| *sum += p);
                if let Some(e) = self.stage.elements.get(k) {
                    let at = e.patch as usize * bands;
                    arrived[at..at + bands].iter_mut().zip(power).for_each(|(sum, p)| *sum += p);
                }
            }
            agree &= arrived.iter().zip(&plane.patches).all(|(a, b)| !differs(*a, *b));
            kept &= (0..bands).all(|c| !differs(all[c], given(channel * bands + c)));
        }
        if !agree {
            return Err(ShootingError::Damaged("sums of power do not agree".into()));
        }
        if !kept {
            return Err(ShootingError::Damaged("what arrived is not what was shot".into()));
        }
        Ok(())
    }
}

/// Refuses what belongs to something else.
fn foreign(what: &'static str, same: bool) -> Result<(), ShootingError> {
    if same { Ok(()) } else { Err(ShootingError::Foreign(what)) }
}

impl Saved {
    fn check_states(&self, scene: &Scene) -> Result<(), ShootingError> {
        let damaged = |what: &str| Err(ShootingError::Damaged(what.into()));
        if self.state > scene.edits.len() as u64 {
            return Err(ShootingError::Foreign("a scene with more edits"));
        }
        let states = &self.version_states;
        let (Some(first), Some(last)) = (states.first(), states.last()) else { return damaged("no version") };
        if *first < self.opened || *last > self.state || states.windows(2).any(|w| w[0] >= w[1]) {
            return damaged("versions out of order");
        }
        Ok(())
    }

    fn check_sizes(&self, solver: &Shooting) -> Result<(), ShootingError> {
        let (values, patches, versions) = (solver.shot.len(), solver.stage.patch_count(), self.version_states.len());
        for (what, values, expected) in [
            ("elements", &self.elements, solver.field.planes.iter().map(|p| p.elements.len()).sum()),
            ("patches", &self.patches, values),
            ("shot", &self.shot, values),
            ("version_shot", &self.version_shot, versions * values),
            ("version_weight", &self.version_weight, versions * patches),
        ] {
            if values.len() != expected {
                let have = values.len();
                return Err(ShootingError::Damaged(format!("{what} has {have} values where {expected} are due")));
            }
            if values.iter().any(|x| !x.is_finite()) {
                return Err(ShootingError::Damaged(format!("{what} holds what is no number")));
            }
        }
        let sound = |x: f64| x.is_finite() && x >= 0.0;
        if !sound(self.brightest) || !sound(self.seconds) || self.lamps.iter().any(|i| *i >= patches as u64) {
            return Err(ShootingError::Damaged("lamps, brightness or seconds are out of range".into()));
        }
        Ok(())
    }
}
