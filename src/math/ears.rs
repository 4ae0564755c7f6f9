//! Polygons that are not planar or not convex, cut into triangles.

use super::{DVec3, Frame, unit_normal};

/// Ears cut off one after the other, the first possible one each time: a convex quadrilateral falls into
/// (0, 1, 2) and (0, 2, 3). Triangles as numbers of corners, wound like the loop; `None` if it crosses itself.
pub fn ears(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
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

/// True if the corner turns the right way and no other corner lies in its triangle.
fn is_ear(flat: &[DVec3], left: &[usize], i: usize) -> bool {
    let corners = around(left, i);
    let t = corners.map(|c| flat[c]);
    if signed(&t) <= 0.0 {
        return false;
    }
    let inside = |p: DVec3| (0..3).all(|k| signed(&[t[k], t[(k + 1) % 3], p]) >= 0.0);
    left.iter().filter(|c| !corners.contains(c)).all(|c| !inside(flat[*c]))
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
        assert_eq!(ears(&q).unwrap(), [[0, 1, 2], [0, 2, 3]]);
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
        let parts: Vec<_> = ears(&l).unwrap().into_iter().map(|t| t.map(|i| l[i])).collect();
        assert_eq!(parts.len(), 4);
        assert!((parts.iter().map(|t| area(t)).sum::<f64>() - 5.0).abs() < 1e-14);
        assert!(parts.iter().all(|t| unit_normal(t).z > 0.0));
    }

    #[test]
    fn a_loop_that_crosses_itself_is_refused() {
        let bow = loop_of(&[(0.0, 0.0, 0.0), (2.0, 2.0, 0.0), (2.0, 0.0, 0.0), (0.0, 1.0, 0.0)]);
        assert!(ears(&bow).is_none());
    }
}
