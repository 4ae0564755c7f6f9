//! Mesh faces that are not planar or not convex, cut into triangles.

use crate::io::scene::polygon::{Flaw, flaw};
use crate::math::{DVec3, Frame, diameter, plane_defect, unit_normal};

/// A face as planar convex polygons.
pub(in crate::io) enum Parts {
    /// It is one.
    Whole,
    /// Triangles, as numbers of its corners, and how far it is off a plane, in the unit of the corners.
    Triangles(Vec<[usize; 3]>, f64),
    /// It has no area.
    Nothing,
    /// It crosses itself.
    Crossed,
}

/// How a face with finite corners falls into planar convex polygons.
pub(in crate::io) fn parts(corners: &[DVec3]) -> Parts {
    let off = match flaw(corners) {
        None => return Parts::Whole,
        Some(Flaw::NoArea) => return Parts::Nothing,
        Some(Flaw::NotPlanar(_)) => plane_defect(corners) * diameter(corners),
        Some(Flaw::NotConvex) => 0.0,
    };
    let Some(mut triangles) = ear_numbers(corners) else { return Parts::Crossed };
    triangles.retain(|t| flaw(&t.map(|i| corners[i])).is_none());
    Parts::Triangles(triangles, off)
}

/// Ears cut off one after the other, the first possible one each time: a convex quadrilateral falls into
/// (0, 1, 2) and (0, 2, 3). `None` if the loop crosses itself.
pub(in crate::io::scene) fn ears(corners: &[DVec3]) -> Option<Vec<[DVec3; 3]>> {
    Some(ear_numbers(corners)?.into_iter().map(|t| t.map(|i| corners[i])).collect())
}

/// The same as numbers of corners.
fn ear_numbers(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let normal = unit_normal(corners);
    let along = corners.iter().map(|c| *c - corners[0]).find(|d| d.cross(normal).length() > 0.0)?;
    let frame = Frame::with_x_axis(normal, along);
    let flat: Vec<DVec3> = corners.iter().map(|c| frame.to_local(*c - corners[0])).collect();
    if crosses_itself(&flat) {
        return None;
    }
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::with_capacity(corners.len() - 2);
    while left.len() > 3 {
        let ear = (1..=left.len()).map(|i| i % left.len()).find(|i| is_ear(&flat, &left, *i))?;
        triangles.push(around(&left, ear));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles.iter().all(|t| signed(&t.map(|i| flat[i])) >= 0.0).then_some(triangles)
}

/// True if two edges that are no neighbours cross.
fn crosses_itself(flat: &[DVec3]) -> bool {
    let k = flat.len();
    let side = |a: DVec3, b: DVec3, p: DVec3| signed(&[a, b, p]);
    (0..k).any(|i| {
        let (a, b) = (flat[i], flat[(i + 1) % k]);
        (i + 2..k).filter(|j| (j + 1) % k != i).any(|j| {
            let (c, d) = (flat[j], flat[(j + 1) % k]);
            side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
        })
    })
}

fn around(left: &[usize], i: usize) -> [usize; 3] {
    let k = left.len();
    [left[(i + k - 1) % k], left[i], left[(i + 1) % k]]
}

/// Signed area in the plane of the frame.
fn signed(t: &[DVec3; 3]) -> f64 {
    0.5 * (t[1] - t[0]).cross(t[2] - t[0]).z
}

/// True if the corner turns the right way and no other corner lies in its triangle; corners of the same place (the
/// ends of a seam to a hole) do not count.
fn is_ear(flat: &[DVec3], left: &[usize], i: usize) -> bool {
    let corners = around(left, i);
    let t = corners.map(|c| flat[c]);
    if signed(&t) <= 0.0 {
        return false;
    }
    let inside = |p: DVec3| (0..3).all(|k| signed(&[t[k], t[(k + 1) % 3], p]) >= 0.0);
    left.iter().filter(|c| !corners.contains(c) && !t.contains(&flat[**c])).all(|c| !inside(flat[*c]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::area;

    fn loop_of(points: &[(f64, f64, f64)]) -> Vec<DVec3> {
        points.iter().map(|(x, y, z)| DVec3::new(*x, *y, *z)).collect()
    }

    #[test]
    fn a_bent_quadrilateral_is_cut_along_its_first_diagonal() {
        let q = loop_of(&[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.1), (0.0, 1.0, 0.0)]);
        assert_eq!(ears(&q).unwrap(), vec![[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    }

    #[test]
    fn an_l_keeps_its_area_and_its_winding() {
        let l = loop_of(&[
            (0.0, 0.0, 0.0),
            (3.0, 0.0, 0.0),
            (3.0, 1.0, 0.0),
            (1.0, 1.0, 0.0),
            (1.0, 3.0, 0.0),
            (0.0, 3.0, 0.0),
        ]);
        let parts = ears(&l).unwrap();
        assert_eq!(parts.len(), 4);
        assert!((parts.iter().map(|t| area(t)).sum::<f64>() - 5.0).abs() < 1e-14);
        assert!(parts.iter().all(|t| unit_normal(t).z > 0.0));
    }

    #[test]
    fn a_seam_leads_to_a_hole() {
        let outer = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 4.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 0.0)];
        let hole = [(1.0, 1.0, 0.0), (1.0, 3.0, 0.0), (3.0, 3.0, 0.0), (3.0, 1.0, 0.0), (1.0, 1.0, 0.0)];
        let parts = ears(&loop_of(&[outer, hole].concat())).unwrap();
        let within = |t: &[DVec3; 3]| (t.iter().sum::<DVec3>() / 3.0 - DVec3::new(2.0, 2.0, 0.0)).abs().max_element();
        assert!((parts.iter().map(|t| area(t)).sum::<f64>() - 12.0).abs() < 1e-14);
        assert!(parts.iter().filter(|t| area(*t) > 0.0).all(|t| within(t) > 1.0), "{parts:?}");
    }

    #[test]
    fn a_loop_that_crosses_itself_is_refused() {
        let bow = loop_of(&[(0.0, 0.0, 0.0), (2.0, 2.0, 0.0), (2.0, 0.0, 0.0), (0.0, 1.0, 0.0)]);
        assert!(ears(&bow).is_none());
    }
}
