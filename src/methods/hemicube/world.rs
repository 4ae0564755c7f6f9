//! What a hemi-cube can see: every standing polygon once as a front, piece by piece, and once as a back.
//!
//! Fronts are drawn as the pieces of their region: what is in contact with another front neither radiates nor
//! receives. Backs are drawn whole: a back is opaque wherever its polygon is, and where the front before it is
//! covered, the polygon it is in contact with is drawn in the same place, with its own back.

use crate::math::{DVec3, area, centroid, unit_normal};
use crate::scene::{COINCIDENCE_TOLERANCE, Patch, Region, Stage};
use std::collections::HashMap;
use std::ops::Range;

/// A standing polygon.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    /// Number of its patch.
    pub patch: u32,
    /// Unit normal of its front.
    pub normal: DVec3,
    /// `normal . p` of its points.
    pub offset: f64,
    /// Loops of its front: the pieces that take part.
    pub fronts: Range<u32>,
    /// Loop of its back: the whole polygon.
    pub back: u32,
}

/// All standing polygons of a stage, with their corners stored once each.
#[derive(Debug, Clone)]
pub struct World {
    pub(super) vertices: Vec<DVec3>,
    pub(super) shapes: Vec<Shape>,
    /// Corner indices of all loops, end to end.
    corners: Vec<u32>,
    /// Loop k holds `corners[loops[k] .. loops[k + 1]]`.
    loops: Vec<u32>,
    /// Planes closer than this are one plane, as everywhere in a stage, metres.
    pub(super) coincident: f64,
    pub(super) patches: usize,
}

impl World {
    /// Gathers the polygons of a stage. Absent patches are left out.
    pub fn new(stage: &Stage) -> Self {
        let polygons = stage.patches.iter().map(|p| (p.corners.as_slice(), &p.region));
        Self::of(stage, polygons, stage.patches.len())
    }

    /// The same divided into elements: items are numbers of elements.
    pub fn of_elements(stage: &Stage) -> Self {
        let polygons = stage.elements.iter().map(|e| (e.corners.as_slice(), &e.region));
        Self::of(stage, polygons, stage.elements.len())
    }

    fn of<'a>(stage: &Stage, polygons: impl Iterator<Item = (&'a [DVec3], &'a Region)>, count: usize) -> Self {
        let mut builder = Builder::default();
        let standing = polygons.enumerate().filter(|(_, (corners, _))| corners.len() >= 3);
        let shapes = standing.map(|(number, (corners, region))| builder.shape(number, corners, region)).collect();
        let (lo, hi) = stage.bounds();
        Self {
            shapes,
            coincident: COINCIDENCE_TOLERANCE * lo.distance(hi),
            vertices: builder.vertices,
            corners: builder.corners,
            loops: builder.loops,
            patches: count,
        }
    }

    /// Corner indices of a loop.
    pub(super) fn corners(&self, which: u32) -> &[u32] {
        let k = which as usize;
        &self.corners[self.loops[k] as usize..self.loops[k + 1] as usize]
    }
}

/// Collects loops; equal corners get one number.
struct Builder {
    vertices: Vec<DVec3>,
    numbers: HashMap<[u64; 3], u32>,
    corners: Vec<u32>,
    loops: Vec<u32>,
}

impl Default for Builder {
    fn default() -> Self {
        Self { vertices: Vec::new(), numbers: HashMap::new(), corners: Vec::new(), loops: vec![0] }
    }
}

impl Builder {
    fn shape(&mut self, number: usize, corners: &[DVec3], region: &Region) -> Shape {
        let normal = unit_normal(corners);
        let back = self.add_loop(corners);
        let fronts = if region.pieces.len() == 1 && region.pieces[0] == corners {
            back..back + 1
        } else {
            let first = back + 1;
            region.pieces.iter().for_each(|piece| _ = self.add_loop(piece));
            first..self.loops.len() as u32 - 1
        };
        Shape { patch: number as u32, normal, offset: normal.dot(corners[0]), fronts, back }
    }

    fn add_loop(&mut self, polygon: &[DVec3]) -> u32 {
        for v in polygon {
            let number = self.vertex(*v);
            self.corners.push(number);
        }
        self.loops.push(self.corners.len() as u32);
        self.loops.len() as u32 - 2
    }

    fn vertex(&mut self, v: DVec3) -> u32 {
        // Adding zero turns -0 into 0, which is the same place.
        let key = (v + DVec3::ZERO).to_array().map(f64::to_bits);
        *self.numbers.entry(key).or_insert_with(|| {
            self.vertices.push(v);
            self.vertices.len() as u32 - 1
        })
    }
}

/// Where the hemi-cube of a patch stands: the mean of its corners (of a quadrilateral, the centre of the
/// bilinear map; of a polygon of five corners and more, its centre of area). Where that point is covered by
/// contact, the centre of area of the largest piece that is not. `None` for a patch that takes no part.
pub fn centre(patch: &Patch) -> Option<DVec3> {
    let largest = patch.region.pieces.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
    if !patch.is_present() {
        return None;
    }
    let corners = &patch.corners;
    let middle =
        if corners.len() <= 4 { corners.iter().sum::<DVec3>() / corners.len() as f64 } else { centroid(corners) };
    let uncovered = patch.region.pieces.iter().any(|piece| contains(piece, patch.normal, middle));
    Some(if uncovered { middle } else { centroid(largest) })
}

/// True if a point of the plane lies in a convex polygon or within rounding of its rim.
fn contains(polygon: &[DVec3], normal: DVec3, p: DVec3) -> bool {
    (0..polygon.len()).all(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        (b - a).cross(p - a).dot(normal) >= -1e-12 * (b - a).length_squared()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::NO_FACET;

    fn square(x0: f64, x1: f64) -> Vec<DVec3> {
        [(x0, 0.0), (x1, 0.0), (x1, 1.0), (x0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec()
    }

    fn patch(corners: Vec<DVec3>, pieces: Vec<Vec<DVec3>>) -> Patch {
        let region = Region { pieces };
        Patch {
            surface: 0,
            material: 0,
            facet: NO_FACET,
            a: 0,
            b: 0,
            normal: DVec3::Z,
            area: region.area(),
            corners,
            region,
            elements: 0..0,
        }
    }

    #[test]
    fn the_hemicube_stands_where_nothing_covers_it() {
        let whole = patch(square(0.0, 2.0), vec![square(0.0, 2.0)]);
        assert_eq!(centre(&whole), Some(DVec3::new(1.0, 0.5, 0.0)));
        let edge = patch(square(0.0, 2.0), vec![square(0.0, 1.0)]);
        assert_eq!(centre(&edge), Some(DVec3::new(1.0, 0.5, 0.0)));
        let covered = patch(square(0.0, 2.0), vec![square(0.0, 0.4), square(1.5, 2.0)]);
        assert_eq!(centre(&covered), Some(DVec3::new(1.75, 0.5, 0.0)));
        assert_eq!(centre(&patch(square(0.0, 2.0), vec![])), None);
    }

    #[test]
    fn a_pentagon_is_seen_from_its_centre_of_area() {
        let mut corners = square(0.0, 2.0);
        corners.insert(1, DVec3::new(1.9, 0.0, 0.0));
        let p = patch(corners.clone(), vec![corners]);
        assert!((centre(&p).unwrap() - DVec3::new(1.0, 0.5, 0.0)).length() < 1e-15);
    }
}
