//! Opaque convex bodies: plates and polyhedra, and the cone of directions each of them hides from a point.

use super::geometry::{ON_PLANE, Plane, Vector, along, cross, dot, in_front, plane_of, sub};

/// An opaque convex body. A plate is a body of two faces that share all their edges.
#[derive(Clone, Debug)]
pub struct Body {
    pub corners: Vec<Vector>,
    pub planes: Vec<Plane>,
    pub edges: Vec<Edge>,
    faces: Vec<Vec<Vector>>,
}

/// An edge runs counter-clockwise round face `left` and clockwise round face `right`.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    pub from: Vector,
    pub to: Vector,
    left: usize,
    right: usize,
}

/// What a body hides from a point: directions w with `w . n >= 0` for every normal n.
#[derive(Clone, Debug, Default)]
pub struct Cone {
    pub normals: Vec<Vector>,
}

/// How a body stands before a point.
pub enum Shadow {
    /// The point sees the body edge on.
    None,
    /// The point lies inside the body, or under a face that rests on it.
    Everything,
    Cone(Cone),
}

impl Body {
    /// A plate: opaque from both sides.
    pub fn plate(corners: &[Vector]) -> Self {
        let back: Vec<Vector> = corners.iter().rev().copied().collect();
        Self::solid(vec![corners.to_vec(), back]).expect("a plate is closed")
    }

    /// A convex polyhedron of faces that run counter-clockwise seen from outside.
    ///
    /// # Errors
    /// An edge without a second face.
    pub fn solid(faces: Vec<Vec<Vector>>) -> Result<Self, String> {
        let planes = faces.iter().map(|f| plane_of(f)).collect();
        let mut corners: Vec<Vector> = Vec::new();
        for &c in faces.iter().flatten() {
            if !corners.iter().any(|&k| same(k, c)) {
                corners.push(c);
            }
        }
        let mut edges = Vec::new();
        for (left, face) in faces.iter().enumerate() {
            for (from, to) in sides(face) {
                let right = (0..faces.len())
                    .find(|&r| r != left && sides(&faces[r]).any(|(a, b)| same(a, to) && same(b, from)));
                let right = right.ok_or_else(|| format!("the edge {from:?} to {to:?} has one face only"))?;
                if left < right {
                    edges.push(Edge { from, to, left, right });
                }
            }
        }
        Ok(Self { corners, planes, edges, faces })
    }

    /// The part in front of a plane, or nothing. The cut is closed by a new face.
    pub fn in_front(&self, plane: &Plane) -> Option<Self> {
        let heights = || self.corners.iter().map(|&c| plane.height(c));
        if heights().all(|h| h <= ON_PLANE) {
            return None;
        }
        if heights().all(|h| h >= -ON_PLANE) {
            return Some(self.clone());
        }
        if self.faces.len() == 2 {
            return Some(Self::plate(&in_front(&self.faces[0], plane)));
        }
        let mut faces: Vec<_> = self.faces.iter().map(|f| in_front(f, plane)).filter(|f| !f.is_empty()).collect();
        faces.push(lid(&faces, plane));
        Some(Self::solid(faces).expect("a cut polyhedron with a lid is closed"))
    }

    /// Its faces, each counter-clockwise seen from outside.
    pub fn faces(&self) -> &[Vec<Vector>] {
        &self.faces
    }

    /// The directions it hides from `x`.
    pub fn shadow(&self, x: Vector) -> Shadow {
        let seen: Vec<bool> = self.planes.iter().map(|p| p.height(x) > ON_PLANE).collect();
        if !seen.contains(&true) {
            return if self.faces.len() == 2 { Shadow::None } else { Shadow::Everything };
        }
        let mut normals = Vec::with_capacity(8);
        for e in &self.edges {
            let (a, b) = (sub(e.from, x), sub(e.to, x));
            match (seen[e.left], seen[e.right]) {
                (true, false) => normals.push(cross(b, a)),
                (false, true) => normals.push(cross(a, b)),
                _ => {}
            }
        }
        Shadow::Cone(Cone { normals })
    }
}

fn same(a: Vector, b: Vector) -> bool {
    let d = sub(a, b);
    dot(d, d) < ON_PLANE * ON_PLANE * 100.0
}

fn sides(face: &[Vector]) -> impl Iterator<Item = (Vector, Vector)> {
    (0..face.len()).map(|k| (face[k], face[(k + 1) % face.len()]))
}

/// The face that closes a cut: corners on the plane, counter-clockwise seen from behind it.
fn lid(faces: &[Vec<Vector>], plane: &Plane) -> Vec<Vector> {
    let mut rim: Vec<Vector> = Vec::new();
    for &c in faces.iter().flatten() {
        if plane.height(c).abs() < 10.0 * ON_PLANE && !rim.iter().any(|&k| same(k, c)) {
            rim.push(c);
        }
    }
    let middle = rim.iter().fold([0.0; 3], |m, &c| along(m, 1.0 / rim.len() as f64, c));
    let first = sub(rim[0], middle);
    let second = cross(plane.turned().normal, first);
    let angle = |c: &Vector| dot(sub(*c, middle), second).atan2(dot(sub(*c, middle), first));
    rim.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    rim
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Body {
        let v = |i: usize| [(i & 1) as f64, ((i >> 1) & 1) as f64, ((i >> 2) & 1) as f64];
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]];
        Body::solid(faces.iter().map(|f| f.iter().map(|&i| v(i)).collect()).collect()).unwrap()
    }

    #[test]
    fn a_cube_has_twelve_edges_and_a_hexagon_for_an_outline() {
        let cube = cube();
        assert_eq!((cube.corners.len(), cube.edges.len()), (8, 12));
        assert!(cube.planes.iter().all(|p| p.height([0.5; 3]) < 0.0));
        let Shadow::Cone(cone) = cube.shadow([3.0, 4.0, 5.0]) else { panic!("no cone") };
        assert_eq!(cone.normals.len(), 6);
        assert!(cone.normals.iter().all(|&n| dot(n, [-2.5, -3.5, -4.5]) > 0.0));
    }

    #[test]
    fn a_cut_cube_is_closed_again() {
        let plane = Plane { normal: super::super::geometry::unit([1.0, 1.0, 1.0]), offset: 0.5 };
        let rest = cube().in_front(&plane).unwrap();
        assert_eq!((rest.planes.len(), rest.corners.len()), (7, 10));
        assert!(rest.planes.iter().all(|p| p.height([0.9; 3]) < 0.0));
    }
}
