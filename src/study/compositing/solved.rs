//! Radiosities of a solution as the diffuse term of a shaded picture.

use crate::compositing::{Diffuse, SpanFace, SpanImage};
use crate::math::DVec3;
use crate::raycast::{BACK, PatchLocator};
use crate::render::{Mesh, Stencils};
use crate::scene::Stage;
use crate::solution::Radiosity;
use std::collections::BTreeMap;

/// A solution, smoothed to the corners of patches [CG85 fig. 8] as pictures of radiosities are.
pub struct Solved<'a> {
    mesh: Mesh<'a>,
    locator: PatchLocator,
    facets: BTreeMap<(&'a str, u32), u32>,
    /// Radiosities at vertices, by band.
    vertices: Vec<Vec<f64>>,
}

impl<'a> Solved<'a> {
    /// Radiosities per patch of a stage.
    pub fn new(stage: &'a Stage, radiosity: &Radiosity) -> Self {
        let mesh = Mesh::of_patches(stage);
        let stencils = Stencils::of(&mesh);
        let bands = radiosity.bands;
        let band = |c: usize| radiosity.values.iter().skip(c).step_by(bands).copied().collect::<Vec<f64>>();
        let vertices = (0..bands).map(|c| stencils.values(&band(c))).collect();
        let mut counts = vec![0; stage.surfaces.len()];
        let key = |(k, f): (usize, &crate::scene::Facet)| {
            let count = &mut counts[f.surface as usize];
            *count += 1;
            ((stage.surfaces[f.surface as usize].name.as_str(), *count - 1), k as u32)
        };
        let facets = stage.facets.iter().enumerate().map(key).collect();
        Self { locator: PatchLocator::new(stage), mesh, facets, vertices }
    }

    /// The first face of an image that is not one of the solution's scene, in shape and material; by surface.
    pub fn missing(&self, image: &SpanImage) -> Option<String> {
        let near = |a: &DVec3, b: &DVec3| a.distance(*b) <= 1e-9 * (1.0 + b.length());
        let known = |f: &SpanFace| {
            self.facets.get(&(f.key.0.as_str(), f.key.1)).is_some_and(|k| {
                let own = &self.mesh.stage().facets[*k as usize].vertices;
                let patch = self.mesh.stage().facets[*k as usize].first_patch as usize;
                let material = &image.materials[f.material as usize];
                own.len() == f.vertices.len()
                    && own.iter().zip(&f.vertices).all(|(a, b)| near(a, b))
                    && self.mesh.stage().reflectance(patch) == material.reflectance
                    && self.mesh.stage().emission(patch) == material.emission
            })
        };
        image.faces.iter().find(|f| f.tree.is_none() && !known(f)).map(|f| f.key.0.clone())
    }
}

impl Diffuse for Solved<'_> {
    fn radiosity(&self, face: &SpanFace, front: bool, point: DVec3, out: &mut [f64]) -> bool {
        let Some(facet) = self.facets.get(&(face.key.0.as_str(), face.key.1)) else { return false };
        let patch = self.locator.patch(*facet, front, point);
        if patch >= BACK {
            return false;
        }
        let cell = self.mesh.cell_at(patch as usize, point);
        out.fill(0.0);
        self.mesh.blend(cell, point, |vertex, weight| {
            out.iter_mut().zip(&self.vertices).for_each(|(o, v)| *o += weight * v[vertex]);
        });
        true
    }
}
