//! Where on a facet a ray lands: side, patch and point, in double precision.

use crate::math::{Bilinear, DVec3, triangle_cell};
use crate::scene::{Facet, Grid, Stage};

/// Landing code of a ray that met nothing.
pub const ESCAPED: u32 = u32::MAX;
/// Landing code of a ray that met a black back, or a covered part that takes no part.
pub const BACK: u32 = u32::MAX - 1;

/// What every hit asks of its facet: kept apart and small, since hits are scattered over all facets.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(super) struct Side {
    normal: DVec3,
    /// First patch of the front; [`ASK`] where the answer needs a [`Locator`].
    front: u32,
    /// First patch of the back; [`ASK`] likewise, also where the back is black.
    back: u32,
}

/// The facet is divided, or the landing needs a second thought.
pub(super) const ASK: u32 = u32::MAX;

impl Side {
    /// The sides of a facet; `simple` if it is one patch and that patch takes part.
    fn new(facet: &Facet, simple: bool) -> Self {
        let answer = |patch: Option<u32>| if simple { patch.unwrap_or(ASK) } else { ASK };
        Self { normal: facet.normal, front: answer(Some(facet.first_patch)), back: answer(facet.first_back_patch) }
    }

    /// The patch met in this direction; [`ASK`] if that takes more to say.
    #[inline]
    pub(super) fn patch(&self, direction: DVec3) -> u32 {
        if self.normal.dot(direction) < 0.0 { self.front } else { self.back }
    }
}

/// One facet, ready to be asked which patch a ray lands in.
#[derive(Debug, Clone)]
pub(super) struct Locator {
    normal: DVec3,
    offset: f64,
    cells: Cells,
    first_patch: u32,
    /// First patch of the back; [`BACK`] where the back is black.
    first_back_patch: u32,
}

#[derive(Debug, Clone)]
enum Cells {
    Whole,
    /// An affine quadrilateral: origin and dual basis scaled to cells.
    Parallelogram {
        origin: DVec3,
        along: [DVec3; 2],
        size: [u32; 2],
    },
    Quad {
        map: Box<Bilinear>,
        size: [u32; 2],
    },
    Triangle {
        origin: DVec3,
        dual: [DVec3; 2],
        n: u32,
    },
}

impl Locator {
    pub(super) fn new(facet: &Facet) -> Self {
        Self {
            normal: facet.normal,
            offset: facet.normal.dot(facet.vertices[0]),
            cells: Cells::new(facet),
            first_patch: facet.first_patch,
            first_back_patch: facet.first_back_patch.unwrap_or(BACK),
        }
    }

    /// True if a ray in this direction meets the front.
    pub(super) fn meets_front(&self, direction: DVec3) -> bool {
        self.normal.dot(direction) < 0.0
    }

    /// True if the facet's back radiates too.
    pub(super) fn is_two_sided(&self) -> bool {
        self.first_back_patch != BACK
    }

    /// Point where the ray meets the facet's plane.
    pub(super) fn point(&self, origin: DVec3, direction: DVec3) -> DVec3 {
        let t = (self.offset - self.normal.dot(origin)) / self.normal.dot(direction);
        origin + direction * t
    }

    /// Patch in which a ray that meets this facet lands; [`BACK`] on a black back.
    #[inline]
    pub(super) fn patch(&self, origin: DVec3, direction: DVec3) -> u32 {
        let facing = self.normal.dot(direction);
        let first = if facing < 0.0 { self.first_patch } else { self.first_back_patch };
        if first == BACK {
            return BACK;
        }
        let t = (self.offset - self.normal.dot(origin)) / facing;
        first + self.cells.number(origin + direction * t)
    }
}

impl Cells {
    fn new(facet: &Facet) -> Self {
        Self::divide(&facet.vertices, facet.grid)
    }

    /// The cells of a polygon.
    fn divide(v: &[DVec3], grid: Grid) -> Self {
        match grid {
            Grid::Quad { na: 1, nb: 1 } | Grid::Triangle { n: 1 } | Grid::Whole => Self::Whole,
            Grid::Quad { na, nb } => {
                let map = Bilinear::new([v[0], v[1], v[2], v[3]]);
                if map.is_parallelogram() {
                    let [a, b] = dual_basis(v[1] - v[0], v[3] - v[0]);
                    Self::Parallelogram { origin: v[0], along: [a * f64::from(na), b * f64::from(nb)], size: [na, nb] }
                } else {
                    Self::Quad { map: Box::new(map), size: [na, nb] }
                }
            }
            Grid::Triangle { n } => Self::Triangle { origin: v[0], dual: dual_basis(v[1] - v[0], v[2] - v[0]), n },
        }
    }

    #[inline]
    fn number(&self, p: DVec3) -> u32 {
        match self {
            Self::Whole => 0,
            Self::Parallelogram { origin, along, size } => {
                let q = p - *origin;
                cell(q.dot(along[0]), size[0]) + cell(q.dot(along[1]), size[1]) * size[0]
            }
            Self::Quad { map, size } => {
                let (u, v) = map.inverse(p);
                cell(u * f64::from(size[0]), size[0]) + cell(v * f64::from(size[1]), size[1]) * size[0]
            }
            Self::Triangle { origin, dual, n } => {
                let q = p - *origin;
                let (k, b) = triangle_cell(*n, q.dot(dual[0]), q.dot(dual[1]));
                b * (2 * n - b) + k
            }
        }
    }
}

/// The elements of all patches, ready to be asked in which one a ray lands.
pub struct ElementLocator {
    patches: Vec<Option<Division>>,
    /// First element of each patch.
    first: Vec<u32>,
}

/// Which patch a point of a facet lies in.
pub struct PatchLocator {
    facets: Vec<Locator>,
}

impl PatchLocator {
    /// The facets of a stage.
    pub fn new(stage: &Stage) -> Self {
        Self { facets: locators(stage) }
    }

    /// Patch of a facet's front or back at a point of it; [`BACK`] on a back that radiates nothing.
    pub fn patch(&self, facet: u32, front: bool, point: DVec3) -> u32 {
        let locator = &self.facets[facet as usize];
        let direction = if front { -locator.normal } else { locator.normal };
        locator.patch(point - direction, direction)
    }
}

/// A patch of more than one element.
struct Division {
    normal: DVec3,
    offset: f64,
    cells: Cells,
}

impl ElementLocator {
    /// The elements of a stage.
    pub fn new(stage: &Stage) -> Self {
        let division = |p: &crate::scene::Patch| {
            let facet = stage.facets.get(p.facet as usize).filter(|_| p.elements.len() > 1)?;
            // Elements of a back are numbered as those of its front, whose loop runs the other way from the same corner.
            let mut corners = p.corners.clone();
            if p.normal.dot(facet.normal) < 0.0 {
                corners[1..].reverse();
            }
            let cells = Cells::divide(&corners, facet.elements);
            Some(Division { normal: p.normal, offset: p.normal.dot(corners[0]), cells })
        };
        Self {
            patches: stage.patches.iter().map(division).collect(),
            first: stage.patches.iter().map(|p| p.elements.start).collect(),
        }
    }

    /// Element in which a ray lands that lands in a patch.
    #[inline]
    pub fn element(&self, patch: u32, origin: DVec3, direction: DVec3) -> u32 {
        let first = self.first[patch as usize];
        match &self.patches[patch as usize] {
            None => first,
            Some(d) => {
                let t = (d.offset - d.normal.dot(origin)) / d.normal.dot(direction);
                first + d.cells.number(origin + direction * t)
            }
        }
    }
}

/// Cell of a coordinate counted in cells; points on or beyond the rim go to the nearest one.
fn cell(x: f64, n: u32) -> u32 {
    // A float-to-integer cast saturates: what lies before the first cell becomes 0.
    (x as u32).min(n - 1)
}

/// Vectors a, b of the plane of e1 and e2 with a.e1 = b.e2 = 1, a.e2 = b.e1 = 0.
fn dual_basis(e1: DVec3, e2: DVec3) -> [DVec3; 2] {
    let n = e1.cross(e2);
    [e2.cross(n), n.cross(e1)].map(|d| d / n.length_squared())
}

/// True if a point of the facet's plane lies inside it (its rim included, up to rounding).
pub(super) fn contains(facet: &Facet, p: DVec3) -> bool {
    let v = &facet.vertices;
    (0..v.len()).all(|i| {
        let (a, b) = (v[i], v[(i + 1) % v.len()]);
        let slack = 1e-12 * (b - a).length_squared();
        facet.normal.cross(b - a).dot(p - a) >= -slack
    })
}

/// Sides of all facets.
pub(super) fn sides(stage: &Stage) -> Vec<Side> {
    let present = |patch: Option<u32>| patch.is_none_or(|p| stage.patches[p as usize].is_present());
    let simple = |f: &Facet| f.grid.count() == 1 && present(Some(f.first_patch)) && present(f.first_back_patch);
    stage.facets.iter().map(|f| Side::new(f, simple(f))).collect()
}

/// Locators of all facets.
pub(super) fn locators(stage: &Stage) -> Vec<Locator> {
    stage.facets.iter().map(Locator::new).collect()
}
