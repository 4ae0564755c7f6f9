//! Which facets lie in one plane.

use crate::math::DVec3;
use crate::scene::{Facet, Stage};
use std::collections::HashMap;

/// Two planes are one if their unit normals, and their distances from the scene's centre as a fraction of its
/// diagonal, differ by less than this. Far above rounding in coordinates, far below any modelled thickness.
const SAME_PLANE: f64 = 1e-9;

/// Cells of the look-up grid; so much wider than the tolerance that a plane rarely has to look next door.
const CELL: f64 = 1e-6;

/// Puts the cell borders where no tidy coordinate lies.
const OFF_GRID: f64 = 0.381_966 * CELL;

/// Number of the plane that each facet lies in, whichever way it faces. Numbers count up from 0 in the order
/// in which the facets first need them.
pub fn plane_groups(stage: &Stage) -> Vec<u32> {
    let (lo, hi) = stage.bounds();
    let (centre, diagonal) = ((lo + hi) * 0.5, (hi - lo).length());
    let mut planes = Planes::default();
    stage.facets.iter().map(|f| planes.number(plane_of(f, centre, diagonal))).collect()
}

/// Unit normal, one of the two, and distance from the centre along it in diagonals.
fn plane_of(facet: &Facet, centre: DVec3, diagonal: f64) -> [f64; 4] {
    let mean = facet.vertices.iter().sum::<DVec3>() / facet.vertices.len() as f64;
    let n = facet.normal * sense(facet.normal);
    [n.x, n.y, n.z, n.dot(mean - centre) / diagonal]
}

/// +1 or -1, so that opposite normals agree: the first component that is not small is made positive.
/// The bound is a number that no tidy normal has.
fn sense(n: DVec3) -> f64 {
    n.to_array().into_iter().find(|c| c.abs() > 0.437_129).map_or(1.0, f64::signum)
}

/// The planes met so far, by grid cell.
#[derive(Default)]
struct Planes {
    known: Vec<[f64; 4]>,
    cells: HashMap<[i64; 4], Vec<u32>>,
}

impl Planes {
    fn number(&mut self, plane: [f64; 4]) -> u32 {
        let same = |k: &u32| self.known[*k as usize].iter().zip(plane).all(|(a, b)| (a - b).abs() <= SAME_PLANE);
        let found = cells_near(plane).into_iter().filter_map(|c| self.cells.get(&c)).flatten().copied().find(same);
        found.unwrap_or_else(|| {
            let number = self.known.len() as u32;
            self.known.push(plane);
            self.cells.entry(plane.map(cell)).or_default().push(number);
            number
        })
    }
}

fn cell(x: f64) -> i64 {
    ((x + OFF_GRID) / CELL).floor() as i64
}

/// The cells that planes equal to this one can be in: one, unless it lies within the tolerance of a border.
fn cells_near(plane: [f64; 4]) -> Vec<[i64; 4]> {
    let mut cells = vec![[0; 4]];
    for axis in 0..4 {
        let (low, high) = (cell(plane[axis] - SAME_PLANE), cell(plane[axis] + SAME_PLANE));
        let copies = if low == high { 1 } else { 2 };
        let base = std::mem::take(&mut cells);
        for side in [low, high].into_iter().take(copies) {
            cells.extend(base.iter().map(|c| {
                let mut c = *c;
                c[axis] = side;
                c
            }));
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raycast::specimen::{box_polygons, rotated};

    #[test]
    fn a_box_has_six_planes_at_any_angle() {
        for turn in 0..40 {
            let mut polygons = box_polygons(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), true);
            // The floor once more, facing down, in two halves.
            for x in [0.0, 1.5] {
                let a = DVec3::new(x, 0.0, 0.0);
                polygons.push(vec![a, a + DVec3::Y * 2.0, a + DVec3::new(1.5, 2.0, 0.0), a + DVec3::X * 1.5]);
            }
            let floor = polygons.iter().position(|p| p.iter().all(|v| v.z == 0.0)).unwrap();
            let axis = DVec3::new(1.0, 0.3 * f64::from(turn), 0.7).normalize();
            let groups = plane_groups(&Stage::from_polygons(&rotated(&polygons, axis, 0.1 * f64::from(turn))));
            assert_eq!(groups[..6], [0, 1, 2, 3, 4, 5]);
            assert_eq!(groups[6..], [floor as u32; 2], "turn {turn}");
        }
    }

    #[test]
    fn a_thin_sheet_has_two_sides() {
        let polygons = box_polygons(DVec3::ZERO, DVec3::new(1.0, 1.0, 1e-7), false);
        let groups = plane_groups(&Stage::from_polygons(&polygons));
        assert_eq!(groups.iter().max(), Some(&5));
    }
}
