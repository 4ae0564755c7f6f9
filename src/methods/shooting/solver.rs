//! The solver: what has been shot where.

use super::cast::Caster;
use super::counter::Counter;
use super::fan::{Fans, sinks};
use super::field::Field;
use super::geometry::Geometry;
use super::preview::Preview;
use super::version::Version;
use super::{Factors, Params, ShootingError};
use crate::estimate::{Plan, is_closed};
use crate::methods::PatchVectors;
use crate::methods::hemicube::DeltaTable;
use crate::raycast::{BuiltinKernel, KernelInfo, KernelKind, RayKernel};
use crate::scene::{Edit, Scene, Stage};
use std::sync::Arc;

/// What a solver has spent. Only `seconds` differs between equal runs.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Costs {
    /// Shots of both kinds.
    pub shots: u64,
    /// Those that redistributed.
    pub redistributions: u64,
    /// Patches whose power needed no redistribution: the shadow volume holds none of their rays.
    pub spared: u64,
    /// Rays traced, those of estimates included; pixels of hemi-cubes are not rays.
    pub rays: u64,
    /// Receivers that shots changed, added up.
    pub receivers: u64,
    /// Seconds of computing: of shots, and of finding out what an edit touches. Callbacks are left out, and the laying
    /// out of scenes and the opening of kernels, which every method needs.
    pub seconds: f64,
}

/// Progressive refinement of a scene that may be edited at any time. See the module for the equations.
pub struct Shooting {
    pub(super) scene: Scene,
    pub(super) state: usize,
    /// State in which it was opened.
    pub(super) opened: usize,
    /// Edits made that the scene did not have.
    pub(super) own_edits: usize,
    pub(super) seed: u64,
    pub(super) kernel: KernelKind,
    pub(super) enclosure: bool,
    pub(super) params: Params,
    pub(super) caster: Caster,
    /// Oldest first; the last is what stands now.
    pub(super) versions: Vec<Version>,
    /// What stands now with its present materials.
    pub(super) stage: Arc<Stage>,
    pub(super) vectors: PatchVectors,
    pub(super) field: Field,
    /// Power that each patch has shot in all versions together, per channel and band.
    pub(super) shot: Vec<f64>,
    /// Patches that came with an emission of their own: they shoot first.
    pub(super) lamps: Vec<usize>,
    /// Strategy one: redistribution goes first until it falls below the threshold.
    pub(super) redistribute_first: bool,
    /// The rest of the log goes before anything else.
    pub(super) drains: bool,
    pub(super) preview: Option<Preview>,
    /// What counts as luminous for the order of shots and their end, per band.
    pub(super) weights: Vec<f64>,
    /// Luminous power each patch has unshot, W; signs left out.
    pub(super) unshot: Vec<f64>,
    /// Luminous power emitted, W.
    pub(super) emitted: f64,
    /// The most that was ever emitted, W.
    pub(super) brightest: f64,
    pub(super) costs: Costs,
}

impl Shooting {
    /// A solver on a state of a scene; nothing is shot yet. Later edits of the scene wait for [`Shooting::apply_next`].
    ///
    /// # Errors
    /// A state that cannot be laid out, point lights, a kernel that is not there, settings of a hemi-cube.
    pub fn open(
        scene: &Scene,
        state: usize,
        params: Params,
        kernel: KernelKind,
        seed: u64,
    ) -> Result<Self, ShootingError> {
        if !scene.lights.is_empty() {
            return Err(ShootingError::PointLights(scene.lights.len()));
        }
        Self::begin(scene.clone(), state, scene.at(state)?, params, kernel, seed)
    }

    /// A solver on a stage that comes without its scene: nothing in it can be edited.
    ///
    /// # Errors
    /// As [`Shooting::open`].
    pub fn on(stage: Stage, params: Params, kernel: KernelKind, seed: u64) -> Result<Self, ShootingError> {
        if !stage.lights.is_empty() {
            return Err(ShootingError::PointLights(stage.lights.len()));
        }
        let scene = Scene {
            name: stage.name.clone(),
            photometry: stage.photometry.clone(),
            enclosure: stage.enclosure,
            materials: stage.materials.clone(),
            surfaces: Vec::new(),
            absent: Vec::new(),
            edits: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            receivers: Vec::new(),
            notices: Vec::new(),
        };
        Self::begin(scene, 0, stage, params, kernel, seed)
    }

    fn begin(
        scene: Scene,
        state: usize,
        stage: Stage,
        params: Params,
        kernel: KernelKind,
        seed: u64,
    ) -> Result<Self, ShootingError> {
        let enclosure = stage.enclosure.unwrap_or_else(|| {
            let exact: Arc<dyn RayKernel> = Arc::new(BuiltinKernel::new(&stage));
            is_closed(&stage, &exact)
        });
        let geometry = Arc::new(Geometry::open(stage, kernel, enclosure)?);
        let stage = geometry.stage.clone();
        let (caster, channels) = match params.factors {
            Factors::Rays { randomisations, .. } if randomisations < 2 => {
                return Err(ShootingError::Setting {
                    method: "redistribution",
                    text: format!("randomisations={randomisations}"),
                    settings: "randomisations=R with R of 2 and more: their spread is the standard error".into(),
                });
            }
            Factors::Rays { rays, randomisations } => {
                let each = Plan { rays, randomisations, ..Plan::default() }.rays_per_randomisation();
                let counter = Counter::new(sinks(&stage), randomisations);
                let fans = Fans::new(each, randomisations, seed, params.lamps, lamps(&scene, &stage));
                (Caster::Rays(Box::new((fans, counter))), usize::from(randomisations) + 1)
            }
            Factors::Hemicube(p) => {
                let p = p.validated()?;
                (Caster::Hemicube(Box::new(DeltaTable::new(p.resolution, p.delta)), p), 1)
            }
        };
        let field = Field::dark(&stage, channels);
        let values = stage.patch_count() * field.width();
        let mut solver = Self {
            scene,
            state,
            opened: state,
            own_edits: 0,
            seed,
            kernel,
            enclosure,
            params,
            caster,
            versions: vec![Version::new(geometry, state, values)],
            vectors: PatchVectors::of(&stage),
            weights: weights(&stage.photometry.weights),
            stage,
            field,
            shot: vec![0.0; values],
            lamps: Vec::new(),
            redistribute_first: false,
            drains: false,
            preview: None,
            unshot: Vec::new(),
            emitted: 0.0,
            brightest: 0.0,
            costs: Costs::default(),
        };
        solver.refresh(None);
        Ok(solver)
    }

    /// The scene as it stands now.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// Number of edits applied.
    pub fn state(&self) -> usize {
        self.state
    }

    /// What has been spent.
    pub fn costs(&self) -> Costs {
        self.costs
    }

    /// The settings.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Other settings of what is shot next and when to stop; form factors stay as they are.
    pub fn set_params(&mut self, params: Params) {
        self.params = Params { factors: self.params.factors, lamps: self.params.lamps, ..params };
    }

    /// The ray kernel in use.
    pub fn kernel(&self) -> &KernelInfo {
        self.newest().geometry.tracer.kernel()
    }

    pub(super) fn newest(&self) -> &Version {
        &self.versions[self.versions.len() - 1]
    }

    /// Sum of the bands' magnitudes by their luminance weights.
    pub(super) fn luminous(&self, power: &[f64]) -> f64 {
        luminous(&self.weights, power)
    }
}

/// Patches that emit in some state of the scene.
fn lamps(scene: &Scene, stage: &Stage) -> Vec<bool> {
    let mut shines: Vec<bool> = stage.materials.iter().map(|m| m.emission.iter().any(|e| *e > 0.0)).collect();
    for edit in &scene.edits {
        if let Edit::Material { material, emission: Some(e), .. } = edit {
            shines[*material as usize] |= e.iter().any(|e| *e > 0.0);
        }
    }
    stage.patches.iter().map(|p| shines[p.material as usize]).collect()
}

/// Luminance weights, those of bands that hardly count raised to a twentieth of the largest: no band is to be left
/// unshot because it is not seen (X and Z of the XYZ primaries have weight 0).
fn weights(luminance: &[f64]) -> Vec<f64> {
    let largest = luminance.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    luminance.iter().map(|w| w.abs().max(0.05 * largest)).collect()
}

pub(super) fn luminous(weights: &[f64], power: &[f64]) -> f64 {
    power.iter().zip(weights).map(|(p, w)| w.abs() * p.abs()).sum()
}
