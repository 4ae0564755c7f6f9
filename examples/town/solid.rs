//! Polygons by object and material, and the bodies that are made of them.

use etalon::math::{DVec3, unit_normal};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Shorthand for a point or a direction, metres.
pub fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// All polygons, by object and material.
#[derive(Default)]
pub struct Solids {
    parts: BTreeMap<(String, String), Vec<Vec<DVec3>>>,
}

impl Solids {
    /// A polygon, turned so that its front looks along `towards`.
    pub fn face(&mut self, of: (&str, &str), mut corners: Vec<DVec3>, towards: DVec3) {
        if unit_normal(&corners).dot(towards) < 0.0 {
            corners.reverse();
        }
        self.parts.entry((of.0.to_string(), of.1.to_string())).or_default().push(corners);
    }

    /// The faces of a convex body, given by its corners and the numbers of the corners of each face.
    pub fn body(&mut self, of: (&str, &str), corners: &[DVec3], faces: &[&[usize]]) {
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        for face in faces {
            let polygon: Vec<_> = face.iter().map(|k| corners[*k]).collect();
            let out = polygon.iter().sum::<DVec3>() / polygon.len() as f64 - middle;
            self.face(of, polygon, out);
        }
    }

    /// A box between two corners; `open` leaves out the sides that look along -x, +x, -y, +y, -z, +z.
    pub fn cuboid(&mut self, of: (&str, &str), low: DVec3, high: DVec3, open: &[usize]) {
        let corner = |k: usize| {
            let pick = |bit: usize, a: f64, b: f64| if k >> bit & 1 == 0 { a } else { b };
            v(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
        };
        let corners: Vec<_> = (0..8).map(corner).collect();
        let sides: [&[usize]; 6] =
            [&[0, 2, 6, 4], &[1, 3, 7, 5], &[0, 1, 5, 4], &[2, 3, 7, 6], &[0, 1, 3, 2], &[4, 5, 7, 6]];
        let kept: Vec<_> = (0..6).filter(|k| !open.contains(k)).map(|k| sides[k]).collect();
        self.body(of, &corners, &kept);
    }

    /// A prism or frustum of `n` sides about an axis, without its ends where `caps` says so (start, end).
    pub fn prism(&mut self, of: (&str, &str), ends: [DVec3; 2], radii: [f64; 2], n: usize, caps: [bool; 2]) {
        let axis = (ends[1] - ends[0]).normalize();
        let (a, b) = axis.any_orthonormal_pair();
        let ring = |e: usize| {
            let at = move |k: usize| {
                let angle = std::f64::consts::TAU * (k as f64 + 0.5) / n as f64;
                ends[e] + (a * angle.cos() + b * angle.sin()) * radii[e]
            };
            (0..n).map(at).collect::<Vec<_>>()
        };
        let (low, high) = (ring(0), ring(1));
        for k in 0..n {
            let next = (k + 1) % n;
            let out = low[k] + low[next] - ends[0] * 2.0;
            self.face(of, vec![low[k], low[next], high[next], high[k]], out);
        }
        for (cap, (corners, towards)) in caps.into_iter().zip([(low, -axis), (high, axis)]) {
            if cap {
                self.face(of, corners, towards);
            }
        }
    }

    /// Polygons of an object and material.
    pub fn parts(&self) -> impl Iterator<Item = (&str, &str, &[Vec<DVec3>])> {
        self.parts.iter().map(|((object, material), faces)| (&**object, &**material, &**faces))
    }

    /// Number of polygons.
    pub fn count(&self) -> usize {
        self.parts.values().map(Vec::len).sum()
    }
}

/// Polygons as a Wavefront OBJ file; a common corner is written once.
pub fn obj(faces: &[Vec<DVec3>]) -> String {
    let (mut text, mut list, mut numbers) = (String::new(), String::new(), BTreeMap::new());
    for face in faces {
        list.push('f');
        for p in face {
            // Nanometres are enough, and corners that differ by rounding become one.
            let key = p.to_array().map(|c| (c * 1e9).round() as i64);
            let next = numbers.len() + 1;
            let number = *numbers.entry(key).or_insert_with(|| {
                let [x, y, z] = key.map(|c| c as f64 / 1e9);
                let _ = writeln!(text, "v {x} {y} {z}");
                next
            });
            let _ = write!(list, " {number}");
        }
        list.push('\n');
    }
    text + &list
}

/// Numbers in [0, 1), the same everywhere.
pub struct Dice(u64);

impl Dice {
    /// Dice with a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// The next number.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 * f64::powi(2.0, -53)
    }

    /// The next number between two.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}
