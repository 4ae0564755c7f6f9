//! The diffuse illumination map [G86 fig. 7]: irradiance by surface normal.

use super::irradiance::irradiances;
use super::map::WorldMap;
use crate::math::DVec3;
use std::f64::consts::{PI, TAU};

/// Columns and rows of the paper's table [G86 fig. 7].
pub const DIFFUSE_SIZE: [u32; 2] = [40, 20];

/// Irradiance by surface normal, in latitude and longitude: a table to be looked up, whose entries are the irradiances
/// for the normals in the middle of its texels, exact for the map that it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct DiffuseMap {
    /// Columns and rows.
    size: [u32; 2],
    bands: usize,
    /// Entry-major, rows from the top, the front in the middle; bands side by side.
    values: Vec<f64>,
}

impl DiffuseMap {
    /// The cosine convolved with a map, [`irradiance_exact`](super::irradiance_exact) for every normal, in parallel.
    /// `size` is columns and rows, at least one each; [`DIFFUSE_SIZE`] is the paper's.
    pub fn new(map: &WorldMap, size: [u32; 2]) -> Self {
        let size = size.map(|n| n.max(1));
        let normals: Vec<DVec3> = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| normal(size, x, y))).collect();
        Self { size, bands: map.bands(), values: irradiances(map, &normals) }
    }

    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// All entries, W/m^2: rows from the top, bands side by side.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The normal that an entry belongs to: column `x`, row `y`.
    pub fn normal(&self, x: u32, y: u32) -> DVec3 {
        normal(self.size, x, y)
    }

    /// Irradiance by band for a normal of any length but 0, W/m^2, interpolated bilinearly: longitudes go round, and
    /// beyond the pole the table goes on half a turn away [G86, "Prefiltered environment maps"].
    pub fn lookup(&self, normal: DVec3) -> Vec<f64> {
        let mut sum = vec![0.0; self.bands];
        self.add(normal, 1.0, &mut sum);
        sum
    }

    /// Adds `weight` times the irradiance for a normal to `sum`, one entry a band.
    pub fn add(&self, normal: DVec3, weight: f64, sum: &mut [f64]) {
        let [w, h] = self.size.map(f64::from);
        let x = normal.x.atan2(normal.y) / TAU * w + 0.5 * w - 0.5;
        let y = (0.5 - normal.z.atan2(normal.x.hypot(normal.y)) / PI) * h - 0.5;
        let (top, below) = (y.floor(), y - y.floor());
        for (row, share) in [(top, 1.0 - below), (top + 1.0, below)] {
            // Beyond a pole: the same row again, seen from the other side.
            let (row, x) = if row < 0.0 {
                (0.0, x + 0.5 * w)
            } else if row > h - 1.0 {
                (h - 1.0, x + 0.5 * w)
            } else {
                (row, x)
            };
            let (left, right) = (x.floor(), x - x.floor());
            for (column, part) in [(left, 1.0 - right), (left + 1.0, right)] {
                let entry =
                    row as usize * self.size[0] as usize + column.rem_euclid(w) as usize % self.size[0] as usize;
                let values = &self.values[entry * self.bands..(entry + 1) * self.bands];
                sum.iter_mut().zip(values).for_each(|(s, v)| *s += weight * share * part * v);
            }
        }
    }

    /// Radiance of a perfectly white matt surface: irradiance / pi. The D of `dc D + sc S` [G86, "Surface shading"].
    pub fn diffuse_radiance(&self, normal: DVec3) -> Vec<f64> {
        self.lookup(normal).into_iter().map(|e| e / PI).collect()
    }

    /// The table between two frames, `t` from 0 (`a`) to 1 (`b`) [G86, "Prefiltered environment maps"]; `None` where their
    /// sizes or bands differ.
    pub fn between(a: &Self, b: &Self, t: f64) -> Option<Self> {
        let values = || a.values.iter().zip(&b.values).map(|(a, b)| a * (1.0 - t) + b * t).collect();
        (a.size == b.size && a.bands == b.bands).then(|| Self { size: a.size, bands: a.bands, values: values() })
    }
}

/// Direction in the middle of an entry.
fn normal([w, h]: [u32; 2], x: u32, y: u32) -> DVec3 {
    let (across, ahead) = (((f64::from(x) + 0.5) / f64::from(w) - 0.5) * TAU).sin_cos();
    let (sine, cosine) = ((0.5 - (f64::from(y) + 0.5) / f64::from(h)) * PI).sin_cos();
    DVec3::new(cosine * across, cosine * ahead, sine)
}

#[cfg(test)]
mod tests {
    use super::super::layout::{Layout, Shape};
    use super::*;

    /// Radiance 1 + d . axis: its irradiance is pi + (2 pi / 3) n . axis.
    fn tilted(shape: Shape) -> WorldMap {
        let axis = DVec3::new(0.3, 0.6, -0.4);
        WorldMap::filled(shape, 2, |k, v| {
            let d = shape.middle(k).expect("whole");
            (v[0], v[1]) = ((1.0 + d.dot(axis)) as f32, 5.0);
        })
    }

    fn expected(n: DVec3) -> f64 {
        PI + TAU / 3.0 * n.dot(DVec3::new(0.3, 0.6, -0.4))
    }

    #[test]
    fn entries_are_irradiances_and_look_ups_interpolate_them() {
        for layout in [Layout::Cube, Layout::LatLong] {
            let map = DiffuseMap::new(&tilted(Shape { layout, size: 64 }), DIFFUSE_SIZE);
            assert_eq!((map.size(), map.bands(), map.values().len()), ([40, 20], 2, 1600));
            for y in 0..20 {
                for x in 0..40 {
                    let n = map.normal(x, y);
                    let found = map.lookup(n * 0.5);
                    // The map itself is only right to the second order in its texels.
                    assert!((found[0] - expected(n)).abs() < 1e-3, "{layout:?} {x} {y}");
                    let entry = &map.values()[(y * 40 + x) as usize * 2..][..2];
                    assert!(found.iter().zip(entry).all(|(a, b)| (a - b).abs() < 1e-10));
                    assert!((found[1] - 5.0 * PI).abs() < 1e-10);
                    assert!((map.diffuse_radiance(n)[1] - 5.0).abs() < 1e-10);
                }
            }
        }
    }

    #[test]
    fn look_ups_go_on_round_and_over_the_poles() {
        for size in [[40, 20], [41, 20], [7, 5], [1, 1]] {
            let map = DiffuseMap::new(&tilted(Shape { layout: Layout::Cube, size: 32 }), size);
            // Half a step of the table, squared and halved, is what bilinear interpolation of an amplitude of 2.1 x 0.78
            // leaves; about a pole it is a circle of that radius.
            let step = (TAU / f64::from(size[0])).max(PI / f64::from(size[1]));
            for k in 0..5000 {
                let (z, phi) = (1.0 - (2.0 * f64::from(k) + 1.0) / 5000.0, 2.399_963 * f64::from(k));
                let n = DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
                let off = (map.lookup(n)[0] - expected(n)).abs();
                assert!(off < 2e-3 + 1.65 * step * step / 4.0, "{size:?} {n}: {off}");
            }
            for (a, b) in [(DVec3::new(1e-9, -1.0, 0.2), DVec3::new(-1e-9, -1.0, 0.2)), (DVec3::Z, -DVec3::Z)] {
                // Continuous across the seam; at a pole the same from every side.
                if a == DVec3::Z {
                    for pole in [a, b] {
                        let at = |x: f64, y: f64| map.lookup(pole + DVec3::new(x, y, 0.0) * 1e-9)[0];
                        assert!((at(1.0, 0.0) - at(-1.0, 0.0)).abs() < 1e-6, "{size:?}");
                    }
                } else {
                    assert!((map.lookup(a)[0] - map.lookup(b)[0]).abs() < 1e-7, "{size:?}");
                }
            }
        }
    }

    #[test]
    fn between_frames_light_is_linear() {
        let (a, b) =
            (tilted(Shape { layout: Layout::Cube, size: 8 }), tilted(Shape { layout: Layout::LatLong, size: 16 }));
        let [a, b] = [a, b].map(|m| DiffuseMap::new(&m, [16, 8]));
        let mixed = DiffuseMap::between(&a, &b, 0.25).expect("alike");
        for ((m, a), b) in mixed.values().iter().zip(a.values()).zip(b.values()) {
            assert!((m - (0.75 * a + 0.25 * b)).abs() < 1e-12);
        }
        assert_eq!(DiffuseMap::between(&a, &b, 0.0).expect("alike").values(), a.values());
        let other = DiffuseMap::new(&tilted(Shape { layout: Layout::Cube, size: 8 }), [8, 4]);
        assert!(DiffuseMap::between(&a, &other, 0.5).is_none());
    }
}
