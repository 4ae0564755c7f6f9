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

    /// All patches that a point of a facet sees over the horizon of the unit vector `normal`, ascending.
    pub fn row(&self, facet: u32, point: DVec3, normal: DVec3) -> Vec<Sight> {
        self.row_of(facet, point, normal, |_| true)
    }

    /// The same of the patches that `wanted` holds of.
    pub fn row_of(&self, facet: u32, point: DVec3, normal: DVec3, wanted: impl Fn(u32) -> bool) -> Vec<Sight> {
        let mut row = Vec::new();
        let own = self.bodies.of_facet.get(facet as usize).copied().flatten();
        for side in self.sides.iter().filter(|s| s.patches.iter().any(|j| wanted(*j))) {
            let Some(whole) = facing_point(point, normal, &side.polygon) else { continue };
            if let Some(few) = self.between(point, normal, own, side, &whole) {
                self.see(PointView::new(point, normal, &whole, &few), side, &wanted, &mut row);
            }
        }
        row.sort_unstable_by_key(|s| s.patch);
        row
    }

    /// The bodies that may stand between a point and a side; `None` where one stands before all of it.
    fn between(
        &self,
        point: DVec3,
        normal: DVec3,
        own: Option<u32>,
        side: &Side,
        whole: &[DVec3],
    ) -> Option<Vec<&Polytope>> {
        let mut near = Vec::new();
        self.tree.near(&Bounds::of(whole).joined(Bounds::of(&[point])), |k| near.push(k));
        // What has rounded corners may reach before its own plane.
        near.retain(|k| own != Some(*k) && self.bodies.of_facet[side.facet] != Some(*k));
        near.sort_unstable();
        let shaft = Shaft::from_point(point, normal, whole, self.touching);
        match shaft.between(&self.bodies.list, near.into_iter()) {
            Between::Wall => None,
            Between::Nothing => Some(Vec::new()),
            Between::Some(few) => Some(few.iter().map(|k| &self.bodies.list[*k as usize]).collect()),
        }
    }

    fn see(&self, mut view: PointView, side: &Side, wanted: &impl Fn(u32) -> bool, row: &mut Vec<Sight>) {
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
