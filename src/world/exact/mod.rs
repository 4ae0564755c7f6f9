//! Reflection cones filtered texel by texel: the yardstick of the fast filters, after Greene (1986).
//!
//! The map is taken for what it holds, one value over the whole of each texel.

mod ellipse;
mod quad;
mod start;

use super::cone::Cone;
use super::layout::{Layout, Shape, Spot};
use super::map::WorldMap;
use super::pyramid::at_rim;
use crate::math::DVec3;

/// Exact mean over a cone, one value a band.
///
/// Quadrilateral cones: every direction between their sides alike, by solid angle; texels on the sides are clipped. On
/// faces of a cube weights add up to the cone's solid angle within 1e-9 of it; on other layouts, where sides of small
/// parts of a texel are drawn as great circles, within 2e-5.
///
/// Elliptical cones: by solid angle times exp(-2 r^2), as [`super::Pyramid::ewa`] has it, from texels cut up finely
/// enough that total weights are right to 2e-4; of a fish-eye by 18,432 points. Needles are made at least 1/64 as wide as
/// long.
///
/// What lies beyond a fish-eye's field takes no part; 0 where nothing is left. Of a texel across its circle the part
/// inside counts, with the value of one at the rim where its own middle is outside.
pub fn exact(map: &WorldMap, cone: &Cone) -> Vec<f64> {
    let mut mean = vec![0.0; map.bands()];
    exact_into(map, cone, &mut mean);
    mean
}

/// [`exact`] into `mean`, one place a band; the total weight, sr.
pub fn exact_into(map: &WorldMap, cone: &Cone, mean: &mut [f64]) -> f64 {
    mean.fill(0.0);
    let mut total = 0.0;
    for_each_weight(map.shape(), cone, &mut |index, weight| {
        total += weight;
        mean.iter_mut().zip(map.texel(index)).for_each(|(m, v)| *m += weight * f64::from(*v));
    });
    if total > 0.0 {
        mean.iter_mut().for_each(|m| *m /= total);
    } else if let Some(texel) = cone.axis().and_then(|axis| map.nearest(axis)) {
        // Without width, or too narrow to count: one direction.
        mean.iter_mut().zip(texel).for_each(|(m, v)| *m = f64::from(*v));
    }
    total
}

/// Tells `each` the texels under a cone and their weights, sr: solid angles inside a quadrilateral cone, times the
/// Gaussian for an elliptical one. A texel may come several times.
pub fn for_each_weight(shape: Shape, cone: &Cone, each: &mut dyn FnMut(usize, f64)) {
    let each = &mut |index: usize, weight: f64| each(at_rim(shape, index), weight);
    match cone {
        Cone::Quad(_) => {
            for part in cone.parts() {
                start::blocks(shape, cone, &part, &mut |block| quad::walk(shape, &part, block, each));
            }
        }
        Cone::Ellipse { .. } => {
            if let Some(seen) = ellipse::Seen::new(cone) {
                if matches!(shape.layout, Layout::Fisheye { .. }) {
                    return seen.points(shape, each);
                }
                start::blocks(shape, cone, &seen.around, &mut |block| seen.walk(shape, block, each));
            }
        }
    }
}

/// Texels x0..x1, y0..y1 of a panel.
#[derive(Debug, Clone, Copy)]
struct Block {
    panel: usize,
    x: [usize; 2],
    y: [usize; 2],
}

impl Block {
    /// The only texel of it.
    fn texel(&self) -> Option<(usize, usize)> {
        (self.x[1] - self.x[0] == 1 && self.y[1] - self.y[0] == 1).then_some((self.x[0], self.y[0]))
    }

    /// Two halves across its longer side.
    fn halves(&self) -> [Self; 2] {
        let half = |[a, b]: [usize; 2]| ([a, usize::midpoint(a, b)], [usize::midpoint(a, b), b]);
        if self.x[1] - self.x[0] >= self.y[1] - self.y[0] {
            let (l, r) = half(self.x);
            [Self { x: l, ..*self }, Self { x: r, ..*self }]
        } else {
            let (u, d) = half(self.y);
            [Self { y: u, ..*self }, Self { y: d, ..*self }]
        }
    }

    /// Its area on the panel.
    fn cell(&self) -> Cell {
        let [x0, x1, y0, y1] = [self.x[0], self.x[1], self.y[0], self.y[1]].map(|v| v as f64);
        Cell { panel: self.panel, x: x0, y: y0, w: x1 - x0, h: y1 - y0 }
    }
}

/// A rectangle on a panel, texels.
#[derive(Debug, Clone, Copy)]
struct Cell {
    panel: usize,
    x: f64,
    y: f64,
    w: f64,
    h: f64,
}

impl Cell {
    /// Direction of the point at these shares of its width and height; outside of a fish-eye's circle, that of its rim.
    fn direction(&self, shape: Shape, s: f64, t: f64) -> DVec3 {
        let (x, y) = (self.x + s * self.w, self.y + t * self.h);
        let spot = match shape.layout {
            Layout::Fisheye { .. } => {
                let half = 0.5 * shape.width() as f64;
                let (dx, dy) = (x - half, y - half);
                // Just within: rounding must not lose it.
                let inwards = (half * (1.0 - 1e-12) / dx.hypot(dy)).min(1.0);
                Spot { panel: 0, x: half + dx * inwards, y: half + dy * inwards }
            }
            _ => Spot { panel: self.panel, x, y: y.clamp(0.0, shape.height() as f64) },
        };
        shape.direction(spot).unwrap_or(DVec3::Y)
    }

    /// Its corners in order around.
    fn corners(&self, shape: Shape) -> [DVec3; 4] {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(s, t)| self.direction(shape, s, t))
    }

    /// Part (i, j) of m x n.
    fn part(&self, [i, j]: [usize; 2], [m, n]: [usize; 2]) -> Self {
        let (w, h) = (self.w / m as f64, self.h / n as f64);
        Self { panel: self.panel, x: self.x + i as f64 * w, y: self.y + j as f64 * h, w, h }
    }

    /// Whether its middle is drawn: not outside of a fish-eye's circle.
    fn is_drawn(&self, shape: Shape) -> bool {
        let half = 0.5 * shape.width() as f64;
        let middle = (self.x + 0.5 * self.w - half).hypot(self.y + 0.5 * self.h - half);
        !matches!(shape.layout, Layout::Fisheye { .. }) || middle <= half
    }

    /// Unit direction of its middle, and a bound on how far (chord) any direction in it lies from there.
    fn middle(&self, shape: Shape) -> (DVec3, f64) {
        let middle = self.direction(shape, 0.5, 0.5);
        let reach = match shape.layout {
            // Angles from the axis are lengths in the picture, those around it are shorter.
            Layout::Fisheye { field } => 0.5 * self.w.hypot(self.h) * field.to_radians() / shape.width() as f64,
            // The corners are the farthest: of a plane figure, and between meridians and parallels too.
            _ => self.corners(shape).iter().map(|c| c.distance(middle)).fold(0.0, f64::max),
        };
        (middle, reach * (1.0 + 1e-12) + 1e-15)
    }
}
