//! What can cast shadows: opaque convex polygons, found by their boxes.

use crate::math::{Bounds, BoxTree, DVec3, Plane};

/// The number of no caster.
pub const NO_CASTER: u32 = u32::MAX;

/// Lengths below this share of the extent of all casters are rounding.
const ROUNDING: f64 = 1e-9;

/// Opaque convex polygons that can cast shadows, to both sides.
pub struct Casters {
    polygons: Vec<Vec<DVec3>>,
    pub(super) planes: Vec<Plane>,
    pub(super) tree: BoxTree,
    /// Heights below it are rounding, m.
    pub(super) slack: f64,
}

impl Casters {
    /// Polygons (corners in metres) by number: the position in the list. What has no area, or corners that are not
    /// finite, keeps its number and casts no shadow.
    pub fn new(polygons: Vec<Vec<DVec3>>) -> Self {
        let sound = |p: &Vec<DVec3>| p.len() >= 3 && p.iter().all(|v| v.is_finite());
        let planes: Vec<Plane> = polygons
            .iter()
            .map(|p| if sound(p) { Plane::of(p) } else { Plane { normal: DVec3::ZERO, offset: 0.0 } })
            .collect();
        let boxes: Vec<Bounds> = polygons.iter().map(|p| Bounds::of(p)).collect();
        let used = planes.iter().zip(&boxes).filter(|(p, _)| p.normal != DVec3::ZERO).map(|(_, b)| *b);
        let whole = used.fold(Bounds::NOTHING, Bounds::joined);
        let extent = (whole.hi - whole.lo).max(DVec3::ZERO).length();
        Self { polygons, planes, tree: BoxTree::new(boxes), slack: ROUNDING * extent }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.polygons.len()
    }

    /// Corners of caster number `i`; none of those that cast no shadow.
    pub(super) fn corners(&self, i: u32) -> &[DVec3] {
        let i = i as usize;
        if self.planes[i].normal == DVec3::ZERO { &[] } else { &self.polygons[i] }
    }
}
