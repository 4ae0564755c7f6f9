//! Edits applied: which faces stand where in a state.

use super::{Edit, Material, Scene, SceneError, Surface};
use crate::math::{DVec3, area};
use std::collections::{BTreeMap, BTreeSet};

/// The scene after some edits, not yet divided.
pub(super) struct Standing {
    pub materials: Vec<Material>,
    /// Per surface: true if it stands there.
    pub stands: Vec<bool>,
    /// Per surface and face: corners.
    pub corners: Vec<Vec<Vec<DVec3>>>,
    /// Per surface: true if it belongs to its object now (others wait for a `replace`, or have been replaced).
    live: Vec<bool>,
    /// Whether each object is there.
    there: BTreeMap<String, bool>,
}

impl Standing {
    /// The scene before the first edit.
    fn initial(scene: &Scene) -> Result<Self, SceneError> {
        let live: Vec<bool> = (0..scene.surfaces.len()).map(|i| !scene.is_replacement(i)).collect();
        let mut now = Self {
            materials: scene.materials.clone(),
            stands: live.clone(),
            corners: scene.surfaces.iter().map(|s| s.faces.iter().map(|f| f.vertices.clone()).collect()).collect(),
            live,
            there: scene.surfaces.iter().map(|s| (s.object.clone(), true)).collect(),
        };
        for object in &scene.absent {
            *now.object(0, object)? = false;
        }
        Ok(now)
    }

    /// The scene after the first `state` edits.
    pub(super) fn after(scene: &Scene, state: usize) -> Result<Self, SceneError> {
        let last = scene.edits.len();
        if state > last {
            return Err(SceneError::NoSuchState { asked: state.to_string(), last });
        }
        let mut now = Self::initial(scene)?;
        for (at, edit) in scene.edits[..state].iter().enumerate() {
            now.apply(scene, at + 1, edit)?;
        }
        now.stands = scene.surfaces.iter().zip(&now.live).map(|(s, live)| *live && now.there[&s.object]).collect();
        match now.stands.contains(&true) {
            true => Ok(now),
            false => Err(SceneError::Empty { state }),
        }
    }

    fn object(&mut self, edit: usize, object: &str) -> Result<&mut bool, SceneError> {
        let known = || self.there.keys().cloned().collect::<Vec<_>>().join(", ");
        if !self.there.contains_key(object) {
            return Err(SceneError::UnknownObject { edit, object: object.into(), known: known() });
        }
        Ok(self.there.entry(object.into()).or_default())
    }

    fn apply(&mut self, scene: &Scene, at: usize, edit: &Edit) -> Result<(), SceneError> {
        match edit {
            Edit::Add { object } => match std::mem::replace(self.object(at, object)?, true) {
                true => Err(SceneError::AlreadyThere { edit: at, object: object.clone() }),
                false => Ok(()),
            },
            Edit::Remove { object } => match std::mem::replace(self.object(at, object)?, false) {
                false => Err(SceneError::NotThere { edit: at, object: object.clone() }),
                true => Ok(()),
            },
            Edit::Move { object, transform } => self.map(&scene.surfaces, at, object, |p| transform.apply(p)),
            Edit::Reshape { object, scale, about } => {
                self.map(&scene.surfaces, at, object, |p| *about + (p - *about) * *scale)
            }
            Edit::Replace { object, by, .. } => {
                self.object(at, object)?;
                for (live, surface) in self.live.iter_mut().zip(&scene.surfaces) {
                    *live &= surface.object != *object;
                }
                self.live[*by] = true;
                Ok(())
            }
            Edit::Material { material, reflectance, emission } => {
                let m = &mut self.materials[*material as usize];
                m.reflectance.clone_from(reflectance.as_ref().unwrap_or(&m.reflectance.clone()));
                m.emission.clone_from(emission.as_ref().unwrap_or(&m.emission.clone()));
                Ok(())
            }
        }
    }

    /// Maps every corner of an object's faces, whether it is there or not.
    fn map(
        &mut self,
        surfaces: &[Surface],
        edit: usize,
        object: &str,
        to: impl Fn(DVec3) -> DVec3,
    ) -> Result<(), SceneError> {
        self.object(edit, object)?;
        for (index, surface) in surfaces.iter().enumerate() {
            if surface.object != object || !self.live[index] {
                continue;
            }
            for corners in &mut self.corners[index] {
                corners.iter_mut().for_each(|p| *p = to(*p));
                let sound = corners.iter().all(|p| p.is_finite()) && area(corners) > 0.0;
                if !sound {
                    return Err(SceneError::Collapsed { edit, surface: surface.name.clone() });
                }
            }
        }
        Ok(())
    }
}

impl Scene {
    /// Names of all objects, in alphabetical order.
    pub fn objects(&self) -> Vec<&str> {
        let names: BTreeSet<&str> = self.surfaces.iter().map(|s| s.object.as_str()).collect();
        names.into_iter().collect()
    }

    /// Number of the state called `initial`, `final` or by its number.
    pub fn state_named(&self, name: &str) -> Result<usize, SceneError> {
        let last = self.edits.len();
        let number = match name {
            "initial" => Some(0),
            "final" => Some(last),
            _ => name.parse().ok(),
        };
        number.filter(|k| *k <= last).ok_or_else(|| SceneError::NoSuchState { asked: name.into(), last })
    }
}
