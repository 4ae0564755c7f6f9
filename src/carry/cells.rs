//! A convex polygon divided by which faces cover which part of it.

use crate::math::{Bounds, DVec3, area, clip_to_half_space, intersect_convex, subtract_convex};

/// Faces for which a polygon is divided at once; where there are more, it is halved first, so that the work grows
/// with the number of faces and not with its square.
const AT_ONCE: usize = 12;

/// A face laid into the plane of the polygon.
#[derive(Debug, Clone)]
pub(super) struct Flat {
    /// Number of the piece it comes from.
    pub facelet: u32,
    /// Convex loop in the plane of the polygon.
    pub polygon: Vec<DVec3>,
    /// Box of the part of it that meets the polygon, with room for rounding.
    pub bounds: Bounds,
}

/// A convex part of the polygon and the faces that cover all of it; none where nothing does.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub polygon: Vec<DVec3>,
    pub facelets: Vec<u32>,
}

/// Divides a convex polygon. What is smaller than `dust`, m^2, is rounding.
pub(super) fn divide(polygon: Vec<DVec3>, flats: &[Flat], dust: f64) -> Vec<Cell> {
    let bounds = Bounds::of(&polygon);
    let here: Vec<&Flat> = flats.iter().filter(|f| f.bounds.meets(&bounds)).collect();
    let mut cells = Vec::new();
    halve(polygon, here, dust, &mut cells);
    cells
}

fn halve(polygon: Vec<DVec3>, flats: Vec<&Flat>, dust: f64, cells: &mut Vec<Cell>) {
    if flats.len() <= AT_ONCE {
        cells.extend(cut(polygon, &flats, dust));
        return;
    }
    let bounds = Bounds::of(&polygon);
    let axis = (bounds.hi - bounds.lo).max_position();
    let mut middles: Vec<f64> = flats.iter().map(|f| 0.5 * (f.bounds.lo[axis] + f.bounds.hi[axis])).collect();
    let half = middles.len() / 2;
    let at = *middles.select_nth_unstable_by(half, f64::total_cmp).1;
    let (below, above): (Vec<&Flat>, Vec<&Flat>) = (
        flats.iter().filter(|f| f.bounds.lo[axis] < at).copied().collect(),
        flats.iter().filter(|f| f.bounds.hi[axis] > at).copied().collect(),
    );
    // Faces that all lie on top of one another cannot be told apart by halving.
    if below.len().max(above.len()) * 8 > flats.len() * 7 {
        cells.extend(cut(polygon, &flats, dust));
        return;
    }
    let direction = DVec3::AXES[axis];
    for (side, flats) in [(-1.0, below), (1.0, above)] {
        let part = clip_to_half_space(&polygon, direction * side, at * side);
        if part.len() >= 3 && area(&part) > dust {
            halve(part, flats, dust, cells);
        }
    }
}

/// Cuts by one face after the other.
fn cut(polygon: Vec<DVec3>, flats: &[&Flat], dust: f64) -> Vec<Cell> {
    let mut cells = vec![Cell { polygon, facelets: Vec::new() }];
    for flat in flats {
        let mut next = Vec::with_capacity(cells.len() + 2);
        for cell in cells {
            cut_cell(cell, flat, dust, &mut next);
        }
        cells = next;
    }
    cells
}

fn cut_cell(cell: Cell, flat: &Flat, dust: f64, next: &mut Vec<Cell>) {
    if !Bounds::of(&cell.polygon).meets(&flat.bounds) {
        next.push(cell);
        return;
    }
    let inside = intersect_convex(&cell.polygon, &flat.polygon);
    if inside.len() < 3 || area(&inside) <= dust {
        next.push(cell);
        return;
    }
    let outside = subtract_convex(&cell.polygon, &flat.polygon).into_iter().filter(|p| area(p) > dust);
    next.extend(outside.map(|polygon| Cell { polygon, facelets: cell.facelets.clone() }));
    let mut facelets = cell.facelets;
    facelets.push(flat.facelet);
    next.push(Cell { polygon: inside, facelets });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, size: f64) -> Vec<DVec3> {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(a, b)| DVec3::new(x + size * a, y + size * b, 0.0))
            .to_vec()
    }

    fn flat(facelet: u32, polygon: Vec<DVec3>) -> Flat {
        Flat { facelet, bounds: Bounds::of(&polygon), polygon }
    }

    fn area_where(cells: &[Cell], count: usize) -> f64 {
        cells.iter().filter(|c| c.facelets.len() == count).map(|c| area(&c.polygon)).sum()
    }

    #[test]
    fn parts_are_told_apart_by_who_covers_them() {
        let cells =
            divide(square(0.0, 0.0, 3.0), &[flat(0, square(0.0, 0.0, 2.0)), flat(1, square(1.0, 1.0, 2.0))], 0.0);
        assert!((area_where(&cells, 0) - 2.0).abs() < 1e-14);
        assert!((area_where(&cells, 1) - 6.0).abs() < 1e-14);
        assert!((area_where(&cells, 2) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn many_faces_are_divided_like_few() {
        let grid: Vec<Flat> = (0..2500).map(|k| flat(k, square(f64::from(k % 50), f64::from(k / 50), 1.0))).collect();
        let cells = divide(square(0.0, 0.0, 60.0), &grid, 1e-12);
        assert!((area_where(&cells, 1) - 2500.0).abs() < 1e-9);
        assert!((area_where(&cells, 0) - 1100.0).abs() < 1e-9);
        // Two sheets, one on top of the other.
        let twice: Vec<Flat> = grid.iter().chain(&grid).cloned().collect();
        assert!((area_where(&divide(square(0.0, 0.0, 50.0), &twice, 1e-12), 2) - 2500.0).abs() < 1e-9);
        let stack: Vec<Flat> = (0..40).map(|k| flat(k, square(0.0, 0.0, 1.0))).collect();
        assert_eq!(divide(square(0.0, 0.0, 1.0), &stack, 1e-12).len(), 1);
    }
}
