//! Rectangles: the two classical formulas, as a check on the general polygon-to-polygon integral and for quick sums.

use super::lengths;
use std::f64::consts::PI;

/// Form factor between two equal rectangles `a` by `b`, parallel and directly opposed, `c` apart (Howell C-11).
/// Digits are lost to cancellation where they are far apart (about 1e-16 absolute times the square of the distance in
/// sides): [`crate::formfactor::polygon_to_polygon`] keeps them. Lengths not finite and above 0: NaN.
pub fn opposed_rectangles(a: f64, b: f64, c: f64) -> f64 {
    if !lengths(&[a, b, c]) {
        return f64::NAN;
    }
    let (x, y) = (a / c, b / c);
    let (u, v) = (1.0 + x * x, 1.0 + y * y);
    let corner = 0.5 * (u * v / (u + y * y)).ln();
    let along = x * v.sqrt() * (x / v.sqrt()).atan() + y * u.sqrt() * (y / u.sqrt()).atan();
    2.0 / (PI * x * y) * (corner + along - x * x.atan() - y * y.atan())
}

/// Form factor from a rectangle `w` wide to one `h` high at right angles to it, with a common edge `l` long
/// (Howell C-14). Digits are lost as in [`opposed_rectangles`]. Lengths not finite and above 0: NaN.
pub fn rectangles_with_common_edge(w: f64, h: f64, l: f64) -> f64 {
    if !lengths(&[w, h, l]) {
        return f64::NAN;
    }
    let (w, h) = (w / l, h / l);
    let (w2, h2) = (w * w, h * h);
    let (all, both) = (1.0 + w2 + h2, w2 + h2);
    let corner = ((1.0 + w2) * (1.0 + h2) / all).ln();
    let sides = w2 * (w2 * all / ((1.0 + w2) * both)).ln() + h2 * (h2 * all / ((1.0 + h2) * both)).ln();
    let angles = w * (1.0 / w).atan() + h * (1.0 / h).atan() - both.sqrt() * (1.0 / both.sqrt()).atan();
    (angles + 0.25 * (corner + sides)) / (PI * w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formfactor::polygon_to_polygon;
    use crate::math::DVec3;

    #[test]
    fn the_general_integral_says_the_same() {
        for (a, b, c) in [(1.0, 1.0, 1.0), (1.0, 2.0, 0.3), (0.2, 5.0, 1.0), (3.0, 3.0, 0.01)] {
            let floor = [[0., 0.], [a, 0.], [a, b], [0., b]].map(|[x, y]| DVec3::new(x, y, 0.0));
            let lid = [[0., 0.], [0., b], [a, b], [a, 0.]].map(|[x, y]| DVec3::new(x, y, c));
            assert!((opposed_rectangles(a, b, c) - polygon_to_polygon(&floor, &lid)).abs() < 1e-13, "{a} {b} {c}");
            // The same three lengths as width, height and edge.
            let wall = [[0., 0.], [0., b], [c, b], [c, 0.]].map(|[z, x]| DVec3::new(x, 0.0, z));
            let ground = [[0., 0.], [b, 0.], [b, a], [0., a]].map(|[x, y]| DVec3::new(x, y, 0.0));
            let wall: Vec<DVec3> = if polygon_to_polygon(&ground, &wall) > 0.0 {
                wall.to_vec()
            } else {
                wall.iter().rev().copied().collect()
            };
            let f = rectangles_with_common_edge(a, c, b);
            assert!((f - polygon_to_polygon(&ground, &wall)).abs() < 1e-13, "{a} {c} {b}: {f}");
        }
        assert!(opposed_rectangles(1.0, 0.0, 1.0).is_nan() && rectangles_with_common_edge(f64::NAN, 1., 1.).is_nan());
    }
}
