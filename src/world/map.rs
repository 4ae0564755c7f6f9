//! A world projection with values: what is seen from one point in all directions.

use super::layout::{Layout, Shape, Spot};
use crate::math::DVec3;
use rayon::prelude::*;

/// Radiances (or anything else) over directions, one value a texel and band.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldMap {
    shape: Shape,
    bands: usize,
    /// Texel-major, in the order of [`Shape::index`]; bands side by side.
    values: Vec<f32>,
}

impl WorldMap {
    /// A map of these values: `shape.texels() * bands` of them, texel-major.
    ///
    /// # Panics
    /// Where the number of values is another.
    pub fn new(shape: Shape, bands: usize, values: Vec<f32>) -> Self {
        assert_eq!(values.len(), shape.texels() * bands, "one value a texel and band");
        Self { shape, bands, values }
    }

    /// A map of what `value` says of each texel, in parallel: it is given the texel's number and room for its bands, all 0.
    pub fn filled(shape: Shape, bands: usize, value: impl Fn(usize, &mut [f32]) + Sync) -> Self {
        let mut values = vec![0.0; shape.texels() * bands];
        let row = shape.width() * bands;
        values.par_chunks_mut(row).enumerate().for_each(|(r, row)| {
            for (x, texel) in row.chunks_mut(bands).enumerate() {
                value(r * shape.width() + x, texel);
            }
        });
        Self { shape, bands, values }
    }

    /// How directions are laid out.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// All values, texel-major.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Values of a texel.
    pub fn texel(&self, index: usize) -> &[f32] {
        &self.values[index * self.bands..(index + 1) * self.bands]
    }

    /// Values of the texel that a direction is drawn in; `None` beyond a fish-eye's field.
    pub fn nearest(&self, d: DVec3) -> Option<&[f32]> {
        Some(self.texel(self.texel_at(self.shape.place(d)?)))
    }

    /// The texel that a point of a panel lies in.
    fn texel_at(&self, spot: Spot) -> usize {
        let last = |n: usize, at: f64| (at.max(0.0) as usize).min(n - 1);
        self.shape.index(spot.panel, last(self.shape.width(), spot.x), last(self.shape.height(), spot.y))
    }

    /// Number of the texel in column x and row y of a panel, which may lie beyond its edges: longitudes go round, poles
    /// are crossed to the other side, and of a cube the face that continues it is asked. A fish-eye ends with its last
    /// texel.
    pub fn wrapped(&self, panel: usize, x: i64, y: i64) -> usize {
        let (w, h) = (self.shape.width() as i64, self.shape.height() as i64);
        if (0..w).contains(&x) && (0..h).contains(&y) {
            return self.shape.index(panel, x as usize, y as usize);
        }
        match self.shape.layout {
            Layout::Cube => {
                let spot = Spot { panel, x: x as f64 + 0.5, y: y as f64 + 0.5 };
                let onto = self.shape.direction(spot).and_then(|d| self.shape.place(d));
                onto.map_or(0, |s| self.texel_at(s))
            }
            Layout::LatLong | Layout::SineLatLong => {
                // Beyond a pole the map goes on half a turn away, downwards again.
                let y = y.rem_euclid(2 * h);
                let (x, y) = if y < h { (x, y) } else { (x + w / 2, 2 * h - 1 - y) };
                self.shape.index(panel, x.rem_euclid(w) as usize, y as usize)
            }
            Layout::Fisheye { .. } => self.shape.index(panel, x.clamp(0, w - 1) as usize, y.clamp(0, h - 1) as usize),
        }
    }

    /// Adds `weight` times the value at a point of a panel to `sum`, interpolated bilinearly between the middles of
    /// texels, across edges as [`WorldMap::wrapped`] says.
    pub fn add_bilinear(&self, spot: Spot, weight: f64, sum: &mut [f64]) {
        let (x, y) = (spot.x - 0.5, spot.y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        for (dx, dy, share) in
            [(0, 0, (1.0 - fx) * (1.0 - fy)), (1, 0, fx * (1.0 - fy)), (0, 1, (1.0 - fx) * fy), (1, 1, fx * fy)]
        {
            let texel = self.texel(self.wrapped(spot.panel, x0 as i64 + dx, y0 as i64 + dy));
            sum.iter_mut().zip(texel).for_each(|(s, v)| *s += weight * share * f64::from(*v));
        }
    }

    /// Value in a direction, interpolated bilinearly; `None` beyond a fish-eye's field.
    pub fn bilinear(&self, d: DVec3) -> Option<Vec<f64>> {
        let mut sum = vec![0.0; self.bands];
        self.add_bilinear(self.shape.place(d)?, 1.0, &mut sum);
        Some(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A map of a function of direction.
    fn map(layout: Layout, size: u32, f: impl Fn(DVec3) -> f64 + Sync) -> WorldMap {
        let shape = Shape { layout, size };
        WorldMap::filled(shape, 1, |k, v| v[0] = shape.middle(k).map_or(0.0, |d| f(d) as f32))
    }

    #[test]
    fn interpolation_goes_on_across_edges_and_poles() {
        let smooth = |d: DVec3| 2.0 + d.x + 0.5 * d.y * d.z;
        for layout in [Layout::Cube, Layout::LatLong] {
            let worst = |size: u32| {
                let map = map(layout, size, smooth);
                let at = |k: u32| {
                    let (z, phi) = (1.0 - (2.0 * f64::from(k) + 1.0) / 4000.0, 2.399_963 * f64::from(k));
                    let r = (1.0 - z * z).sqrt();
                    DVec3::new(r * phi.cos(), r * phi.sin(), z)
                };
                let off = |d: DVec3| (map.bilinear(d).expect("whole")[0] - smooth(d)).abs();
                (0..4000).map(|k| off(at(k))).fold(0.0, f64::max)
            };
            // Of second order inside; where the four texels at a corner of the cube are three, of first.
            let (coarse, fine) = (worst(32), worst(128));
            assert!(fine < 0.012 && fine < 0.35 * coarse, "{layout:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn a_constant_stays_one() {
        for layout in [Layout::Cube, Layout::LatLong, Layout::SineLatLong] {
            let map = map(layout, 5, |_| 3.0);
            for k in 0..map.shape().texels() {
                let d = map.shape().middle(k).expect("whole");
                assert!((map.bilinear(d + DVec3::splat(0.01)).expect("whole")[0] - 3.0).abs() < 1e-12);
            }
        }
    }
}
