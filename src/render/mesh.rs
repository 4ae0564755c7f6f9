//! Patches or elements joined where they touch: what smooth shading runs over.

use super::junctions::connect;
use super::weld::Welder;
use crate::math::{DVec3, centroid};
use crate::scene::{Region, Stage};

/// Angles around an inner vertex add to a full turn within this, radians.
const TURN_SLACK: f64 = 0.02;

/// Cells (patches or elements) and the vertices they share. Cells share a vertex where they lie in one plane, look
/// the same way and are of one material; so edges of the scene and changes of reflectance stay sharp.
#[derive(Debug)]
pub struct Mesh<'a> {
    stage: &'a Stage,
    per_element: bool,
    /// Vertices of each cell, one per corner; none for cells that take no part.
    cells: Vec<Vec<u32>>,
    vertices: Vec<Vertex>,
}

/// A point of a surface with the cells that meet there.
#[derive(Debug, Clone)]
pub struct Vertex {
    /// Where it is, metres.
    pub point: DVec3,
    /// Unit normal of the surface there.
    pub normal: DVec3,
    /// Material of the surface, as an index into the stage's.
    pub material: u32,
    /// The cells around it, by number.
    pub cells: Vec<u32>,
    /// How much of a turn they fill, radians.
    pub angle: f64,
}

impl Vertex {
    /// True if its cells surround it, false on the rim of a surface.
    pub fn is_inner(&self) -> bool {
        self.angle > std::f64::consts::TAU - TURN_SLACK
    }
}

impl<'a> Mesh<'a> {
    /// The patches of a stage.
    pub fn of_patches(stage: &'a Stage) -> Self {
        Self::of(stage, false)
    }

    /// The elements of a stage.
    pub fn of_elements(stage: &'a Stage) -> Self {
        Self::of(stage, true)
    }

    fn of(stage: &'a Stage, per_element: bool) -> Self {
        let count = if per_element { stage.elements.len() } else { stage.patch_count() };
        let mut mesh = Self { stage, per_element, cells: vec![Vec::new(); count], vertices: Vec::new() };
        let mut welder = Welder::new(stage);
        for cell in (0..count).filter(|c| mesh.takes_part(*c)).collect::<Vec<_>>() {
            let patch = &stage.patches[mesh.patch_of(cell)];
            mesh.cells[cell] = welder.join(cell as u32, mesh.corners(cell), patch.normal, patch.material);
        }
        let (mut vertices, tolerance) = welder.vertices();
        connect(&mesh.cells, &mut vertices, tolerance);
        mesh.vertices = vertices;
        mesh
    }

    /// The stage.
    pub fn stage(&self) -> &'a Stage {
        self.stage
    }

    /// Number of cells, those that take no part included: patches or elements by their numbers.
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    /// The vertices.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Vertices of a cell, one per corner and in their order; none where it takes no part.
    pub fn vertices_of(&self, cell: usize) -> &[u32] {
        &self.cells[cell]
    }

    /// Corners of a cell, metres.
    pub fn corners(&self, cell: usize) -> &'a [DVec3] {
        if self.per_element { &self.stage.elements[cell].corners } else { &self.stage.patches[cell].corners }
    }

    /// The patch a cell is, or belongs to.
    pub fn patch_of(&self, cell: usize) -> usize {
        if self.per_element { self.stage.elements[cell].patch as usize } else { cell }
    }

    /// Centre of the area that a cell's value is the mean of.
    pub fn centre(&self, cell: usize) -> DVec3 {
        self.region(cell).centroid().unwrap_or_else(|| centroid(self.corners(cell)))
    }

    /// The cell of a patch that holds a point of it.
    pub fn cell_at(&self, patch: usize, point: DVec3) -> usize {
        let elements = self.stage.patches[patch].elements.clone();
        if !self.per_element || elements.is_empty() {
            return patch;
        }
        let normal = self.stage.patches[patch].normal;
        let mut best = (f64::NEG_INFINITY, elements.start as usize);
        for e in elements.map(|e| e as usize) {
            let depth = depth_within(&self.stage.elements[e].corners, normal, point);
            if depth > best.0 {
                best = (depth, e);
            }
        }
        best.1
    }

    fn takes_part(&self, cell: usize) -> bool {
        let whole = self.corners(cell).len() >= 3 && self.stage.patches[self.patch_of(cell)].is_present();
        whole && self.region(cell).area() > 0.0
    }

    fn region(&self, cell: usize) -> &'a Region {
        if self.per_element { &self.stage.elements[cell].region } else { &self.stage.patches[cell].region }
    }
}

/// How far inside a convex polygon a point of its plane lies, metres: the distance to the nearest edge, negative
/// outside.
fn depth_within(corners: &[DVec3], normal: DVec3, p: DVec3) -> f64 {
    let edge = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        normal.cross(b - a).normalize_or_zero().dot(p - a)
    };
    (0..corners.len()).map(edge).fold(f64::INFINITY, f64::min)
}
