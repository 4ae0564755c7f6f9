//! Where lights find the shape of what shines: scenes in a state, and intermediate images.

use crate::compositing::SpanImage;
use crate::math::DVec3;
use crate::scene::Stage;
use std::collections::BTreeSet;

/// A face that may shine.
#[derive(Debug, Clone, PartialEq)]
pub struct Shining {
    /// Corners in metres, counter-clockwise seen from the front.
    pub vertices: Vec<DVec3>,
    /// Self-emitted radiosity, W/m^2 per band.
    pub emission: Vec<f64>,
}

/// What lights and finishes may refer to by name.
pub trait Shapes {
    /// Names of the bands.
    fn bands(&self) -> &[String];
    /// Names of all materials.
    fn materials(&self) -> BTreeSet<&str>;
    /// Names of the surfaces that stand there; groups of a mesh as `surface/group`.
    fn surfaces(&self) -> BTreeSet<&str>;
    /// Names of the objects that stand there and whose faces can be told.
    fn objects(&self) -> BTreeSet<&str>;
    /// True for a surface or object that the scene has, but that does not stand there in this state.
    fn is_away(&self, name: &str, object: bool) -> bool;
    /// Faces of a surface (with the groups of its mesh) or of an object, in order.
    fn faces(&self, name: &str, object: bool) -> Vec<Shining>;
}

/// A face, and its back where that shines too.
fn sides(vertices: &[DVec3], two_sided: bool, emission: &[f64]) -> Vec<Shining> {
    let front = Shining { vertices: vertices.to_vec(), emission: emission.to_vec() };
    let back =
        two_sided.then(|| Shining { vertices: vertices.iter().rev().copied().collect(), emission: emission.to_vec() });
    std::iter::once(front).chain(back).collect()
}

/// True for the surface itself and for the groups of its mesh.
fn is_of(surface: &str, name: &str) -> bool {
    surface.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

impl Shapes for Stage {
    fn bands(&self) -> &[String] {
        &self.photometry.bands
    }

    fn materials(&self) -> BTreeSet<&str> {
        self.materials.iter().map(|m| m.name.as_str()).collect()
    }

    fn surfaces(&self) -> BTreeSet<&str> {
        self.facets.iter().filter_map(|f| self.surfaces.get(f.surface as usize)).map(|s| s.name.as_str()).collect()
    }

    fn objects(&self) -> BTreeSet<&str> {
        self.facets.iter().filter_map(|f| self.surfaces.get(f.surface as usize)).map(|s| s.object.as_str()).collect()
    }

    fn is_away(&self, name: &str, object: bool) -> bool {
        let own = |s: &crate::scene::StageSurface| if object { s.object == name } else { is_of(&s.name, name) };
        self.surfaces.iter().any(own) && self.faces(name, object).is_empty()
    }

    fn faces(&self, name: &str, object: bool) -> Vec<Shining> {
        let own = |surface: u32| {
            let surface = self.surfaces.get(surface as usize);
            surface.is_some_and(|s| if object { s.object == name } else { is_of(&s.name, name) })
        };
        let facets = self.facets.iter().filter(|f| own(f.surface));
        let both = |f: &crate::scene::Facet| {
            sides(&f.vertices, f.first_back_patch.is_some(), self.emission(f.first_patch as usize))
        };
        facets.flat_map(both).collect()
    }
}

impl Shapes for SpanImage {
    fn bands(&self) -> &[String] {
        &self.photometry.bands
    }

    fn materials(&self) -> BTreeSet<&str> {
        self.materials.iter().map(|m| m.name.as_str()).collect()
    }

    fn surfaces(&self) -> BTreeSet<&str> {
        self.faces.iter().filter(|f| f.tree.is_none()).map(|f| f.key.0.as_str()).collect()
    }

    fn objects(&self) -> BTreeSet<&str> {
        // Faces know their cluster; which object of several they belong to is not kept.
        let alone = |c: &&crate::compositing::Cluster| c.objects.len() == 1;
        self.clusters.iter().filter(alone).flat_map(|c| &c.objects).map(String::as_str).collect()
    }

    fn is_away(&self, _name: &str, _object: bool) -> bool {
        // An image knows what was scanned, and nothing of other states.
        false
    }

    fn faces(&self, name: &str, object: bool) -> Vec<Shining> {
        let cluster = |f: &crate::compositing::SpanFace| {
            self.clusters.get(f.cluster as usize).is_some_and(|c| matches!(c.objects.as_slice(), [one] if one == name))
        };
        let own = self.faces.iter().filter(|f| f.tree.is_none());
        let own = own.filter(|f| if object { cluster(f) } else { is_of(&f.key.0, name) });
        let emission = |f: &crate::compositing::SpanFace| {
            self.materials.get(f.material as usize).map(|m| m.emission.clone()).unwrap_or_default()
        };
        own.flat_map(|f| sides(&f.vertices, f.two_sided, &emission(f))).collect()
    }
}
