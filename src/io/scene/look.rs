//! What a file says about pictures, not yet tied to what stands there.

use super::check::{Check, Checked, known_names};
use super::error::{Refusal, SceneFileError};
use super::finishes::Keys;
use super::folder::Folder;
use super::lamps::{Borrowed, Lamp, lamps};
use super::pictures::Pictures;
use super::raw;
use super::raw_look::LightingFile;
use super::shapes::{Shapes, Shining};
use super::source::Source;
use super::surroundings::{background, fog, trees};
use crate::scene::{Appearance, Background, Finish, Fog, Light, LightShape, Picture, PointLight, Texture, Tree};
use std::ops::Range;

/// What a scene file or a lighting file says about pictures. Lights that have the shape of a surface or an object get it
/// from [`Shapes`]: a scene in a state, or an intermediate image.
#[derive(Debug, Clone)]
pub struct Look {
    source: Source,
    bands: Vec<String>,
    /// `None`: the file has no word on it, and what was there stays.
    lights: Option<Vec<Lamp>>,
    fog: Option<Fog>,
    background: Option<Background>,
    finishes: Vec<(Finish, Range<usize>)>,
    trees: Vec<Tree>,
    pictures: Vec<Picture>,
}

impl Look {
    /// What a scene file says.
    pub(super) fn of_scene(check: Check, file: &raw::File, folder: &Folder, bands: &[String]) -> Checked<Self> {
        let mut pictures = Pictures::of(folder);
        let mut finishes = Vec::new();
        for table in &file.material {
            let keys = Keys::of_material(table);
            if !keys.are_none() {
                finishes.push((keys.finish(check, table.name.get_ref(), &mut pictures)?, table.name.span()));
            }
        }
        let background = file.background.as_ref().map(|b| background(check, b, bands, &mut pictures)).transpose()?;
        Ok(Self {
            source: check.source.clone(),
            bands: bands.to_vec(),
            lights: Some(lamps(check, &file.light, bands)?),
            fog: file.fog.as_ref().map(|f| fog(check, f, bands)).transpose()?,
            background,
            finishes,
            trees: trees(check, &file.tree, &mut pictures)?,
            pictures: pictures.list,
        })
    }

    /// What a lighting file says.
    pub(super) fn of_lighting(check: Check, file: &LightingFile, folder: &Folder, bands: &[String]) -> Checked<Self> {
        let mut pictures = Pictures::of(folder);
        let mut finishes: Vec<(Finish, Range<usize>)> = Vec::new();
        for table in &file.finish {
            let material = check.name("material name", &table.material)?;
            if finishes.iter().any(|(f, _)| f.material == material) {
                let message = format!("a second finish of the material \"{material}\"");
                return check.refuse(Refusal::Name, table.material.span(), message, "write one for each material");
            }
            finishes.push((Keys::of_finish(table).finish(check, &material, &mut pictures)?, table.material.span()));
        }
        let background = file.background.as_ref().map(|b| background(check, b, bands, &mut pictures)).transpose()?;
        Ok(Self {
            source: check.source.clone(),
            bands: bands.to_vec(),
            lights: file.light.as_ref().map(|l| lamps(check, l, bands)).transpose()?,
            fog: file.fog.as_ref().map(|f| fog(check, f, bands)).transpose()?,
            background,
            finishes,
            trees: Vec::new(),
            pictures: pictures.list,
        })
    }

    /// Lights alone.
    pub(super) fn of_lights(source: Source, bands: &[String], lights: Vec<Light>) -> Self {
        Self {
            source,
            bands: bands.to_vec(),
            lights: Some(lights.into_iter().map(Lamp::Ready).collect()),
            fog: None,
            background: None,
            finishes: Vec::new(),
            trees: Vec::new(),
            pictures: Vec::new(),
        }
    }

    /// Those lights that radiosity knows.
    pub(super) fn point_lights(&self) -> Vec<PointLight> {
        let point = |lamp: &Lamp| match lamp {
            Lamp::Ready(Light { name, strength, shape: LightShape::Point { position, distribution, curve: None } }) => {
                let (name, intensity) = (name.clone(), strength.clone());
                Some(PointLight { name, position: *position, intensity, distribution: *distribution })
            }
            _ => None,
        };
        self.lights.iter().flatten().filter_map(point).collect()
    }

    /// The appearance with nothing before it.
    ///
    /// # Errors
    /// As [`Look::over`].
    pub fn on(&self, shapes: &dyn Shapes) -> Result<Appearance, SceneFileError> {
        self.over(&Appearance::default(), shapes)
    }

    /// An appearance with everything that the file says in place of what was there: all lights, the fog, the background,
    /// the finish of a material. What it has no word on stays.
    ///
    /// # Errors
    /// [`SceneFileError`] where a surface, an object or a material is not there, faces do not emit or not alike, or the
    /// bands are others.
    pub fn over(&self, base: &Appearance, shapes: &dyn Shapes) -> Result<Appearance, SceneFileError> {
        let check = Check { source: &self.source };
        if shapes.bands() != self.bands {
            let (own, others) = (self.bands.join(", "), shapes.bands().join(", "));
            let message = format!("was read for the bands {own}, and is to be used with {others}");
            return check.refuse(Refusal::Bands, 0..0, message, "read it again for these bands");
        }
        let mut look = base.clone();
        if let Some(lamps) = &self.lights {
            let lit = lamps.iter().map(|l| light(check, l, shapes)).collect::<Checked<Vec<_>>>()?;
            look.lights = lit.into_iter().flatten().collect();
        }
        let first = look.pictures.len();
        look.pictures.extend(self.pictures.iter().cloned());
        look.fog = self.fog.clone().or(look.fog);
        if let Some(mut background) = self.background.clone() {
            background.picture.iter_mut().for_each(|p| *p += first);
            background.clouds.iter_mut().for_each(|c| c.picture += first);
            look.background = background;
        }
        for (finish, span) in &self.finishes {
            let known = shapes.materials();
            if !known.contains(finish.material.as_str()) {
                let message = format!("there is no material \"{}\"", finish.material.escape_debug());
                return check.refuse(Refusal::Name, span.clone(), message, known_names(&finish.material, known));
            }
            look.finishes.retain(|f| f.material != finish.material);
            look.finishes.push(shifted(finish, first));
        }
        let tree = |t: &Tree| Tree { picture: t.picture + first, ..t.clone() };
        look.trees.extend(self.trees.iter().map(tree));
        Ok(look)
    }
}

/// The finish with its pictures behind those that were there.
fn shifted(finish: &Finish, first: usize) -> Finish {
    let mut finish = finish.clone();
    let maps = [&mut finish.colour, &mut finish.bump, &mut finish.reflection_map, &mut finish.transparency_map];
    maps.into_iter().flatten().for_each(|t: &mut Texture| t.picture += first);
    finish
}

/// The light; `None` if what has its shape was taken away by an edit, or is not there yet.
fn light(check: Check, lamp: &Lamp, shapes: &dyn Shapes) -> Checked<Option<Light>> {
    match lamp {
        Lamp::Ready(light) => Ok(Some(light.clone())),
        Lamp::Of(borrowed) if shapes.is_away(&borrowed.owner, borrowed.object) => Ok(None),
        Lamp::Of(borrowed) => shining(check, borrowed, shapes).map(Some),
    }
}

/// A light in the shape of what stands there: faces that emit, all alike, or all faces with the radiosity given.
fn shining(check: Check, lamp: &Borrowed, shapes: &dyn Shapes) -> Checked<Light> {
    let what = if lamp.object { "object" } else { "surface" };
    let owner = lamp.owner.escape_debug();
    let refuse = |kind, message: String, mend: String| check.refuse(kind, lamp.span.clone(), message, mend);
    let all = shapes.faces(&lamp.owner, lamp.object);
    if all.is_empty() {
        let known = if lamp.object { shapes.objects() } else { shapes.surfaces() };
        let message = format!("no {what} \"{owner}\" stands there by itself");
        return refuse(Refusal::Name, message, known_names(&lamp.owner, known));
    }
    let emits = |f: &Shining| lamp.radiosity.is_some() || f.emission.iter().any(|e| *e > 0.0);
    let faces: Vec<Shining> = all.into_iter().filter(emits).collect();
    let Some(first) = faces.first() else {
        let mend = "add radiosity = ... in W/m^2, or give its material an emission".into();
        return refuse(Refusal::Number, format!("the {what} \"{owner}\" emits nothing"), mend);
    };
    let strength = lamp.radiosity.clone().unwrap_or_else(|| first.emission.clone());
    if lamp.radiosity.is_none() && faces.iter().any(|f| f.emission != strength) {
        let message = format!("the faces of the {what} \"{owner}\" do not all emit alike");
        return refuse(Refusal::Number, message, "add radiosity = ..., or make a light of each surface".into());
    }
    let mut faces: Vec<_> = faces.into_iter().map(|f| f.vertices).collect();
    let shape = match faces.pop() {
        Some(polygon) if faces.is_empty() => LightShape::Area { polygon },
        last => LightShape::Polyhedron { faces: faces.into_iter().chain(last).collect() },
    };
    Ok(Light { name: lamp.name.clone(), strength, shape })
}

#[cfg(test)]
mod tests;
