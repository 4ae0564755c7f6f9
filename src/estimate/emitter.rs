//! What rays start from: a region of a plane, its frame, and the key of its random shifts.

use crate::math::Frame;
use crate::sampling::PointMap;
use crate::scene::{Patch, Region, Stage};

/// A flat region from which cosine-distributed rays start.
#[derive(Debug, Clone)]
pub struct Emitter {
    /// Unit square to points of the region.
    pub map: PointMap,
    /// Normal and a tangent.
    pub frame: Frame,
    /// Facet it lies on.
    pub facet: u32,
    /// Address of its random shifts: differs between any two emitters of one run.
    pub key: u64,
}

impl Emitter {
    fn new(patch: &Patch, region: &Region, key: u64) -> Option<Self> {
        let map = PointMap::new(&region.pieces)?;
        let frame = Frame::with_x_axis(patch.normal, patch.corners[1] - patch.corners[0]);
        Some(Self { map, frame, facet: patch.facet, key })
    }
}

/// One emitter per patch; `None` for those that take no part.
pub fn patch_emitters(stage: &Stage) -> Vec<Option<Emitter>> {
    let make = |(i, p): (usize, &Patch)| Emitter::new(p, &p.region, i as u64);
    stage.patches.iter().enumerate().map(make).collect()
}

/// One emitter per element; `None` for those that take no part.
pub fn element_emitters(stage: &Stage) -> Vec<Option<Emitter>> {
    let offset = stage.patch_count() as u64;
    let make = |(e, element): (usize, &crate::scene::Element)| {
        Emitter::new(&stage.patches[element.patch as usize], &element.region, offset + e as u64)
    };
    stage.elements.iter().enumerate().map(make).collect()
}
