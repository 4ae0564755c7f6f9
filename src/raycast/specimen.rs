//! Geometry and rays made in code: what the self-test, the benchmark and the tests trace.

use super::RayBatch;
use crate::math::{DMat3, DVec3, Frame, unit_normal};
use crate::scene::Stage;

/// A small generator of reproducible numbers (SplitMix64). Not for results: those have streams of their own.
#[derive(Debug, Clone)]
pub struct Numbers(u64);

impl Numbers {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number, in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (0.5f64).powi(53)
    }

    /// The next number, in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A point in a box.
    pub fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        DVec3::new(self.between(low.x, high.x), self.between(low.y, high.y), self.between(low.z, high.z))
    }

    /// A direction, all alike.
    pub fn direction(&mut self) -> DVec3 {
        let (z, turn) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    }
}

/// The six faces of a box: low x, high x, low y, high y, low z, high z. A room faces inward.
pub fn box_polygons(low: DVec3, high: DVec3, room: bool) -> Vec<Vec<DVec3>> {
    let corner = |k: usize| {
        DVec3::new(
            if k & 1 == 0 { low.x } else { high.x },
            if k & 2 == 0 { low.y } else { high.y },
            if k & 4 == 0 { low.z } else { high.z },
        )
    };
    let inward = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    inward
        .into_iter()
        .map(|face| {
            let mut polygon: Vec<DVec3> = face.into_iter().map(corner).collect();
            if !room {
                polygon.reverse();
            }
            polygon
        })
        .collect()
}

/// Every polygon turned about the origin.
pub fn rotated(polygons: &[Vec<DVec3>], axis: DVec3, angle: f64) -> Vec<Vec<DVec3>> {
    let m = DMat3::from_axis_angle(axis, angle);
    polygons.iter().map(|p| p.iter().map(|v| m * *v).collect()).collect()
}

/// Every quadrilateral cut into `na` x `nb`, and each of those into two triangles.
pub fn tessellated(quads: &[Vec<DVec3>], na: u32, nb: u32) -> Vec<Vec<DVec3>> {
    let mut triangles = Vec::new();
    for q in quads {
        let map = crate::math::Bilinear::new([q[0], q[1], q[2], q[3]]);
        for cell in (0..na * nb).map(|k| map.cell(k % na, k / na, na, nb)) {
            triangles.push(vec![cell[0], cell[1], cell[2]]);
            triangles.push(vec![cell[0], cell[2], cell[3]]);
        }
    }
    triangles
}

/// A closed bumpy ball about the origin, radius about 1, faces outward (or inward): `12 n^2` triangles.
pub fn bumpy_ball(n: u32, inward: bool) -> Vec<Vec<DVec3>> {
    let cube = tessellated(&box_polygons(DVec3::NEG_ONE, DVec3::ONE, inward), n, n);
    let bump = |v: DVec3| {
        let u = v.normalize();
        u * (1.0 + 0.05 * (7.0 * u.x).sin() * (5.0 * u.y + 1.0).cos() * (6.0 * u.z).sin())
    };
    cube.iter().map(|p| p.iter().map(|v| bump(*v)).collect()).collect()
}

/// `count` boxes at random places and angles inside a room of the given size, faces outward; they may overlap.
pub fn clutter(room: DVec3, count: usize, numbers: &mut Numbers) -> Vec<Vec<DVec3>> {
    let mut polygons = box_polygons(DVec3::ZERO, room, true);
    for _ in 0..count {
        let half = numbers.point(DVec3::splat(0.02), DVec3::splat(0.1)) * room.min_element();
        let (axis, angle) = (numbers.direction(), numbers.between(0.0, 3.0));
        let reach = half.length();
        let centre = numbers.point(DVec3::splat(reach), room - DVec3::splat(reach));
        let faces = rotated(&box_polygons(-half, half, false), axis, angle);
        polygons.extend(faces.iter().map(|p| p.iter().map(|v| *v + centre).collect()));
    }
    polygons
}

/// `n` rays from random points of a facet, cosine-distributed about its normal.
pub fn rays_from(stage: &Stage, facet: u32, n: usize, numbers: &mut Numbers) -> RayBatch {
    let polygon = &stage.facets[facet as usize].vertices;
    let frame = Frame::with_x_axis(unit_normal(polygon), polygon[1] - polygon[0]);
    let mut rays = RayBatch::zeroed(n);
    rays.from = facet;
    for k in 0..n {
        rays.set(k, point_on(polygon, numbers), frame.to_world(cosine(numbers)));
    }
    rays
}

/// A random point of a convex polygon: some triangle of its fan, chosen evenly, and even within it.
fn point_on(polygon: &[DVec3], numbers: &mut Numbers) -> DVec3 {
    let fan = 1 + (numbers.unit() * (polygon.len() - 2) as f64) as usize;
    let (mut a, mut b) = (numbers.unit(), numbers.unit());
    if a + b > 1.0 {
        (a, b) = (1.0 - a, 1.0 - b);
    }
    polygon[0] + (polygon[fan] - polygon[0]) * a + (polygon[fan + 1] - polygon[0]) * b
}

fn cosine(numbers: &mut Numbers) -> DVec3 {
    let (r2, turn) = (numbers.unit(), numbers.between(0.0, std::f64::consts::TAU));
    let r = r2.sqrt();
    DVec3::new(r * turn.cos(), r * turn.sin(), (1.0 - r2).sqrt())
}
