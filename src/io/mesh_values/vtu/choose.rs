//! Which arrays of a grid are values.

use super::document::{Array, Document, Section};
use crate::io::FileError;
use crate::io::mesh_values::shown;
use crate::io::scene::mesh::{band_names, stemmed};
use crate::solution::ValuesPer;
use roxmltree::Node;

/// Arrays that hold values where the user names none, most telling first; one array may hold all bands.
const USUAL: [&[&str]; 8] = [
    &["radiosity"],
    &["r", "g", "b"],
    &["red", "green", "blue"],
    &["R", "G", "B"],
    &["B"],
    &["value"],
    &["quality"],
    &["y"],
];

/// The arrays chosen.
#[derive(Clone)]
pub(super) struct Choice<'a> {
    pub arrays: Vec<Array<'a>>,
    pub per: ValuesPer,
    pub bands: Vec<String>,
    pub notice: Option<String>,
}

const SECTIONS: [(Section, ValuesPer); 2] =
    [(Section::CellData, ValuesPer::Face), (Section::PointData, ValuesPer::Corner)];

/// Chooses the arrays of a piece: those named, the usual ones, or the only one of floats. Cells go before points.
pub(super) fn choose<'a>(
    document: &Document<'a>,
    piece: Node<'a, 'a>,
    fields: Option<&[String]>,
) -> Result<Choice<'a>, FileError> {
    let mut all = Vec::new();
    for (section, per) in SECTIONS {
        all.push((document.section(piece, section)?, per, section));
    }
    for (arrays, per, _) in &all {
        let names = match fields {
            Some(fields) => Some(fields.to_vec()),
            None => usual(arrays),
        };
        if let Some(found) = names.and_then(|names| pick(arrays, &names)) {
            return Ok(Choice { bands: bands(&found), arrays: found, per: *per, notice: None });
        }
    }
    let floats = all.iter().flat_map(|(arrays, per, _)| arrays.iter().map(move |a| (a, *per)));
    let floats: Vec<_> = floats.filter(|(a, _)| a.kind.is_float()).collect();
    if let ([(only, per)], None) = (floats.as_slice(), fields) {
        let arrays = vec![(*only).clone()];
        let notice = Some(format!("the only array of floats, \"{}\", is taken for the values", shown(&only.name)));
        return Ok(Choice { bands: bands(&arrays), arrays, per: *per, notice });
    }
    let list = |arrays: &[Array]| match arrays {
        [] => "nothing".to_string(),
        _ => arrays.iter().map(|a| shown(&a.name)).collect::<Vec<_>>().join(", "),
    };
    let there: Vec<String> = all.iter().map(|(arrays, _, s)| format!("{} has {}", s.tag(), list(arrays))).collect();
    let problem = match fields {
        Some(fields) => format!("no section has the arrays {}", shown(&fields.join(", "))),
        None => "it is not plain which arrays are the values".into(),
    };
    document.refuse(piece, &problem, &format!("name them (--fields): {}", there.join("; ")))
}

fn pick<'a>(arrays: &[Array<'a>], names: &[String]) -> Option<Vec<Array<'a>>> {
    let find = |n: &String| arrays.iter().find(|a| a.name == *n).cloned();
    let found: Vec<Array> = names.iter().map(find).collect::<Option<_>>()?;
    // Bands in arrays of their own are single numbers each.
    (!found.is_empty() && (found.len() == 1 || found.iter().all(|a| a.components == 1))).then_some(found)
}

fn usual(arrays: &[Array]) -> Option<Vec<String>> {
    let own = stemmed(arrays.iter().map(|a| a.name.as_str()));
    if !own.is_empty() {
        return Some(own);
    }
    let has = |n: &&str| arrays.iter().any(|a| a.name == **n);
    let names = USUAL.iter().find(|names| names.iter().all(has))?;
    Some(names.iter().map(|n| n.to_string()).collect())
}

/// Names of the bands: three components are red, green and blue.
fn bands(arrays: &[Array]) -> Vec<String> {
    match arrays {
        [one] if one.components == 3 => ["r", "g", "b"].map(String::from).to_vec(),
        [one] if one.components > 1 => (0..one.components).map(|k| format!("{}_{k}", one.name)).collect(),
        _ => band_names(&arrays.iter().map(|a| a.name.clone()).collect::<Vec<_>>()),
    }
}
