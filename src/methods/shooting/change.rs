//! What differs between two versions of the geometry.

use super::geometry::Geometry;
use super::shadow::Outline;
use crate::math::{DVec3, area};

/// The difference of two versions, as seen from an old one.
#[derive(Debug)]
pub(super) struct Change {
    /// Patches on facets that stand in the old version and not, or not so, in the new one.
    pub gone: Vec<bool>,
    /// Patches on facets that stand in the new version and not, or not so, in the old one.
    pub came: Vec<bool>,
    /// Patches whose own rays differ: they came, went, moved, or are covered in another way.
    pub own: Vec<bool>,
    /// What went, and what came.
    pub outlines: [Option<Outline>; 2],
    /// Mean area that what has changed shows to a direction, m^2: a quarter of its surface, were it convex.
    pub shown: f64,
    /// Points that stand for what went (in the old version) and for what came (in the new one).
    pub samples: [Vec<DVec3>; 2],
}

impl Change {
    /// Compares two versions; `samples` points stand for each of the old and the new place.
    pub fn between(old: &Geometry, new: &Geometry, samples: usize) -> Self {
        let (gone, went) = missing(old, new);
        let (came, arrived) = missing(new, old);
        let (p, q) = (&old.stage.patches, &new.stage.patches);
        let own = (0..p.len()).map(|i| gone[i] || came[i] || p[i].region != q[i].region || p[i].normal != q[i].normal);
        let own = own.collect();
        let outlines = [&went, &arrived].map(|facets| Outline::of(&facets.concat()));
        let surface = [&went, &arrived].map(|facets| facets.iter().map(|f| area(f)).sum::<f64>());
        let samples = [0, 1].map(|k| sample_points(&outlines[k], [&went, &arrived][k], samples));
        Self { gone, came, own, outlines, shown: surface[0].max(surface[1]) / 4.0, samples }
    }
}

/// Patches, and corners, of the facets of `here` that `there` does not have.
fn missing(here: &Geometry, there: &Geometry) -> (Vec<bool>, Vec<Vec<DVec3>>) {
    let stage = &here.stage;
    let facets: Vec<bool> = stage.facets.iter().map(|f| !there.holds(f)).collect();
    let on = |facet: u32| facets.get(facet as usize).copied().unwrap_or(false);
    let patches = stage.patches.iter().map(|p| on(p.facet)).collect();
    let corners = stage.facets.iter().zip(&facets).filter(|(_, m)| **m).map(|(f, _)| f.vertices.clone()).collect();
    (patches, corners)
}

/// The middle of the object, then middles of its faces at equal steps.
fn sample_points(outline: &Option<Outline>, facets: &[Vec<DVec3>], count: usize) -> Vec<DVec3> {
    let Some(outline) = outline else { return Vec::new() };
    let middle = |f: &Vec<DVec3>| f.iter().sum::<DVec3>() / f.len() as f64;
    let more = count.saturating_sub(1).min(facets.len());
    let faces = (0..more).map(|k| middle(&facets[k * facets.len() / more]));
    std::iter::once(outline.centre()).chain(faces).collect()
}
