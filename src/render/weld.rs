//! Finding the corners that are one vertex.

use super::Vertex;
use crate::math::DVec3;
use crate::scene::Stage;
use std::collections::HashMap;

/// Points closer than this share of the scene's diagonal are one vertex.
const SAME_POINT: f64 = 1e-7;
/// Cosine of the angle (half a degree) within which facets count as one surface: quadrilaterals that were split
/// because they are not quite planar stay smooth, every edge that is meant stays sharp.
const SAME_SURFACE: f64 = 0.999_962;

/// Collects vertices, cell by cell.
pub(super) struct Welder {
    tolerance: f64,
    vertices: Vec<Vertex>,
    /// Vertices by the box of space they lie in.
    boxes: HashMap<[i64; 3], Vec<u32>>,
}

impl Welder {
    pub(super) fn new(stage: &Stage) -> Self {
        let (low, high) = stage.bounds();
        let diagonal = (high - low).length();
        let tolerance = SAME_POINT * if diagonal.is_finite() && diagonal > 0.0 { diagonal } else { 1.0 };
        Self { tolerance, vertices: Vec::new(), boxes: HashMap::new() }
    }

    /// Vertices of a cell's corners, made where there are none yet.
    pub(super) fn join(&mut self, cell: u32, corners: &[DVec3], normal: DVec3, material: u32) -> Vec<u32> {
        let n = corners.len();
        let mut joined = Vec::with_capacity(n);
        for k in 0..n {
            let (before, at, after) = (corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
            let number = self.find(at, normal, material).unwrap_or_else(|| self.add(at, normal, material));
            let vertex = &mut self.vertices[number as usize];
            vertex.angle += (before - at).angle_between(after - at);
            if vertex.cells.last() != Some(&cell) {
                vertex.cells.push(cell);
            }
            joined.push(number);
        }
        joined
    }

    /// The vertices, once all cells have been joined, and the distance within which points are one.
    pub(super) fn vertices(self) -> (Vec<Vertex>, f64) {
        (self.vertices, self.tolerance)
    }

    fn find(&self, point: DVec3, normal: DVec3, material: u32) -> Option<u32> {
        let near = |v: &Vertex| v.point.distance(point) <= self.tolerance;
        let same = |v: &Vertex| same_surface(v, normal, material);
        let reach = DVec3::splat(self.tolerance);
        let (low, high) = (self.place(point - reach), self.place(point + reach));
        // Nearly always one box; a point by a wall of its box looks into the next one too.
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let listed = self.boxes.get(&[x, y, z]).map_or(&[][..], Vec::as_slice);
                    let fits = |i: &&u32| near(&self.vertices[**i as usize]) && same(&self.vertices[**i as usize]);
                    if let Some(i) = listed.iter().find(fits) {
                        return Some(*i);
                    }
                }
            }
        }
        None
    }

    fn add(&mut self, point: DVec3, normal: DVec3, material: u32) -> u32 {
        let number = self.vertices.len() as u32;
        self.vertices.push(Vertex { point, normal, material, cells: Vec::new(), angle: 0.0 });
        self.boxes.entry(self.place(point)).or_default().push(number);
        number
    }

    fn place(&self, p: DVec3) -> [i64; 3] {
        (p / (16.0 * self.tolerance)).floor().to_array().map(|x| x as i64)
    }
}

/// True if a vertex is on a surface that looks this way and is of this material.
pub(super) fn same_surface(vertex: &Vertex, normal: DVec3, material: u32) -> bool {
    vertex.material == material && vertex.normal.dot(normal) >= SAME_SURFACE
}
