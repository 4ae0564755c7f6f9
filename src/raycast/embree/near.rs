//! Which rays start so near to something that single precision may put them on its other side.

use crate::math::DVec3;
use crate::raycast::builtin::BuiltinKernel;
use crate::raycast::polygons::Polygons;
use crate::scene::{NO_FACET, Stage};

/// What surrounds each facet.
pub(super) struct Surroundings {
    /// Checks for rays that start on a facet; `None` where there are too many to do them all for every batch.
    of_facet: Vec<Option<Checks>>,
    reach: f64,
}

/// Tests that pick out origins close to something. Rows as in [`Polygons`], single precision.
#[derive(Debug, Clone, Default)]
pub(super) struct Checks {
    /// Edges of the facet itself; what lies beyond an edge is at least as far as the edge.
    edges: Vec<[f32; 4]>,
    /// Planes of polygons that rise over the facet, and their numbers.
    planes: Vec<([f32; 4], u32)>,
}

/// More neighbours than this are looked up batch by batch.
const FEW: usize = 24;

impl Surroundings {
    /// `reach` is the distance, metres, within which an origin counts as near.
    pub(super) fn new(stage: &Stage, exact: &BuiltinKernel, reach: f64) -> Self {
        let mut found = Vec::new();
        let of_facet = (0..stage.facets.len() as u32).map(|f| {
            neighbours(exact, &stage.facets[f as usize].vertices, f, reach, &mut found);
            (found.len() <= FEW).then(|| checks(stage, exact.polygons(), f, &found, reach))
        });
        Self { of_facet: of_facet.collect(), reach }
    }

    /// The checks for a batch whose origins lie in a box.
    pub(super) fn checks_for<'a>(
        &'a self,
        exact: &BuiltinKernel,
        from: u32,
        origins: impl FnOnce() -> [DVec3; 2],
        local: &'a mut Checks,
    ) -> &'a Checks {
        let known = if from == NO_FACET { None } else { self.of_facet[from as usize].as_ref() };
        known.unwrap_or_else(|| {
            let (mut found, corners) = (Vec::new(), corners_of(origins()));
            neighbours(exact, &corners, from, self.reach, &mut found);
            let planes = found.into_iter().map(|p| (exact.polygons().plane(p), p));
            let near = planes.filter(|(row, _)| comes_near(exact.polygons().span(row, &corners), self.reach));
            local.planes = near.map(|(row, p)| (single(row), p)).collect();
            local
        })
    }
}

impl Checks {
    /// True if there is nothing to check.
    pub(super) fn is_empty(&self) -> bool {
        self.edges.is_empty() && self.planes.is_empty()
    }

    /// Bit k is set if origin k of eight (from the scene's centre) is within reach of something.
    pub(super) fn near(&self, polygons: &Polygons, x: &[f32; 8], y: &[f32; 8], z: &[f32; 8], reach: f32) -> u32 {
        let mut near = 0;
        for row in &self.edges {
            near |= mask(&distances(row, x, y, z).map(|d| d < reach));
        }
        for (row, polygon) in &self.planes {
            let mut close = mask(&distances(row, x, y, z).map(|d| d.abs() < reach)) & !near;
            while close != 0 {
                let k = close.trailing_zeros() as usize;
                close &= close - 1;
                let at = DVec3::new(x[k].into(), y[k].into(), z[k].into());
                near |= u32::from(polygons.is_over(*polygon, at, reach.into())) << k;
            }
        }
        near
    }
}

#[inline]
fn distances(row: &[f32; 4], x: &[f32; 8], y: &[f32; 8], z: &[f32; 8]) -> [f32; 8] {
    std::array::from_fn(|k| distance(row, [x[k], y[k], z[k]]))
}

#[inline]
fn mask(lanes: &[bool; 8]) -> u32 {
    lanes.iter().enumerate().fold(0, |m, (k, lane)| m | u32::from(*lane) << k)
}

/// Distance of a point from the plane of a row.
#[inline]
pub(super) fn distance(row: &[f32; 4], [x, y, z]: [f32; 3]) -> f32 {
    row[0] * x + row[1] * y + row[2] * z + row[3]
}

/// A row in single precision.
pub(super) fn single(row: [f64; 4]) -> [f32; 4] {
    row.map(|c| c as f32)
}

/// Polygons whose boxes come within reach of the box around points, other than those in the plane of `from`.
fn neighbours(exact: &BuiltinKernel, points: &[DVec3], from: u32, reach: f64, found: &mut Vec<u32>) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = points.iter().fold(start, |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    exact.polygons_in_box(lo - reach, hi + reach, found);
    let own = exact.polygons().own_group(from);
    found.retain(|&p| exact.polygons().group_of(p) != own);
}

/// Sorts what is near a facet into what lies beyond one of its edges and what is over it.
fn checks(stage: &Stage, polygons: &Polygons, facet: u32, near: &[u32], reach: f64) -> Checks {
    let outline = polygons.outline(facet);
    let mut needed = vec![false; outline.len()];
    let mut checks = Checks::default();
    for &p in near {
        let corners = &stage.facets[polygons.facet_of(p) as usize].vertices;
        match outline.iter().position(|edge| polygons.is_beyond(edge, corners)) {
            Some(edge) => needed[edge] = true,
            None => checks.planes.push((single(polygons.plane(p)), p)),
        }
    }
    let own = &stage.facets[facet as usize].vertices;
    checks.planes.retain(|(_, p)| comes_near(polygons.span(&polygons.plane(*p), own), reach));
    checks.edges.extend(outline.iter().zip(needed).filter(|(_, n)| *n).map(|(row, _)| single(*row)));
    checks
}

fn comes_near((low, high): (f64, f64), reach: f64) -> bool {
    low <= reach && high >= -reach
}

/// The eight corners of a box.
fn corners_of([lo, hi]: [DVec3; 2]) -> [DVec3; 8] {
    std::array::from_fn(|k| {
        let pick = |bit: usize, l: f64, h: f64| if k & bit == 0 { l } else { h };
        DVec3::new(pick(1, lo.x, hi.x), pick(2, lo.y, hi.y), pick(4, lo.z, hi.z))
    })
}
