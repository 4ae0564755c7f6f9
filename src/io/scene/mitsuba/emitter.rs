//! `<emitter>`: surfaces that shine, and points.

use super::colour::{Colour, colour};
use super::spectrum::Use;
use super::transform::transform;
use super::tree::{Id, Tree, shown};
use crate::io::scene::check::Checked;
use crate::io::scene::error::Refusal;
use crate::math::DVec3;
use crate::scene::{Distribution, PointLight};
use std::f64::consts::PI;

/// An area emitter.
pub(super) struct Area {
    /// Self-emitted radiosity, W/m^2: pi times the radiance.
    pub emission: [f64; 3],
    /// A band of its spectrum had to be raised to zero.
    pub raised: bool,
}

/// The area emitter of a shape.
pub(super) fn area(tree: &Tree, at: Id) -> Checked<Area> {
    match tree.kind(at)? {
        "area" => {
            let radiance = one_colour(tree, at, "radiance", &["radiance"])?;
            Ok(Area { emission: radiance.bands.map(|l| PI * l), raised: radiance.raised })
        }
        other => {
            let message = format!("a surface cannot be an emitter of type \"{}\"", shown(other));
            tree.refuse(at, Refusal::Reserved, message, "use type=\"area\"")
        }
    }
}

/// An emitter that stands by itself.
pub(super) fn point(tree: &Tree, at: Id, name: String) -> Checked<(PointLight, bool)> {
    match tree.kind(at)? {
        "point" => {}
        other => {
            let message = format!("an emitter of type \"{}\" is not read", shown(other));
            let mend = "light comes from area emitters and from type=\"point\": take this one out";
            return tree.refuse(at, Refusal::Reserved, message, mend);
        }
    }
    let intensity = one_colour(tree, at, "intensity", &["intensity", "position", "to_world"])?;
    let mut position = DVec3::ZERO;
    for child in tree.children(at) {
        match tree.name(child) {
            "position" => position = tree.vector(child, 0.0)?,
            "to_world" => position = transform(tree, child)?.translation,
            _ => {}
        }
    }
    let light =
        PointLight { name, position, intensity: intensity.bands.to_vec(), distribution: Distribution::Isotropic };
    Ok((light, intensity.raised))
}

/// The one colour of an emitter; other parameters must be known.
fn one_colour(tree: &Tree, at: Id, wanted: &str, known: &[&str]) -> Checked<Colour> {
    let mut found = None;
    for child in tree.children(at) {
        match tree.name(child) {
            name if name == wanted => found = Some(colour(tree, tree.resolved(child)?, Use::Emission)?),
            name if known.contains(&name) => {}
            _ => return tree.unknown(child, "an emitter of this type", known),
        }
    }
    match found {
        Some(found) => Ok(found),
        None => {
            let message = format!("the emitter has no {wanted}");
            tree.refuse(at, Refusal::Key, message, format!("add <rgb name=\"{wanted}\" value=\"...\"/>"))
        }
    }
}
