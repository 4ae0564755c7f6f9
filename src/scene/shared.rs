//! Areas that two faces of one plane claim for the same side.

use super::contact::Overlap;
use super::names::Names;
use super::{Facet, Scene, SceneError};
use crate::math::{DVec3, area, centroid};
use std::collections::BTreeMap;

/// Areas that two surfaces (or one with itself) radiate from twice; meshes only, polygons are refused.
/// The earlier face keeps them.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedArea {
    /// Names of the surfaces, the earlier first.
    pub surfaces: [String; 2],
    /// Pairs of faces.
    pub pairs: usize,
    /// Those of them that cover each other wholly.
    pub duplicates: usize,
    /// Area in common, m^2.
    pub area: f64,
    /// Middle of the largest common part.
    pub point: DVec3,
}

impl SharedArea {
    /// One sentence for a notice.
    pub fn notice(&self) -> String {
        let [first, second] = &self.surfaces;
        format!(
            "surfaces \"{first}\" and \"{second}\": {} pairs of mesh faces overlap in one plane and radiate to the same \
             side ({:.3e} m^2); the later face leaves that area to the earlier one",
            self.pairs, self.area
        )
    }
}

impl Scene {
    /// Areas of meshes that radiate twice to one side in a state. Fails as [`Scene::at`] does, at less cost.
    pub fn shared_areas(&self, state: usize) -> Result<Vec<SharedArea>, SceneError> {
        let (facets, overlaps) = self.coincidences(state)?;
        let names = Names::of(self);
        let number = |facet: u32| facets[facet as usize].surface;
        let mut found: BTreeMap<(u32, u32), Sum> = BTreeMap::new();
        for o in overlaps.iter().filter(|o| o.radiates_twice(&facets)) {
            found.entry((number(o.first), number(o.second))).or_default().add(o, &facets);
        }
        let name = |i: u32| names.list[i as usize].name.clone();
        Ok(found.into_iter().map(|((a, b), sum)| sum.named([name(a), name(b)])).collect())
    }
}

#[derive(Default)]
struct Sum {
    pairs: usize,
    duplicates: usize,
    area: f64,
    largest: f64,
    point: DVec3,
}

impl Sum {
    fn add(&mut self, o: &Overlap, facets: &[Facet]) {
        let common = area(&o.polygon);
        let whole = |i: u32| common >= (1.0 - 1e-6) * area(&facets[i as usize].vertices);
        self.pairs += 1;
        self.duplicates += usize::from(whole(o.first) && whole(o.second));
        self.area += common;
        if common > self.largest {
            (self.largest, self.point) = (common, centroid(&o.polygon));
        }
    }

    fn named(self, surfaces: [String; 2]) -> SharedArea {
        SharedArea { surfaces, pairs: self.pairs, duplicates: self.duplicates, area: self.area, point: self.point }
    }
}
