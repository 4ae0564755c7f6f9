//! Edits: the newest version of the geometry becomes an entry of the log.

use super::cast::Caster;
use super::change::Change;
use super::geometry::Geometry;
use super::importance;
use super::shadow::Directions;
use super::solver::luminous;
use super::version::{Version, describe};
use super::{Ranking, Shooting, ShootingError};
use crate::methods::PatchVectors;
use crate::scene::{Edit, Scene, Stage};
use std::sync::Arc;

impl Shooting {
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
        (self.redistribute_first, self.drains) = (true, false);
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

    /// True if a change may alter what patch i shoots.
    pub(super) fn touches(&self, old: &Geometry, change: &Change, i: usize) -> bool {
        touches(&self.caster, old, change, i)
    }
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

/// True if some of what has changed lies before a patch.
fn is_before(g: &Geometry, change: &Change, i: usize) -> bool {
    g.emitters[i].as_ref().is_some_and(|e| {
        let corners = &g.stage.patches[i].corners;
        change.outlines.iter().flatten().any(|o| Directions::towards(o, corners, &e.frame).is_some())
    })
}
