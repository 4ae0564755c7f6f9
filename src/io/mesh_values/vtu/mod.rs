//! VTK's unstructured grids in XML (`.vtu`): cells with values per cell or per point.

mod blocks;
mod cells;
mod choose;
mod document;
mod numbers;
mod write;

pub use write::write_vtu;

use super::laying::Laying;
use super::{MeshValuesOptions, bytes_of, shown};
use crate::io::FileError;
use crate::math::DVec3;
use crate::solution::{MeshValues, ValuesPer};
use choose::Choice;
use document::{Document, Section};
use std::path::Path;

/// Reads a grid of polygons.
pub(super) fn read(path: &Path, options: &MeshValuesOptions) -> Result<MeshValues, FileError> {
    let bytes = bytes_of(path)?;
    let parts = document::split(path, &bytes)?;
    let xml = document::parse(path, &parts.xml)?;
    let document = Document::new(path, &xml, parts.appended)?;
    let pieces = document.pieces()?;
    let mut notices = Vec::new();
    let mut laying: Option<(Laying, Choice)> = None;
    for (number, piece) in pieces.iter().enumerate() {
        let prefix = if pieces.len() > 1 { format!("piece {number}, ") } else { String::new() };
        let choice = choose::choose(&document, *piece, options.fields.as_deref())?;
        let (laying, first) = laying.get_or_insert_with(|| {
            notices.extend(choice.notice.clone());
            (Laying::new(path, options, false, choice.bands.clone(), choice.per), choice.clone())
        });
        if (&first.bands, first.per) != (&choice.bands, choice.per) {
            return document.refuse(*piece, "the pieces have different arrays", "give every piece the same ones");
        }
        let thin = one_piece(&document, *piece, &choice, laying, &prefix)?;
        if thin > 0 {
            notices.push(format!("{prefix}{thin} points and lines were left out"));
        }
    }
    match laying {
        Some((laying, _)) => laying.finish(notices),
        None => Err(FileError::new(path, "has no <Piece>").mend("save an unstructured grid with cells")),
    }
}

/// Adds the cells of a piece; returns how many were points and lines.
fn one_piece(
    document: &Document,
    piece: roxmltree::Node,
    choice: &Choice,
    laying: &mut Laying,
    prefix: &str,
) -> Result<usize, FileError> {
    let points = points(document, piece)?;
    let grid = cells::read(document, piece, points.len())?;
    let count = if choice.per == ValuesPer::Face { grid.cells() } else { points.len() };
    let values = values(document, choice, count)?;
    let width = choice.bands.len();
    let of = |number: usize| &values[number * width..(number + 1) * width];
    let mut thin = 0;
    let mut loops = Vec::new();
    for cell in 0..grid.cells() {
        loops.clear();
        if !grid.loops(document, cell, prefix, &mut loops)? {
            thin += 1;
            continue;
        }
        let place = || format!("{prefix}cell {cell}");
        for polygon in &loops {
            let corners: Vec<DVec3> = polygon.iter().map(|i| points[*i]).collect();
            let own: Vec<f64> = match choice.per {
                ValuesPer::Face => of(cell).to_vec(),
                ValuesPer::Corner => polygon.iter().flat_map(|i| of(*i)).copied().collect(),
            };
            if let Some(k) = own.iter().position(|v| !v.is_finite()) {
                let problem = format!("the value of {} is {}", shown(&choice.bands[k % width]), own[k]);
                return Err(FileError::new(document.path, problem)
                    .at(place())
                    .mend("give finite numbers, or leave cells without a value out of the file"));
            }
            laying.add(&corners, &own, place)?;
        }
    }
    Ok(thin)
}

fn points(document: &Document, piece: roxmltree::Node) -> Result<Vec<DVec3>, FileError> {
    let array = document.section(piece, Section::Points)?.into_iter().next();
    let Some(array) = array else {
        return document.refuse(piece, "the piece has no <Points>", "save the grid with its points");
    };
    let count = document.count(piece, "NumberOfPoints")?;
    if array.components != 3 {
        let problem = format!("points of {} numbers", array.components);
        return document.refuse(array.node, &problem, "give x, y and z");
    }
    let numbers = document.numbers(&array, Some(count.saturating_mul(3)))?;
    Ok(numbers.chunks_exact(3).map(|p| DVec3::new(p[0], p[1], p[2])).collect())
}

/// Values of the chosen arrays, interleaved: all bands of one cell or point, then the next.
fn values(document: &Document, choice: &Choice, count: usize) -> Result<Vec<f64>, FileError> {
    let width = choice.bands.len();
    let mut out = vec![0.0; count * width];
    let mut band = 0;
    for array in &choice.arrays {
        let numbers = document.numbers(array, Some(count.saturating_mul(array.components)))?;
        for (item, values) in numbers.chunks_exact(array.components).enumerate() {
            out[item * width + band..][..array.components].copy_from_slice(values);
        }
        band += array.components;
    }
    Ok(out)
}
