//! Materials that diffuse radiosity can hold.

use super::parse::{Primitive, shown};
use crate::io::scene::check::{Check, Checked};
use crate::io::scene::error::Refusal;
use std::collections::HashMap;
use std::f64::consts::PI;

/// What a modifier means for the surfaces that carry it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Meaning {
    /// Reflects diffusely, from both sides.
    Diffuse {
        reflectance: [f64; 3],
        /// Share of the light that it mirrors, which is left out.
        specularity: f64,
        /// Pattern or texture that is left out.
        pattern: Option<String>,
    },
    /// Shines evenly from the front: self-emitted radiosity, W/m^2.
    Light { emission: [f64; 3] },
    /// Of a type that diffuse radiosity cannot hold.
    Other { kind: String },
}

/// Modifiers by name: the last definition before a use counts.
#[derive(Default)]
pub(super) struct Modifiers {
    known: HashMap<String, Meaning>,
}

impl Modifiers {
    /// What the modifier of a primitive means; `None` for `void`.
    pub(super) fn of(&self, check: Check, primitive: &Primitive) -> Checked<Option<Meaning>> {
        self.named(check, primitive, &primitive.modifier)
    }

    fn named(&self, check: Check, primitive: &Primitive, name: &str) -> Checked<Option<Meaning>> {
        if name == "void" {
            return Ok(None);
        }
        match self.known.get(name) {
            Some(meaning) => Ok(Some(meaning.clone())),
            None => {
                let message = format!("the modifier \"{}\" is not defined before its use", shown(name));
                let near = crate::io::scene::check::nearest(name, self.known.keys().map(String::as_str));
                let mend = match near {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => "define it above: void plastic NAME 0 0 5 r g b 0 0".into(),
                };
                check.refuse(Refusal::Name, primitive.span.clone(), message, mend)
            }
        }
    }

    /// Takes in a material, a pattern or an alias.
    pub(super) fn define(&mut self, check: Check, primitive: &Primitive) -> Checked<()> {
        let meaning = match (primitive.kind.as_str(), &primitive.alias) {
            (_, Some(reference)) => {
                let own = self.named(check, primitive, reference)?;
                own.unwrap_or(Meaning::Other { kind: "void".into() })
            }
            ("plastic", _) => plastic(check, primitive, self.of(check, primitive)?)?,
            ("light", _) => light(check, primitive, 3)?,
            ("glow", _) => light(check, primitive, 4)?,
            (kind, _) => {
                // A pattern may modify nothing that is there; a name that is not is a mistake.
                self.of(check, primitive)?;
                Meaning::Other { kind: kind.into() }
            }
        };
        self.known.insert(primitive.name.clone(), meaning);
        Ok(())
    }
}

/// The reals of a material, one after the other.
fn reals<const N: usize>(check: Check, primitive: &Primitive, what: &str) -> Checked<[f64; N]> {
    match <[f64; N]>::try_from(primitive.reals.as_slice()) {
        Ok(reals) => Ok(reals),
        Err(_) => {
            let (kind, name, count) = (&primitive.kind, shown(&primitive.name), primitive.reals.len());
            let message = format!("the {kind} \"{name}\" has {count} numbers");
            check.refuse(Refusal::Number, primitive.span.clone(), message, format!("give {N}: {what}"))
        }
    }
}

/// What is mirrored is lost to diffuse light: r g b times (1 - specularity).
fn plastic(check: Check, primitive: &Primitive, modifier: Option<Meaning>) -> Checked<Meaning> {
    let [r, g, b, specularity, _] = reals(check, primitive, "r g b specularity roughness")?;
    let refuse = |message: String, mend: &str| check.refuse(Refusal::Number, primitive.span.clone(), message, mend);
    if !(0.0..=1.0).contains(&specularity) {
        let message = format!("the specularity {specularity} of \"{}\" is outside [0, 1]", shown(&primitive.name));
        return refuse(message, "give a share; most plastics have less than 0.07");
    }
    let reflectance = [r, g, b].map(|v| v * (1.0 - specularity));
    if let Some(v) = reflectance.iter().find(|v| !(0.0..1.0).contains(*v)) {
        let message = format!("the plastic \"{}\" reflects {v}, outside [0, 1)", shown(&primitive.name));
        return refuse(message, "a diffuse surface reflects less than it receives; white paint is about 0.85");
    }
    let pattern = modifier.map(|_| primitive.modifier.clone());
    Ok(Meaning::Diffuse { reflectance, specularity, pattern })
}

/// The radiance of a light or glow; a pattern makes it uneven.
fn light(check: Check, primitive: &Primitive, count: usize) -> Checked<Meaning> {
    let (kind, name) = (&primitive.kind, shown(&primitive.name));
    let [r, g, b] = match count {
        3 => reals::<3>(check, primitive, "r g b")?,
        _ => {
            let [r, g, b, _] = reals(check, primitive, "r g b radius")?;
            [r, g, b]
        }
    };
    if let Some(v) = [r, g, b].iter().find(|v| **v < 0.0) {
        let message = format!("the {kind} \"{name}\" shines with {v}, less than nothing");
        return check.refuse(Refusal::Number, primitive.span.clone(), message, "give zero or more");
    }
    if primitive.modifier != "void" {
        let message = format!("the {kind} \"{name}\" is modified by \"{}\"", shown(&primitive.modifier));
        let mend = "lamps shine alike in all directions here: write void in its place, with the radiance it comes to";
        return check.refuse(Refusal::Reserved, primitive.span.clone(), message, mend);
    }
    Ok(Meaning::Light { emission: [r, g, b].map(|l| PI * l) })
}
