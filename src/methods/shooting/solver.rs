//! The solver: what has been shot where, and the steps that change it.

use super::change::Change;
use super::counter::Counter;
use super::energy::Energy;
use super::fan::{EXCESS_SINK, Fans, back_sink, escaped_sink, sinks};
use super::field::Field;
use super::geometry::Geometry;
use super::importance;
use super::preview::Preview;
use super::row::Row;
use super::shadow::Directions;
use super::version::{LogEntry, Version, describe};
use super::{Factors, Params, Ranking, ShootingError};
use crate::estimate::{Plan, is_closed};
use crate::math::compensated_sum;
use crate::methods::PatchVectors;
use crate::methods::hemicube::{DeltaTable, Hemicube, stand};
use crate::raycast::{BuiltinKernel, KernelInfo, KernelKind, RayKernel};
use crate::scene::{Edit, Scene, Stage};
use crate::solution::Radiosity;
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

/// Where rows come from.
enum Caster {
    Rays(Box<(Fans, Counter)>),
    Hemicube(Box<DeltaTable>, super::super::hemicube::Params),
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
    kernel: KernelKind,
    enclosure: bool,
    pub(super) params: Params,
    caster: Caster,
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
        self.params = Params { factors: self.params.factors, ..params };
    }

    /// The ray kernel in use.
    pub fn kernel(&self) -> &KernelInfo {
        self.newest().geometry.tracer.kernel()
    }

    pub(super) fn newest(&self) -> &Version {
        &self.versions[self.versions.len() - 1]
    }

    /// Applies the next edit of the scene itself.
    ///
    /// # Errors
    /// [`ShootingError::NoMoreEdits`]; else as [`Shooting::apply`].
    pub fn apply_next(&mut self) -> Result<(), ShootingError> {
        self.nothing_selected()?;
        if self.state == self.scene.edits.len() {
            return Err(ShootingError::NoMoreEdits(self.state));
        }
        self.advance(self.state + 1)
    }

    /// Applies an edit now, before those of the scene that are still to come. What the last edit has left to be
    /// redistributed stays in the log. After an error everything is as before.
    ///
    /// # Errors
    /// An edit that the scene refuses; one that brings patches with new numbers; a selected object.
    pub fn apply(&mut self, edit: Edit) -> Result<(), ShootingError> {
        self.nothing_selected()?;
        self.scene.edits.insert(self.state, edit);
        let done = self.advance(self.state + 1);
        match done {
            Ok(()) => self.own_edits += 1,
            Err(_) => _ = self.scene.edits.remove(self.state),
        }
        done
    }

    pub(super) fn nothing_selected(&self) -> Result<(), ShootingError> {
        self.preview.as_ref().map_or(Ok(()), |p| Err(ShootingError::Selected(p.object.clone())))
    }

    /// Goes on to a later state of the scene.
    fn advance(&mut self, state: usize) -> Result<(), ShootingError> {
        let stage = self.checked_stage(&self.scene, state)?;
        let edits = &self.scene.edits[self.state..state];
        let words: Vec<String> = edits.iter().map(|e| describe(e, &stage.materials)).collect();
        if edits.iter().all(|e| matches!(e, Edit::Material { .. })) {
            self.repaint(stage);
        } else {
            let geometry = Arc::new(Geometry::open(stage, self.kernel, self.enclosure)?);
            let begin = std::time::Instant::now();
            self.rebuild(geometry, state, &words);
            self.costs.seconds += begin.elapsed().as_secs_f64();
        }
        self.state = state;
        Ok(())
    }

    pub(super) fn checked_stage(&self, scene: &Scene, state: usize) -> Result<Stage, ShootingError> {
        let stage = scene.at(state)?;
        let (got, expected) = (stage.patch_count(), self.stage.patch_count());
        if got != expected || stage.elements.len() != self.stage.elements.len() {
            return Err(ShootingError::NewNumbers { got, expected });
        }
        Ok(stage)
    }

    pub(super) fn open_geometry(&self, stage: Stage) -> Result<Geometry, ShootingError> {
        Geometry::open(stage, self.kernel, self.enclosure)
    }

    /// Reflectances and emissions change; what has arrived stays.
    fn repaint(&mut self, stage: Stage) {
        let before = std::mem::replace(&mut self.vectors, PatchVectors::of(&stage));
        self.stage = Arc::new(stage);
        let bands = before.bands;
        let emission = |v: &PatchVectors, i: usize| v.emission[i * bands..(i + 1) * bands].to_vec();
        let lit = (0..self.stage.patch_count()).map(|i| emission(&before, i) != emission(&self.vectors, i)).collect();
        self.lamps_first(lit);
        self.refresh(None);
    }

    /// Lamps among these patches shoot first, beside those that are still waiting.
    fn lamps_first(&mut self, mut patches: Vec<bool>) {
        self.lamps.iter().for_each(|i| patches[*i] = true);
        self.lamps = (0..patches.len()).filter(|i| patches[*i] && self.is_lamp(*i)).collect();
    }

    pub(super) fn is_lamp(&self, i: usize) -> bool {
        self.stage.patches[i].is_present() && self.stage.emission(i).iter().any(|e| *e > 0.0)
    }

    /// Another geometry stands: the newest version becomes an entry of the log.
    pub(super) fn rebuild(&mut self, geometry: Arc<Geometry>, state: usize, words: &[String]) {
        self.stage = geometry.stage.clone();
        self.vectors = PatchVectors::of(&self.stage);
        let version = Version::new(geometry, state, self.shot.len());
        let newest = version.geometry.clone();
        let ended = self.newest().geometry.clone();
        let step = Change::between(&ended, &newest, self.params.ranking.samples());
        let estimate = importance::estimate([&ended, &newest], &step);
        self.costs.rays += estimate.rays;
        for old in &mut self.versions {
            old.edits.extend(words.iter().cloned());
            old.change = Some(Change::between(&old.geometry, &newest, 0));
            old.weight.iter_mut().zip(&estimate.share).for_each(|(w, s)| *w = (*w + s).min(1.0));
        }
        self.versions.push(version);
        self.spare();
        if self.params.ranking == Ranking::Exact {
            self.rank_exactly();
        }
        self.lamps_first(step.came);
        self.redistribute_first = true;
        let (width, bands) = (self.field.width(), self.field.bands);
        let last = self.versions.len() - 1;
        for version in &mut self.versions[..last] {
            version.enqueue(width, bands, |power| luminous(&self.weights, power));
        }
        self.refresh(None);
    }

    /// Brings over at once the power of patches whose rays the changes do not touch, and forgets empty versions.
    fn spare(&mut self) {
        let width = self.field.width();
        let last = self.versions.len() - 1;
        for v in 0..last {
            let (old, newest) = self.versions.split_at_mut(last);
            let (old, newest) = (&mut old[v], &mut newest[0]);
            let Some(change) = &old.change else { continue };
            for i in 0..change.own.len() {
                if !old.holds(i, width) || touches(&self.caster, &old.geometry, change, i) {
                    continue;
                }
                for c in i * width..(i + 1) * width {
                    newest.shot[c] += std::mem::take(&mut old.shot[c]);
                }
                self.costs.spared += 1;
            }
        }
        self.forget_empty();
    }

    fn forget_empty(&mut self) {
        let last = self.versions.len() - 1;
        let mut number = 0;
        self.versions.retain(|v| {
            number += 1;
            number > last || v.shot.iter().any(|q| *q != 0.0)
        });
    }

    /// Traces what every patch would divert.
    fn rank_exactly(&mut self) {
        for v in 0..self.versions.len() - 1 {
            for i in 0..self.stage.patch_count() {
                if self.versions[v].holds(i, self.field.width()) {
                    self.versions[v].weight[i] = self.difference(v, i).moved();
                }
            }
        }
    }

    /// All form factors of a patch in a version.
    pub(super) fn whole(&mut self, g: &Geometry, patch: usize) -> Row {
        match &mut self.caster {
            Caster::Rays(rays) => {
                let (fans, counter) = &mut **rays;
                self.costs.rays += fans.whole(g, patch, 1, counter);
                counter.take(fans.rays(patch))
            }
            Caster::Hemicube(table, params) => hemicube_row(g, patch, table, params),
        }
    }

    /// Form factors in the newest version less those in an old one.
    fn difference(&mut self, version: usize, patch: usize) -> Row {
        let (old, new) = (self.versions[version].geometry.clone(), self.newest().geometry.clone());
        let change = self.versions[version].change.take();
        let row = self.row_between([&old, &new], change.as_ref(), patch);
        self.versions[version].change = change;
        row
    }

    pub(super) fn row_between(&mut self, [old, new]: [&Geometry; 2], change: Option<&Change>, patch: usize) -> Row {
        match (&mut self.caster, change) {
            (Caster::Rays(rays), Some(change)) => {
                let (fans, counter) = &mut **rays;
                self.costs.rays += if change.own[patch] {
                    fans.whole(old, patch, -1, counter) + fans.whole(new, patch, 1, counter)
                } else {
                    fans.diverted([old, new], change, patch, counter)
                };
                counter.take(fans.rays(patch))
            }
            (Caster::Hemicube(table, params), Some(_)) => {
                let (before, after) =
                    (hemicube_row(old, patch, table, params), hemicube_row(new, patch, table, params));
                less(&after, &before)
            }
            (_, None) => Row::default(),
        }
    }

    /// Shoots all that patch i has unshot.
    pub(super) fn propagate(&mut self, i: usize) -> usize {
        let g = self.newest().geometry.clone();
        let row = self.whole(&g, i);
        let power = self.unshot_of(i);
        self.field.add(&row, &power);
        let (width, last) = (self.field.width(), self.versions.len() - 1);
        for (c, p) in power.iter().enumerate() {
            self.shot[i * width + c] += p;
            self.versions[last].shot[i * width + c] += p;
        }
        self.account(&row, i);
        row.sinks.len()
    }

    /// Books a shot of patch i.
    pub(super) fn account(&mut self, row: &Row, i: usize) {
        self.costs.shots += 1;
        self.costs.receivers += row.sinks.len() as u64;
        self.refresh(Some(row));
        self.refresh_one(i);
    }

    /// Redistributes what patch i has shot in an old version [GSG90 fig. 2].
    pub(super) fn redistribute(&mut self, version: usize, i: usize) -> usize {
        let row = self.difference(version, i);
        let (width, last) = (self.field.width(), self.versions.len() - 1);
        let range = i * width..(i + 1) * width;
        let power: Vec<f64> = self.versions[version].shot[range.clone()].to_vec();
        self.field.add(&row, &power);
        self.versions[version].shot[range.clone()].fill(0.0);
        let stands = self.stage.patches[i].is_present();
        for (at, p) in range.zip(&power) {
            if stands {
                self.versions[last].shot[at] += p;
            } else {
                // What is not there has shot nothing.
                self.shot[at] -= p;
            }
        }
        let queue = &mut self.versions[version].queue;
        if queue.pop_if(|(_, patch)| *patch as usize == i).is_none() {
            queue.retain(|(_, patch)| *patch as usize != i);
        }
        self.costs.redistributions += 1;
        self.account(&row, i);
        row.sinks.len()
    }

    /// Power that patch i has to shoot, per channel and band, W; nothing for what is not there.
    pub(super) fn unshot_of(&self, i: usize) -> Vec<f64> {
        let width = self.field.width();
        (0..width).map(|c| self.unshot_at(i, c)).collect()
    }

    #[inline]
    pub(super) fn unshot_at(&self, i: usize, channel: usize) -> f64 {
        let area = self.stage.patches[i].area;
        if area == 0.0 {
            return 0.0;
        }
        let bands = self.vectors.bands;
        let at = i * self.field.width() + channel;
        let c = i * bands + channel % bands;
        area * self.vectors.emission[c] + self.vectors.reflectance[c] * self.field.patches[at] - self.shot[at]
    }

    /// Radiosities per patch, W/m^2, as far as they are known, with the standard errors of the rays (none with
    /// hemi-cubes, which have no noise). Includes what a drag shows.
    pub fn radiosity(&self) -> Radiosity {
        let stage = self.seen_stage();
        let area = |i: usize| stage.patches[i].area;
        let preview = self.preview.as_ref().and_then(Preview::field).map(|f| f.patches.as_slice());
        self.radiosities(stage, stage.patch_count(), &self.field.patches, preview, |i| i, area)
    }

    /// Radiosities per element, W/m^2.
    pub fn element_radiosity(&self) -> Radiosity {
        let stage = self.seen_stage();
        let preview = self.preview.as_ref().and_then(Preview::field).map(|f| f.elements.as_slice());
        let (patch, area) = (|e: usize| stage.elements[e].patch as usize, |e: usize| stage.elements[e].area);
        self.radiosities(stage, stage.elements.len(), &self.field.elements, preview, patch, area)
    }

    fn seen_stage(&self) -> &Stage {
        self.preview.as_ref().and_then(Preview::stage).unwrap_or(&self.stage)
    }

    fn radiosities(
        &self,
        stage: &Stage,
        count: usize,
        power: &[f64],
        preview: Option<&[f64]>,
        patch: impl Fn(usize) -> usize,
        area: impl Fn(usize) -> f64,
    ) -> Radiosity {
        let (bands, width, channels) = (self.field.bands, self.field.width(), self.field.channels);
        let mut values = vec![0.0; count * bands];
        let mut std_err = (channels > 1).then(|| vec![0.0; count * bands]);
        let ambient = if self.params.ambient { self.ambient() } else { vec![0.0; bands] };
        for k in (0..count).filter(|k| area(*k) > 0.0) {
            let (emission, reflectance) = (stage.emission(patch(k)), stage.reflectance(patch(k)));
            for c in 0..bands {
                let received = |channel: usize| {
                    let at = k * width + channel * bands + c;
                    (power[at] + preview.map_or(0.0, |p| p[at])) / area(k)
                };
                values[k * bands + c] = emission[c] + reflectance[c] * (received(0) + ambient[c]);
                if let Some(std_err) = &mut std_err {
                    std_err[k * bands + c] = reflectance[c] * std_err_of_mean((1..channels).map(received));
                }
            }
        }
        Radiosity { bands, values, std_err }
    }

    /// What each patch has still to shoot, as radiosity, W/m^2: `B - U` is what it has shot.
    pub fn unshot(&self) -> Radiosity {
        let bands = self.field.bands;
        let of = |i: usize| {
            let area = self.stage.patches[i].area;
            (0..bands).map(move |c| if area > 0.0 { self.unshot_at(i, c) / area } else { 0.0 })
        };
        let values = (0..self.stage.patch_count()).flat_map(of).collect();
        Radiosity { bands, values, std_err: None }
    }

    /// Where all power is now.
    pub fn energy(&self) -> Energy {
        let (bands, width) = (self.field.bands, self.field.width());
        let patches = &self.stage.patches;
        let over = |present: bool, f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let chosen = |i: &usize| patches[*i].is_present() == present;
            (0..bands).map(|c| compensated_sum((0..patches.len()).filter(chosen).map(|i| f(i, c)))).collect()
        };
        let (e, rho) = (&self.vectors.emission, &self.vectors.reflectance);
        let arrived = |i: usize, c: usize| self.field.patches[i * width + c];
        let at = |sink: usize| (0..bands).map(|c| self.field.at(sink, c)).collect::<Vec<f64>>();
        Energy {
            emitted: over(true, &|i, c| patches[i].area * e[i * bands + c]),
            absorbed: over(true, &|i, c| (1.0 - rho[i * bands + c]) * arrived(i, c)),
            unshot: over(true, &|i, c| self.unshot_at(i, c)),
            escaped: at(escaped_sink(&self.stage)),
            backs: at(back_sink(&self.stage)),
            excess: at(self.stage.elements.len() + EXCESS_SINK).iter().map(|x| -x).collect(),
            left_behind: over(false, &|i, c| arrived(i, c) - self.shot[i * width + c]),
            brightest: self.brightest,
        }
    }

    /// What has not been redistributed, version by version, oldest first; empty if the log is drained.
    pub fn log(&self) -> Vec<LogEntry> {
        let (bands, width) = (self.field.bands, self.field.width());
        let entry = |v: &Version| {
            let holding = (0..self.stage.patch_count()).filter(|i| v.holds(*i, width));
            let patches: Vec<(usize, Vec<f64>)> = holding.map(|i| (i, v.shot[i * width..][..bands].to_vec())).collect();
            let amount = |i: usize| v.weight[i] * self.luminous(&v.shot[i * width..][..bands]);
            let largest = patches.iter().map(|(i, _)| (*i, amount(*i))).max_by(|a, b| a.1.total_cmp(&b.1));
            LogEntry { state: v.state, edits: v.edits.clone(), patches, largest }
        };
        self.versions[..self.versions.len() - 1].iter().map(entry).collect()
    }

    /// True if a change may alter what patch i shoots.
    pub(super) fn touches(&self, old: &Geometry, change: &Change, i: usize) -> bool {
        touches(&self.caster, old, change, i)
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

/// True if a change may alter what patch i shoots.
fn touches(caster: &Caster, old: &Geometry, change: &Change, i: usize) -> bool {
    change.own[i]
        || match caster {
            Caster::Rays(rays) => rays.0.may_divert(old, change, i),
            // A hemi-cube's row has no rays to be chosen from: it is made anew unless all lies behind.
            Caster::Hemicube(..) => is_before(old, change, i),
        }
}

pub(super) fn luminous(weights: &[f64], power: &[f64]) -> f64 {
    power.iter().zip(weights).map(|(p, w)| w.abs() * p.abs()).sum()
}

/// True if some of what has changed lies before a patch.
fn is_before(g: &Geometry, change: &Change, i: usize) -> bool {
    g.emitters[i].as_ref().is_some_and(|e| {
        let corners = &g.stage.patches[i].corners;
        change.outlines.iter().flatten().any(|o| Directions::towards(o, corners, &e.frame).is_some())
    })
}

/// `sqrt(sum (x_r - mean)^2 / (R (R - 1)))`.
fn std_err_of_mean(replicates: impl Iterator<Item = f64> + Clone) -> f64 {
    let r = replicates.clone().count() as f64;
    let mean = replicates.clone().sum::<f64>() / r;
    (replicates.map(|x| (x - mean).powi(2)).sum::<f64>() / (r * (r - 1.0))).sqrt()
}

fn hemicube_row(g: &Geometry, patch: usize, table: &DeltaTable, params: &super::super::hemicube::Params) -> Row {
    let mut row = Row::default();
    let Some((eye, frame)) = stand(&g.stage.patches[patch], params) else { return row };
    let (entries, lost) = Hemicube::new(g.world(), table).row(eye, &frame);
    entries.iter().for_each(|(e, f)| row.push_exact(*e, *f));
    let lost = [
        (escaped_sink(&g.stage), lost.nothing),
        (back_sink(&g.stage), lost.backs),
        (g.stage.elements.len() + EXCESS_SINK, 1.0 - table.total()),
    ];
    lost.iter().filter(|(_, f)| *f != 0.0).for_each(|(sink, f)| row.push_exact(*sink as u32, *f));
    row
}

/// The difference of two rows; equal entries leave nothing.
fn less(after: &Row, before: &Row) -> Row {
    let mut entries: std::collections::BTreeMap<usize, f64> = after.iter().map(|e| (e.sink, e.mean)).collect();
    before.iter().for_each(|e| *entries.entry(e.sink).or_default() -= e.mean);
    let mut row = Row::default();
    entries.into_iter().filter(|(_, f)| *f != 0.0).for_each(|(s, f)| row.push_exact(s as u32, f));
    row
}
