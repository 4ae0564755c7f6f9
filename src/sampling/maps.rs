//! Maps from the unit square onto hemispheres and polygons.

use crate::math::{Bilinear, DVec3, area};

/// The unit square onto the unit disk, area for area, keeping neighbours together (Shirley and Chiu 1997).
pub fn concentric_disk(s: f64, t: f64) -> (f64, f64) {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
    let (a, b) = (2.0 * s - 1.0, 2.0 * t - 1.0);
    if a == 0.0 && b == 0.0 {
        return (0.0, 0.0);
    }
    let (r, angle) = if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, FRAC_PI_2 - FRAC_PI_4 * (a / b)) };
    (r * angle.cos(), r * angle.sin())
}

/// The unit square onto directions about +z with density cos / pi.
pub fn cosine_hemisphere(s: f64, t: f64) -> DVec3 {
    let (x, y) = concentric_disk(s, t);
    // Strictly above the surface: a grazing direction must not lie in the plane.
    DVec3::new(x, y, (1.0 - x * x - y * y).max(1e-24).sqrt())
}

/// Spreads unit-square points evenly over a region made of convex pieces.
#[derive(Debug, Clone)]
pub enum PointMap {
    /// One parallelogram: origin and two edges.
    Parallelogram {
        /// Corner at (0, 0).
        origin: DVec3,
        /// Edge along u.
        e1: DVec3,
        /// Edge along v.
        e2: DVec3,
    },
    /// One triangle: origin and two edges.
    Triangle {
        /// Corner at (0, 0).
        origin: DVec3,
        /// Edge along u.
        e1: DVec3,
        /// Edge along v.
        e2: DVec3,
    },
    /// Several triangles, chosen by the first coordinate in proportion to area.
    Triangles(Vec<Triangle>),
}

/// A triangle of a [`PointMap`] and the stretch of the first coordinate it takes.
#[derive(Debug, Clone)]
pub struct Triangle {
    origin: DVec3,
    e1: DVec3,
    e2: DVec3,
    /// First coordinate at which it begins.
    begin: f64,
    /// 1 / length of its stretch.
    scale: f64,
}

impl PointMap {
    /// The map onto convex pieces; `None` if they have no area.
    pub fn new(pieces: &[Vec<DVec3>]) -> Option<Self> {
        if let [piece] = pieces
            && let Ok(corners) = <[DVec3; 4]>::try_from(piece.as_slice())
            && Bilinear::new(corners).is_parallelogram()
        {
            let [o, a, _, b] = corners;
            return Some(Self::Parallelogram { origin: o, e1: a - o, e2: b - o });
        }
        let fans = pieces.iter().flat_map(|p| p[1..].windows(2).map(move |w| [p[0], w[0], w[1]]));
        let triangles: Vec<_> = fans.map(|t| (t, area(&t))).filter(|(_, a)| *a > 0.0).collect();
        let total: f64 = triangles.iter().map(|(_, a)| a).sum();
        let mut begin = 0.0;
        let mut out = Vec::with_capacity(triangles.len());
        for ([o, a, b], size) in triangles {
            out.push(Triangle { origin: o, e1: a - o, e2: b - o, begin, scale: total / size });
            begin += size / total;
        }
        match out[..] {
            [] => None,
            [Triangle { origin, e1, e2, .. }] => Some(Self::Triangle { origin, e1, e2 }),
            _ => Some(Self::Triangles(out)),
        }
    }

    /// The point that (u, v) goes to.
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        match self {
            Self::Parallelogram { origin, e1, e2 } => *origin + *e1 * u + *e2 * v,
            Self::Triangle { origin, e1, e2 } => {
                let (a, b) = fold(u, v);
                *origin + *e1 * a + *e2 * b
            }
            Self::Triangles(list) => {
                let k = list.partition_point(|t| t.begin <= u).max(1) - 1;
                let t = &list[k];
                let w = ((u - t.begin) * t.scale).clamp(0.0, 1.0);
                let (a, b) = fold(w, v);
                t.origin + t.e1 * a + t.e2 * b
            }
        }
    }
}

/// Folds the unit square along its diagonal: covers the triangle u + v <= 1 evenly.
#[inline]
pub fn fold(u: f64, v: f64) -> (f64, f64) {
    if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: u32) -> impl Iterator<Item = (f64, f64)> {
        let at = move |k: u32| (f64::from(k) + 0.5) / f64::from(n);
        (0..n).flat_map(move |i| (0..n).map(move |j| (at(i), at(j))))
    }

    #[test]
    fn moments_of_the_cosine_hemisphere() {
        // Mean direction (0, 0, 2/3), mean square of z 1/2.
        let n = 200;
        let (sum, square) =
            grid(n).map(|(s, t)| cosine_hemisphere(s, t)).fold((DVec3::ZERO, 0.0), |(a, b), d| (a + d, b + d.z * d.z));
        let count = f64::from(n * n);
        // The rim, where z falls like a square root, costs the midpoint rule about n^-1.5 = 3.5e-4.
        assert!((sum / count - DVec3::new(0.0, 0.0, 2.0 / 3.0)).length() < 3.5e-4);
        assert!((square / count - 0.5).abs() < 1e-4);
    }

    #[test]
    fn points_are_spread_evenly_over_an_l() {
        // An L of three unit squares: a fair share in each, and the right centroid.
        let at = |x: f64, y: f64| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| DVec3::new(x + a, y + b, 2.0)).to_vec()
        };
        let map = PointMap::new(&[at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]).unwrap();
        let n = 300;
        let mean = grid(n).map(|(u, v)| map.at(u, v)).sum::<DVec3>() / f64::from(n * n);
        assert!((mean - DVec3::new(5.0 / 6.0, 5.0 / 6.0, 2.0)).length() < 1e-4, "{mean}");
        let right = grid(n).filter(|(u, v)| map.at(*u, *v).x > 1.0).count() as f64 / f64::from(n * n);
        assert!((right - 1.0 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_has_no_map() {
        assert!(PointMap::new(&[]).is_none());
    }
}
