//! Select, drag, release: a series of changes of one object folds into one removal and one addition [GSG90 fig. 5].
//!
//! Selecting removes the object. While it is dragged, what its places bring is kept apart, shown, and forgotten when
//! it is dragged on. Releasing makes the last place an edit, and what was shot towards it is kept.

use super::change::Change;
use super::field::Field;
use super::geometry::Geometry;
use super::importance;
use super::version::describe;
use super::{Shooting, ShootingError};
use crate::scene::{Edit, Scene, Stage};
use std::sync::Arc;

/// An object taken out of the scene.
pub(super) struct Preview {
    pub object: String,
    /// Where it is shown; `None` before the first drag.
    place: Option<Place>,
}

/// One place of it.
struct Place {
    /// The scene with the edits that bring it there.
    scene: Scene,
    /// How many those are.
    edits: usize,
    geometry: Arc<Geometry>,
    change: Change,
    weight: Vec<f64>,
    /// Patches whose shots it may alter.
    touched: Vec<bool>,
    /// What it adds to what has arrived.
    field: Field,
    /// Power of each patch that is in `field` already, per channel and band.
    shot: Vec<f64>,
    /// Patches of the object that emit and have not shot.
    lamps: Vec<usize>,
}

impl Preview {
    /// What the place adds.
    pub fn field(&self) -> Option<&Field> {
        self.place.as_ref().map(|p| &p.field)
    }

    /// The scene with the object where it is shown.
    pub fn stage(&self) -> Option<&Stage> {
        self.place.as_ref().map(|p| &*p.geometry.stage)
    }
}

impl Shooting {
    /// Takes an object out of the scene to drag it: an edit that removes it, redistributed like any other.
    ///
    /// # Errors
    /// As [`Shooting::apply`]: no such object, not there, another one selected.
    pub fn select(&mut self, object: &str) -> Result<(), ShootingError> {
        self.apply(Edit::Remove { object: object.into() })?;
        self.preview = Some(Preview { object: object.into(), place: None });
        Ok(())
    }

    /// Shows the selected object changed by some edits (moves, reshapings), counted from where it was selected. What the
    /// last place had brought is erased.
    ///
    /// # Errors
    /// Nothing selected; edits that the scene refuses (the object stays where it was shown last).
    pub fn drag(&mut self, edits: &[Edit]) -> Result<(), ShootingError> {
        let Some(preview) = &self.preview else { return Err(ShootingError::NothingSelected) };
        let begin = std::time::Instant::now();
        let mut scene = self.scene.clone();
        let add = Edit::Add { object: preview.object.clone() };
        scene.edits.splice(self.state..self.state, edits.iter().cloned().chain([add]));
        let edits = edits.len() + 1;
        let stage = self.checked_stage(&scene, self.state + edits)?;
        let geometry = Arc::new(self.open_geometry(stage)?);
        let change = Change::between(&self.newest().geometry, &geometry, self.params.ranking.samples());
        let estimate = importance::estimate([&self.newest().geometry, &geometry], &change);
        self.costs.rays += estimate.rays;
        let touched = (0..change.own.len()).map(|i| self.touches(&self.newest().geometry, &change, i)).collect();
        let stands = |i: &usize| change.came[*i] && geometry.stage.patches[*i].is_present();
        let shines = |i: &usize| stands(i) && geometry.stage.emission(*i).iter().any(|e| *e > 0.0);
        let place = Place {
            scene,
            edits,
            lamps: (0..change.own.len()).filter(shines).collect(),
            geometry,
            change,
            weight: estimate.share,
            touched,
            field: Field::dark(&self.stage, self.field.channels()),
            shot: vec![0.0; self.shot.len()],
        };
        if let Some(preview) = &mut self.preview {
            preview.place = Some(place);
        }
        self.costs.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// Puts the object down where it is shown; where it was not dragged, where it was. What was shot towards it is kept.
    ///
    /// # Errors
    /// Nothing selected.
    pub fn release(&mut self) -> Result<(), ShootingError> {
        let Some(Preview { object, place }) = self.preview.take() else { return Err(ShootingError::NothingSelected) };
        let Some(place) = place else {
            let done = self.apply(Edit::Add { object: object.clone() });
            if done.is_err() {
                self.preview = Some(Preview { object, place });
            }
            return done;
        };
        let begin = std::time::Instant::now();
        let state = self.state + place.edits;
        let edits = &place.scene.edits[self.state..state];
        let words: Vec<String> = edits.iter().map(|e| describe(e, &self.stage.materials)).collect();
        // What is taken over leaves the version it was shot in before that becomes an entry of the log.
        let last = self.versions.len() - 1;
        let own = &place.change.own;
        let (stage, width) = (&place.geometry.stage, self.field.width());
        for (at, q) in place.shot.iter().enumerate() {
            let i = at / width;
            if self.stage.patches[i].is_present() {
                self.versions[last].shot[at] -= q;
                if !stage.patches[i].is_present() && own[i] {
                    self.shot[at] -= q;
                }
            } else {
                self.shot[at] += q;
            }
        }
        self.field.join(&place.field);
        self.scene = place.scene.clone();
        self.own_edits += place.edits;
        self.rebuild(place.geometry.clone(), state, &words);
        self.state = state;
        let last = self.versions.len() - 1;
        for (at, q) in place.shot.iter().enumerate() {
            if self.stage.patches[at / width].is_present() {
                self.versions[last].shot[at] += q;
            }
        }
        self.costs.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// The patch with most to shoot towards the place the object is shown at: its lamps first. `all` includes those for
    /// which the estimate says nothing, as they do not see the sample points: they go last.
    pub(super) fn next_preview(&self, all: bool) -> Option<usize> {
        let place = self.preview.as_ref()?.place.as_ref()?;
        if let Some(lamp) = place.lamps.last() {
            return Some(*lamp);
        }
        let rank = |best: Option<([f64; 2], usize)>, i: usize| {
            let pending = self.pending(place, i);
            let key = [place.weight[i] * pending, pending];
            let counts = key[0] > 0.0 || all && pending > 0.0;
            if counts && best.is_none_or(|(k, _)| key > k) { Some((key, i)) } else { best }
        };
        (0..self.stage.patch_count()).fold(None, rank).map(|(_, i)| i)
    }

    /// Luminous power of patch i that the place does not have yet, W.
    fn pending(&self, place: &Place, i: usize) -> f64 {
        if !place.touched[i] || !self.stage.patches[i].is_present() {
            return 0.0;
        }
        let (base, at) = (&self.newest().shot, i * self.field.width());
        self.weights.iter().enumerate().map(|(c, w)| w * (base[at + c] - place.shot[at + c]).abs()).sum()
    }

    /// Shoots all that patch i has for the place.
    pub(super) fn shoot_preview(&mut self, i: usize) -> usize {
        let Some(mut preview) = self.preview.take() else { return 0 };
        let Some(place) = &mut preview.place else { return 0 };
        let width = self.field.width();
        let base = self.newest().geometry.clone();
        let held = i * width..(i + 1) * width;
        let row;
        let power: Vec<f64>;
        if place.lamps.pop_if(|lamp| *lamp == i).is_some() {
            let (area, emission) = (place.geometry.stage.patches[i].area, place.geometry.stage.emission(i));
            power = (0..width).map(|c| area * emission[c % emission.len()]).collect();
            row = self.whole(&place.geometry, i);
            place.shot[held].copy_from_slice(&power);
        } else {
            power = held.clone().map(|at| self.newest().shot[at] - place.shot[at]).collect();
            row = self.row_between([&base, &place.geometry], Some(&place.change), i);
            // Not a sum: what rounding leaves would be shot once more.
            place.shot[held.clone()].copy_from_slice(&self.newest().shot[held]);
        }
        place.field.add(&row, &power);
        self.preview = Some(preview);
        self.costs.redistributions += 1;
        self.account(&row, i);
        row.sinks.len()
    }
}
