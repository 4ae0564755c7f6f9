//! `[[light]]` and `[[receiver]]`.

use super::check::{Check, Checked, known_names};
use super::error::Refusal;
use super::lamp_keys::{kind, name};
use super::photometry::per_band;
use super::{raw, raw_look};
use crate::math::DVec3;
use crate::scene::{Distribution, PointLight, Receiver};
use std::ops::Range;
use toml::Spanned;

/// Reads the lights of a scene for radiosity, which knows those without extent alone. Those without a name are called
/// `light 1`, `light 2`, ...
pub(super) fn lights(check: Check, tables: &[raw_look::Light], bands: &[String]) -> Checked<Vec<PointLight>> {
    let mut lights: Vec<PointLight> = Vec::new();
    for (k, table) in tables.iter().enumerate() {
        kind(check, table)?;
        let beyond = match &table.curve {
            None => (table.kind.get_ref() != "point")
                .then(|| (table.kind.span(), format!("of type \"{}\"", table.kind.get_ref()))),
            Some(curve) => Some((curve.span(), "with a curve".to_string())),
        };
        if let Some((span, what)) = beyond {
            return check.refuse(
                Refusal::Reserved,
                span,
                format!("a light {what} is for pictures: radiosity knows point lights alone"),
                "put it into a lighting file for `etalon shade --lighting FILE`; here lamps are surfaces with emission",
            );
        }
        let light = light(check, table, bands, k + 1)?;
        if lights.iter().any(|l| l.name == light.name) {
            let span = table.name.as_ref().map_or_else(|| table.kind.span(), Spanned::span);
            return second(check, span, "light", &light.name);
        }
        lights.push(light);
    }
    Ok(lights)
}

pub(super) fn second<T>(check: Check, span: Range<usize>, what: &str, name: &str) -> Checked<T> {
    check.refuse(Refusal::Name, span, format!("a second {what} \"{name}\""), format!("give every {what} its own name"))
}

fn light(check: Check, table: &raw_look::Light, bands: &[String], number: usize) -> Checked<PointLight> {
    let missing = |key: &str| format!("a point light has no {key}");
    let Some(position) = &table.position else {
        return check.refuse(Refusal::Key, table.kind.span(), missing("position"), "add position = [x, y, z]");
    };
    let Some(intensity) = &table.intensity else {
        return check.refuse(Refusal::Key, table.kind.span(), missing("intensity"), "add intensity = ... in W/sr");
    };
    Ok(PointLight {
        name: name(check, table, number)?,
        position: check.point("position", position)?,
        intensity: self::intensity(check, intensity, bands)?,
        distribution: distribution(check, table)?,
    })
}

fn intensity(check: Check, value: &Spanned<raw::Numbers>, bands: &[String]) -> Checked<Vec<f64>> {
    let list = per_band(check, "intensity", value, bands)?;
    match list.iter().find(|v| **v < 0.0) {
        None => Ok(list),
        Some(v) => check.refuse(
            Refusal::Number,
            value.span(),
            format!("intensity {v} is negative"),
            "give the intensity in W/sr, zero or more; a power of P watts in all directions is P / (4 pi)",
        ),
    }
}

pub(super) fn distribution(check: Check, table: &raw_look::Light) -> Checked<Distribution> {
    let name = table.distribution.as_ref().map_or("isotropic", |d| d.get_ref().as_str());
    let span = || table.distribution.as_ref().unwrap_or(&table.kind).span();
    match (name, &table.direction) {
        ("isotropic", None) => Ok(Distribution::Isotropic),
        ("isotropic", Some(direction)) => check.refuse(
            Refusal::Key,
            direction.span(),
            "an isotropic light has no direction",
            "leave direction out, or write distribution = \"lambert\"",
        ),
        ("lambert", Some(direction)) => Ok(Distribution::Lambert(unit(check, "direction", direction)?)),
        ("lambert", None) => check.refuse(
            Refusal::Key,
            span(),
            "a light that shines by Lambert's law has no direction",
            "add direction = [0, 0, -1] or another axis",
        ),
        _ => check.refuse(
            Refusal::Key,
            span(),
            format!("there is no distribution \"{}\"", name.escape_debug()),
            known_names(name, ["isotropic", "lambert"]),
        ),
    }
}

/// Reads all receivers.
pub(super) fn receivers(check: Check, tables: &[raw::Receiver]) -> Checked<Vec<Receiver>> {
    let mut receivers: Vec<Receiver> = Vec::with_capacity(tables.len());
    let mut taken = std::collections::BTreeSet::new();
    for table in tables {
        let name = check.name("receiver name", &table.name)?;
        if !taken.insert(name.clone()) {
            return second(check, table.name.span(), "receiver", &name);
        }
        let position = check.point("position", &table.position)?;
        receivers.push(Receiver { name, position, normal: unit(check, "normal", &table.normal)? });
    }
    Ok(receivers)
}

/// A direction of length 1.
pub(super) fn unit(check: Check, what: &str, value: &Spanned<Vec<f64>>) -> Checked<DVec3> {
    let v = check.direction(what, value)?;
    let u = (v / v.abs().max_element()).normalize_or_zero();
    match u.is_finite() && u != DVec3::ZERO {
        true => Ok(u),
        false => check.refuse(
            Refusal::Number,
            value.span(),
            format!("{what} is too short to have a direction"),
            "give numbers about 1, such as [0, 0, 1]",
        ),
    }
}
