//! Spheres, seen from an element, a polygon, a disk and another sphere. The outside radiates unless told otherwise.

use super::integral::integral_in_pieces;
use super::{disk_solid_angle, lengths, polygon_solid_angle};
use crate::math::{DVec3, area, unit_normal};
use std::f64::consts::PI;

/// Form factor from a differential area at `point` with `normal` to a sphere, the part below the horizon left out.
///
/// Wholly above the horizon `cos t / H^2`, with `H` the distance in radii and `t` the angle between normal and centre;
/// cut by the horizon the entry of Howell's part B for that case (also K. H. Juul, 1979). From inside: 1 (the sphere
/// closes the view). Lengths not finite, radius not above 0: NaN.
pub fn element_to_sphere(point: DVec3, normal: DVec3, centre: DVec3, radius: f64) -> f64 {
    let (n, c) = (normal.normalize_or_zero(), centre - point);
    let distance = c.length();
    if !lengths(&[radius]) || !distance.is_finite() || n == DVec3::ZERO {
        return f64::NAN;
    }
    if distance <= radius {
        return 1.0;
    }
    // The angle from both its functions: near 0 and near a right angle one of them is blurred.
    above_horizon(distance / radius, n.dot(c) / distance, n.cross(c).length() / distance)
}

/// `H` above 1, cosine and sine of the angle between normal and centre.
fn above_horizon(h: f64, cos: f64, sin: f64) -> f64 {
    if h * cos >= 1.0 {
        return cos / (h * h);
    }
    if h * cos <= -1.0 {
        return 0.0;
    }
    let q = ((h - 1.0) * (h + 1.0)).sqrt();
    let rest = ((1.0 - h * cos) * (1.0 + h * cos)).max(0.0).sqrt();
    let tilted = cos * (-q * cos / sin).clamp(-1.0, 1.0).acos() - q * rest;
    let f = 0.5 - (q / (h * sin)).clamp(-1.0, 1.0).asin() / PI + tilted / (PI * h * h);
    f.clamp(0.0, 1.0)
}

/// Form factor from a polygon, convex or not, to a sphere that lies wholly in front of its plane: `r^2 Omega / A`, with
/// `Omega` the solid angle of the polygon seen from the centre, since every element sees `r^2 cos / d^2` of the
/// sphere. `None` if the sphere reaches the plane, where that is not so.
pub fn polygon_to_sphere(polygon: &[DVec3], centre: DVec3, radius: f64) -> Option<f64> {
    let sound = polygon.len() >= 3 && lengths(&[radius, area(polygon)]);
    let height = unit_normal(polygon).dot(centre - *polygon.first()?);
    (sound && height >= radius).then(|| radius * radius * polygon_solid_angle(centre, polygon) / area(polygon))
}

/// Form factor from a disk of radius `r` to a sphere of radius `sphere` whose centre is on its axis, `h` above it: by
/// the same argument `sphere^2 Omega / (pi r^2)`. `None` if the sphere reaches the disk's plane.
pub fn disk_to_coaxial_sphere(r: f64, sphere: f64, h: f64) -> Option<f64> {
    (lengths(&[r, sphere, h]) && h >= sphere).then(|| sphere * sphere * disk_solid_angle(r, h) / (PI * r * r))
}

/// Form factor from a sphere of radius `r1` to one of radius `r2` outside of it, centres `d` apart (tabulated by Juul
/// 1976; no elementary form is known): [`element_to_sphere`] integrated over the first sphere,
/// `1/2 integral of F(c) dc` over the cosine c of the polar angle, cut where the second sphere begins to rise and is
/// risen. Accurate to 1e-12 relative, also where they almost touch. Spheres that overlap, lengths not finite and above 0: NaN.
pub fn sphere_to_sphere(r1: f64, r2: f64, d: f64) -> f64 {
    if !lengths(&[r1, r2, d]) || r1 + r2 > d {
        return f64::NAN;
    }
    let seen = |c: f64| {
        let distance = ((d - r1) * (d - r1) + 2.0 * r1 * d * (1.0 - c)).max(r2 * r2).sqrt();
        let sine = d * (1.0 - c * c).max(0.0).sqrt() / distance;
        above_horizon(distance / r2, (d * c - r1) / distance, sine)
    };
    0.5 * integral_in_pieces((r1 - r2) / d, 1.0, &[(r1 + r2) / d], seen)
}

/// Form factors between the inside of a sphere of radius `outer` and the outside of one of radius `inner` within, for
/// any position: (outer to inner, inner to outer) = `(inner/outer)^2`, 1. NaN unless `0 < inner <= outer`.
pub fn concentric_spheres(outer: f64, inner: f64) -> (f64, f64) {
    let sound = lengths(&[outer, inner]) && inner <= outer;
    if sound { ((inner / outer).powi(2), 1.0) } else { (f64::NAN, f64::NAN) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_and_its_opposite_share_the_sphere() {
        // What the horizon cuts off one side, the other side sees: F(n) - F(-n) = cos t / H^2.
        for h in [1.0001, 1.2, 3.0, 40.0] {
            for k in 1..40 {
                let t = PI * f64::from(k) / 40.0;
                let of = |n: DVec3| element_to_sphere(DVec3::ZERO, n, DVec3::Z * h, 1.0);
                let n = DVec3::new(t.sin(), 0.0, t.cos());
                assert!((of(n) - of(-n) - t.cos() / (h * h)).abs() < 3e-15, "H {h} t {t}");
            }
        }
        assert_eq!(element_to_sphere(DVec3::ZERO, DVec3::Z, DVec3::X * 0.5, 1.0), 1.0);
        assert!(element_to_sphere(DVec3::ZERO, DVec3::Z, DVec3::X, -1.0).is_nan());
    }

    #[test]
    fn the_horizon_changes_nothing_suddenly() {
        for h in [1.01f64, 2.0, 7.0] {
            let edge = (1.0 / h).acos();
            let at = |t: f64| element_to_sphere(DVec3::ZERO, DVec3::new(t.sin(), 0.0, t.cos()), DVec3::Z * h, 1.0);
            assert!((at(edge - 1e-7) - at(edge + 1e-7)).abs() < 1e-6);
            assert!(at(PI - edge - 1e-7) < 1e-9 && at(PI - edge + 1e-7) == 0.0);
        }
    }

    #[test]
    fn six_walls_share_a_sphere() {
        let wall = [[0., 0.], [2., 0.], [2., 2.], [0., 2.]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let f = polygon_to_sphere(&wall, DVec3::ONE, 0.7).unwrap();
        assert!((f - 4.0 * PI * 0.49 / 6.0 / 4.0).abs() < 1e-15);
        assert_eq!(polygon_to_sphere(&wall, DVec3::ONE, 1.1), None, "it reaches the plane");
        assert_eq!(polygon_to_sphere(&wall, -DVec3::ONE, 0.5), None, "behind");
        let far = disk_to_coaxial_sphere(1e-6, 1.0, 3.0).unwrap();
        assert!((far - 1.0 / 9.0).abs() < 1e-12, "a speck sees cos / H^2");
    }

    #[test]
    fn spheres_exchange_alike_and_far_ones_by_their_solid_angle() {
        for (r1, r2, d) in [(1.0, 0.5, 2.0), (3.0, 0.01, 3.02), (1.0, 1.0, 2.0)] {
            let (there, back) = (sphere_to_sphere(r1, r2, d), sphere_to_sphere(r2, r1, d));
            assert!((r1 * r1 * there / (r2 * r2 * back) - 1.0).abs() < 1e-11, "{r1} {r2} {d}: {there} {back}");
        }
        // A small sphere far away fills pi r^2 / d^2 of the 4 pi around.
        let far = sphere_to_sphere(1.0, 1.0, 1e4);
        assert!((far * 4.0 * 1e8 - 1.0).abs() < 1e-7);
        assert!(sphere_to_sphere(1.0, 1.0, 1.9).is_nan());
        assert_eq!(concentric_spheres(2.0, 1.0), (0.25, 1.0));
    }
}
