//! Real spherical harmonics up to order 2: a modern rival of the diffuse map, for comparison only.

use super::layout::{Shape, Spot};
use super::map::WorldMap;
use crate::math::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Number of harmonics up to order 2.
pub const HARMONICS: usize = 9;
/// What Lambert's cosine makes of orders 0, 1 and 2 (Ramamoorthi and Hanrahan 2001, eqs. 7 and 8).
const LAMBERT: [f64; 3] = [PI, 2.0 * PI / 3.0, PI / 4.0];
/// Points of Gauss's rule over the unit stretch, with their weights.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Rows that are summed as one; the same on any number of threads.
const ROWS: usize = 16;

/// Coefficients of a map in the nine lowest real spherical harmonics (Ramamoorthi and Hanrahan, "An efficient
/// representation for irradiance environment maps", 2001), band by band. The factors of the first two orders are exact;
/// order 3 contributes nothing to irradiance, orders 4 and beyond are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonics {
    /// Of each band: radiance times harmonic, integrated over all directions.
    coefficients: Vec<[f64; HARMONICS]>,
}

impl Harmonics {
    /// Projects a map. Each texel counts with its solid angle, order 1 with its exact moment, order 2 by Gauss's rule of 3 x
    /// 3 points over it. What a fish-eye does not show is dark.
    pub fn new(map: &WorldMap) -> Self {
        let (shape, bands) = (map.shape(), map.bands());
        let rows = shape.panels() * shape.height();
        let parts: Vec<Vec<[f64; HARMONICS]>> = (0..rows.div_ceil(ROWS))
            .into_par_iter()
            .map(|block| {
                let mut sums = vec![[0.0; HARMONICS]; bands];
                let end = ((block + 1) * ROWS).min(rows) * shape.width();
                for k in block * ROWS * shape.width()..end {
                    let angle = shape.solid_angle(k);
                    let moment = shape.moment(k);
                    let mut weights = over_texel(shape, k, angle);
                    for (weight, linear) in weights[1..4].iter_mut().zip(linear(moment)) {
                        *weight = linear;
                    }
                    for (sum, value) in sums.iter_mut().zip(map.texel(k)) {
                        sum.iter_mut().zip(weights).for_each(|(s, w)| *s += w * f64::from(*value));
                    }
                }
                sums
            })
            .collect();
        let mut coefficients = vec![[0.0; HARMONICS]; bands];
        for part in parts {
            for (sum, part) in coefficients.iter_mut().zip(part) {
                sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
            }
        }
        Self { coefficients }
    }

    /// Coefficients of each band, in the order 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2.
    pub fn coefficients(&self) -> &[[f64; HARMONICS]] {
        &self.coefficients
    }

    /// Irradiance by band for a normal of any length but 0, W/m^2 where the map holds radiance; it may be below 0, as it
    /// never is in truth.
    pub fn irradiance(&self, normal: DVec3) -> Vec<f64> {
        let mut weights = harmonics(normal.normalize_or_zero());
        for (k, w) in weights.iter_mut().enumerate() {
            *w *= LAMBERT[usize::from(k > 0) + usize::from(k > 3)];
        }
        self.coefficients.iter().map(|c| c.iter().zip(weights).map(|(c, w)| c * w).sum()).collect()
    }
}

/// Integrals of the harmonics over a texel of this solid angle.
fn over_texel(shape: Shape, index: usize, angle: f64) -> [f64; HARMONICS] {
    let (panel, x, y) = shape.texel(index);
    let (mut sums, mut all) = ([0.0; HARMONICS], 0.0);
    for (dx, wx) in GAUSS {
        for (dy, wy) in GAUSS {
            let (x, y) = (x as f64 + dx, y as f64 + dy);
            let Some(d) = shape.direction(Spot { panel, x, y }) else { continue };
            let weight = wx * wy * shape.density(x, y);
            all += weight;
            sums.iter_mut().zip(harmonics(d)).for_each(|(s, h)| *s += weight * h);
        }
    }
    // The rule shares out the solid angle, which is known exactly.
    sums.map(|s| if all > 0.0 { s * angle / all } else { 0.0 })
}

/// The three harmonics of order 1, which are linear in the direction.
fn linear(d: DVec3) -> [f64; 3] {
    let one = (3.0 / (4.0 * PI)).sqrt();
    [one * d.y, one * d.z, one * d.x]
}

/// The nine harmonics in a direction of unit length.
fn harmonics(d: DVec3) -> [f64; HARMONICS] {
    let [y, z, x] = linear(d);
    let two = (15.0 / (4.0 * PI)).sqrt();
    let middle = (5.0 / (16.0 * PI)).sqrt() * (3.0 * d.z * d.z - 1.0);
    let last = 0.5 * two * (d.x * d.x - d.y * d.y);
    [(0.25 / PI).sqrt(), y, z, x, two * d.x * d.y, two * d.y * d.z, middle, two * d.x * d.z, last]
}

#[cfg(test)]
mod tests {
    use super::super::irradiance::irradiance_exact;
    use super::super::layout::{Layout, Shape};
    use super::*;

    fn map(shape: Shape, f: impl Fn(DVec3) -> f64 + Sync) -> WorldMap {
        WorldMap::filled(shape, 1, |k, v| v[0] = shape.middle(k).map_or(0.0, |d| f(d) as f32))
    }

    fn directions() -> impl Iterator<Item = DVec3> {
        (0..300u32).map(|k| {
            let (z, phi) = (1.0 - (2.0 * f64::from(k) + 1.0) / 300.0, 2.399_963 * f64::from(k));
            DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z)
        })
    }

    #[test]
    fn fields_up_to_order_2_are_exact() {
        // Irradiance under 1 is pi, under d.a it is (2 pi / 3) n.a, under (d.a)(d.b) with a, b perpendicular it is
        // (pi / 4) (n.a)(n.b), and under 3 (d.a)^2 - 1 it is (pi / 4) (3 (n.a)^2 - 1).
        let a = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        let b = DVec3::new(1.0, 2.0, 0.0) / 5f64.sqrt();
        let radiance =
            |d: DVec3| 2.0 + 0.7 * d.dot(b) + 1.5 * d.dot(a) * d.dot(b) + 0.4 * (3.0 * d.dot(a).powi(2) - 1.0);
        let irradiance = |n: DVec3| {
            2.0 * PI
                + 0.7 * 2.0 * PI / 3.0 * n.dot(b)
                + 0.25 * PI * (1.5 * n.dot(a) * n.dot(b) + 0.4 * (3.0 * n.dot(a).powi(2) - 1.0))
        };
        for layout in [Layout::Cube, Layout::LatLong] {
            let off = |size: u32| {
                let map = map(Shape { layout, size }, radiance);
                let harmonics = Harmonics::new(&map);
                directions()
                    .map(|n| {
                        let (found, exact) = (harmonics.irradiance(n * 2.0)[0], irradiance_exact(&map, n)[0]);
                        assert!((found - exact).abs() < 40.0 / f64::from(size * size), "{layout:?} {n}");
                        (found - irradiance(n)).abs()
                    })
                    .fold(0.0, f64::max)
            };
            let (coarse, fine) = (off(16), off(64));
            assert!(fine < 5e-3 && fine < 0.08 * coarse, "{layout:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn a_uniform_world_has_one_coefficient() {
        for layout in [Layout::Cube, Layout::LatLong, Layout::SineLatLong] {
            let second = |size: u32| {
                let harmonics = Harmonics::new(&map(Shape { layout, size }, |_| 1.0));
                let c = harmonics.coefficients()[0];
                assert!((c[0] - (4.0 * PI).sqrt()).abs() < 1e-10, "{layout:?}: {c:?}");
                assert!(c[1..4].iter().all(|c| c.abs() < 1e-10), "{layout:?}: {c:?}");
                c[4..].iter().map(|c| c.abs()).fold(0.0, f64::max)
            };
            // Order 2 is right to the second order in the size of texels; where rows of equal sines grow high towards the
            // poles, to h^2 log(1/h): a factor of 16 by 7/5.
            let (coarse, fine) = (second(32), second(128));
            assert!(fine < 2e-3 && (fine < 0.1 * coarse || coarse < 1e-10), "{layout:?}: {coarse} {fine}");
        }
    }

    /// A small bright sky: its irradiance has harmonics of order 4, which are left out.
    #[test]
    fn what_order_2_leaves_out_is_seen() {
        let map = map(Shape { layout: Layout::LatLong, size: 64 }, |d| f64::from(d.dot(DVec3::Z) > 0.9));
        let harmonics = Harmonics::new(&map);
        let worst = directions().map(|n| (harmonics.irradiance(n)[0] - irradiance_exact(&map, n)[0]).abs());
        let worst = worst.fold(0.0, f64::max);
        assert!(worst > 0.02 && worst < 0.1, "{worst}");
    }
}
