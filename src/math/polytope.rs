//! Convex bodies by their faces: a closed convex solid, or one polygon alone as a body without thickness.

use super::{DVec3, unit_normal};

/// Heights below this share of the extent count as lying in a plane.
const ON_PLANE: f64 = 1e-12;

/// The plane `normal . p = offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal.
    pub normal: DVec3,
    /// Signed distance from the origin, m.
    pub offset: f64,
}

impl Plane {
    /// The plane of a polygon, normal on its front; through the mean of its vertices.
    pub fn of(polygon: &[DVec3]) -> Self {
        let normal = unit_normal(polygon);
        Self { normal, offset: normal.dot(polygon.iter().sum::<DVec3>()) / polygon.len() as f64 }
    }

    /// Signed distance of a point, m; positive in front.
    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// The same plane seen from the other side.
    pub fn reversed(&self) -> Self {
        Self { normal: -self.normal, offset: -self.offset }
    }
}

/// A convex body.
///
/// Faces are loops of vertices, counter-clockwise seen from outside. A flat body has two faces: a polygon and its
/// back. Every edge lies between two faces.
#[derive(Debug, Clone)]
pub struct Polytope {
    vertices: Vec<DVec3>,
    planes: Vec<Plane>,
    loops: Vec<Vec<u32>>,
    edges: Vec<PolytopeEdge>,
    centre: DVec3,
}

/// An edge of a body and the faces it lies between.
#[derive(Debug, Clone, Copy)]
pub struct PolytopeEdge {
    /// First and last vertex, in the direction of face `left`.
    pub ends: [u32; 2],
    /// The face that runs along it forwards.
    pub left: u32,
    /// The face that runs along it backwards.
    pub right: u32,
}

impl Polytope {
    /// A polygon as a body that hides what is behind it from both sides.
    pub fn flat(polygon: &[DVec3]) -> Option<Self> {
        let plane = Plane::of(polygon);
        let forth: Vec<u32> = (0..polygon.len() as u32).collect();
        let back = forth.iter().rev().copied().collect();
        Self::assembled(polygon.to_vec(), vec![plane, plane.reversed()], vec![forth, back])
    }

    /// The solid between faces that share their vertices; `None` if they do not close around a convex body.
    pub fn closed(vertices: Vec<DVec3>, loops: Vec<Vec<u32>>) -> Option<Self> {
        let corners = |l: &Vec<u32>| l.iter().map(|v| vertices[*v as usize]).collect::<Vec<_>>();
        let planes: Vec<Plane> = loops.iter().map(|l| Plane::of(&corners(l))).collect();
        let slack = ON_PLANE * extent(&vertices);
        let convex = planes.iter().all(|p| p.normal != DVec3::ZERO && vertices.iter().all(|v| p.height(*v) <= slack));
        if !convex {
            return None;
        }
        Self::assembled(vertices, planes, loops)
    }

    fn assembled(vertices: Vec<DVec3>, planes: Vec<Plane>, loops: Vec<Vec<u32>>) -> Option<Self> {
        let mut half = Vec::new();
        for (face, l) in loops.iter().enumerate() {
            for k in 0..l.len() {
                half.push(([l[k], l[(k + 1) % l.len()]], face as u32));
            }
        }
        half.sort_unstable();
        let mut edges = Vec::with_capacity(half.len() / 2);
        for ([a, b], left) in &half {
            let at = half.binary_search_by_key(&[*b, *a], |h| h.0).ok()?;
            if a < b {
                edges.push(PolytopeEdge { ends: [*a, *b], left: *left, right: half[at].1 });
            }
        }
        let twice = half.windows(2).any(|w| w[0].0 == w[1].0);
        let centre = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        (!twice && !edges.is_empty()).then_some(Self { vertices, planes, loops, edges, centre })
    }

    /// Vertices.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Planes of the faces, normals outwards.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Edges, each once.
    pub fn edges(&self) -> &[PolytopeEdge] {
        &self.edges
    }

    /// The mean of the vertices.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// True for a polygon without thickness.
    pub fn is_flat(&self) -> bool {
        self.loops.len() == 2
    }

    /// The part in front of a plane; `None` if no vertex rises above it by more than `slack`.
    pub fn in_front(&self, plane: &Plane, slack: f64) -> Option<Self> {
        let height: Vec<f64> = self.vertices.iter().map(|v| plane.height(*v)).collect();
        if height.iter().all(|h| *h <= slack) {
            return None;
        }
        if height.iter().all(|h| *h >= -slack) {
            return Some(self.clone());
        }
        if self.is_flat() {
            let polygon: Vec<DVec3> = self.loops[0].iter().map(|v| self.vertices[*v as usize]).collect();
            let part = super::clip_to_half_space(&polygon, plane.normal, plane.offset);
            return Self::flat(&without_repeats(part, slack)?);
        }
        self.solid_in_front(plane, &height)
    }

    /// Clips every face and closes the cut with a face of its own.
    fn solid_in_front(&self, plane: &Plane, height: &[f64]) -> Option<Self> {
        let mut vertices = Vec::new();
        let mut kept = vec![u32::MAX; height.len()];
        for (v, h) in height.iter().enumerate() {
            if *h >= 0.0 {
                kept[v] = vertices.len() as u32;
                vertices.push(self.vertices[v]);
            }
        }
        let mut cut = std::collections::BTreeMap::new();
        let (mut loops, mut planes, mut rim) = (Vec::new(), Vec::new(), Vec::new());
        for (l, face) in self.loops.iter().zip(&self.planes) {
            let mut part = Vec::new();
            let mut crossing = [u32::MAX; 2];
            for k in 0..l.len() {
                let (a, b) = (l[k], l[(k + 1) % l.len()]);
                let (ha, hb) = (height[a as usize], height[b as usize]);
                if ha >= 0.0 {
                    part.push(kept[a as usize]);
                }
                if (ha >= 0.0) != (hb >= 0.0) {
                    let at = *cut.entry((a.min(b), a.max(b))).or_insert_with(|| {
                        let (p, q) = (self.vertices[a as usize], self.vertices[b as usize]);
                        vertices.push(p.lerp(q, ha / (ha - hb)));
                        vertices.len() as u32 - 1
                    });
                    part.push(at);
                    crossing[usize::from(ha < 0.0)] = at;
                }
            }
            if part.len() >= 3 {
                loops.push(part);
                planes.push(*face);
            }
            if crossing[0] != crossing[1] {
                // The cap runs along each cut the other way than the face.
                rim.push((crossing[1], crossing[0]));
            }
        }
        let cap = chained(&rim)?;
        loops.push(cap);
        planes.push(plane.reversed());
        Self::assembled(vertices, planes, loops)
    }
}

/// A loop through arcs (from, to), each vertex left once.
fn chained(arcs: &[(u32, u32)]) -> Option<Vec<u32>> {
    let mut out = vec![arcs.first()?.0];
    let mut at = arcs[0].1;
    while at != out[0] {
        out.push(at);
        at = arcs.iter().find(|a| a.0 == at)?.1;
        if out.len() > arcs.len() {
            return None;
        }
    }
    (out.len() == arcs.len() && out.len() >= 3).then_some(out)
}

fn without_repeats(mut polygon: Vec<DVec3>, slack: f64) -> Option<Vec<DVec3>> {
    polygon.dedup_by(|a, b| a.distance(*b) <= slack);
    while polygon.len() > 1 && polygon[0].distance(polygon[polygon.len() - 1]) <= slack {
        polygon.pop();
    }
    (polygon.len() >= 3).then_some(polygon)
}

fn extent(points: &[DVec3]) -> f64 {
    let (lo, hi) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    (hi - lo).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Polytope {
        let vertices = (0..8).map(|k| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64)).collect();
        let loops = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Polytope::closed(vertices, loops.iter().map(|l| l.to_vec()).collect()).expect("a cube is convex")
    }

    #[test]
    fn a_cut_cube_is_a_closed_body() {
        let corner = Plane { normal: DVec3::ONE.normalize(), offset: 2.5 / 3f64.sqrt() };
        let tip = cube().in_front(&corner, 1e-12).expect("the corner is in front");
        assert_eq!((tip.vertices().len(), tip.edges().len(), tip.planes().len()), (4, 6, 4));
        assert!(tip.planes().iter().all(|p| tip.vertices().iter().all(|v| p.height(*v) < 1e-12)));
        let rest = cube().in_front(&corner.reversed(), 1e-12).expect("so is the rest from the other side");
        assert_eq!((rest.vertices().len(), rest.edges().len(), rest.planes().len()), (10, 15, 7));
        assert!(rest.planes().iter().all(|p| rest.vertices().iter().all(|v| p.height(*v) < 1e-12)));
    }

    #[test]
    fn what_only_touches_a_plane_is_whole_or_gone() {
        let floor = Plane { normal: DVec3::Z, offset: 0.0 };
        assert_eq!(cube().in_front(&floor, 1e-12).map(|b| b.vertices().len()), Some(8));
        assert!(cube().in_front(&floor.reversed(), 1e-12).is_none());
        let plate = Polytope::flat(&[DVec3::ZERO, DVec3::X, DVec3::Z]).expect("a triangle");
        let half = plate.in_front(&Plane { normal: DVec3::Z, offset: 0.5 }, 1e-12).expect("half of it");
        assert_eq!((half.vertices().len(), half.edges().len()), (3, 3));
    }

    #[test]
    fn what_is_not_convex_or_not_closed_is_refused() {
        let open = vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3]];
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        assert!(Polytope::closed(corners.clone(), open).is_none());
        // A tetrahedron wound inside out is a room, not a body.
        let inwards = vec![vec![0, 1, 2], vec![0, 3, 1], vec![1, 3, 2], vec![0, 2, 3]];
        assert!(Polytope::closed(corners, inwards).is_none());
    }
}
