//! The scene at one state: what kernels trace, and the numbered patches.

use super::{Grid, Material, PointLight, Receiver, Region};
use crate::math::DVec3;
use crate::view::{Camera, Photometry};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Stands for "no facet": an escaped ray, a camera ray's origin.
pub const NO_FACET: u32 = u32::MAX;

/// What stands there in one state, divided into patches. Built by `Scene::at`; nothing in it refers back.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Stage {
    /// Name of the scene.
    pub name: String,
    /// Number of edits applied.
    pub state: usize,
    /// Bands and their luminance weights.
    pub photometry: Photometry,
    /// What the author says; `None` leaves it to the geometry.
    pub enclosure: Option<bool>,
    /// Materials in this state.
    pub materials: Vec<Material>,
    /// Surfaces by number; also those of absent objects.
    pub surfaces: Vec<StageSurface>,
    /// The planar polygons that stand there: what kernels trace and what numbers refer to.
    pub facets: Vec<Facet>,
    /// All patches, numbered as the contract says; absent ones have area 0.
    pub patches: Vec<Patch>,
    /// All elements; those of patch i are `patches[i].elements`.
    pub elements: Vec<Element>,
    /// Cameras in file order; empty where the file has none.
    pub cameras: Vec<Camera>,
    /// Point lights in file order; none in what earlier versions stored.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<PointLight>,
    /// Receivers in file order; none in what earlier versions stored.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub receivers: Vec<Receiver>,
}

/// Names of a surface, or of a group of its mesh.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StageSurface {
    /// Name given in the file.
    pub name: String,
    /// Object it belongs to.
    pub object: String,
}

/// A planar convex polygon as the kernels see it: undivided.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Facet {
    /// Corners in metres, counter-clockwise seen from the front.
    pub vertices: Vec<DVec3>,
    /// Unit normal of the front.
    pub normal: DVec3,
    /// Index into [`Stage::surfaces`].
    pub surface: u32,
    /// Division into patches.
    pub grid: Grid,
    /// Division of each patch into elements.
    pub elements: Grid,
    /// Number of its first patch; the others follow.
    pub first_patch: u32,
    /// Number of the first patch of its back, where it radiates from both sides.
    pub first_back_patch: Option<u32>,
    /// Facets that coincide with this one in part or whole and face the other way.
    pub twins: Vec<u32>,
}

/// A patch: the unit of the radiosity system.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Patch {
    /// Index into [`Stage::surfaces`].
    pub surface: u32,
    /// Index into [`Stage::materials`].
    pub material: u32,
    /// Facet it is a cell of; [`NO_FACET`] while its object is absent.
    pub facet: u32,
    /// Column (triangles: place in the row).
    pub a: u32,
    /// Row.
    pub b: u32,
    /// Corners, counter-clockwise seen from the radiating side; empty while absent.
    pub corners: Vec<DVec3>,
    /// Unit normal on the radiating side; zero while absent.
    pub normal: DVec3,
    /// Area that takes part, m^2: what is in contact with another front is left out. 0 while absent.
    pub area: f64,
    /// The part of the polygon that takes part.
    pub region: Region,
    /// Its elements.
    pub elements: Range<u32>,
}

/// An element: a receiver within a patch.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Element {
    /// Patch it belongs to.
    pub patch: u32,
    /// Column within the patch.
    pub a: u32,
    /// Row within the patch.
    pub b: u32,
    /// Corners, wound like the patch; empty while absent.
    pub corners: Vec<DVec3>,
    /// Area that takes part, m^2.
    pub area: f64,
    /// The part of the polygon that takes part.
    pub region: Region,
}

impl Patch {
    /// True if it takes part: its object stands there and not all of it is covered.
    pub fn is_present(&self) -> bool {
        self.area > 0.0
    }
}

impl Stage {
    /// Number of patches, absent ones included: the N of N x N.
    pub fn patch_count(&self) -> usize {
        self.patches.len()
    }

    /// Number of bands.
    pub fn band_count(&self) -> usize {
        self.photometry.bands.len()
    }

    /// Areas that take part, per patch, m^2.
    pub fn areas(&self) -> Vec<f64> {
        self.patches.iter().map(|p| p.area).collect()
    }

    /// Reflectance of a patch, per band.
    pub fn reflectance(&self, patch: usize) -> &[f64] {
        &self.materials[self.patches[patch].material as usize].reflectance
    }

    /// Self-emitted radiosity of a patch, W/m^2 per band.
    pub fn emission(&self, patch: usize) -> &[f64] {
        &self.materials[self.patches[patch].material as usize].emission
    }

    /// Self-emitted radiosities of all patches, W/m^2, row-major N x bands; 0 for patches that take no part.
    pub fn emissions(&self) -> Vec<f64> {
        self.per_patch(|i| self.emission(i))
    }

    /// Reflectances of all patches, row-major N x bands; 0 for patches that take no part.
    pub fn reflectances(&self) -> Vec<f64> {
        self.per_patch(|i| self.reflectance(i))
    }

    fn per_patch<'a>(&'a self, values: impl Fn(usize) -> &'a [f64]) -> Vec<f64> {
        let part = |i: usize| if self.patches[i].is_present() { 1.0 } else { 0.0 };
        (0..self.patch_count()).flat_map(|i| values(i).iter().map(move |v| v * part(i))).collect()
    }

    /// Name of the surface a patch belongs to.
    pub fn surface_name(&self, patch: usize) -> &str {
        &self.surfaces[self.patches[patch].surface as usize].name
    }

    /// True if any patch has more than one element.
    pub fn has_elements(&self) -> bool {
        self.elements.len() > self.patches.len()
    }

    /// Lowest and highest corner of everything that stands there.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let corners = self.facets.iter().flat_map(|f| &f.vertices);
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)))
    }
}
