//! Dividing a planar polygon into cells.

use super::Grid;
use crate::math::{Bilinear, DVec3, triangle_cell_corners};

/// A polygon with its grid, ready to give the corners of each cell.
pub(super) enum Divider<'a> {
    Quad(Bilinear, u32, u32),
    Triangle([DVec3; 3], u32),
    Whole(&'a [DVec3]),
}

impl<'a> Divider<'a> {
    /// A grid of one cell gives the polygon itself, bit for bit.
    pub(super) fn new(corners: &'a [DVec3], grid: Grid) -> Self {
        match (grid, corners) {
            (_, _) if grid.count() == 1 => Divider::Whole(corners),
            (Grid::Quad { na, nb }, [a, b, c, d]) => Divider::Quad(Bilinear::new([*a, *b, *c, *d]), na, nb),
            (Grid::Triangle { n }, [a, b, c]) => Divider::Triangle([*a, *b, *c], n),
            _ => Divider::Whole(corners),
        }
    }

    /// Corners of the cell in column `a` of row `b`, wound like the polygon.
    pub(super) fn corners(&self, a: u32, b: u32) -> Vec<DVec3> {
        match self {
            Divider::Quad(map, na, nb) => map.cell(a, b, *na, *nb).to_vec(),
            Divider::Triangle(t, n) => triangle_cell_corners(*t, *n, a, b).to_vec(),
            Divider::Whole(corners) => corners.to_vec(),
        }
    }
}

/// The loop seen from the other side, with the same first corner.
pub(super) fn reversed(mut corners: Vec<DVec3>) -> Vec<DVec3> {
    if let [_, rest @ ..] = corners.as_mut_slice() {
        rest.reverse();
    }
    corners
}
