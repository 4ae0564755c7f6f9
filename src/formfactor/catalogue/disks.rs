//! Disks: with a common axis, and seen from an element.

use super::lengths;
use crate::formfactor::gauss::rule;
use crate::math::DVec3;
use std::f64::consts::{PI, TAU};

/// Form factor from a disk of radius `r1` to a parallel disk of radius `r2` on the same axis, `h` apart (Howell C-41).
///
/// `F = (X - sqrt(X^2 - 4 Y^2)) / 2` with `Y = r2 / r1` and `X = 1 + Y^2 + (h / r1)^2`, written without the difference.
/// Lengths that are not finite and above 0: NaN.
///
/// ```
/// // Two unit disks a radius apart: (3 - sqrt 5) / 2.
/// let f = etalon::formfactor::catalogue::coaxial_disks(1.0, 1.0, 1.0);
/// assert!((f - 0.381_966_011_250_105_15).abs() < 1e-15);
/// ```
pub fn coaxial_disks(r1: f64, r2: f64, h: f64) -> f64 {
    if !lengths(&[r1, r2, h]) {
        return f64::NAN;
    }
    let (y, z) = (r2 / r1, h / r1);
    let sum = (1.0 + y) * (1.0 + y) + z * z;
    let difference = (1.0 - y) * (1.0 - y) + z * z;
    let x = 1.0 + y * y + z * z;
    2.0 * y * y / (x + (sum * difference).sqrt())
}

/// Form factor from a disk of radius `r1` to the ring between `inner` and `outer` on the same axis, `h` apart: the
/// difference of two disks. A ring without width: 0.
pub fn disk_to_coaxial_ring(r1: f64, inner: f64, outer: f64, h: f64) -> f64 {
    (coaxial_disks(r1, outer, h) - coaxial_disks(r1, inner, h)).max(0.0)
}

/// Form factor from a differential area at `point` with `normal` to the front of a disk anywhere (the element-to-disk
/// entries of Howell's part B, for any tilt), the part below the horizon left out.
///
/// Lambert's contour integral `1/(2 pi) integral of (r x dr) . n / r^2` over the arc above the horizon, whose
/// integrand is `(alpha + beta cos t + gamma sin t) / (A + B cos t)`, and over the chord in the horizon, which
/// brings the angle it fills. A point in the plane of the disk or behind it: 0. Radius not finite and above 0: NaN.
pub fn element_to_disk(point: DVec3, normal: DVec3, centre: DVec3, front: DVec3, radius: f64) -> f64 {
    let (n, axis, c) = (normal.normalize_or_zero(), front.normalize_or_zero(), centre - point);
    if !lengths(&[radius]) || !c.is_finite() || n == DVec3::ZERO || axis == DVec3::ZERO {
        return f64::NAN;
    }
    if -c.dot(axis) <= 1e-15 * (c.length() + radius) {
        return 0.0;
    }
    let rim = Rim::new(c, axis, radius);
    // Height of the rim above the horizon: middle + amplitude cos(t - highest).
    let (middle, x, y) = (n.dot(c), radius * n.dot(rim.u), radius * n.dot(rim.v));
    let (amplitude, highest) = (x.hypot(y), y.atan2(x));
    if middle <= -amplitude {
        return 0.0;
    }
    let sum = if middle >= amplitude {
        rim.arc(n, 0.0, TAU)
    } else {
        let half = (-middle / amplitude).acos();
        let (from, to) = (highest - half, highest + half);
        rim.arc(n, from, to) + chord(rim.at(to), rim.at(from), n)
    };
    // Minus: the front is wound counter-clockwise for who looks at it.
    (-sum / TAU).clamp(0.0, 1.0)
}

/// The angle that a chord fills, seen from the origin, with the sign of its turn about `n`.
fn chord(a: DVec3, b: DVec3, n: DVec3) -> f64 {
    let cross = a.cross(b);
    cross.dot(n).signum() * cross.length().atan2(a.dot(b))
}

/// The rim of a disk, seen from the origin: `c + r (u cos t + v sin t)`, `u` along the offset of its axis.
struct Rim {
    c: DVec3,
    u: DVec3,
    v: DVec3,
    axis: DVec3,
    r: f64,
}

impl Rim {
    fn new(c: DVec3, axis: DVec3, r: f64) -> Self {
        let aside = c - axis * c.dot(axis);
        let u = if aside.length() > 1e-14 * c.length() { aside.normalize() } else { axis.any_orthonormal_vector() };
        let u = (u - axis * u.dot(axis)).normalize();
        Self { c, u, v: axis.cross(u), axis, r }
    }

    fn at(&self, t: f64) -> DVec3 {
        self.c + (self.u * t.cos() + self.v * t.sin()) * self.r
    }

    /// Integral of `(r x dr) . n / r^2` over an arc of at most one turn.
    fn arc(&self, n: DVec3, from: f64, to: f64) -> f64 {
        let (a, b) = (self.c.length_squared() + self.r * self.r, 2.0 * self.r * self.c.dot(self.u));
        let alpha = self.r * n.dot(self.axis);
        let (beta, gamma) = (n.dot(self.c.cross(self.v)), -n.dot(self.c.cross(self.u)));
        if b.abs() < 0.1 * a {
            // Almost on the axis the closed form divides rounding by B; the integrand is nearly a constant there.
            let f = |t: f64| (alpha + beta * t.cos() + gamma * t.sin()) / (a + b * t.cos());
            return self.r * panels(from, to, f);
        }
        let root = ((a - b) * (a + b)).sqrt();
        let plain = |t: f64| {
            let turns = ((t + PI) / TAU).floor();
            let half = 0.5 * (t - TAU * turns);
            2.0 / root * (PI * turns + ((a - b).sqrt() * half.sin()).atan2((a + b).sqrt() * half.cos()))
        };
        let whole = plain(to) - plain(from);
        let cosine = ((to - from) - a * whole) / b;
        let sine = ((a + b * from.cos()) / (a + b * to.cos())).ln() / b;
        self.r * (alpha * whole + beta * cosine + gamma * sine)
    }
}

/// Gauss points on eight panels: exact to rounding for what changes slowly around a circle.
fn panels(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let width = (to - from) / 8.0;
    let panel = |k: u32| {
        let begin = from + width * f64::from(k);
        rule(16).iter().map(|(x, w)| 0.5 * w * f(begin + 0.5 * width * (x + 1.0))).sum::<f64>()
    };
    width * (0..8).map(panel).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formfactor::point_to_polygon;

    #[test]
    fn disks_exchange_alike_and_fill_the_view_when_near() {
        for (r1, r2, h) in [(1.0, 2.0, 1.0), (0.01, 3.0, 0.2), (5.0, 0.1, 70.0)] {
            let (there, back) = (coaxial_disks(r1, r2, h), coaxial_disks(r2, r1, h));
            assert!((r1 * r1 * there / (r2 * r2 * back) - 1.0).abs() < 1e-14);
        }
        assert!((coaxial_disks(1.0, 1.0, 1e-9) - 1.0).abs() < 2e-9);
        assert!((coaxial_disks(1.0, 1.0, 1e6) * 1e12 - 1.0).abs() < 1e-11, "far: r2^2 / h^2");
        assert!(coaxial_disks(0.0, 1.0, 1.0).is_nan() && coaxial_disks(1.0, f64::INFINITY, 1.0).is_nan());
    }

    #[test]
    fn on_the_axis() {
        // r^2 / (r^2 + h^2), also so near to the axis that the closed form would fail.
        for off in [0.0, 1e-13, 1e-9, 1e-5] {
            let f = element_to_disk(DVec3::X * off, DVec3::Z, DVec3::Z * 2.0, -DVec3::Z, 1.0);
            assert!((f - 0.2).abs() < 2e-15 + off * off, "{off}: {f}");
        }
        assert_eq!(element_to_disk(DVec3::ZERO, DVec3::Z, DVec3::Z, DVec3::Z, 1.0), 0.0, "its back");
        assert_eq!(element_to_disk(DVec3::ZERO, -DVec3::Z, DVec3::Z, -DVec3::Z, 0.5), 0.0, "below the horizon");
    }

    /// Lambert's formula for a polygon of very many corners, which lacks its area's share of the disk.
    #[test]
    fn a_disk_is_a_polygon_of_many_corners() {
        let (axis, centre, r) = (DVec3::new(-0.4, 0.3, -1.0).normalize(), DVec3::new(0.7, -0.2, 0.9), 0.8);
        let (u, corners) = (axis.any_orthonormal_vector(), 20_000);
        let v = axis.cross(u);
        let corner = |k: i32| {
            let t = TAU * f64::from(k) / f64::from(corners);
            centre + (u * t.cos() + v * t.sin()) * r
        };
        let polygon: Vec<DVec3> = (0..corners).map(corner).collect();
        for normal in [DVec3::Z, DVec3::X, DVec3::new(1.0, 0.4, 0.3), DVec3::new(-0.5, 1.0, 0.2), -DVec3::Y] {
            let exact = point_to_polygon(DVec3::ZERO, normal, &polygon);
            let got = element_to_disk(DVec3::ZERO, normal, centre, axis, r);
            // 1 - sin(x)/x of x = 2 pi / 20,000 is 1.6e-8.
            assert!((got - exact).abs() < 5e-8 * (exact + 0.1), "{normal}: {got} {exact}");
        }
    }
}
