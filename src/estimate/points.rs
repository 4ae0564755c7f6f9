//! What single points see of all patches, without a ray: closed forms past exact shadows.

use super::pairs::{Side, sides};
use crate::formfactor::{Eye, Obstacle, Screen};
use crate::math::{DVec3, area};
use crate::raycast::bodies;
use crate::scene::{Region, Stage};

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
    sides: Vec<(Side, Screen)>,
    obstacles: Vec<Obstacle>,
    /// Body of each facet.
    of_facet: Vec<Option<u32>>,
    extent: f64,
}

impl<'a> PointSight<'a> {
    /// Makes a stage ready.
    pub fn new(stage: &'a Stage) -> Self {
        let (lo, hi) = stage.bounds();
        let bodies = bodies(stage);
        let screen = |s: Side| {
            let screen = Screen::new(&s.polygon);
            (s, screen)
        };
        Self {
            stage,
            sides: sides(stage).into_iter().map(screen).collect(),
            obstacles: bodies.list.into_iter().map(Obstacle::new).collect(),
            of_facet: bodies.of_facet,
            extent: (hi - lo).length(),
        }
    }

    /// All patches that a point of a facet sees over the horizon of the unit vector `normal`, ascending.
    pub fn row(&self, facet: u32, point: DVec3, normal: DVec3) -> Vec<Sight> {
        self.row_of(facet, point, normal, |_| true)
    }

    /// The same of the patches that `wanted` holds of.
    pub fn row_of(&self, facet: u32, point: DVec3, normal: DVec3, wanted: impl Fn(u32) -> bool) -> Vec<Sight> {
        // What has rounded corners may reach before its own plane: neither the body that the point stands on hides
        // anything, nor the one that is looked at.
        let body = |facet: usize| self.of_facet.get(facet).copied().flatten();
        let mut eye = Eye::new(point, normal, &self.obstacles, body(facet as usize), self.extent);
        let mut row = Vec::new();
        for (side, screen) in self.sides.iter().filter(|(s, _)| s.patches.iter().any(|j| wanted(*j))) {
            let Some(mut view) = eye.onto(screen, body(side.facet)) else { continue };
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
        row.sort_unstable_by_key(|s| s.patch);
        row
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
