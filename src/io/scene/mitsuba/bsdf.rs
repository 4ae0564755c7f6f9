//! `<bsdf>`: diffuse, on one side or both.

use super::colour::colour;
use super::spectrum::Use;
use super::tree::{Id, Tree, shown};
use crate::io::scene::check::Checked;
use crate::io::scene::error::Refusal;

/// Reflectance where the file gives none, as in Mitsuba.
const DEFAULT_REFLECTANCE: f64 = 0.5;

/// How a surface reflects.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bsdf {
    pub name: String,
    pub reflectance: [f64; 3],
    /// The back reflects like the front; else it is black.
    pub two_sided: bool,
    /// A band of its spectrum had to be raised to zero.
    pub raised: bool,
}

impl Bsdf {
    /// What a shape without a BSDF gets: grey, or black if it emits.
    pub(super) fn default_of(emits: bool) -> Self {
        let (name, reflectance) = if emits { ("black", 0.0) } else { ("default", DEFAULT_REFLECTANCE) };
        Self { name: name.into(), reflectance: [reflectance; 3], two_sided: false, raised: false }
    }
}

/// Reads a BSDF that a surface uses.
pub(super) fn bsdf(tree: &Tree, at: Id) -> Checked<Bsdf> {
    match tree.kind(at)? {
        "diffuse" => diffuse(tree, at),
        "twosided" => two_sided(tree, at),
        other => {
            let message = format!("the BSDF \"{}\" is not diffuse", shown(other));
            let mend = "radiosity holds diffuse surfaces only: use type=\"diffuse\", or take its shapes out";
            tree.refuse(at, Refusal::Reserved, message, mend)
        }
    }
}

fn diffuse(tree: &Tree, at: Id) -> Checked<Bsdf> {
    let mut found = Bsdf { name: tree.title(at).into(), ..Bsdf::default_of(false) };
    for child in tree.children(at) {
        if tree.name(child) != "reflectance" {
            return tree.unknown(child, "a diffuse BSDF", &["reflectance"]);
        }
        let child = tree.resolved(child)?;
        let read = colour(tree, child, Use::Reflectance)?;
        (found.reflectance, found.raised) = (read.bands, read.raised);
    }
    Ok(found)
}

fn two_sided(tree: &Tree, at: Id) -> Checked<Bsdf> {
    let inner: Vec<Id> = tree.children(at).collect();
    let [inner] = inner[..] else {
        let message = format!("the BSDF \"twosided\" holds {} BSDFs", inner.len());
        return tree.refuse(at, Refusal::Reserved, message, "put one diffuse BSDF into it, for both sides");
    };
    let inner = tree.resolved(inner)?;
    if tree.tag(inner) != "bsdf" || tree.kind(inner)? == "twosided" {
        return tree.refuse(inner, Refusal::Key, "this does not belong in \"twosided\"", "put a diffuse BSDF into it");
    }
    let own = tree.attribute(at, "id").map(String::from);
    let read = bsdf(tree, inner)?;
    Ok(Bsdf { name: own.unwrap_or(read.name), two_sided: true, ..read })
}
