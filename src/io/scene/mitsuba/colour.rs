//! `<rgb>`, `<spectrum>` and `<float>` as values per band.

use super::spectrum::{Spectrum, Use, even};
use super::tree::{Id, Tree, shown};
use crate::io::scene::check::Checked;
use crate::io::scene::error::Refusal;

/// A colour, and whether a band had to be raised to zero.
pub(super) struct Colour {
    pub bands: [f64; 3],
    pub raised: bool,
}

/// Red, green and blue of a parameter: reflectances in [0, 1), powers of zero and more.
pub(super) fn colour(tree: &Tree, at: Id, what: Use) -> Checked<Colour> {
    let (bands, raised) = match tree.tag(at) {
        "rgb" => (rgb(tree, at)?, false),
        "float" => ([tree.number(at, "value")?; 3], false),
        "spectrum" => {
            let bands = spectrum(tree, at, what)?;
            (bands.map(|v| v.max(0.0)), bands.iter().any(|v| *v < 0.0))
        }
        other => {
            let message = format!("a colour of kind <{}> is not read", shown(other));
            return tree.refuse(at, Refusal::Reserved, message, "give one <rgb> or <spectrum> for the whole surface");
        }
    };
    check_range(tree, at, what, bands)?;
    Ok(Colour { bands, raised })
}

fn check_range(tree: &Tree, at: Id, what: Use, bands: [f64; 3]) -> Checked<()> {
    let name = tree.name(at);
    match what {
        Use::Reflectance => match bands.iter().find(|v| !(0.0..1.0).contains(*v)) {
            None => Ok(()),
            Some(v) => {
                let message = format!("{} {v} is outside [0, 1)", shown(name));
                let mend = "a diffuse surface reflects less than it receives; white paint is about 0.85";
                tree.refuse(at, Refusal::Number, message, mend)
            }
        },
        Use::Emission => match bands.iter().find(|v| !v.is_finite() || **v < 0.0) {
            None => Ok(()),
            Some(v) => {
                let message = format!("{} {v} is negative", shown(name));
                tree.refuse(at, Refusal::Number, message, "give zero or more")
            }
        },
    }
}

fn rgb(tree: &Tree, at: Id) -> Checked<[f64; 3]> {
    if tree.needed(at, "value")?.trim_start().starts_with('#') {
        let message = "a colour in hexadecimal digits is not read";
        return tree.refuse(at, Refusal::Reserved, message, "give linear values: value=\"0.8, 0.7, 0.6\"");
    }
    match tree.numbers(at, "value")?[..] {
        [v] => Ok([v; 3]),
        [r, g, b] => Ok([r, g, b]),
        ref list => {
            let message = format!("<rgb> has {} numbers", list.len());
            tree.refuse(at, Refusal::Number, message, "give three (or one for all)")
        }
    }
}

/// One number for all wavelengths, or `wavelength:value` pairs in nm.
fn spectrum(tree: &Tree, at: Id, what: Use) -> Checked<[f64; 3]> {
    if tree.attribute(at, "filename").is_some() || tree.attribute(at, "wavelengths").is_some() {
        let message = "a spectrum from a file or from two lists is not read";
        let mend = "write value=\"400:0.3, 500:0.4, ...\" (wavelength in nm : value)";
        return tree.refuse(at, Refusal::Reserved, message, mend);
    }
    let text = tree.needed(at, "value")?;
    if !text.contains(':') {
        return Ok(even(tree.number(at, "value")?, what));
    }
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for word in text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()) {
        let Some((wavelength, value)) = word.split_once(':') else {
            let message = format!("\"{}\" is not a wavelength with its value", shown(word));
            return tree.refuse(at, Refusal::Syntax, message, "write pairs: 400:0.3, 500:0.4");
        };
        let pair = (tree.parsed(at, "a wavelength", wavelength)?, tree.parsed(at, "a value", value)?);
        if pairs.last().is_some_and(|last| last.0 >= pair.0) {
            let message = format!("the wavelength {} comes after {}", pair.0, pairs[pairs.len() - 1].0);
            return tree.refuse(at, Refusal::Number, message, "put wavelengths (nm) in rising order");
        }
        if pair.1 < 0.0 {
            let message = format!("the value {} at {} nm is negative", pair.1, pair.0);
            return tree.refuse(at, Refusal::Number, message, "give zero or more");
        }
        pairs.push(pair);
    }
    match pairs.len() {
        0 | 1 => tree.refuse(at, Refusal::Number, "the spectrum has fewer than two values", "give two or more pairs"),
        _ => Ok(Spectrum(pairs).rec709(what)),
    }
}
