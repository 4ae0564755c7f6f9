//! Irradiance under a map, exact for its texels as they are: areas of one value each.

use super::above::reach;
use super::layout::{Face, Layout, Shape};
use super::map::WorldMap;
use super::weights::Band;
use crate::math::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Rows that are summed as one; the same on any number of threads.
const ROWS: usize = 16;
/// Normals that are summed together.
const AT_ONCE: usize = 2048;

/// Irradiance, band by band, of a surface with this normal at the world centre: W/m^2 where the map holds radiance in
/// W/(m^2 sr). Texels wholly above the horizon enter by their moments, those it cuts by Lambert's formula: exact for a map
/// whose texels are areas of one value (of a fish-eye, cut texels have 64 points each). What a fish-eye does not show is
/// dark. The normal may have any length but 0; without a direction it counts as up.
pub fn irradiance_exact(map: &WorldMap, normal: DVec3) -> Vec<f64> {
    irradiances(map, &[normal.normalize_or(DVec3::Z)])
}

/// Irradiances for unit normals: normal-major, bands side by side.
pub(super) fn irradiances(map: &WorldMap, normals: &[DVec3]) -> Vec<f64> {
    // So many at a time: every block of rows keeps sums for each of them.
    normals.chunks(AT_ONCE).flat_map(|some| at_once(map, some)).collect()
}

fn at_once(map: &WorldMap, normals: &[DVec3]) -> Vec<f64> {
    let shape = map.shape();
    let rows = shape.panels() * shape.height();
    let parts: Vec<Vec<f64>> = (0..rows.div_ceil(ROWS))
        .into_par_iter()
        .map(|block| {
            let mut sums = vec![0.0; normals.len() * map.bands()];
            for row in block * ROWS..((block + 1) * ROWS).min(rows) {
                Row::new(map, row).add(normals, &mut sums);
            }
            sums
        })
        .collect();
    let mut sums = vec![0.0; normals.len() * map.bands()];
    for part in parts {
        sums.iter_mut().zip(part).for_each(|(s, p)| *s += p);
    }
    sums
}

/// A row of texels with the sums of what stands left of each.
struct Row<'a> {
    map: &'a WorldMap,
    /// Number of its first texel.
    first: usize,
    moments: Vec<DVec3>,
    /// For every column and one more, bands side by side: sum of value times moment of all columns before it.
    before: Vec<DVec3>,
}

impl<'a> Row<'a> {
    fn new(map: &'a WorldMap, row: usize) -> Self {
        let (shape, bands) = (map.shape(), map.bands());
        let width = shape.width();
        let first = row * width;
        let moments: Vec<DVec3> = (first..first + width).map(|k| shape.moment(k)).collect();
        let mut before = vec![DVec3::ZERO; (width + 1) * bands];
        for (x, moment) in moments.iter().enumerate() {
            for (b, value) in map.texel(first + x).iter().enumerate() {
                before[(x + 1) * bands + b] = before[x * bands + b] + *moment * f64::from(*value);
            }
        }
        Self { map, first, moments, before }
    }

    fn add(&self, normals: &[DVec3], sums: &mut [f64]) {
        let (shape, bands) = (self.map.shape(), self.map.bands());
        let width = self.moments.len() as i64;
        let (panel, _, y) = shape.texel(self.first);
        let finder = Finder::of(shape, panel, y);
        for (normal, sum) in normals.iter().zip(sums.chunks_mut(bands)) {
            let Spans { above, cut } = finder.spans(*normal);
            for (b, sum) in sum.iter_mut().enumerate() {
                if above.0 < above.1 {
                    *sum += normal.dot(self.up_to(above.1, b) - self.up_to(above.0, b));
                }
            }
            for x in cut.into_iter().flat_map(|(from, to)| from..to) {
                let x = x.rem_euclid(width) as usize;
                let share = shape.above(self.first + x, *normal, self.moments[x]);
                if share > 0.0 {
                    let values = self.map.texel(self.first + x);
                    sum.iter_mut().zip(values).for_each(|(s, v)| *s += share * f64::from(*v));
                }
            }
        }
    }

    /// Sum of band `b` over the columns before `x`; longitudes go round.
    fn up_to(&self, x: i64, b: usize) -> DVec3 {
        let (width, bands) = (self.moments.len() as i64, self.map.bands());
        let round = self.before[self.moments.len() * bands + b] * x.div_euclid(width) as f64;
        if (0..=width).contains(&x) {
            self.before[x as usize * bands + b]
        } else {
            round + self.before[x.rem_euclid(width) as usize * bands + b]
        }
    }
}

/// Columns of a row, from and up to; in latitude-longitude layouts they may lie beyond the borders, going round.
struct Spans {
    /// Wholly above the horizon.
    above: (i64, i64),
    /// Those it may cut.
    cut: [(i64, i64); 2],
}

/// What is needed to find columns of a row above a horizon.
enum Finder {
    /// Middle of the row on the left border of a face, step to its right border, and from its middle to its lower border.
    Cube { start: DVec3, across: DVec3, half: DVec3, width: f64 },
    /// Sines and cosines of the latitudes of both borders.
    Round { borders: [(f64, f64); 2], width: f64 },
    /// Each texel by itself.
    Each { width: usize },
}

impl Finder {
    fn of(shape: Shape, panel: usize, y: usize) -> Self {
        let width = shape.width() as f64;
        match shape.layout {
            Layout::Cube => {
                let [forward, right, down] = Face::ALL[panel].axes();
                let middle = (2.0 * y as f64 + 1.0) / width - 1.0;
                Self::Cube { start: forward + down * middle - right, across: right * 2.0, half: down / width, width }
            }
            Layout::LatLong | Layout::SineLatLong => {
                Self::Round { borders: Band::of(shape, y).latitudes.map(f64::sin_cos), width }
            }
            Layout::Fisheye { .. } => Self::Each { width: shape.width() },
        }
    }

    fn spans(&self, normal: DVec3) -> Spans {
        match *self {
            Self::Cube { start, across, half, width } => {
                // On both borders of the row the cosine is linear in the column.
                let (height, slope, span) = (start.dot(normal), across.dot(normal), half.dot(normal).abs());
                let (last, none) = (width as i64, (0, 0));
                if slope == 0.0 {
                    let above = if height >= span { (0, last) } else { none };
                    let cut = if height.abs() < span { (0, last) } else { none };
                    return Spans { above, cut: [cut, none] };
                }
                let column = |height: f64| (-height / slope * width).clamp(0.0, width);
                let (whole, any) = (column(height - span), column(height + span));
                if slope > 0.0 {
                    let (from, to) = (any.floor() as i64, whole.ceil() as i64);
                    Spans { above: (to, last), cut: [(from, to), none] }
                } else {
                    let (from, to) = (whole.floor() as i64, any.ceil() as i64);
                    Spans { above: (0, from), cut: [(from, to), none] }
                }
            }
            Self::Round { borders, width } => {
                let level = normal.x.hypot(normal.y);
                let [a, b] = borders.map(|(sine, cosine)| reach(level * cosine, normal.z * sine) / TAU * width);
                let (whole, any) = (a.min(b), a.max(b));
                let middle = (normal.x.atan2(normal.y) / TAU + 0.5) * width;
                let columns = width as i64;
                // All of the row, counted from the middle's opposite, so that nothing is counted twice.
                let (first, last) = {
                    let first = (middle - 0.5 * width).floor() as i64;
                    (first, first + columns)
                };
                let bounded = |x: f64| (x as i64).clamp(first, last);
                let above = if whole >= 0.5 * width {
                    (first, last)
                } else {
                    let (from, to) = (bounded((middle - whole).ceil()), bounded((middle + whole).floor()));
                    if from < to { (from, to) } else { (bounded(middle), bounded(middle)) }
                };
                let (mut from, mut to) = (bounded((middle - any).floor()), bounded((middle + any).ceil()));
                if (middle - any).floor() < first as f64 || (middle + any).ceil() > last as f64 {
                    // What would go beyond one end comes back at the other.
                    (from, to) = (first, last);
                }
                Spans { above, cut: [(from.min(above.0), above.0), (above.1, to.max(above.1))] }
            }
            Self::Each { width } => Spans { above: (0, 0), cut: [(0, width as i64), (0, 0)] },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const WHOLE: [Layout; 3] = [Layout::Cube, Layout::LatLong, Layout::SineLatLong];

    /// Normals in every direction, those along and between axes among them, and some a rounding error beside them.
    fn normals() -> Vec<DVec3> {
        let mut all = Vec::new();
        for x in -1..=1 {
            for y in -1..=1 {
                for z in -1..=1 {
                    let d = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                    if d != DVec3::ZERO {
                        all.extend([d, d + DVec3::new(1e-16, -3e-16, 2e-16), d + DVec3::new(-2e-10, 1e-10, 3e-10)]);
                    }
                }
            }
        }
        all.extend((0..200).map(|k| {
            let (z, phi) = (1.0 - (2.0 * f64::from(k) + 1.0) / 200.0, 2.399_963_229_728_653 * f64::from(k));
            DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z)
        }));
        all.into_iter().map(DVec3::normalize).collect()
    }

    fn uneven(shape: Shape, seed: usize) -> WorldMap {
        WorldMap::filled(shape, 2, |k, v| {
            v[0] = ((k * 7919 + seed) % 97) as f32;
            v[1] = ((k * 31 + seed) % 11) as f32;
        })
    }

    #[test]
    fn a_uniform_world_brings_pi_whatever_the_normal() {
        for layout in WHOLE {
            for size in [1, 2, 3, 5, 8, 20, 64] {
                let map = WorldMap::filled(Shape { layout, size }, 1, |_, v| v[0] = 1.0);
                let normals = normals();
                for (n, e) in normals.iter().zip(irradiances(&map, &normals)) {
                    assert!((e - PI).abs() < 1e-11, "{layout:?} {size} {n}: {e}");
                }
            }
        }
    }

    /// A surface tilted by t against a bright half world sees pi (1 + cos t) / 2 of it.
    #[test]
    fn half_a_world_brings_what_its_tilt_leaves() {
        for layout in WHOLE {
            for (axis, size) in [(DVec3::X, 8), (DVec3::Y, 8), (DVec3::Z, 8), (DVec3::Z, 30)] {
                let shape = Shape { layout, size };
                let lit = |k: usize| shape.moment(k).dot(axis) > 0.0;
                let map = WorldMap::filled(shape, 1, |k, v| v[0] = if lit(k) { 2.0 } else { 0.0 });
                let normals = normals();
                for (n, e) in normals.iter().zip(irradiances(&map, &normals)) {
                    let expected = PI * (1.0 + n.dot(axis));
                    assert!((e - expected).abs() < 1e-11, "{layout:?} {size} {axis} {n}: {e} {expected}");
                }
            }
        }
        // As a fish-eye of 180 degrees shows it.
        let off = |size: u32| {
            let map = WorldMap::filled(Shape { layout: Layout::Fisheye { field: 180.0 }, size }, 1, |_, v| v[0] = 2.0);
            let worst = |n: &DVec3| (irradiance_exact(&map, *n)[0] - PI * (1.0 + n.y)).abs();
            normals().iter().map(worst).fold(0.0, f64::max)
        };
        let (coarse, fine) = (off(16), off(64));
        assert!(fine < 2e-5 && fine < 0.2 * coarse, "{coarse} {fine}");
    }

    /// The same areas of one value, laid out in finer texels, bring the same: all that the horizon cuts is cut elsewhere.
    #[test]
    fn finer_texels_of_the_same_values_bring_the_same() {
        for layout in WHOLE {
            for (size, times) in [(1, 2), (2, 3), (5, 4), (12, 2)] {
                let coarse = uneven(Shape { layout, size }, 5);
                let fine = WorldMap::filled(Shape { layout, size: size * times }, 2, |k, v| {
                    let (panel, x, y) = Shape { layout, size: size * times }.texel(k);
                    let t = times as usize;
                    v.copy_from_slice(coarse.texel(coarse.shape().index(panel, x / t, y / t)));
                });
                let normals = normals();
                let (a, b) = (irradiances(&coarse, &normals), irradiances(&fine, &normals));
                for (k, (a, b)) in a.iter().zip(&b).enumerate() {
                    assert!((a - b).abs() < 1e-10 * 97.0, "{layout:?} {size} {}: {a} {b}", normals[k / 2]);
                }
            }
        }
    }

    /// Against what needs no layout: directions spread evenly, each asked for its texel.
    #[test]
    fn it_is_the_integral_over_all_directions() {
        const N: u32 = 400_000;
        for layout in WHOLE {
            let map = uneven(Shape { layout, size: 6 }, 3);
            for n in [DVec3::new(0.3, -0.5, 0.7), DVec3::new(-0.9, 0.1, -0.02), DVec3::new(0.1, 0.8, -0.6)] {
                let (n, mut sum) = (n.normalize(), [0.0; 2]);
                for k in 0..N {
                    let (z, phi) =
                        (1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(N), 2.399_963_229_728_653 * f64::from(k));
                    let d = DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z);
                    let values = map.nearest(d).expect("whole");
                    (0..2).for_each(|b| sum[b] += d.dot(n).max(0.0) * f64::from(values[b]));
                }
                for (e, s) in irradiance_exact(&map, n * 3.0).iter().zip(sum) {
                    let expected = s * 4.0 * PI / f64::from(N);
                    assert!((e - expected).abs() < 2e-4 * expected, "{layout:?} {n}: {e} {expected}");
                }
            }
        }
    }

    #[test]
    fn threads_change_no_bit() {
        let map = uneven(Shape { layout: Layout::Cube, size: 33 }, 1);
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| irradiances(&map, &normals()))
        };
        let bits = |v: Vec<f64>| v.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(on(1)), bits(on(3)));
    }
}
