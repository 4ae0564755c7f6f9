//! Disks and polygons with something round between them.

use super::integral::integral_in_pieces;
use super::{lengths, polygon_to_sphere};
use crate::formfactor::polygon_to_polygon;
use crate::math::{DVec3, unit_normal};
use std::f64::consts::PI;

/// Form factor from a disk of radius `r1` to a parallel disk of radius `r2` on the same axis, `h` apart, with an opaque
/// disk of radius `screen` on the axis at height `at` (0 < at < h) between them.
///
/// Double integral over the two radii of the kernel `h^2 / (pi d^4)`, whose integral over the azimuth that clears the
/// screen is closed; cut where the shadow's edge meets an axis or a rim. Accurate to 1e-12. Lengths not finite and
/// above 0, a screen outside of the gap: NaN.
pub fn coaxial_disks_past_disk(r1: f64, r2: f64, h: f64, screen: f64, at: f64) -> f64 {
    if !lengths(&[r1, r2, h, screen, at]) || at >= h {
        return f64::NAN;
    }
    let t = at / h;
    let ring = |rho: f64| {
        let near = (1.0 - t) * rho;
        let corners = [(screen - near) / t, (near - screen) / t, (near + screen) / t];
        rho * integral_in_pieces(0.0, r2, &corners, |s| s * azimuth(rho, s, h, clear_azimuth(near, t * s, screen)))
    };
    let far = t * r2;
    let corners = [screen, screen - far, far - screen, far + screen].map(|c| c / (1.0 - t));
    4.0 * h * h / (PI * r1 * r1) * integral_in_pieces(0.0, r1, &corners, ring)
}

/// Half the azimuth, from 0, in which a line clears the screen: it crosses the screen's plane at the sum of two
/// vectors of these lengths.
fn clear_azimuth(near: f64, far: f64, screen: f64) -> f64 {
    let cosine = (screen * screen - near * near - far * far) / (2.0 * near * far);
    cosine.clamp(-1.0, 1.0).acos()
}

/// Integral from 0 to `end` of `d phi / (a - b cos phi)^2`, the squared distance to the second power.
fn azimuth(rho: f64, s: f64, h: f64, end: f64) -> f64 {
    let (a, b) = (rho * rho + s * s + h * h, 2.0 * rho * s);
    let (less, more) = ((rho - s) * (rho - s) + h * h, (rho + s) * (rho + s) + h * h);
    let root = (less * more).sqrt();
    let half = 0.5 * end;
    let single = 2.0 / root * (more.sqrt() * half.sin()).atan2(less.sqrt() * half.cos());
    (a * single + b * end.sin() / (a - b * end.cos())) / (less * more)
}

/// Form factor between two convex polygons with an opaque sphere between them whose every shadow falls inside the
/// second: the open form factor less what the sphere takes. `None` where that cannot be shown: the sphere has to lie
/// in front of both planes, and for every edge of `b` a plane through it has to part `a` from the sphere.
pub fn polygons_past_sphere(a: &[DVec3], b: &[DVec3], centre: DVec3, radius: f64) -> Option<f64> {
    if a.len() < 3 || b.len() < 3 || unit_normal(b).dot(centre - b[0]) < radius {
        return None;
    }
    let parted = |k: usize| {
        let (from, to) = (b[k], b[(k + 1) % b.len()]);
        a.iter().any(|corner| {
            let n = (to - from).cross(*corner - from).normalize_or_zero();
            let n = n * n.dot(centre - from).signum();
            let slack = 1e-12 * (centre - from).length();
            n.dot(centre - from) >= radius && a.iter().all(|p| n.dot(*p - from) <= slack)
        })
    };
    let taken = polygon_to_sphere(a, centre, radius)?;
    (0..b.len()).all(parted).then(|| (polygon_to_polygon(a, b) - taken).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::super::coaxial_disks;
    use super::*;

    #[test]
    fn small_screens_take_what_reaches_them() {
        // Every shadow falls inside the second disk: what is lost is what the first disk sends to the screen.
        let f = coaxial_disks_past_disk(0.5, 1.5, 1.0, 0.25, 0.5);
        assert!((f - (coaxial_disks(0.5, 1.5, 1.0) - coaxial_disks(0.5, 0.25, 0.5))).abs() < 1e-12, "{f}");
        let open = coaxial_disks_past_disk(1.0, 1.0, 1.0, 1e-9, 0.3);
        assert!((open - coaxial_disks(1.0, 1.0, 1.0)).abs() < 1e-12);
        assert_eq!(coaxial_disks_past_disk(1.0, 1.0, 1.0, 1.0, 0.5), 0.0, "it covers all lines");
    }

    #[test]
    fn screened_disks_exchange_alike() {
        let (there, back) =
            (coaxial_disks_past_disk(1.0, 0.7, 1.3, 0.4, 0.5), coaxial_disks_past_disk(0.7, 1.0, 1.3, 0.4, 0.8));
        assert!((there - 0.49 * back).abs() < 1e-12, "{there} {back}");
        assert!(coaxial_disks_past_disk(1.0, 1.0, 1.0, 0.5, 1.0).is_nan());
    }

    #[test]
    fn shadows_that_reach_the_rim_are_not_answered() {
        let square = |half: f64, z: f64, up: bool| {
            let p = [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| DVec3::new(x, y, z));
            if up { p.to_vec() } else { p.iter().rev().copied().collect() }
        };
        let (small, large) = (square(0.25, 0.0, true), square(2.0, 2.0, false));
        assert!(polygons_past_sphere(&small, &large, DVec3::Z, 0.2).is_some());
        assert_eq!(polygons_past_sphere(&small, &large, DVec3::Z, 0.95), None);
        assert_eq!(polygons_past_sphere(&small, &large, DVec3::new(0.9, 0.0, 1.0), 0.2), None);
        assert_eq!(polygons_past_sphere(&small, &large, DVec3::Z * 0.1, 0.2), None, "through the plane");
    }
}
