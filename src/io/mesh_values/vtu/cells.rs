//! Cells of a grid as polygons. VTK's types of cells, by number.

use super::document::{Array, Document, Section};
use crate::io::FileError;
use roxmltree::Node;

const STRIP: u8 = 6;
const PIXEL: u8 = 8;
/// Most corners of a polygon.
const MAX_CORNERS: usize = 4096;

/// Cells of a piece.
pub(super) struct Cells {
    connectivity: Vec<usize>,
    /// End of each cell in the connectivity.
    ends: Vec<usize>,
    types: Vec<u8>,
}

/// Reads the cells; every number of a point is checked against `points`.
pub(super) fn read<'a>(document: &Document<'a>, piece: Node<'a, 'a>, points: usize) -> Result<Cells, FileError> {
    let count = document.count(piece, "NumberOfCells")?;
    let arrays = document.section(piece, Section::Cells)?;
    let find = |name: &str| match arrays.iter().find(|a| a.name == name) {
        Some(array) => Ok(array),
        None => document.refuse(piece, &format!("<Cells> has no array \"{name}\""), "save the grid with its cells"),
    };
    let (connectivity, offsets, types) = (find("connectivity")?, find("offsets")?, find("types")?);
    let types_read = wholes(document, types, Some(count), 256, "a type of cell")?;
    let numbers = wholes(document, connectivity, None, points, "a point")?;
    let ends = wholes(document, offsets, Some(count), numbers.len() + 1, "an end within the connectivity")?;
    if let Some(k) = (1..ends.len()).find(|k| ends[*k] < ends[k - 1]) {
        return document.refuse(
            offsets.node,
            &format!("the offset of cell {k} is less than the one before"),
            "sort them",
        );
    }
    Ok(Cells { connectivity: numbers, ends, types: types_read.into_iter().map(|t| t as u8).collect() })
}

/// Whole numbers below a limit.
fn wholes(
    document: &Document,
    array: &Array,
    count: Option<usize>,
    limit: usize,
    what: &str,
) -> Result<Vec<usize>, FileError> {
    let numbers = document.numbers(array, count)?;
    let wrong = numbers.iter().position(|v| !(*v >= 0.0 && v.fract() == 0.0 && *v < limit as f64));
    match wrong {
        None => Ok(numbers.into_iter().map(|v| v as usize).collect()),
        Some(k) => {
            let problem = format!("number {k} is {}, not {what}: 0 to {}", numbers[k], limit as f64 - 1.0);
            document.refuse(array.node, &problem, "numbers count from 0; is the type of the array right?")
        }
    }
}

impl Cells {
    /// Number of cells.
    pub(super) fn cells(&self) -> usize {
        self.ends.len()
    }

    /// Adds the polygons of a cell, counter-clockwise as the file has them. False for points and lines.
    pub(super) fn loops(
        &self,
        document: &Document,
        cell: usize,
        prefix: &str,
        out: &mut Vec<Vec<usize>>,
    ) -> Result<bool, FileError> {
        let start = if cell == 0 { 0 } else { self.ends[cell - 1] };
        let corners = &self.connectivity[start..self.ends[cell]];
        let kind = self.types[cell];
        let refuse = |problem: String, mend: &str| {
            Err(FileError::new(document.path, problem).at(format!("{prefix}cell {cell}")).mend(mend))
        };
        let (least, most) = match kind {
            0..=4 => return Ok(false),
            5 => (3, 3),
            STRIP | 7 => (3, MAX_CORNERS),
            PIXEL | 9 => (4, 4),
            _ => return refuse(format!("the cell is {}", name_of(kind)), mend_of(kind)),
        };
        if !(least..=most).contains(&corners.len()) {
            let problem = format!("{} with {} corners", name_of(kind), corners.len());
            return refuse(problem, "correct its offset or its type");
        }
        match kind {
            // Every other triangle of a strip runs the other way round.
            STRIP => out.extend((0..corners.len() - 2).map(|t| {
                let order = if t % 2 == 0 { [t, t + 1, t + 2] } else { [t + 1, t, t + 2] };
                order.map(|i| corners[i]).to_vec()
            })),
            PIXEL => out.push([0, 1, 3, 2].map(|i| corners[i]).to_vec()),
            _ => out.push(corners.to_vec()),
        }
        out.iter_mut().for_each(without_repeats);
        Ok(true)
    }
}

/// A corner written twice in a row is the same corner.
fn without_repeats(polygon: &mut Vec<usize>) {
    polygon.dedup();
    if polygon.len() > 1 && polygon.first() == polygon.last() {
        polygon.pop();
    }
}

fn name_of(kind: u8) -> &'static str {
    match kind {
        5 => "a triangle",
        STRIP => "a strip of triangles",
        7 => "a polygon",
        PIXEL => "a pixel",
        9 => "a quadrilateral",
        10 => "a tetrahedron",
        11 => "a voxel",
        12 => "a hexahedron",
        13 => "a wedge",
        14 => "a pyramid",
        15 | 16 => "a prism",
        42 => "a polyhedron",
        21..=37 => "of a curved kind",
        _ => "of a kind that is not read",
    }
}

fn mend_of(kind: u8) -> &'static str {
    match kind {
        10..=16 | 42 => "volumes do not radiate: extract the surface (ParaView: Extract Surface) and save that",
        _ => "save triangles, quadrilaterals or polygons with straight edges (ParaView: Tessellate)",
    }
}
