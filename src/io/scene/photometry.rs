//! `[photometry]` and `[[material]]`.

use super::check::{Check, Checked, known_names};
use super::error::Refusal;
use super::raw::{self, Numbers};
use crate::scene::Material;
use crate::view::{Photometry, Primaries};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

const PRIMARIES: [(&str, Primaries); 4] = [
    ("rec709", Primaries::Rec709),
    ("rec2020", Primaries::Rec2020),
    ("xyz", Primaries::Xyz),
    ("mono", Primaries::Mono),
];

/// Bands and weights. Without the table: r, g, b of Rec. 709. One band without `primaries`: weight 1.
pub(super) fn photometry(check: Check, table: Option<&Spanned<raw::Photometry>>) -> Checked<Photometry> {
    let Some(table) = table else { return Ok(Photometry::rec709()) };
    let raw = table.get_ref();
    let bands = raw.bands.as_ref().map(|b| bands(check, b)).transpose()?;
    if let Some(luminance) = &raw.luminance {
        if let Some(primaries) = &raw.primaries {
            return check.refuse(
                Refusal::Bands,
                primaries.span(),
                "both primaries and luminance are given",
                "keep one: primaries carry their own luminance weights",
            );
        }
        let bands = bands.unwrap_or_else(|| Photometry::rec709().bands);
        return Ok(Photometry { weights: weights(check, luminance, bands.len())?, bands });
    }
    let primaries = match &raw.primaries {
        Some(name) => primaries(check, name)?,
        None if bands.as_ref().is_some_and(|b| b.len() == 1) => Primaries::Mono,
        None => Primaries::Rec709,
    };
    let weights = primaries.weights().to_vec();
    let bands = bands.unwrap_or_else(|| match primaries {
        Primaries::Mono => vec!["y".into()],
        Primaries::Xyz => ["x", "y", "z"].map(String::from).to_vec(),
        _ => Photometry::rec709().bands,
    });
    if bands.len() != weights.len() {
        let span = raw.primaries.as_ref().map_or_else(|| table.span(), Spanned::span);
        let (have, need) = (bands.len(), weights.len());
        return check.refuse(
            Refusal::Bands,
            raw.bands.as_ref().map_or(span, Spanned::span),
            format!("{have} bands, but the primaries have {need}"),
            format!("name {need} bands, or give luminance = [...] with {have} weights instead of primaries"),
        );
    }
    Ok(Photometry { bands, weights })
}

fn primaries(check: Check, name: &Spanned<String>) -> Checked<Primaries> {
    match PRIMARIES.iter().find(|(n, _)| n == name.get_ref()) {
        Some((_, p)) => Ok(*p),
        None => check.refuse(
            Refusal::Bands,
            name.span(),
            format!("unknown primaries \"{}\"", name.get_ref()),
            "use rec709, rec2020, xyz or mono, or give luminance = [...]",
        ),
    }
}

/// Band names become columns of solution files.
fn bands(check: Check, names: &Spanned<Vec<String>>) -> Checked<Vec<String>> {
    let list = names.get_ref();
    let fault = |name: &String| {
        let plain = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.'));
        if !plain {
            Some(format!(
                "the band name \"{}\" is empty or has characters besides letters, digits, _ - .",
                name.escape_debug()
            ))
        } else if name == "patch" || name.ends_with("_std_err") {
            Some(format!("the band name \"{name}\" is that of another column of solution files"))
        } else if list.iter().filter(|n| *n == name).count() > 1 {
            Some(format!("the band \"{name}\" is named twice"))
        } else {
            None
        }
    };
    if list.is_empty() {
        return check.refuse(Refusal::Bands, names.span(), "there are no bands", "name at least one");
    }
    if list.len() > 64 {
        return check.refuse(Refusal::Bands, names.span(), format!("{} bands", list.len()), "use at most 64");
    }
    match list.iter().find_map(fault) {
        Some(message) => check.refuse(Refusal::Bands, names.span(), message, "choose another name"),
        None => Ok(list.clone()),
    }
}

fn weights(check: Check, luminance: &Spanned<Vec<f64>>, bands: usize) -> Checked<Vec<f64>> {
    let w = luminance.get_ref();
    if w.len() != bands {
        return check.refuse(
            Refusal::Bands,
            luminance.span(),
            format!("{} luminance weights for {bands} bands", w.len()),
            "give one weight per band",
        );
    }
    let sound = w.iter().all(|v| v.is_finite() && *v >= 0.0) && w.iter().any(|v| *v > 0.0);
    match sound {
        true => Ok(w.clone()),
        false => check.refuse(
            Refusal::Bands,
            luminance.span(),
            "luminance weights must be finite, none negative, and not all zero",
            "take the Y row of your primaries' matrix to XYZ",
        ),
    }
}

/// A list of numbers per band from one number or a list.
pub(super) fn per_band(check: Check, what: &str, value: &Spanned<Numbers>, bands: &[String]) -> Checked<Vec<f64>> {
    let list = match value.get_ref() {
        Numbers::One(v) => vec![*v; bands.len()],
        Numbers::List(l) => l.clone(),
    };
    if list.len() != bands.len() {
        return check.refuse(
            Refusal::Bands,
            value.span(),
            format!("{what} has {} numbers, but there are {} bands ({})", list.len(), bands.len(), bands.join(", ")),
            "give one number for all bands, or one per band",
        );
    }
    list.iter().try_for_each(|v| check.finite(what, *v, value.span()).map(|_| ()))?;
    Ok(list)
}

pub(super) fn reflectance(check: Check, value: &Spanned<Numbers>, bands: &[String]) -> Checked<Vec<f64>> {
    let list = per_band(check, "reflectance", value, bands)?;
    match list.iter().find(|v| !(0.0..1.0).contains(*v)) {
        None => Ok(list),
        Some(v) => check.refuse(
            Refusal::Number,
            value.span(),
            format!("reflectance {v} is outside [0, 1)"),
            "a diffuse surface reflects less than it receives; white paint is about 0.85",
        ),
    }
}

pub(super) fn emission(check: Check, value: &Spanned<Numbers>, bands: &[String]) -> Checked<Vec<f64>> {
    let list = per_band(check, "emission", value, bands)?;
    match list.iter().find(|v| **v < 0.0) {
        None => Ok(list),
        Some(v) => check.refuse(
            Refusal::Number,
            value.span(),
            format!("emission {v} is negative"),
            "give the self-emitted radiosity in W/m^2, zero or more",
        ),
    }
}

/// The materials of the file, by name.
#[derive(Default)]
pub(super) struct Materials {
    pub list: Vec<Material>,
    numbers: BTreeMap<String, u32>,
}

impl Materials {
    /// Adds a material; `false` if the name is taken.
    pub(super) fn add(&mut self, material: Material) -> bool {
        let number = self.list.len() as u32;
        let free = !self.numbers.contains_key(&material.name);
        if free {
            self.numbers.insert(material.name.clone(), number);
            self.list.push(material);
        }
        free
    }

    pub(super) fn number(&self, name: &str) -> Option<u32> {
        self.numbers.get(name).copied()
    }

    /// The number of a material that must exist.
    pub(super) fn named(&self, check: Check, name: &Spanned<String>) -> Checked<u32> {
        match self.number(name.get_ref()) {
            Some(number) => Ok(number),
            None => check.refuse(
                Refusal::Name,
                name.span(),
                format!("there is no material \"{}\"", name.get_ref()),
                known_names(name.get_ref(), self.numbers.keys().map(String::as_str)),
            ),
        }
    }
}

/// Reads all `[[material]]` tables.
pub(super) fn materials(
    check: Check,
    tables: &[raw::Material],
    bands: &[String],
    notices: &mut Vec<String>,
) -> Checked<Materials> {
    let mut materials = Materials::default();
    for table in tables {
        reserved(check, "material.specular", table.specular.as_ref().map(Spanned::span))?;
        let name = check.name("material name", &table.name)?;
        if table.reflectance.is_none() && table.emission.is_none() {
            return check.refuse(
                Refusal::Key,
                table.name.span(),
                "the material has neither reflectance nor emission",
                "add reflectance = ... (0 for black)",
            );
        }
        if table.reflectance.is_none() {
            notices.push(format!("material \"{name}\" has no reflectance: taken as 0"));
        }
        let zero = || Ok(vec![0.0; bands.len()]);
        let material = Material {
            reflectance: table.reflectance.as_ref().map_or_else(zero, |v| reflectance(check, v, bands))?,
            emission: table.emission.as_ref().map_or_else(zero, |v| emission(check, v, bands))?,
            name,
        };
        if !materials.add(material) {
            return check.refuse(
                Refusal::Name,
                table.name.span(),
                format!("a second material \"{}\"", table.name.get_ref()),
                "give every material its own name",
            );
        }
    }
    Ok(materials)
}

/// Refuses keys that a later version will bring.
pub(super) fn reserved(check: Check, what: &str, span: Option<Range<usize>>) -> Checked<()> {
    match span {
        None => Ok(()),
        Some(span) => check.refuse(
            Refusal::Reserved,
            span,
            format!("{what} is reserved: a later version brings it"),
            "leave it out for now; surfaces are diffuse, and what pictures show beyond that are textures, shares and lights",
        ),
    }
}
