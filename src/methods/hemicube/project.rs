//! The environment as a patch sees it: transformed into its frame, clipped to the frustum of each face, projected.
//!
//! In the frame of the patch z is its normal. Face coordinates are (depth, u, v): on the top (z, x, y), on side k
//! the same as on the face x = 1, (x, y, z), after a turn by k quarters. A face shows u in [-1, 1] and v in
//! [-1, 1] (top) or [0, 1] (sides), as fractions of the depth.

use super::raster::Item;
use super::world::World;
use crate::math::{DVec3, Frame};

/// Faces of a hemi-cube.
pub const FACES: usize = 5;

/// Which face: the top, or a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Facing along the patch normal.
    Top,
    /// Facing along the x axis turned by this many quarters: +x, +y, -x, -y.
    Side(u8),
}

impl Face {
    /// All five, top first.
    pub const ALL: [Face; FACES] = [Face::Top, Face::Side(0), Face::Side(1), Face::Side(2), Face::Side(3)];

    /// (columns, rows) of pixels.
    pub fn size(self, resolution: usize) -> (usize, usize) {
        (resolution, if self == Face::Top { resolution } else { resolution / 2 })
    }

    /// From the patch frame to (depth, u, v).
    fn coordinates(self, p: DVec3) -> DVec3 {
        match self {
            Face::Top => DVec3::new(p.z, p.x, p.y),
            Face::Side(0) => p,
            Face::Side(1) => DVec3::new(p.y, -p.x, p.z),
            Face::Side(2) => DVec3::new(-p.x, -p.y, p.z),
            Face::Side(_) => DVec3::new(-p.y, p.x, p.z),
        }
    }

    /// From (depth, u, v) to the patch frame.
    pub fn to_frame(self, q: DVec3) -> DVec3 {
        match self {
            Face::Top => DVec3::new(q.y, q.z, q.x),
            Face::Side(0) => q,
            Face::Side(1) => DVec3::new(-q.y, q.x, q.z),
            Face::Side(2) => DVec3::new(-q.x, -q.y, q.z),
            Face::Side(_) => DVec3::new(q.y, -q.x, q.z),
        }
    }

    /// Which bits of an [`outcode`] lie outside this face's frustum.
    fn outside(self) -> u16 {
        match self {
            Face::Top => BELOW[0] | BELOW[1] | BELOW[2] | BELOW[3],
            Face::Side(0) => ABOVE[0] | BELOW[4] | BELOW[5] | BELOW[6],
            Face::Side(1) => ABOVE[2] | BELOW[4] | ABOVE[5] | BELOW[6],
            Face::Side(2) => ABOVE[1] | BELOW[4] | ABOVE[5] | ABOVE[6],
            Face::Side(_) => ABOVE[3] | BELOW[4] | BELOW[5] | ABOVE[6],
        }
    }
}

/// Bits of an outcode: on the negative side of plane k.
const BELOW: [u16; 7] = [1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 4, 1 << 5, 1 << 6];
/// Bits of an outcode: on the positive side of plane k.
const ABOVE: [u16; 7] = [1 << 7, 1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13];

/// On which side of every clipping plane of the hemi-cube a point lies: z = x, z = -x, z = y, z = -y, the
/// horizon, and the planes x = y and x = -y between the sides.
fn outcode(p: DVec3) -> u16 {
    let planes = [p.z - p.x, p.z + p.x, p.z - p.y, p.z + p.y, p.z, p.x - p.y, p.x + p.y];
    let mut code = 0;
    for k in 0..7 {
        code |= (u16::from(planes[k] < 0.0) << k) | (u16::from(planes[k] > 0.0) << (k + 7));
    }
    code
}

/// A polygon that may be seen: its loop, and its plane `normal . p = offset` in the patch frame.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    which: u32,
    item: Item,
    normal: DVec3,
    offset: f64,
    /// Outcode bits that all corners share.
    all: u16,
    /// Outcode bits that any corner has.
    any: u16,
}

/// A polygon on a face: its points in pixel coordinates, and 1 / depth as a linear function of them.
/// Pixel (column, row) has its sampling point, without a shift its centre, at integer coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projected {
    /// First of its points.
    pub first: u32,
    /// One past the last of its points.
    pub last: u32,
    /// What is written into the item buffer.
    pub item: Item,
    /// `1 / depth = nearness[0] + nearness[1] column + nearness[2] row`.
    pub nearness: [f64; 3],
}

/// The pixels of a face and where in them it is sampled.
#[derive(Debug, Clone, Copy)]
pub(super) struct PixelGrid {
    /// Pixels along an edge of the top.
    pub resolution: usize,
    /// The sampling point from the pixel's centre, pixels along columns and rows.
    shift: [f64; 2],
}

impl PixelGrid {
    /// Sampling points stay within their pixels by this much: on the rim of a face they would belong to two.
    const MARGIN: f64 = 1.0 / (1u64 << 20) as f64;

    /// Shifts within -0.5 to 0.5.
    pub fn new(resolution: usize, shift: [f64; 2]) -> Self {
        let most = 0.5 - Self::MARGIN;
        Self { resolution, shift: shift.map(|s| s.clamp(-most, most)) }
    }
}

/// Polygons projected onto one face.
#[derive(Debug, Default)]
pub(super) struct Projection {
    /// Points of all polygons, end to end.
    pub points: Vec<[f64; 2]>,
    /// The polygons: fronts first, then backs, each in order of patch number.
    pub polygons: Vec<Projected>,
}

/// Transforms and clips; holds the buffers it needs.
#[derive(Debug, Default)]
pub(super) struct Projector {
    local: Vec<DVec3>,
    codes: Vec<u16>,
    candidates: Vec<Candidate>,
    backs: Vec<Candidate>,
    clipped: Vec<DVec3>,
    spare: Vec<DVec3>,
}

impl Projector {
    /// Takes position: everything into the patch frame, what cannot be seen left out.
    pub fn aim(&mut self, world: &World, eye: DVec3, frame: &Frame) {
        self.local.clear();
        self.local.extend(world.vertices.iter().map(|v| frame.to_local(*v - eye)));
        self.codes.clear();
        self.codes.extend(self.local.iter().map(|p| outcode(*p)));
        self.candidates.clear();
        self.backs.clear();
        for shape in &world.shapes {
            // The eye's distance before the plane. The plane the hemi-cube stands on shows nothing.
            let before = shape.normal.dot(eye) - shape.offset;
            let normal = frame.to_local(shape.normal);
            if before > world.coincident {
                for which in shape.fronts.clone() {
                    let c = self.candidate(world, which, Item::patch(shape.patch), normal, -before);
                    self.candidates.extend(c);
                }
            } else if before < -world.coincident {
                // Behind everything in its plane: the front of a thin plate beats the back of its other side,
                // though the two planes may be rounded differently.
                let offset = world.coincident - before;
                let c = self.candidate(world, shape.back, Item::BACK, normal, offset);
                self.backs.extend(c);
            }
        }
        // Of two at the same depth the first stays: the front of the lower patch number, and never a back.
        self.candidates.append(&mut self.backs);
    }

    /// `None` for a loop wholly below the horizon.
    fn candidate(&self, world: &World, which: u32, item: Item, normal: DVec3, offset: f64) -> Option<Candidate> {
        let (mut all, mut any) = (u16::MAX, 0);
        for k in world.corners(which) {
            let code = self.codes[*k as usize];
            all &= code;
            any |= code;
        }
        let above_horizon = any & ABOVE[4] != 0;
        above_horizon.then_some(Candidate { which, item, normal, offset, all, any })
    }

    /// Clips the candidates to a face's frustum and projects what is left.
    pub fn project(&mut self, world: &World, face: Face, grid: &PixelGrid, out: &mut Projection) {
        out.points.clear();
        out.polygons.clear();
        let outside = face.outside();
        for k in 0..self.candidates.len() {
            let c = self.candidates[k];
            if c.all & outside != 0 {
                continue;
            }
            self.clipped.clear();
            self.clipped.extend(world.corners(c.which).iter().map(|v| face.coordinates(self.local[*v as usize])));
            if c.any & outside != 0 {
                self.clip(face);
            }
            if self.clipped.len() >= 3 {
                out.push(&self.clipped, face, grid, &c);
            }
        }
    }

    /// Sutherland-Hodgman against the frustum, plane by plane.
    fn clip(&mut self, face: Face) {
        self.clip_plane(|q| q.x - q.y);
        self.clip_plane(|q| q.x + q.y);
        self.clip_plane(|q| q.x - q.z);
        match face {
            Face::Top => self.clip_plane(|q| q.x + q.z),
            Face::Side(_) => self.clip_plane(|q| q.z),
        }
    }

    /// Keeps the part where `side` is not negative.
    fn clip_plane(&mut self, side: impl Fn(DVec3) -> f64) {
        std::mem::swap(&mut self.clipped, &mut self.spare);
        self.clipped.clear();
        let Some(mut previous) = self.spare.last().copied() else { return };
        let mut before = side(previous);
        for &next in &self.spare {
            let after = side(next);
            if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
                self.clipped.push(previous + (next - previous) * (before / (before - after)));
            }
            if after >= 0.0 {
                self.clipped.push(next);
            }
            (previous, before) = (next, after);
        }
    }
}

impl Projection {
    /// Points of one of its polygons.
    pub fn points_of(&self, p: &Projected) -> &[[f64; 2]] {
        &self.points[p.first as usize..p.last as usize]
    }

    fn push(&mut self, polygon: &[DVec3], face: Face, grid: &PixelGrid, c: &Candidate) {
        let half = 0.5 * grid.resolution as f64;
        let [x, y] = grid.shift;
        // Row 0 starts at v = -1 on the top, at the horizon on a side.
        let v0 = if face == Face::Top { 1.0 } else { 0.0 };
        let first = self.points.len() as u32;
        for q in polygon {
            let inverse = half / q.x;
            self.points.push([q.y * inverse + half - 0.5 - x, q.z * inverse + v0 * half - 0.5 - y]);
        }
        let n = face.coordinates(c.normal) / c.offset;
        let (du, dv) = (n.y / half, n.z / half);
        let nearness = [n.x - n.y - n.z * v0 + 0.5 * (du + dv) + (x * du + y * dv), du, dv];
        self.polygons.push(Projected { first, last: self.points.len() as u32, item: c.item, nearness });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_above_the_horizon_lies_in_one_frustum() {
        for k in 0..500 {
            let (a, z) = (k as f64 * 0.7, (k as f64 * 0.37).fract().max(0.01));
            let p = DVec3::new(a.cos(), a.sin(), z * 2.0);
            let faces: Vec<Face> = Face::ALL.into_iter().filter(|f| outcode(p) & f.outside() == 0).collect();
            assert_eq!(faces.len(), 1, "{p}");
            let q = faces[0].coordinates(p);
            assert!(q.x >= q.y.abs() && q.z <= q.x && (faces[0] == Face::Top || q.z >= 0.0));
            assert_eq!(faces[0].to_frame(q), p);
        }
    }

    #[test]
    fn what_lies_below_the_horizon_is_outside_every_face() {
        let p = DVec3::new(0.3, -0.2, -0.1);
        assert!(Face::ALL.iter().all(|f| outcode(p) & f.outside() != 0));
    }

    #[test]
    fn clipping_keeps_the_part_within_the_frustum() {
        // A square on the plane depth = 1 that reaches twice as far as the face on one side.
        let square = [(0.0, -0.5), (2.0, -0.5), (2.0, 0.5), (0.0, 0.5)];
        let mut p = Projector { clipped: square.map(|(u, v)| DVec3::new(1.0, u, v)).to_vec(), ..Projector::default() };
        p.clip(Face::Side(0));
        assert!((crate::math::area(&p.clipped) - 0.5).abs() < 1e-15);
        assert!(p.clipped.iter().all(|q| q.y >= 0.0 && q.y <= 1.0 && q.z >= 0.0));
    }
}
