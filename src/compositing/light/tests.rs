//! Lamps against closed forms, quadrature, and brute force that knows nothing of shadow volumes.

mod open;
mod penumbrae;
mod robust;
mod sharp;

use super::{Casters, Lamp, Volumes};
use crate::math::{Bounds, DVec3};
use crate::scene::{Light, LightShape, SkyModel};
use std::f64::consts::PI;

/// Numbers 0 to 1, the same in every run (a linear congruential generator, upper bits).
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    fn point(&mut self, lo: f64, hi: f64) -> DVec3 {
        DVec3::new(self.within(lo, hi), self.within(lo, hi), self.within(lo, hi))
    }

    fn direction(&mut self) -> DVec3 {
        let (z, phi) = (self.within(-1.0, 1.0), self.within(0.0, 2.0 * PI));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * phi.cos(), r * phi.sin(), z)
    }

    /// About a normal, by the cosine.
    fn cosine(&mut self, normal: DVec3) -> DVec3 {
        (normal + self.direction() * (1.0 - 1e-12)).normalize()
    }

    /// Triangles with sides of about `size` and middles in a cube.
    fn triangles(&mut self, count: usize, lo: DVec3, hi: DVec3, size: f64) -> Vec<Vec<DVec3>> {
        let mut one = || {
            let at = lo + (hi - lo) * self.point(0.0, 1.0);
            (0..3).map(|_| at + self.point(-size, size)).collect()
        };
        (0..count).map(|_| one()).collect()
    }
}

fn lamp(shape: LightShape) -> Lamp {
    Lamp::new(&Light { name: "lamp".into(), strength: vec![1.0], shape })
}

fn sky(model: SkyModel) -> Lamp {
    lamp(LightShape::Sky { model, up: DVec3::Z })
}

const CLEAR: SkyModel = SkyModel::Clear { sun: DVec3::new(0.48, 0.6, 0.64) };

fn rectangle(x: [f64; 2], y: [f64; 2], z: f64) -> Vec<DVec3> {
    [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])].map(|(x, y)| DVec3::new(x, y, z)).to_vec()
}

/// Faces of a box, counter-clockwise seen from outside: down, up, and the four walls.
fn cuboid(lo: DVec3, hi: DVec3) -> Vec<Vec<DVec3>> {
    let p = |k: usize| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().map(|f| f.iter().map(|k| p(*k)).collect()).collect()
}

/// All volumes of a lamp, nothing culled but what cannot matter anywhere in a large box.
fn volumes(lamp: &Lamp, polygons: &[Vec<DVec3>], reach: f64) -> Volumes {
    let receivers = Bounds { lo: DVec3::splat(-reach), hi: DVec3::splat(reach) };
    Volumes::new(lamp, &Casters::new(polygons.to_vec()), &receivers)
}

/// True if a polygon other than `own` stands between two points: triangle by triangle, by volumes of tetrahedra.
fn blocked(polygons: &[Vec<DVec3>], own: u32, from: DVec3, to: DVec3) -> bool {
    polygons.iter().enumerate().filter(|(k, _)| *k as u32 != own).any(|(_, p)| {
        (1..p.len() - 1).any(|k| {
            let [a, b, c] = [p[0] - from, p[k] - from, p[k + 1] - from];
            let way = to - from;
            let normal = (b - a).cross(c - a);
            let t = normal.dot(a) / normal.dot(way);
            let sides = [a.cross(b).dot(way), b.cross(c).dot(way), c.cross(a).dot(way)];
            let inside = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
            t > 1e-9 && t < 1.0 - 1e-9 && inside
        })
    })
}
