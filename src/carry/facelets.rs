//! Their faces as convex pieces of one plane each, with the function that stands on them.

use crate::math::{Bounds, BoxTree, DVec3, area, diameter, plane_defect, unit_normal};
use crate::solution::{MeshValues, ValuesPer};

/// Faces further than this share of their diameter from a plane are cut into triangles, as faces of scenes are.
const PLANE_TOLERANCE: f64 = 1e-6;
/// Faces of less area than this share of their squared diameter are lines: nothing stands on them.
const NO_AREA: f64 = 1e-12;

/// A convex planar piece of a face.
#[derive(Debug)]
pub(super) struct Facelet {
    /// Number of the face.
    pub face: usize,
    /// Corners, counter-clockwise seen from the side that radiates.
    pub corners: Vec<DVec3>,
    /// Unit normal of that side.
    pub normal: DVec3,
    /// Places of the three corners within the face, where values are linear.
    linear: Option<[usize; 3]>,
}

/// All pieces, with the tree that finds them by place.
pub(super) struct Facelets<'a> {
    values: &'a MeshValues,
    list: Vec<Facelet>,
    tree: BoxTree,
}

impl<'a> Facelets<'a> {
    /// The pieces of all faces, wound as written or `turned` around.
    pub fn new(values: &'a MeshValues, turned: bool) -> Self {
        let pieces = (0..values.len()).flat_map(|face| pieces(values, face));
        let mut list: Vec<Facelet> = pieces.filter(has_area).collect();
        if turned {
            list.iter_mut().for_each(Facelet::turn);
        }
        let tree = BoxTree::new(list.iter().map(|f| Bounds::of(&f.corners)).collect());
        Self { values, list, tree }
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.values.bands.len()
    }

    /// A piece by number.
    pub fn get(&self, k: u32) -> &Facelet {
        &self.list[k as usize]
    }

    /// Calls `visit` for each piece whose box meets `bounds`.
    pub fn near(&self, bounds: &Bounds, visit: impl FnMut(u32)) {
        self.tree.near(bounds, visit);
    }

    /// Adds the value of piece `k` at a point of its plane, times `weight`, to `out`: one number per band.
    pub fn add_value(&self, k: u32, point: DVec3, weight: f64, out: &mut [f64]) {
        let facelet = self.get(k);
        let values = self.values.values(facelet.face);
        let bands = out.len();
        let Some(places) = facelet.linear else {
            out.iter_mut().zip(values).for_each(|(o, v)| *o += weight * v);
            return;
        };
        let (s, t) = facelet.coordinates(point);
        for (band, o) in out.iter_mut().enumerate() {
            let [a, b, c] = places.map(|place| values[place * bands + band]);
            *o += weight * (a + s * (b - a) + t * (c - a));
        }
    }
}

impl Facelet {
    fn turn(&mut self) {
        self.corners.reverse();
        self.normal = -self.normal;
        self.linear = self.linear.map(|[a, b, c]| [c, b, a]);
    }

    /// (s, t) with point = corner 0 + s (corner 1 - corner 0) + t (corner 2 - corner 0).
    fn coordinates(&self, point: DVec3) -> (f64, f64) {
        let (o, b, c) = (self.corners[0], self.corners[1] - self.corners[0], self.corners[2] - self.corners[0]);
        let whole = b.cross(c).dot(self.normal);
        let p = point - o;
        (p.cross(c).dot(self.normal) / whole, b.cross(p).dot(self.normal) / whole)
    }

    /// The point of the piece that is nearest to a point.
    pub fn nearest_point(&self, point: DVec3) -> DVec3 {
        let k = self.corners.len();
        let edge = |i: usize| (self.corners[i], self.corners[(i + 1) % k]);
        let outside = |(a, b): (DVec3, DVec3)| self.normal.cross(b - a).dot(point - a) < 0.0;
        if !(0..k).map(edge).any(outside) {
            return point - self.normal * self.normal.dot(point - self.corners[0]);
        }
        let on_edge = |(a, b): (DVec3, DVec3)| {
            let along = (point - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
            a + (b - a) * along.clamp(0.0, 1.0)
        };
        let ends = (0..k).map(edge).map(on_edge);
        ends.min_by(|p, q| p.distance_squared(point).total_cmp(&q.distance_squared(point))).unwrap_or(self.corners[0])
    }
}

fn has_area(f: &Facelet) -> bool {
    let d = diameter(&f.corners);
    area(&f.corners) > NO_AREA * d * d
}

/// The planar pieces of a convex face: itself, or the triangles from its first corner, where it is bent or its values
/// are linear on them.
fn pieces(values: &MeshValues, face: usize) -> Vec<Facelet> {
    let corners = values.corners(face);
    let linear = values.per() == ValuesPer::Corner;
    if linear || (corners.len() > 3 && plane_defect(corners) > PLANE_TOLERANCE) {
        let triangle = |k: usize| {
            let places = [0, k, k + 1];
            let corners = places.map(|i| corners[i]).to_vec();
            Facelet { face, normal: unit_normal(&corners), corners, linear: linear.then_some(places) }
        };
        return (1..corners.len() - 1).map(triangle).collect();
    }
    vec![Facelet { face, normal: unit_normal(corners), corners: corners.to_vec(), linear: None }]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, 0.0)
    }

    #[test]
    fn values_are_linear_between_corners_however_the_face_is_turned() {
        let mut m = MeshValues::new(vec!["y".into()], ValuesPer::Corner);
        m.push(&[p(0.0, 0.0), p(2.0, 0.0), p(2.0, 1.0), p(0.0, 1.0)], &[1.0, 3.0, 4.0, 2.0]);
        for turned in [false, true] {
            let facelets = Facelets::new(&m, turned);
            assert_eq!(facelets.list.len(), 2);
            let mut out = [0.0];
            facelets.add_value(0, p(1.0, 0.25), 1.0, &mut out);
            assert!((out[0] - 2.25).abs() < 1e-15, "{out:?}");
        }
    }

    #[test]
    fn a_bent_face_is_cut_and_a_line_left_out() {
        let mut m = MeshValues::new(vec!["y".into()], ValuesPer::Face);
        m.push(&[p(0.0, 0.0), p(1.0, 0.0), DVec3::new(1.0, 1.0, 0.1), p(0.0, 1.0)], &[1.0]);
        m.push(&[p(0.0, 0.0), p(2.0, 2.0), p(1.0, 1.0)], &[1.0]);
        let facelets = Facelets::new(&m, false);
        assert_eq!(facelets.list.len(), 2);
        assert!(facelets.list.iter().all(|f| f.face == 0 && f.corners.len() == 3));
    }

    #[test]
    fn the_nearest_point_lies_inside_or_on_the_rim() {
        let mut m = MeshValues::new(vec!["y".into()], ValuesPer::Face);
        m.push(&[p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)], &[1.0]);
        let facelets = Facelets::new(&m, false);
        let f = facelets.get(0);
        assert_eq!(f.nearest_point(DVec3::new(0.3, 0.4, 2.0)), p(0.3, 0.4));
        assert_eq!(f.nearest_point(DVec3::new(3.0, 0.5, -1.0)), p(1.0, 0.5));
        assert_eq!(f.nearest_point(DVec3::new(2.0, 5.0, 1.0)), p(1.0, 1.0));
    }
}
