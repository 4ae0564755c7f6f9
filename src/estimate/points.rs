//! What single points see of all patches, without a ray: closed forms past exact shadows.

use super::pairs::{Side, sides};
use crate::formfactor::{PointView, facing_point};
use crate::math::{Bounds, BoxTree, DVec3, Polytope, area};
use crate::raycast::{Between, Bodies, Shaft, bodies};
use crate::scene::{Region, Stage};

/// What reaches into a shaft by less than this share of the scene's extent touches it.
const TOUCHING: f64 = 1e-11;

/// Factors below this are the rounding of what shadows leave.
const NOTHING: f64 = 1e-14;

/// What a point sees of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Number of the patch.
    pub patch: u32,
    /// Form factor from the point with nothing between.
    pub open: f64,
    /// Form factor from the point to what is seen.
    pub seen: f64,
}

/// A stage, ready to be looked at from points: the exact value that a hemi-cube of infinite resolution would find.
pub struct PointSight<'a> {
    stage: &'a Stage,
    sides: Vec<Side>,
    bodies: Bodies,
    tree: BoxTree,
    touching: f64,
}

impl<'a> PointSight<'a> {
    /// Makes a stage ready.
    pub fn new(stage: &'a Stage) -> Self {
        let (lo, hi) = stage.bounds();
        let touching = TOUCHING * (hi - lo).length();
        let bodies = bodies(stage);
        let tree = BoxTree::new(bodies.list.iter().map(|b| Bounds::of(b.vertices()).grown(touching)).collect());
        Self { stage, sides: sides(stage), bodies, tree, touching }
    }

    /// All patches that `point` sees over the horizon of the unit vector `normal`, ascending.
    pub fn row(&self, point: DVec3, normal: DVec3) -> Vec<Sight> {
        self.row_of(point, normal, |_| true)
    }

    /// The same of the patches that `wanted` holds of.
    pub fn row_of(&self, point: DVec3, normal: DVec3, wanted: impl Fn(u32) -> bool) -> Vec<Sight> {
        let mut row = Vec::new();
        for side in self.sides.iter().filter(|s| s.patches.iter().any(|j| wanted(*j))) {
            self.see(point, normal, side, &wanted, &mut row);
        }
        row.sort_unstable_by_key(|s| s.patch);
        row
    }

    fn see(&self, point: DVec3, normal: DVec3, side: &Side, wanted: &impl Fn(u32) -> bool, row: &mut Vec<Sight>) {
        let Some(whole) = facing_point(point, normal, &side.polygon) else { return };
        let shaft = Shaft::from_point(point, normal, &whole, self.touching);
        let mut near = Vec::new();
        self.tree.near(&Bounds::of(&whole).joined(Bounds::of(&[point])), |k| near.push(k));
        near.retain(|k| self.bodies.of_facet[side.facet] != Some(*k));
        near.sort_unstable();
        let few: Vec<&Polytope> = match shaft.between(&self.bodies.list, near.into_iter()) {
            Between::Wall => return,
            Between::Nothing => Vec::new(),
            Between::Some(few) => few.iter().map(|k| &self.bodies.list[*k as usize]).collect(),
        };
        let mut view = PointView::new(point, normal, &whole, &few);
        for j in side.patches.iter().copied().filter(|j| wanted(*j)) {
            let (mut open, mut seen) = (0.0, 0.0);
            for piece in &self.stage.patches[j as usize].region.pieces {
                let (o, s) = view.factors(piece);
                open += o;
                seen += s;
            }
            if seen > NOTHING {
                row.push(Sight { patch: j, open, seen });
            }
        }
    }
}

/// Form factor from a point to a region with nothing between.
pub fn open_factor(point: DVec3, normal: DVec3, region: &Region) -> f64 {
    region.pieces.iter().map(|p| crate::formfactor::point_to_polygon(point, normal, p)).sum()
}

/// Mean form factor of a region to another with nothing between.
pub fn open_mean(from: &Region, to: &Region) -> f64 {
    let mut sum = 0.0;
    for a in &from.pieces {
        let size = area(a);
        sum += to.pieces.iter().map(|b| size * crate::formfactor::polygon_to_polygon(a, b)).sum::<f64>();
    }
    let whole = from.area();
    if whole > 0.0 { sum / whole } else { 0.0 }
}
