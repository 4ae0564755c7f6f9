//! `[initial]` and `[[edit]]`.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::photometry::{Materials, emission, reflectance};
use super::raw::{self, Numbers};
use crate::math::DVec3;
use crate::scene::{Edit, Transform};
use std::ops::Range;
use toml::Spanned;

/// An edit as far as it can be read without meshes.
pub(super) enum Read<'a> {
    Done(Edit),
    /// The object is replaced by the faces of a mesh.
    Mesh {
        object: String,
        mesh: &'a Spanned<String>,
    },
}

/// Keys of an edit with their places; the value says whether the key is there.
fn keys(e: &raw::Edit) -> [(&'static str, Option<Range<usize>>); 15] {
    fn at<T>(v: &Option<Spanned<T>>) -> Option<Range<usize>> {
        v.as_ref().map(Spanned::span)
    }
    [
        ("add", at(&e.add)),
        ("remove", at(&e.remove)),
        ("move", at(&e.moved)),
        ("replace", at(&e.replace)),
        ("material", at(&e.material)),
        ("translate", at(&e.translate)),
        ("rotate", at(&e.rotate)),
        ("mesh", at(&e.mesh)),
        ("scale", at(&e.scale)),
        ("about", at(&e.about)),
        ("up", at(&e.up)),
        ("patches", at(&e.patches)),
        ("elements", at(&e.elements)),
        ("reflectance", at(&e.reflectance)),
        ("emission", at(&e.emission)),
    ]
}

/// The first five keys name the action.
const ACTIONS: usize = 5;

/// What may stand beside an action.
fn companions(action: &str, mesh: bool) -> &'static [&'static str] {
    match (action, mesh) {
        ("move", _) => &["translate", "rotate"],
        ("replace", true) => &["mesh", "scale", "up", "patches", "elements"],
        ("replace", false) => &["mesh", "scale", "about"],
        ("material", _) => &["reflectance", "emission"],
        _ => &[],
    }
}

/// Reads one edit.
pub(super) fn edit<'a>(
    check: Check,
    table: &'a Spanned<raw::Edit>,
    materials: &Materials,
    bands: &[String],
) -> Checked<Read<'a>> {
    let raw = table.get_ref();
    let action = action(check, table)?;
    let named = |name: &Option<Spanned<String>>| name.as_ref().map(|n| n.get_ref().clone()).unwrap_or_default();
    let done = match action {
        "add" => Edit::Add { object: named(&raw.add) },
        "remove" => Edit::Remove { object: named(&raw.remove) },
        "move" => Edit::Move { object: named(&raw.moved), transform: transform(check, table)? },
        "material" => material(check, table, materials, bands)?,
        _ => match &raw.mesh {
            Some(mesh) => return Ok(Read::Mesh { object: named(&raw.replace), mesh }),
            None => reshape(check, table, named(&raw.replace))?,
        },
    };
    Ok(Read::Done(done))
}

/// The one action of an edit, with nothing beside it that it cannot use.
fn action(check: Check, table: &Spanned<raw::Edit>) -> Checked<&'static str> {
    let keys = keys(table.get_ref());
    let given: Vec<_> = keys[..ACTIONS].iter().filter_map(|(k, at)| Some((*k, at.clone()?))).collect();
    let action = match given.as_slice() {
        [] => {
            return check.refuse(
                Refusal::Edit,
                table.span(),
                "the edit has no action",
                "give one of add, remove, move, replace, material",
            );
        }
        [(action, _)] => *action,
        [(first, _), (second, at), ..] => {
            return check.refuse(
                Refusal::Edit,
                at.clone(),
                format!("the edit has two actions, {first} and {second}"),
                "write one [[edit]] for each",
            );
        }
    };
    let fit = companions(action, table.get_ref().mesh.is_some());
    for (key, at) in &keys[ACTIONS..] {
        if let Some(at) = at.clone().filter(|_| !fit.contains(key)) {
            let mend = if fit.is_empty() { "leave it out".into() } else { format!("it may use {}", fit.join(", ")) };
            return check.refuse(Refusal::Edit, at, format!("{action} does not use {key}"), mend);
        }
    }
    Ok(action)
}

fn transform(check: Check, table: &Spanned<raw::Edit>) -> Checked<Transform> {
    let raw = table.get_ref();
    if raw.translate.is_none() && raw.rotate.is_none() {
        return check.refuse(
            Refusal::Edit,
            table.span(),
            "move says neither translate nor rotate",
            "add translate = [x, y, z] or rotate = { axis = [..], degrees = .. }",
        );
    }
    let translate = raw.translate.as_ref().map_or(Ok(DVec3::ZERO), |t| check.point("translate", t))?;
    let Some(rotate) = raw.rotate.as_ref().map(Spanned::get_ref) else {
        return Ok(Transform { axis: DVec3::Z, angle: 0.0, about: DVec3::ZERO, translate });
    };
    let degrees = check.finite("degrees", *rotate.degrees.get_ref(), rotate.degrees.span())?;
    Ok(Transform {
        axis: check.direction("axis", &rotate.axis)?.normalize(),
        angle: degrees.to_radians(),
        about: rotate.about.as_ref().map_or(Ok(DVec3::ZERO), |p| check.point("about", p))?,
        translate,
    })
}

fn reshape(check: Check, table: &Spanned<raw::Edit>, object: String) -> Checked<Edit> {
    let raw = table.get_ref();
    let Some(scale) = &raw.scale else {
        return check.refuse(
            Refusal::Edit,
            table.span(),
            "replace says neither mesh nor scale",
            "add mesh = \"file.obj\" or scale = [x, y, z]",
        );
    };
    let list = match scale.get_ref() {
        Numbers::One(v) => vec![*v; 3],
        Numbers::List(l) => l.clone(),
    };
    let factors = check.point("scale", &Spanned::new(scale.span(), list))?;
    if factors.min_element() <= 0.0 {
        return check.refuse(
            Refusal::Number,
            scale.span(),
            format!("scale is {factors}"),
            "give factors greater than zero: a mirrored object would radiate inwards",
        );
    }
    let about = raw.about.as_ref().map_or(Ok(DVec3::ZERO), |p| check.point("about", p))?;
    Ok(Edit::Reshape { object, scale: factors, about })
}

fn material(check: Check, table: &Spanned<raw::Edit>, materials: &Materials, bands: &[String]) -> Checked<Edit> {
    let raw = table.get_ref();
    if raw.reflectance.is_none() && raw.emission.is_none() {
        return check.refuse(
            Refusal::Edit,
            table.span(),
            "the material edit changes nothing",
            "add reflectance = ... or emission = ...",
        );
    }
    let name = raw.material.clone().unwrap_or_else(|| Spanned::new(table.span(), String::new()));
    Ok(Edit::Material {
        material: materials.named(check, &name)?,
        reflectance: raw.reflectance.as_ref().map(|v| reflectance(check, v, bands)).transpose()?,
        emission: raw.emission.as_ref().map(|v| emission(check, v, bands)).transpose()?,
    })
}
