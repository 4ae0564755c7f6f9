//! Which keys a light of which kind has.

use super::check::{Check, Checked, known_names};
use super::error::Refusal;
use super::raw_look;
use std::ops::Range;
use toml::Spanned;

/// Kinds of light, each with the keys it may have.
const KINDS: [(&str, &[&str]); 6] = [
    ("point", &["position", "intensity", "distribution", "direction", "curve"]),
    ("parallel", &["direction", "irradiance"]),
    ("linear", &["from", "to", "intensity"]),
    ("area", &["polygon", "surface", "radiosity"]),
    ("polyhedron", &["faces", "surface", "object", "radiosity"]),
    ("sky", &["model", "radiance", "sun", "up"]),
];

/// The name of a light, or `light` with its number.
pub(super) fn name(check: Check, table: &raw_look::Light, number: usize) -> Checked<String> {
    table.name.as_ref().map_or(Ok(format!("light {number}")), |n| check.name("light name", n))
}

/// The kind must exist, and must have all keys that are there.
pub(super) fn kind(check: Check, table: &raw_look::Light) -> Checked<()> {
    let kind = table.kind.get_ref().as_str();
    let Some((_, allowed)) = KINDS.iter().find(|(k, _)| *k == kind) else {
        let message = format!("there is no type of light \"{}\"", kind.escape_debug());
        return check.refuse(Refusal::Key, table.kind.span(), message, known_names(kind, KINDS.map(|k| k.0)));
    };
    match keys(table).into_iter().find_map(|(key, span)| span.filter(|_| !allowed.contains(&key)).map(|s| (key, s))) {
        None => Ok(()),
        Some((key, span)) => {
            let message = format!("a light of type \"{kind}\" has no {key}");
            check.refuse(Refusal::Key, span, message, format!("it has {}", allowed.join(", ")))
        }
    }
}

type Place = Option<Range<usize>>;

fn keys(t: &raw_look::Light) -> [(&'static str, Place); 17] {
    fn at<T>(value: &Option<Spanned<T>>) -> Place {
        value.as_ref().map(Spanned::span)
    }
    [
        ("position", at(&t.position)),
        ("intensity", at(&t.intensity)),
        ("distribution", at(&t.distribution)),
        ("direction", at(&t.direction)),
        ("curve", at(&t.curve)),
        ("irradiance", at(&t.irradiance)),
        ("from", at(&t.from)),
        ("to", at(&t.to)),
        ("polygon", at(&t.polygon)),
        ("faces", at(&t.faces)),
        ("surface", at(&t.surface)),
        ("object", at(&t.object)),
        ("radiosity", at(&t.radiosity)),
        ("model", at(&t.model)),
        ("radiance", at(&t.radiance)),
        ("sun", at(&t.sun)),
        ("up", at(&t.up)),
    ]
}
