//! Surfaces that emit, as lights.

use super::image::SpanImage;
use crate::math::{DVec3, centroid, unit_normal};
use crate::scene::{Light, LightShape};
use std::collections::BTreeMap;

/// Faces count as one where their middles are nearer than this share of the distance from the origin plus one.
const SAME: f64 = 1e-9;

impl SpanImage {
    /// A light for every surface and material that emits: what surfaces radiate where no radiosities tell it. Faces that a
    /// light of the appearance stands for already are left out.
    pub fn emitters(&self) -> Vec<Light> {
        let told: Vec<[DVec3; 2]> = self.appearance.lights.iter().flat_map(|l| sides(&l.shape)).collect();
        let mut faces: BTreeMap<(&str, u32), Vec<Vec<DVec3>>> = BTreeMap::new();
        for face in &self.faces {
            let material = &self.materials[face.material as usize];
            if material.emission.iter().all(|e| *e <= 0.0) || face.tree.is_some() {
                continue;
            }
            let mut shine = |vertices: Vec<DVec3>| {
                let [middle, normal] = side(&vertices);
                let same =
                    |t: &[DVec3; 2]| t[0].distance(middle) <= SAME * (1.0 + middle.length()) && t[1].dot(normal) > 0.0;
                if !told.iter().any(same) {
                    faces.entry((&face.key.0, face.material)).or_default().push(vertices);
                }
            };
            shine(face.vertices.clone());
            if face.two_sided {
                shine(face.vertices.iter().rev().copied().collect());
            }
        }
        let light = |((surface, material), mut faces): ((&str, u32), Vec<Vec<DVec3>>)| Light {
            name: surface.to_string(),
            strength: self.materials[material as usize].emission.clone(),
            shape: match faces.len() {
                1 => LightShape::Area { polygon: faces.remove(0) },
                _ => LightShape::Polyhedron { faces },
            },
        };
        faces.into_iter().map(light).collect()
    }
}

/// Middle and normal of the faces of a light.
fn sides(shape: &LightShape) -> Vec<[DVec3; 2]> {
    match shape {
        LightShape::Area { polygon } => vec![side(polygon)],
        LightShape::Polyhedron { faces } => faces.iter().map(|f| side(f)).collect(),
        _ => Vec::new(),
    }
}

fn side(vertices: &[DVec3]) -> [DVec3; 2] {
    [centroid(vertices), unit_normal(vertices)]
}
