//! Polygons that are not convex, as signed triangles.

use crate::formfactor::polygon_to_polygon;
use crate::math::{DVec3, area, convex_defect, unit_normal};

/// Turns by less than this (sine) are rounding.
const STRAIGHT: f64 = 1e-9;

/// Form factor from a convex polygon to a planar polygon that need not be convex (but must not cross itself), nothing
/// between: the sum over the fan of triangles from the first corner, those wound the other way counted negative, since
/// the form factor is an integral over the receiver. Accuracy as [`polygon_to_polygon`], once per triangle.
pub fn polygon_to_any_polygon(a: &[DVec3], b: &[DVec3]) -> f64 {
    if b.len() <= 3 || convex_defect(b) > -STRAIGHT {
        return polygon_to_polygon(a, b);
    }
    let normal = unit_normal(b);
    let part = |w: &[DVec3]| {
        let triangle = [b[0], w[0], w[1]];
        match unit_normal(&triangle).dot(normal) {
            turn if turn > 0.0 => polygon_to_polygon(a, &triangle),
            turn if turn < 0.0 => -polygon_to_polygon(a, &[b[0], w[1], w[0]]),
            _ => 0.0,
        }
    };
    b[1..].windows(2).map(part).sum::<f64>().clamp(0.0, 1.0)
}

/// The same the other way round: from a polygon that need not be convex to a convex one, by reciprocity.
pub fn any_polygon_to_polygon(a: &[DVec3], b: &[DVec3]) -> f64 {
    if a.len() <= 3 || convex_defect(a) > -STRAIGHT {
        return polygon_to_polygon(a, b);
    }
    polygon_to_any_polygon(b, a) * area(b) / area(a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_and_its_notch_are_the_square() {
        let at = |z: f64, list: &[[f64; 2]]| list.iter().map(|[x, y]| DVec3::new(*x, *y, z)).collect::<Vec<_>>();
        let floor = at(0.0, &[[0., 0.], [1., 0.], [1., 2.], [0., 2.]]);
        let square = at(1.0, &[[0., 0.], [0., 2.], [2., 2.], [2., 0.]]);
        let notch = at(1.0, &[[1., 1.], [1., 2.], [2., 2.], [2., 1.]]);
        let l = at(1.0, &[[0., 0.], [0., 2.], [1., 2.], [1., 1.], [2., 1.], [2., 0.]]);
        let all = polygon_to_polygon(&floor, &square);
        for start in 0..l.len() {
            let turned: Vec<DVec3> = (0..l.len()).map(|k| l[(k + start) % l.len()]).collect();
            let sum = polygon_to_any_polygon(&floor, &turned) + polygon_to_polygon(&floor, &notch);
            assert!((sum - all).abs() < 1e-14, "from corner {start}: {sum} {all}");
        }
        assert!((any_polygon_to_polygon(&l, &floor) * 3.0 - polygon_to_any_polygon(&floor, &l) * 2.0).abs() < 1e-15);
    }
}
