//! Images of random faces for the tests of this module.

use super::image::{Cluster, SpanFace, SpanImage};
use super::scan::scanned;
use crate::math::DVec3;
use crate::scene::{Appearance, Material};
use crate::view::{Camera, Photometry};

/// Numbers in [0, 1) from a seed: a multiplicative congruential generator, sharing nothing with the library's streams.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 * f64::powi(2.0, -53)
    }

    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub(super) fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        DVec3::new(self.within(low.x, high.x), self.within(low.y, high.y), self.within(low.z, high.z))
    }
}

pub(super) fn camera(size: [u32; 2]) -> Camera {
    Camera { name: "c".into(), eye: DVec3::ZERO, target: DVec3::Y, up: DVec3::Z, fov: 60.0, size }
}

/// Grey faces, every third of one cluster of `clusters`, without lights.
pub(super) fn outset(polygons: Vec<Vec<DVec3>>, clusters: u32, size: [u32; 2], per_line: u32) -> SpanImage {
    let face = |(k, vertices): (usize, Vec<DVec3>)| SpanFace {
        key: ("s".into(), k as u32),
        vertices,
        material: 0,
        cluster: k as u32 % clusters,
        two_sided: true,
        tree: None,
    };
    SpanImage {
        camera: camera(size),
        per_line,
        photometry: Photometry::rec709(),
        materials: vec![Material { name: "grey".into(), reflectance: vec![0.5; 3], emission: vec![0.0; 3] }],
        clusters: (0..clusters)
            .map(|k| Cluster { name: format!("c{k}"), objects: vec![], hash: String::new() })
            .collect(),
        faces: polygons.into_iter().enumerate().map(face).collect(),
        appearance: Appearance::default(),
        lines: Vec::new(),
    }
}

/// The same with its lines.
pub(super) fn image(polygons: Vec<Vec<DVec3>>, clusters: u32, size: [u32; 2], per_line: u32) -> SpanImage {
    scanned(outset(polygons, clusters, size, per_line))
}

/// The part of an image's faces that belongs to one cluster, scanned by itself.
pub(super) fn part(whole: &SpanImage, cluster: u32) -> SpanImage {
    let faces = whole.faces.iter().filter(|f| f.cluster == cluster).map(|f| SpanFace { cluster: 0, ..f.clone() });
    let clusters = vec![whole.clusters[cluster as usize].clone()];
    scanned(SpanImage { faces: faces.collect(), clusters, lines: Vec::new(), ..whole.clone() })
}

/// Triangles before the camera, many of which go through one another.
pub(super) fn triangles(count: usize, seed: u64) -> Vec<Vec<DVec3>> {
    let mut random = Random::new(seed);
    let one = |_| {
        let middle = random.point(DVec3::new(-3.0, 4.0, -2.5), DVec3::new(3.0, 9.0, 2.5));
        (0..3).map(|_| middle + random.point(DVec3::splat(-1.5), DVec3::splat(1.5))).collect()
    };
    (0..count).map(one).collect()
}
