//! What a path needs to know of the scene, patch by patch.

use super::lamps::Lamps;
use crate::math::{DVec3, Frame};
use crate::scene::{Patch, Stage};

/// Materials, planes and lamps, in the order of patches; row-major N x bands.
pub(super) struct World {
    pub bands: usize,
    pub emission: Vec<f64>,
    pub reflectance: Vec<f64>,
    /// About the mean irradiance of each patch: stands for the rest of a path that ends. Any value is right.
    pub expected: Vec<f64>,
    pub lamps: Lamps,
    pub places: Vec<Place>,
}

/// Where a patch lies.
pub(super) struct Place {
    pub frame: Frame,
    /// A point of its plane.
    pub point: DVec3,
    pub facet: u32,
}

impl World {
    pub fn of(stage: &Stage) -> Self {
        let place = |p: &Patch| {
            let (point, along) = match &p.corners[..] {
                [a, b, ..] => (*a, *b - *a),
                _ => (DVec3::ZERO, DVec3::X),
            };
            // Absent patches have no normal; nothing ever lands on them.
            let normal = if p.is_present() { p.normal } else { DVec3::Z };
            let along = if p.is_present() { along } else { DVec3::X };
            Place { frame: Frame::with_x_axis(normal, along), point, facet: p.facet }
        };
        let bands = stage.band_count();
        Self {
            bands,
            emission: stage.emissions(),
            reflectance: stage.reflectances(),
            expected: vec![0.0; stage.patch_count() * bands],
            lamps: Lamps::of(stage),
            places: stage.patches.iter().map(place).collect(),
        }
    }

    pub fn emission_of(&self, patch: usize) -> &[f64] {
        &self.emission[patch * self.bands..(patch + 1) * self.bands]
    }

    pub fn reflectance_of(&self, patch: usize) -> &[f64] {
        &self.reflectance[patch * self.bands..(patch + 1) * self.bands]
    }

    pub fn expected_of(&self, patch: usize) -> &[f64] {
        &self.expected[patch * self.bands..(patch + 1) * self.bands]
    }

    pub fn is_lamp(&self, patch: usize) -> bool {
        self.emission_of(patch).iter().any(|e| *e > 0.0)
    }

    /// Distance to the plane of a patch along a ray.
    pub fn distance(&self, patch: usize, origin: DVec3, direction: DVec3) -> f64 {
        let place = &self.places[patch];
        place.frame.z.dot(place.point - origin) / place.frame.z.dot(direction)
    }
}
