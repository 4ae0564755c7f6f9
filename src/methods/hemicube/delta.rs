//! Delta form factors: what each pixel of the hemi-cube contributes.
//!
//! The cube has half-width 1 and its centre on the patch. At N pixels along the top's edge a pixel has edge
//! h = 2 / N; N x N pixels lie on the top, N x N/2 on each side. By symmetry one quarter of the top and half of
//! one half-face are stored.

use super::Delta;
use crate::math::Compensated;
use std::f64::consts::PI;

/// Delta form factor of an area `da` at (x, y) on the top, the face z = 1 [CG85 fig. 7a].
pub fn delta_top(x: f64, y: f64, da: f64) -> f64 {
    da / (PI * (x * x + y * y + 1.0).powi(2))
}

/// Delta form factor of an area `da` at (y, z) on a side, the face x = 1 [CG85 fig. 7b].
pub fn delta_side(y: f64, z: f64, da: f64) -> f64 {
    z * da / (PI * (y * y + z * z + 1.0).powi(2))
}

/// A pixel: intervals of its two coordinates on the face.
#[derive(Debug, Clone, Copy)]
pub struct Pixel {
    /// x on the top, y on a side.
    pub u: [f64; 2],
    /// y on the top, z on a side.
    pub v: [f64; 2],
}

impl Pixel {
    /// The pixel in column `a` and row `b`, counted from the axes, of edge `h`.
    fn at(a: usize, b: usize, h: f64) -> Self {
        let interval = |k: usize| [k as f64 * h, (k + 1) as f64 * h];
        Self { u: interval(a), v: interval(b) }
    }

    fn centre(&self) -> (f64, f64) {
        (0.5 * (self.u[0] + self.u[1]), 0.5 * (self.v[0] + self.v[1]))
    }

    fn area(&self) -> f64 {
        (self.u[1] - self.u[0]) * (self.v[1] - self.v[0])
    }

    /// Delta form factor as part of the top.
    pub fn top(&self, delta: Delta) -> f64 {
        let (x, y) = self.centre();
        match delta {
            Delta::Midpoint => delta_top(x, y, self.area()),
            Delta::Exact => gauss(self.v, |y| top_strip(self.u, y)),
        }
    }

    /// Delta form factor as part of a side.
    pub fn side(&self, delta: Delta) -> f64 {
        let (y, z) = self.centre();
        match delta {
            Delta::Midpoint => delta_side(y, z, self.area()),
            Delta::Exact => gauss(self.u, |y| side_strip(y, self.v)),
        }
    }
}

/// Integral over x of `1 / (pi (x^2 + y^2 + 1)^2)`. Differences are taken by hand: those of the antiderivative
/// at the ends of a small pixel would lose half the digits.
fn top_strip([x0, x1]: [f64; 2], y: f64) -> f64 {
    let c2 = 1.0 + y * y;
    let c = c2.sqrt();
    let rational = (x1 - x0) * (c2 - x0 * x1) / ((x0 * x0 + c2) * (x1 * x1 + c2));
    let angle = (c * (x1 - x0)).atan2(c2 + x0 * x1) / c;
    (rational + angle) / (2.0 * PI * c2)
}

/// Integral over z of `z / (pi (y^2 + z^2 + 1)^2)`.
fn side_strip(y: f64, [z0, z1]: [f64; 2]) -> f64 {
    let s = 1.0 + y * y;
    (z1 - z0) * (z1 + z0) / (2.0 * PI * (s + z0 * z0) * (s + z1 * z1))
}

/// Gauss-Legendre, eight points: abscissae and weights on [-1, 1], positive half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_27),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Integral over an interval no longer than 1/2 of a function whose poles are at least 1 away: exact to rounding.
fn gauss([a, b]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let (m, r) = (0.5 * (a + b), 0.5 * (b - a));
    GAUSS.iter().map(|(x, w)| w * (f(m - r * x) + f(m + r * x))).sum::<f64>() * r
}

/// The delta form factors of all pixels at one resolution.
#[derive(Debug, Clone, PartialEq)]
pub struct DeltaTable {
    half: usize,
    /// Quadrant of the top: column a, row b, both counted from the axes, at `a + b * half`.
    quadrant: Vec<f64>,
    /// Half of a side: column a counted from the axis, row b from the horizon, at `a + b * half`.
    side: Vec<f64>,
}

impl DeltaTable {
    /// The table for `resolution` pixels (even) along the top's edge.
    pub fn new(resolution: u32, delta: Delta) -> Self {
        let half = resolution as usize / 2;
        let h = 1.0 / half as f64;
        let mut quadrant = vec![0.0; half * half];
        for (a, b) in (0..half).flat_map(|a| (0..=a).map(move |b| (a, b))) {
            let value = Pixel::at(a, b, h).top(delta);
            // Two pixels that mirror each other are one value, bit for bit.
            (quadrant[a + b * half], quadrant[b + a * half]) = (value, value);
        }
        let side = (0..half).flat_map(|b| (0..half).map(move |a| Pixel::at(a, b, h).side(delta)));
        Self { half, quadrant, side: side.collect() }
    }

    /// Pixels from an axis to the edge: half the resolution.
    pub fn half(&self) -> usize {
        self.half
    }

    /// Top pixel in column a, row b, both counted from the axes.
    pub fn top(&self, a: usize, b: usize) -> f64 {
        self.quadrant[a + b * self.half]
    }

    /// Side pixel in column a counted from the axis, row b counted from the horizon.
    pub fn side(&self, a: usize, b: usize) -> f64 {
        self.side[a + b * self.half]
    }

    /// One row of top pixels, from the axis outwards; `b` counts rows from the axis.
    pub(super) fn top_row(&self, b: usize) -> &[f64] {
        &self.quadrant[b * self.half..(b + 1) * self.half]
    }

    /// One row of side pixels, from the axis outwards; `b` counts rows from the horizon.
    pub(super) fn side_row(&self, b: usize) -> &[f64] {
        &self.side[b * self.half..(b + 1) * self.half]
    }

    /// Sum over the top.
    pub fn top_sum(&self) -> f64 {
        let mut sum = Compensated::default();
        for a in 0..self.half {
            (0..a).for_each(|b| sum.add(8.0 * self.top(a, b)));
            sum.add(4.0 * self.top(a, a));
        }
        sum.value()
    }

    /// Sum over one side.
    pub fn side_sum(&self) -> f64 {
        2.0 * crate::math::compensated_sum(self.side.iter().copied())
    }

    /// Sum over all five faces: what a row sums to in a closed scene.
    pub fn total(&self) -> f64 {
        self.top_sum() + 4.0 * self.side_sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integrals as differences of their antiderivatives, an independent way to the same pixels: four terms of up
    /// to 0.14, each good to a few units of 1e-17 and differently so in each build profile.
    fn closed(g: impl Fn(f64, f64) -> f64, p: Pixel) -> f64 {
        g(p.u[1], p.v[1]) - g(p.u[0], p.v[1]) - g(p.u[1], p.v[0]) + g(p.u[0], p.v[0])
    }

    fn top_antiderivative(x: f64, y: f64) -> f64 {
        let part = |x: f64, y: f64| {
            let c = (1.0 + x * x).sqrt();
            x / c * (y / c).atan()
        };
        (part(x, y) + part(y, x)) / (2.0 * PI)
    }

    fn side_antiderivative(y: f64, z: f64) -> f64 {
        let c = (1.0 + z * z).sqrt();
        -(y / c).atan() / c / (2.0 * PI)
    }

    #[test]
    fn exact_pixels_agree_with_the_antiderivatives() {
        for half in [2, 5, 25, 50] {
            for (a, b) in (0..half).flat_map(|a| (0..half).map(move |b| (a, b))) {
                let p = Pixel::at(a, b, 1.0 / half as f64);
                assert!((p.top(Delta::Exact) - closed(top_antiderivative, p)).abs() < 1e-15, "top {a} {b} of {half}");
                assert!(
                    (p.side(Delta::Exact) - closed(side_antiderivative, p)).abs() < 1e-15,
                    "side {a} {b} of {half}"
                );
            }
        }
    }

    #[test]
    fn rows_are_the_table_read_in_order() {
        let t = DeltaTable::new(20, Delta::Midpoint);
        for b in 0..10 {
            assert!((0..10).all(|a| t.top_row(b)[a] == t.top(a, b) && t.side_row(b)[a] == t.side(a, b)));
        }
    }
}
