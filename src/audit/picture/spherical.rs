//! Triangles as a point sees them: solid angle, and directions spread evenly over it.

use super::sky::angle;
use crate::math::DVec3;

/// Solid angle of a triangle of unit vectors, sr (van Oosterom and Strackee 1983).
pub(super) fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

/// The unit vector that (u, v) of the unit square goes to, evenly over a spherical triangle (Arvo 1995).
pub(super) fn direction([a, b, c]: [DVec3; 3], solid_angle: f64, u: f64, v: f64) -> DVec3 {
    // Angle at corner a, and the part of the triangle on b's side that has u of the area.
    let alpha = angle(a.cross(b), a.cross(c));
    let part = u * solid_angle;
    let (s, t) = (part - alpha).sin_cos();
    let (sine, cosine) = alpha.sin_cos();
    let along = t - cosine;
    let across = s + sine * a.dot(b);
    let below = (across * s + along * t) * sine;
    let q = if below.abs() > 0.0 { ((across * t - along * s) * cosine - across) / below } else { 1.0 };
    let q = q.clamp(-1.0, 1.0);
    let corner = a * q + towards(c, a) * (1.0 - q * q).max(0.0).sqrt();
    let z = 1.0 - v * (1.0 - corner.dot(b));
    (b * z + towards(corner, b) * (1.0 - z * z).max(0.0).sqrt()).normalize_or(b)
}

/// Unit vector at right angles to `axis` in the plane of both, on the side of `v`.
fn towards(v: DVec3, axis: DVec3) -> DVec3 {
    (v - axis * v.dot(axis)).normalize_or_zero()
}
