//! The bilinear map of a quadrilateral, its inverse, and the triangle grid.

use super::DVec3;

/// `p(u, v) = v0 + u e1 + v e2 + u v e3` over the unit square; u along v0->v1, v along v0->v3.
#[derive(Debug, Clone, Copy)]
pub struct Bilinear {
    origin: DVec3,
    e1: DVec3,
    e2: DVec3,
    e3: DVec3,
    /// Dual basis of (e1, e2): exact inverse of a parallelogram.
    dual: [DVec3; 2],
    parallelogram: bool,
}

impl Bilinear {
    /// The map of a planar convex quadrilateral.
    pub fn new(v: [DVec3; 4]) -> Self {
        let (e1, e2) = (v[1] - v[0], v[3] - v[0]);
        let e3 = v[2] - v[1] - e2;
        let n = e1.cross(e2);
        let dual = [e2.cross(n), n.cross(e1)].map(|d| d / n.length_squared());
        let scale = e1.length().max(e2.length());
        Self { origin: v[0], e1, e2, e3, dual, parallelogram: e3.length() <= 1e-14 * scale }
    }

    /// True if the map is affine, hence uniform in area.
    pub fn is_parallelogram(&self) -> bool {
        self.parallelogram
    }

    /// The point at (u, v).
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        self.origin + self.e1 * u + self.e2 * v + self.e3 * (u * v)
    }

    /// (u, v) of a point in the plane of the quadrilateral; outside the unit square for points outside.
    pub fn inverse(&self, p: DVec3) -> (f64, f64) {
        let q = p - self.origin;
        let (s, t) = (q.dot(self.dual[0]), q.dot(self.dual[1]));
        if self.parallelogram {
            return (s, t);
        }
        // In the basis (e1, e2): q = (s, t), e3 = (a, b):  s = u + a u v,  t = v + b u v.
        let (a, b) = (self.e3.dot(self.dual[0]), self.e3.dot(self.dual[1]));
        // Eliminate u v:  b s - a t = b u - a v, a quadratic in the coordinate that stays well conditioned.
        let solve = |a: f64, b: f64, s: f64, t: f64| -> (f64, f64) {
            // a v^2 + (1 + b s - a t) v - t = 0 with u = s / (1 + a v)
            let half = 0.5 * (1.0 + b * s - a * t);
            let root = (half * half + a * t).max(0.0).sqrt();
            let v = if half >= 0.0 { t / (half + root) } else { (root - half) / a };
            (s / (1.0 + a * v), v)
        };
        if a.abs() <= b.abs() {
            solve(a, b, s, t)
        } else {
            let (v, u) = solve(b, a, t, s);
            (u, v)
        }
    }

    /// Corners of cell (a, b) of an na x nb grid, wound like the parent.
    pub fn cell(&self, a: u32, b: u32, na: u32, nb: u32) -> [DVec3; 4] {
        let (u0, u1) = (f64::from(a) / f64::from(na), f64::from(a + 1) / f64::from(na));
        let (v0, v1) = (f64::from(b) / f64::from(nb), f64::from(b + 1) / f64::from(nb));
        [self.at(u0, v0), self.at(u1, v0), self.at(u1, v1), self.at(u0, v1)]
    }
}

/// Cell (k, row b) of the n-fold triangle grid that holds barycentric (u along v0->v1, v along v0->v2).
/// Points on or beyond the rim go to the nearest cell.
pub fn triangle_cell(n: u32, u: f64, v: f64) -> (u32, u32) {
    let nf = f64::from(n);
    let b = ((v * nf).floor().max(0.0) as u32).min(n - 1);
    let columns = n - b;
    let x = u * nf;
    let i = (x.floor().max(0.0) as u32).min(columns - 1);
    let inverted = (x - f64::from(i)) + (v * nf - f64::from(b)) > 1.0 && i + 1 < columns;
    (2 * i + u32::from(inverted), b)
}

/// Corners of cell k of row b of the n-fold grid of a triangle, wound like the parent.
pub fn triangle_cell_corners(t: [DVec3; 3], n: u32, k: u32, b: u32) -> [DVec3; 3] {
    let at = |i: u32, j: u32| {
        t[0] + (t[1] - t[0]) * (f64::from(i) / f64::from(n)) + (t[2] - t[0]) * (f64::from(j) / f64::from(n))
    };
    let i = k / 2;
    if k.is_multiple_of(2) {
        [at(i, b), at(i + 1, b), at(i, b + 1)]
    } else {
        [at(i + 1, b), at(i + 1, b + 1), at(i, b + 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{area, unit_normal};
    use proptest::prelude::*;

    fn quad(x2: f64, y2: f64) -> Bilinear {
        Bilinear::new([
            DVec3::new(0.0, 0.0, 1.0),
            DVec3::new(2.0, 0.0, 1.0),
            DVec3::new(x2, y2, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
        ])
    }

    proptest! {
        #[test]
        fn inverse_undoes_the_map(u in 0.0..1.0f64, v in 0.0..1.0f64, x2 in 0.6..4.0f64, y2 in 0.75..3.0f64) {
            let q = quad(x2, y2);
            let (a, b) = q.inverse(q.at(u, v));
            prop_assert!((a - u).abs() < 1e-12 && (b - v).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn parallelograms_are_recognised() {
        assert!(quad(2.0, 1.0).is_parallelogram());
        assert!(!quad(2.0, 1.1).is_parallelogram());
    }

    #[test]
    fn triangle_cells_tile_the_triangle_and_are_found_again() {
        let t = [DVec3::ZERO, DVec3::X * 3.0, DVec3::new(0.5, 2.0, 0.0)];
        let n = 5;
        let mut total = 0.0;
        for b in 0..n {
            for k in 0..2 * (n - b) - 1 {
                let c = triangle_cell_corners(t, n, k, b);
                assert_eq!(unit_normal(&c), DVec3::Z);
                total += area(&c);
                let m = (c[0] + c[1] + c[2]) / 3.0;
                let v = m.y / 2.0;
                let u = (m.x - 0.5 * v) / 3.0;
                assert_eq!(triangle_cell(n, u, v), (k, b));
            }
        }
        assert!((total - 3.0).abs() < 1e-12);
    }
}
