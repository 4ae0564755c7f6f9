//! Which properties of a PLY file are values: of faces or of vertices, as floats or as colours of few bits.

use super::header::{Element, Header};
use crate::io::scene::error::Refusal;
use crate::io::scene::mesh::keep::{Keep, band_names, coarse, stemmed};
use crate::io::scene::mesh::model::{At, MeshFault, fault, shown};

/// Properties that hold values where the user names none, most telling first.
const USUAL: [&[&str]; 8] = [
    &["r", "g", "b"],
    &["red", "green", "blue"],
    &["diffuse_red", "diffuse_green", "diffuse_blue"],
    &["radiosity"],
    &["quality"],
    &["value"],
    &["scalar"],
    &["y"],
];

/// The properties that are kept of each element of the header, with what their numbers are divided by.
#[derive(Default)]
pub(super) struct Kept {
    pub bands: Vec<String>,
    pub notice: Option<String>,
    places: Vec<Vec<(usize, f64)>>,
}

impl Kept {
    /// Number of values kept of an element.
    pub(super) fn width(&self, element: usize) -> usize {
        self.places.get(element).map_or(0, Vec::len)
    }

    /// Which value a property is, and what it is divided by.
    pub(super) fn slot(&self, element: usize, place: usize) -> Option<(usize, f64)> {
        let places = self.places.get(element)?;
        places.iter().enumerate().find(|(_, (p, _))| *p == place).map(|(slot, (_, full))| (slot, *full))
    }
}

/// Chooses the properties. Floats go before whole numbers, faces before vertices.
pub(super) fn choose(header: &Header, keep: Keep) -> Result<Kept, MeshFault> {
    let Keep::Values(fields) = keep else { return Ok(Kept::default()) };
    let find = |name: &str| header.elements.iter().position(|e| e.name == name);
    let (Some(face), Some(vertex)) = (find("face"), find("vertex")) else { return Ok(Kept::default()) };
    let (element, names) = match fields {
        Some(fields) => named(header, fields, [face, vertex])?,
        None => usual(header, [face, vertex])?,
    };
    let of = &header.elements[element];
    let places: Vec<(usize, f64)> = names
        .iter()
        .filter_map(|n| of.scalar(n))
        .map(|place| (place, of.properties[place].kind.full().unwrap_or(1.0)))
        .collect();
    let full = places.iter().map(|(_, full)| *full).fold(1.0, f64::max);
    let notice = (full > 1.0).then(|| coarse(&format!("the values of each {}", of.name), full));
    let mut all = vec![Vec::new(); header.elements.len()];
    all[element] = places;
    Ok(Kept { bands: band_names(&names), notice, places: all })
}

/// Names that may be values: not the coordinates of vertices.
fn candidates(element: &Element) -> impl Iterator<Item = &str> {
    let names = element.properties.iter().filter(|p| p.count.is_none()).map(|p| p.name.as_str());
    names.filter(|n| element.name != "vertex" || !matches!(*n, "x" | "y" | "z"))
}

fn all(header: &Header, elements: [usize; 2]) -> String {
    let of = |e: usize| {
        let names: Vec<String> = candidates(&header.elements[e]).map(shown).collect();
        let list = if names.is_empty() { "nothing".into() } else { names.join(", ") };
        format!("each {} has {list}", header.elements[e].name)
    };
    format!("{}; {}", of(elements[0]), of(elements[1]))
}

fn named(header: &Header, fields: &[String], elements: [usize; 2]) -> Result<(usize, Vec<String>), MeshFault> {
    let has = |e: usize, f: &String| candidates(&header.elements[e]).any(|n| n == f);
    if let Some(e) = elements.into_iter().find(|e| !fields.is_empty() && fields.iter().all(|f| has(*e, f))) {
        return Ok((e, fields.to_vec()));
    }
    let missing = fields.iter().find(|f| elements.iter().all(|e| !has(*e, f)));
    let message = match missing {
        Some(f) => format!("there is no property \"{}\" of faces or vertices", shown(f)),
        None => "no element has all the properties that were asked for".into(),
    };
    fault(header.elements[elements[0]].line, message, format!("name others (--fields): {}", all(header, elements)))
}

fn usual(header: &Header, elements: [usize; 2]) -> Result<(usize, Vec<String>), MeshFault> {
    for whole in [false, true] {
        for e in elements {
            let element = &header.elements[e];
            let fits = |name: &str| {
                let place = element.scalar(name).filter(|_| candidates(element).any(|n| n == name));
                place.is_some_and(|p| element.properties[p].kind.is_whole() == whole)
            };
            let own: Vec<String> = stemmed(candidates(element)).into_iter().filter(|n| fits(n)).collect();
            if !own.is_empty() {
                return Ok((e, own));
            }
            if let Some(names) = USUAL.iter().find(|names| names.iter().all(|n| fits(n))) {
                return Ok((e, names.iter().map(|n| n.to_string()).collect()));
            }
        }
    }
    let message = format!("no property holds values: {}", all(header, elements));
    MeshFault::new(At::File, message)
        .of(Refusal::Empty)
        .mend("write property float radiosity, or red, green and blue, or name the properties (--fields)")
}
