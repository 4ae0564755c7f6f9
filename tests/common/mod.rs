//! Stages built in code: planar polygons divided into patches, one element each, without any file.
#![allow(dead_code)]

use etalon::math::{Bilinear, DVec3, area, triangle_cell_corners, unit_normal};
use etalon::scene::{Element, Facet, Grid, Material, Patch, Region, Stage, StageSurface};
use etalon::view::Photometry;

/// A stage of one band under construction.
pub struct Build(pub Stage);

/// A point.
pub fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

impl Build {
    pub fn new() -> Self {
        Self(Stage {
            name: "built".into(),
            state: 0,
            photometry: Photometry { bands: vec!["y".into()], weights: vec![1.0] },
            enclosure: None,
            materials: vec![],
            surfaces: vec![],
            facets: vec![],
            patches: vec![],
            elements: vec![],
            cameras: vec![],
            lights: vec![],
            receivers: vec![],
        })
    }

    /// Adds a polygon with a material of its own. Returns the number of its first patch.
    pub fn surface(&mut self, vertices: &[DVec3], grid: Grid, reflectance: f64, emission: f64) -> usize {
        let stage = &mut self.0;
        let first = stage.patches.len();
        let (surface, material, facet) =
            (stage.surfaces.len() as u32, stage.materials.len() as u32, stage.facets.len() as u32);
        stage.surfaces.push(StageSurface { name: format!("s{surface}"), object: "scene".into() });
        let name = format!("m{material}");
        stage.materials.push(Material { name, reflectance: vec![reflectance], emission: vec![emission] });
        let normal = unit_normal(vertices);
        stage.facets.push(Facet {
            vertices: vertices.to_vec(),
            normal,
            surface,
            grid,
            elements: Grid::Whole,
            first_patch: first as u32,
            first_back_patch: None,
            twins: vec![],
        });
        for number in 0..grid.count() {
            let (a, b) = grid.place(number);
            let corners = cell(vertices, grid, a, b);
            let region = Region::whole(corners.clone());
            let area = area(&corners);
            let patch = stage.patches.len() as u32;
            stage.elements.push(Element { patch, a: 0, b: 0, corners: corners.clone(), area, region: region.clone() });
            stage.patches.push(Patch {
                surface,
                material,
                facet,
                a,
                b,
                corners,
                normal,
                area,
                region,
                elements: patch..patch + 1,
            });
        }
        first
    }

    /// The same polygon seen from the other side.
    pub fn back_of(&mut self, vertices: &[DVec3], grid: Grid, reflectance: f64, emission: f64) -> usize {
        let reversed: Vec<DVec3> = vertices.iter().rev().copied().collect();
        self.surface(&reversed, grid, reflectance, emission)
    }

    /// A closed box seen from the inside, `n` x `n` patches per face: z = lo, z = hi, x = lo, x = hi, y = lo, y = hi.
    pub fn room(&mut self, lo: DVec3, hi: DVec3, n: u32, reflectance: f64, emission: [f64; 6]) {
        for (face, e) in box_faces(lo, hi).iter().zip(emission) {
            let inwards: Vec<DVec3> = face.iter().rev().copied().collect();
            self.surface(&inwards, Grid::Quad { na: n, nb: n }, reflectance, e);
        }
    }

    /// A closed box seen from outside, `n` x `n` patches per face.
    pub fn solid(&mut self, lo: DVec3, hi: DVec3, n: u32, reflectance: f64) {
        for face in box_faces(lo, hi) {
            self.surface(&face, Grid::Quad { na: n, nb: n }, reflectance, 0.0);
        }
    }
}

fn cell(v: &[DVec3], grid: Grid, a: u32, b: u32) -> Vec<DVec3> {
    match grid {
        Grid::Quad { na, nb } => Bilinear::new([v[0], v[1], v[2], v[3]]).cell(a, b, na, nb).to_vec(),
        Grid::Triangle { n } => triangle_cell_corners([v[0], v[1], v[2]], n, a, b).to_vec(),
        Grid::Whole => v.to_vec(),
    }
}

/// Faces of a box, counter-clockwise seen from outside.
pub fn box_faces(lo: DVec3, hi: DVec3) -> [[DVec3; 4]; 6] {
    let at = |x: f64, y: f64, z: f64| lo + (hi - lo) * p(x, y, z);
    let faces = [
        [(0., 0., 0.), (0., 1., 0.), (1., 1., 0.), (1., 0., 0.)],
        [(0., 0., 1.), (1., 0., 1.), (1., 1., 1.), (0., 1., 1.)],
        [(0., 0., 0.), (0., 0., 1.), (0., 1., 1.), (0., 1., 0.)],
        [(1., 0., 0.), (1., 1., 0.), (1., 1., 1.), (1., 0., 1.)],
        [(0., 0., 0.), (1., 0., 0.), (1., 0., 1.), (0., 0., 1.)],
        [(0., 1., 0.), (0., 1., 1.), (1., 1., 1.), (1., 1., 0.)],
    ];
    faces.map(|f| f.map(|(x, y, z)| at(x, y, z)))
}

/// A rectangle parallel to the floor, facing up: corner (x0, y0), sizes, height z.
pub fn flat(x0: f64, y0: f64, x1: f64, y1: f64, z: f64) -> [DVec3; 4] {
    [p(x0, y0, z), p(x1, y0, z), p(x1, y1, z), p(x0, y1, z)]
}
