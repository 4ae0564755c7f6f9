//! A stage with some of its surfaces taken away, all else where and as it was.

use super::{NO_FACET, Region, Stage};

impl Stage {
    /// The numbers of the surfaces of an object, or of the surface of this name; empty where there is neither.
    pub fn surfaces_named(&self, name: &str) -> Vec<u32> {
        let numbers = |of: fn(&super::StageSurface) -> &str| -> Vec<u32> {
            (0u32..).zip(&self.surfaces).filter(|(_, s)| of(s) == name).map(|(k, _)| k).collect()
        };
        let objects = numbers(|s| &s.object);
        if objects.is_empty() { numbers(|s| &s.name) } else { objects }
    }

    /// The stage without the surfaces of these numbers: patches keep their numbers, those taken away are absent. What was
    /// covered by them, in contact, comes to light, with the numbers of the patches it is a part of.
    pub fn without(&self, surfaces: &[u32]) -> Self {
        let goes = |facet: u32| surfaces.contains(&self.facets[facet as usize].surface);
        let mut renumbered = vec![NO_FACET; self.facets.len()];
        let kept: Vec<u32> = (0..self.facets.len() as u32).filter(|f| !goes(*f)).collect();
        (0u32..).zip(&kept).for_each(|(new, old)| renumbered[*old as usize] = new);
        let uncovered: Vec<bool> = self.facets.iter().map(|f| f.twins.iter().any(|t| goes(*t))).collect();
        let mut stage = self.clone();
        stage.facets = kept.iter().map(|f| self.facets[*f as usize].clone()).collect();
        for facet in &mut stage.facets {
            facet.twins = facet.twins.iter().map(|t| renumbered[*t as usize]).filter(|t| *t != NO_FACET).collect();
        }
        for patch in stage.patches.iter_mut().filter(|p| p.facet != NO_FACET) {
            let (was, elements) = (patch.facet, patch.elements.start as usize..patch.elements.end as usize);
            patch.facet = renumbered[was as usize];
            if patch.facet == NO_FACET {
                patch.region = Region::default();
                patch.area = 0.0;
            } else if uncovered[was as usize] {
                patch.region = Region::whole(patch.corners.clone());
                patch.area = patch.region.area();
            } else {
                continue;
            }
            for element in &mut stage.elements[elements] {
                let whole = patch.facet != NO_FACET;
                element.region = if whole { Region::whole(element.corners.clone()) } else { Region::default() };
                element.area = element.region.area();
            }
        }
        stage
    }
}
