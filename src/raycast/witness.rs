//! Do two kernels see the same?

use super::{KernelInfo, RayBatch, RayKernel, plane_groups};
use crate::math::DVec3;
use crate::scene::{Facet, NO_FACET, Stage};
use serde::{Deserialize, Serialize};

/// Rays that pass an edge as near as this, in scene diagonals, are left out: single precision may see them on
/// either side.
const EDGE: f64 = 1e-5;

/// Disagreements that are kept for a replay.
const KEPT: usize = 5;

/// What came of tracing the same rays on two kernels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// The two kernels.
    pub kernels: [KernelInfo; 2],
    /// Rays traced on both.
    pub rays: u64,
    /// Share of them left out because they pass an edge of what they meet within 1e-5 of the scene's diagonal.
    pub near_edge: f64,
    /// Rays, of those not left out, that the kernels see end on different facets.
    pub disagreements: u64,
    /// The first few of them.
    pub first: Vec<Disagreement>,
}

/// A ray that two kernels see end on different facets.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Disagreement {
    /// Origin, metres.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Facet it starts on, [`NO_FACET`] for none.
    pub from: u32,
    /// What each kernel names, [`NO_FACET`] for an escape.
    pub facets: [u32; 2],
}

impl Agreement {
    /// True if no ray away from edges ends on different facets.
    pub fn holds(&self) -> bool {
        self.disagreements == 0
    }
}

/// Traces batches on two kernels and compares. Facets that coincide where a ray ends count as one.
pub fn agree(a: &dyn RayKernel, b: &dyn RayKernel, stage: &Stage, batches: &[RayBatch]) -> Agreement {
    let judge = Judge::new(stage);
    let (mut rays, mut left_out, mut disagreements, mut first) = (0, 0u64, 0, Vec::new());
    let (mut by_a, mut by_b) = (Vec::new(), Vec::new());
    for batch in batches {
        by_a.resize(batch.len(), NO_FACET);
        by_b.resize(batch.len(), NO_FACET);
        a.intersect(batch, &mut by_a);
        b.intersect(batch, &mut by_b);
        rays += batch.len() as u64;
        for k in 0..batch.len() {
            let ray = Disagreement {
                origin: batch.origin_of(k),
                direction: batch.direction_of(k),
                from: batch.from,
                facets: [by_a[k], by_b[k]],
            };
            match judge.judge(&ray) {
                Finding::Same => {}
                Finding::NearEdge => left_out += 1,
                Finding::Different => {
                    disagreements += 1;
                    first.extend((first.len() < KEPT).then_some(ray));
                }
            }
        }
    }
    let near_edge = if rays == 0 { 0.0 } else { left_out as f64 / rays as f64 };
    Agreement { kernels: [a.info().clone(), b.info().clone()], rays, near_edge, disagreements, first }
}

#[derive(Debug, PartialEq)]
enum Finding {
    Same,
    NearEdge,
    Different,
}

struct Judge<'a> {
    stage: &'a Stage,
    groups: Vec<u32>,
    edge: f64,
}

impl<'a> Judge<'a> {
    fn new(stage: &'a Stage) -> Self {
        let (lo, hi) = stage.bounds();
        Self { stage, groups: plane_groups(stage), edge: EDGE * (hi - lo).length() }
    }

    fn judge(&self, ray: &Disagreement) -> Finding {
        let hits = ray.facets.map(|f| self.stage.facets.get(f as usize));
        let near = |f: &Facet| passes_edge(f, ray) <= self.edge;
        if hits.iter().flatten().any(|f| near(f)) {
            return Finding::NearEdge;
        }
        match hits {
            _ if ray.facets[0] == ray.facets[1] => Finding::Same,
            [Some(a), Some(b)] if self.coincide(ray, a, b) => Finding::Same,
            [Some(a), Some(b)] if self.cross(ray, a, b) => Finding::NearEdge,
            _ => Finding::Different,
        }
    }

    /// Facets in one plane that both hold the end of the ray.
    fn coincide(&self, ray: &Disagreement, a: &Facet, b: &Facet) -> bool {
        let one_plane = self.groups[ray.facets[0] as usize] == self.groups[ray.facets[1] as usize];
        one_plane && inside(a, end_on(b, ray)) >= 0.0 && inside(b, end_on(a, ray)) >= 0.0
    }

    /// Facets that pass through one another where the ray ends: the line where they cross is an edge of both.
    fn cross(&self, ray: &Disagreement, a: &Facet, b: &Facet) -> bool {
        let steep = a.normal.cross(b.normal).length();
        let (on_a, on_b) = (end_on(a, ray), end_on(b, ray));
        let off_line = |p: DVec3, f: &Facet| (p - f.vertices[0]).dot(f.normal).abs() / steep;
        off_line(on_a, b) <= self.edge && off_line(on_b, a) <= self.edge && inside(b, on_a) >= -self.edge
    }
}

/// Distance at which a ray passes the nearest edge of a facet that it meets, metres. Where a ray grazes the facet
/// this is much less than the distance in the plane.
fn passes_edge(facet: &Facet, ray: &Disagreement) -> f64 {
    let (end, steep) = (end_on(facet, ray), ray.direction.dot(facet.normal).abs());
    let distances = edges(facet).map(|(a, along)| {
        let in_plane = facet.normal.cross(along).dot(end - a).abs();
        in_plane * steep / ray.direction.cross(along).length()
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// A corner and the unit direction to the next, all around.
fn edges(facet: &Facet) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    let v = &facet.vertices;
    v.iter().enumerate().map(|(k, a)| (*a, (v[(k + 1) % v.len()] - *a).normalize_or_zero()))
}

/// Where a ray meets the plane of a facet.
fn end_on(facet: &Facet, ray: &Disagreement) -> DVec3 {
    let t = (facet.vertices[0] - ray.origin).dot(facet.normal) / ray.direction.dot(facet.normal);
    ray.origin + ray.direction * t
}

/// Distance of a point in the plane of a facet from its nearest edge, metres; negative outside.
fn inside(facet: &Facet, point: DVec3) -> f64 {
    edges(facet).map(|(a, along)| facet.normal.cross(along).dot(point - a)).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raycast::BuiltinKernel;
    use crate::raycast::specimen::{Numbers, box_polygons, rays_from};

    fn room_with_plates() -> Stage {
        let mut polygons = box_polygons(DVec3::ZERO, DVec3::ONE, true);
        let plate = [(0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)].map(|(x, y)| DVec3::new(x, y, 0.5));
        polygons.push(plate.to_vec());
        polygons.push(plate.iter().rev().copied().collect());
        Stage::from_polygons(&polygons)
    }

    /// A kernel that takes one facet for another.
    struct Mistaken<'a>(&'a BuiltinKernel, u32, u32);

    impl RayKernel for Mistaken<'_> {
        fn info(&self) -> &KernelInfo {
            self.0.info()
        }
        fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
            self.0.intersect(rays, facets);
            facets.iter_mut().filter(|f| **f == self.1).for_each(|f| *f = self.2);
        }
    }

    fn judged(mistake: (u32, u32)) -> Agreement {
        let stage = room_with_plates();
        let kernel = BuiltinKernel::new(&stage);
        let batches: Vec<_> = (0..6).map(|f| rays_from(&stage, f, 2000, &mut Numbers::new(f.into()))).collect();
        agree(&kernel, &Mistaken(&kernel, mistake.0, mistake.1), &stage, &batches)
    }

    #[test]
    fn a_mistake_is_found_and_kept() {
        let wrong = judged((4, NO_FACET));
        assert!(wrong.disagreements > 500 && !wrong.holds());
        assert_eq!(wrong.first.len(), KEPT);
        assert!(wrong.first.iter().all(|d| d.facets == [4, NO_FACET]));
        assert!(!judged((4, 0)).holds());
        assert!(!judged((6, 5)).holds(), "another facet, but not where the ray ends");
    }

    #[test]
    fn two_sides_of_a_plate_are_one() {
        let swapped = judged((6, 7));
        assert!(swapped.holds(), "{swapped:?}");
        assert!(swapped.near_edge < 1e-3);
    }

    #[test]
    fn rays_near_an_edge_are_left_out() {
        let stage = room_with_plates();
        let judge = Judge::new(&stage);
        let ray =
            |x: f64| Disagreement { origin: DVec3::new(x, 0.5, 0.9), direction: DVec3::NEG_Z, from: 5, facets: [6, 4] };
        assert_eq!(judge.judge(&ray(0.2 + 1e-6)), Finding::NearEdge);
        assert_eq!(judge.judge(&ray(0.2 + 1e-4)), Finding::Different);
        assert_eq!(judge.judge(&Disagreement { facets: [6, 7], ..ray(0.5) }), Finding::Same);
    }
}
