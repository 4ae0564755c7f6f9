//! Stages made in code: geometry only.

use super::{Facet, Grid, Material, Patch, Region, Stage, StageSurface};
use crate::math::{DVec3, area, unit_normal};
use crate::view::Photometry;

impl Stage {
    /// Polygons as facets of one patch each, in order, all of one grey material: what kernels are tried on.
    /// Loops are planar, convex, counter-clockwise seen from the front; metres. Contacts are not looked for.
    pub fn from_polygons(polygons: &[Vec<DVec3>]) -> Self {
        Self {
            name: "polygons".to_owned(),
            state: 0,
            photometry: Photometry::rec709(),
            enclosure: None,
            materials: vec![Material { name: "grey".to_owned(), reflectance: vec![0.5; 3], emission: vec![0.0; 3] }],
            surfaces: vec![StageSurface { name: "all".to_owned(), object: "scene".to_owned() }],
            facets: polygons.iter().zip(0..).map(|(p, i)| plain_facet(p, i)).collect(),
            patches: polygons.iter().zip(0..).map(|(p, i)| plain_patch(p, i)).collect(),
            elements: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            receivers: Vec::new(),
        }
    }
}

fn plain_facet(polygon: &[DVec3], number: u32) -> Facet {
    Facet {
        vertices: polygon.to_vec(),
        normal: unit_normal(polygon),
        surface: 0,
        grid: Grid::Whole,
        elements: Grid::Whole,
        first_patch: number,
        first_back_patch: None,
        twins: Vec::new(),
    }
}

fn plain_patch(polygon: &[DVec3], facet: u32) -> Patch {
    Patch {
        surface: 0,
        material: 0,
        facet,
        a: 0,
        b: 0,
        corners: polygon.to_vec(),
        normal: unit_normal(polygon),
        area: area(polygon),
        region: Region::whole(polygon.to_vec()),
        elements: 0..0,
    }
}
