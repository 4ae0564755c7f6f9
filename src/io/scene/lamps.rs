//! `[[light]]` of every kind, for pictures.

use super::check::{Check, Checked, known_names};
use super::error::Refusal;
use super::lamp_keys::{kind, name};
use super::lighting::{distribution, second, unit};
use super::photometry::per_band;
use super::polygon::polygon;
use super::raw::Numbers;
use super::raw_look::{self, Outline};
use crate::math::DVec3;
use crate::scene::{Distribution, IntensityCurve, Light, LightShape, SkyModel};
use std::ops::Range;
use toml::Spanned;

/// A light, or one whose shape is that of something in the scene.
#[derive(Debug, Clone)]
pub(super) enum Lamp {
    Ready(Light),
    Of(Borrowed),
}

/// A light in the shape of a surface or an object.
#[derive(Debug, Clone)]
pub(super) struct Borrowed {
    pub name: String,
    /// True for an object, false for a surface.
    pub object: bool,
    pub owner: String,
    pub span: Range<usize>,
    /// In place of what the faces emit.
    pub radiosity: Option<Vec<f64>>,
}

/// Reads all lights. Those without a name are called `light 1`, `light 2`, ...
pub(super) fn lamps(check: Check, tables: &[raw_look::Light], bands: &[String]) -> Checked<Vec<Lamp>> {
    let mut lamps = Vec::new();
    let mut names = std::collections::BTreeSet::new();
    for (k, table) in tables.iter().enumerate() {
        kind(check, table)?;
        let name = name(check, table, k + 1)?;
        if !names.insert(name.clone()) {
            return second(check, table.name.as_ref().map_or_else(|| table.kind.span(), Spanned::span), "light", &name);
        }
        lamps.push(Reader { check, table, bands }.lamp(name)?);
    }
    Ok(lamps)
}

/// One number for all bands or one per band, none negative.
pub(super) fn strength(check: Check, what: &str, value: &Spanned<Numbers>, bands: &[String]) -> Checked<Vec<f64>> {
    let list = per_band(check, what, value, bands)?;
    match list.iter().find(|v| **v < 0.0) {
        None => Ok(list),
        Some(v) => check.refuse(Refusal::Number, value.span(), format!("{what} {v} is negative"), "give zero or more"),
    }
}

/// One table of lights.
struct Reader<'a> {
    check: Check<'a>,
    table: &'a raw_look::Light,
    bands: &'a [String],
}

impl<'a> Reader<'a> {
    /// A key that this kind cannot do without.
    fn need<T>(&self, key: &str, value: &'a Option<Spanned<T>>) -> Checked<&'a Spanned<T>> {
        let kind = &self.table.kind;
        match value {
            Some(value) => Ok(value),
            None => self.check.refuse(
                Refusal::Key,
                kind.span(),
                format!("a light of type \"{}\" needs {key}", kind.get_ref()),
                format!("add {key} = ..."),
            ),
        }
    }

    fn strength(&self, key: &str, value: &'a Option<Spanned<Numbers>>) -> Checked<Vec<f64>> {
        strength(self.check, key, self.need(key, value)?, self.bands)
    }

    fn lamp(&self, name: String) -> Checked<Lamp> {
        let (check, t) = (self.check, self.table);
        let (strength, shape) = match t.kind.get_ref().as_str() {
            "parallel" => {
                let direction = unit(check, "direction", self.need("direction", &t.direction)?)?;
                (self.strength("irradiance", &t.irradiance)?, LightShape::Parallel { direction })
            }
            "linear" => {
                let (from, to) = (self.need("from", &t.from)?, self.need("to", &t.to)?);
                let ends = (check.point("from", from)?, check.point("to", to)?);
                if ends.0 == ends.1 {
                    return check.refuse(Refusal::Number, to.span(), "from and to are the same point", "move one");
                }
                (self.strength("intensity", &t.intensity)?, LightShape::Linear { from: ends.0, to: ends.1 })
            }
            "area" | "polyhedron" => return self.faces(name),
            "sky" => (self.strength("radiance", &t.radiance)?, self.sky()?),
            _ => (self.strength("intensity", &t.intensity)?, self.point()?),
        };
        Ok(Lamp::Ready(Light { name, strength, shape }))
    }

    fn point(&self) -> Checked<LightShape> {
        let (check, t) = (self.check, self.table);
        let position = check.point("position", self.need("position", &t.position)?)?;
        let Some(curve) = &t.curve else {
            return Ok(LightShape::Point { position, distribution: distribution(check, t)?, curve: None });
        };
        let axis = unit(check, "direction", self.need("direction", &t.direction)?)?;
        let isotropic = t.distribution.as_ref().is_none_or(|d| d.get_ref() == "isotropic");
        let distribution = if isotropic { Distribution::Isotropic } else { distribution(check, t)? };
        Ok(LightShape::Point { position, distribution, curve: Some(self.curve(axis, curve)?) })
    }

    fn curve(&self, axis: DVec3, value: &Spanned<Vec<Spanned<Vec<f64>>>>) -> Checked<IntensityCurve> {
        let mut samples: Vec<(f64, f64)> = Vec::new();
        for pair in value.get_ref() {
            let known = match pair.get_ref()[..] {
                [angle, factor] => {
                    let follows = samples.last().map_or(angle == 0.0, |last| angle > last.0 && angle <= 180.0);
                    (follows && factor.is_finite() && factor >= 0.0).then_some((angle, factor))
                }
                _ => None,
            };
            match known {
                Some(sample) => samples.push(sample),
                None => {
                    let message = format!("the curve goes wrong at {:?}", pair.get_ref());
                    let mend = "give [degrees, factor] pairs from 0 upwards to at most 180, factors of zero or more";
                    return self.check.refuse(Refusal::Number, pair.span(), message, mend);
                }
            }
        }
        match samples.is_empty() {
            false => Ok(IntensityCurve { axis, samples }),
            true => self.check.refuse(Refusal::Number, value.span(), "the curve is empty", "add [0, 1]"),
        }
    }

    fn sky(&self) -> Checked<LightShape> {
        let (check, t) = (self.check, self.table);
        let up = t.up.as_ref().map_or(Ok(DVec3::Z), |u| unit(check, "up", u))?;
        let model = self.need("model", &t.model)?;
        let plain = match (model.get_ref().as_str(), &t.sun) {
            ("clear", _) => {
                let place = self.need("sun", &t.sun)?;
                let sun = unit(check, "sun", place)?;
                if sun.dot(up) < 0.0 {
                    let mend = "give the direction to the sun, above the horizon";
                    return check.refuse(Refusal::Number, place.span(), "the sun is below the horizon", mend);
                }
                return Ok(LightShape::Sky { model: SkyModel::Clear { sun }, up });
            }
            ("overcast", None) => SkyModel::Overcast,
            ("uniform", None) => SkyModel::Uniform,
            ("overcast" | "uniform", Some(sun)) => {
                let message = format!("the sky \"{}\" has no sun", model.get_ref());
                return check.refuse(Refusal::Key, sun.span(), message, "leave sun out, or take model = \"clear\"");
            }
            (other, _) => {
                let message = format!("there is no model of the sky \"{}\"", other.escape_debug());
                let known = known_names(other, ["overcast", "clear", "uniform"]);
                return check.refuse(Refusal::Key, model.span(), message, known);
            }
        };
        Ok(LightShape::Sky { model: plain, up })
    }

    /// A light with a body of its own, or with that of something in the scene.
    fn faces(&self, name: String) -> Checked<Lamp> {
        let (check, t) = (self.check, self.table);
        let given = t.radiosity.as_ref().map(|r| strength(check, "radiosity", r, self.bands)).transpose()?;
        let polygons: Option<&[Outline]> = match (&t.polygon, &t.faces) {
            (Some(one), _) => Some(std::slice::from_ref(one)),
            (None, faces) => faces.as_ref().map(|f| f.get_ref().as_slice()),
        };
        match (polygons, &t.surface, &t.object) {
            (Some(outlines), None, None) if !outlines.is_empty() => {
                let mut faces = outlines.iter().map(|o| polygon(check, o)).collect::<Checked<Vec<_>>>()?;
                let area = t.kind.get_ref() == "area";
                let shape = match faces.pop() {
                    Some(polygon) if area => LightShape::Area { polygon },
                    last => LightShape::Polyhedron { faces: faces.into_iter().chain(last).collect() },
                };
                Ok(Lamp::Ready(Light { name, strength: self.strength("radiosity", &t.radiosity)?, shape }))
            }
            (None, Some(owner), None) | (None, None, Some(owner)) => Ok(Lamp::Of(Borrowed {
                name,
                object: t.object.is_some(),
                owner: owner.get_ref().clone(),
                span: owner.span(),
                radiosity: given,
            })),
            _ => {
                let choice = if t.kind.get_ref() == "area" { "polygon, surface" } else { "faces, surface, object" };
                let message = format!("a light of type \"{}\" needs one of {choice}", t.kind.get_ref());
                check.refuse(Refusal::Key, t.kind.span(), message, "say once what shines")
            }
        }
    }
}
