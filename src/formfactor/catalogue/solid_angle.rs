//! Solid angles: what a point that sees all directions alike sees.

use super::lengths;
use crate::math::DVec3;
use std::f64::consts::TAU;

/// Solid angle (sr) under which `point` sees the front of a planar polygon, convex or not; 0 from behind and from its
/// plane. Vertices counter-clockwise seen from the front.
///
/// Sum over the fan of triangles, each `2 atan2(a . (b x c), abc + a (b . c) + b (c . a) + c (a . b))` (A. Van Oosterom
/// and J. Strackee, 1983). Signed: what a fan counts too much outside of a polygon that is not convex, it takes away
/// again. Fewer than three vertices: 0. Coordinates that are not finite: NaN.
pub fn polygon_solid_angle(point: DVec3, polygon: &[DVec3]) -> f64 {
    if polygon.len() < 3 {
        return 0.0;
    }
    let seen: Vec<DVec3> = polygon.iter().map(|p| *p - point).collect();
    let triangle = |w: &[DVec3]| {
        let (a, b, c) = (seen[0], w[0], w[1]);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        // From an edge of the triangle instead of from the point: the normal keeps its digits.
        let volume = a.dot((b - a).cross(c - a));
        2.0 * volume.atan2(la * lb * lc + la * b.dot(c) + lb * c.dot(a) + lc * a.dot(b))
    };
    // Minus: the front is wound counter-clockwise for who looks at it, and then the volume is negative.
    let angle = -seen[1..].windows(2).map(triangle).sum::<f64>();
    if angle.is_nan() { angle } else { angle.max(0.0) }
}

/// Solid angle (sr) of a disk of radius `r` seen from its axis at distance `h`: `2 pi (1 - h / sqrt(h^2 + r^2))`.
pub fn disk_solid_angle(r: f64, h: f64) -> f64 {
    if !lengths(&[r, h]) {
        return f64::NAN;
    }
    let slant = h.hypot(r);
    // Without the difference of two numbers that are almost one.
    TAU * r * r / (slant * (slant + h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn faces_of_a_cube_fill_the_view_and_notches_are_left_out() {
        let square = [[-1., -1.], [-1., 1.], [1., 1.], [1., -1.]].map(|[x, y]| DVec3::new(x, y, 1.0));
        assert!((polygon_solid_angle(DVec3::ZERO, &square) - 4.0 * PI / 6.0).abs() < 1e-15);
        assert_eq!(polygon_solid_angle(DVec3::Z * 2.0, &square), 0.0, "from behind");
        let l = [[-1., -1.], [-1., 1.], [0., 1.], [0., 0.], [1., 0.], [1., -1.]].map(|[x, y]| DVec3::new(x, y, 1.0));
        assert!((polygon_solid_angle(DVec3::ZERO, &l) - 0.75 * 4.0 * PI / 6.0).abs() < 1e-15);
        // From any corner as the middle of the fan.
        let turned: Vec<DVec3> = (0..6).map(|k| l[(k + 4) % 6]).collect();
        assert!((polygon_solid_angle(DVec3::ZERO, &turned) - 0.5 * PI).abs() < 1e-15);
    }

    #[test]
    fn disks_near_and_far() {
        assert!((disk_solid_angle(1.0, 1e-9) - TAU).abs() < 1e-8);
        assert!((disk_solid_angle(1.0, 1e9) / (PI * 1e-18) - 1.0).abs() < 1e-15);
        assert!(disk_solid_angle(-1.0, 1.0).is_nan());
    }
}
