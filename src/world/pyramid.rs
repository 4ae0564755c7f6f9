//! Pyramids of images: a map at half the size, a quarter, and so on, panel by panel (Williams 1983) Greene (1986).

use super::layout::{Layout, Shape, Spot};
use super::map::WorldMap;
use crate::math::DVec3;
use rayon::prelude::*;

/// A map and its averages over ever larger squares of texels.
#[derive(Debug, Clone)]
pub struct Pyramid {
    levels: Vec<WorldMap>,
}

impl Pyramid {
    /// Each level has half the texels each way, down to one a face (two of a latitude-longitude map): means of 2 x 2. Of
    /// an odd number half is rounded down, and texels on the border between two squares count for both by their shares,
    /// so a panel's mean never changes. Texels outside of a fish-eye's circle first take the value at the rim next to
    /// them.
    pub fn new(map: WorldMap) -> Self {
        let map = if matches!(map.shape().layout, Layout::Fisheye { .. }) { rimmed(&map) } else { map };
        let mut levels = vec![map];
        while let Some(next) = levels.last().and_then(halved) {
            levels.push(next);
        }
        Self { levels }
    }

    /// The map itself.
    pub fn base(&self) -> &WorldMap {
        &self.levels[0]
    }

    /// All levels, the map itself first.
    pub fn levels(&self) -> &[WorldMap] {
        &self.levels
    }

    /// Level k; the last one beyond.
    pub fn level(&self, k: usize) -> &WorldMap {
        &self.levels[k.min(self.levels.len() - 1)]
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.base().bands()
    }

    /// Edge of a texel of level k, in texels of the map.
    pub(super) fn scale(&self, k: usize) -> f64 {
        f64::from(self.base().shape().size) / f64::from(self.level(k).shape().size)
    }

    /// The level whose texels are just below `edge` (texels of the map), and the share of the next one: by the logarithm,
    /// as Williams does.
    pub(super) fn between(&self, edge: f64) -> (usize, f64) {
        let last = self.levels.len() - 1;
        // From the size's binary logarithm, right for sizes that are powers of 2; at most one off elsewhere.
        let guess = edge.max(1.0).log2();
        let mut k = (guess as usize).min(last);
        while k > 0 && self.scale(k) > edge {
            k -= 1;
        }
        if k == last || edge <= self.scale(k) {
            return (k, 0.0);
        }
        (k, ((edge / self.scale(k)).log2() / (self.scale(k + 1) / self.scale(k)).log2()).min(1.0))
    }

    /// Adds `weight` times the mean over a square of `edge` texels about a point of the map (both in its texels):
    /// bilinear in two levels, linear between them.
    pub(super) fn add_square(&self, spot: Spot, edge: f64, weight: f64, sum: &mut [f64]) {
        let (k, share) = self.between(edge);
        for (k, share) in [(k, 1.0 - share), (k + 1, share)] {
            if share > 0.0 {
                self.level(k).add_bilinear(self.spot(spot, k), weight * share, sum);
            }
        }
    }

    /// A point of the map as one of level k.
    pub(super) fn spot(&self, spot: Spot, k: usize) -> Spot {
        let scale = self.scale(k);
        Spot { panel: spot.panel, x: spot.x / scale, y: spot.y / scale }
    }
}

/// A fish-eye with texels outside of the circle filled in from the rim.
fn rimmed(map: &WorldMap) -> WorldMap {
    let shape = map.shape();
    WorldMap::filled(shape, map.bands(), |k, out| out.copy_from_slice(map.texel(at_rim(shape, k))))
}

/// The texel that stands for one: itself, but for those of a fish-eye whose middle is outside of the circle, where it is
/// one at the rim, inwards from there.
pub(super) fn at_rim(shape: Shape, index: usize) -> usize {
    if !matches!(shape.layout, Layout::Fisheye { .. }) || shape.middle(index).is_some() {
        return index;
    }
    let half = 0.5 * f64::from(shape.size);
    let (_, x, y) = shape.texel(index);
    let (dx, dy) = (x as f64 + 0.5 - half, y as f64 + 0.5 - half);
    let length = dx.hypot(dy);
    let inwards = |step: i32| {
        let inner = (half - 0.5 * f64::from(step)).max(0.0) / length;
        let at = |d: f64| (half + d * inner).clamp(0.0, 2.0 * half - 1.0) as usize;
        shape.index(0, at(dx), at(dy))
    };
    (0..4).map(inwards).find(|k| shape.middle(*k).is_some()).unwrap_or(index)
}

/// The next level; `None` above the last.
fn halved(map: &WorldMap) -> Option<WorldMap> {
    let (old, bands) = (map.shape(), map.bands());
    let shape = Shape { size: old.size / 2, ..old };
    if shape.size == 0 {
        return None;
    }
    let (n, m) = (old.height(), shape.height());
    let mut values = vec![0.0_f32; shape.texels() * bands];
    let width = shape.width();
    values.par_chunks_mut(width * bands).enumerate().for_each(|(row, out)| {
        let (panel, y) = (row / m, row % m);
        let line = |y: usize| &map.values()[old.index(panel, 0, y) * bands..][..old.width() * bands];
        if n == 2 * m {
            let (upper, lower) = (line(2 * y), line(2 * y + 1));
            let pairs = upper.chunks_exact(2 * bands).zip(lower.chunks_exact(2 * bands));
            for (texel, (u, l)) in out.chunks_exact_mut(bands).zip(pairs) {
                for b in 0..bands {
                    texel[b] = ((u[b] + u[b + bands]) + (l[b] + l[b + bands])) * 0.25;
                }
            }
            return;
        }
        let mut sum = vec![0.0_f64; bands];
        for (x, texel) in out.chunks_exact_mut(bands).enumerate() {
            sum.fill(0.0);
            for (sy, wy) in shares(y, n, m) {
                for (sx, wx) in shares(x, n, m) {
                    let from = &line(sy)[sx * bands..][..bands];
                    sum.iter_mut().zip(from).for_each(|(s, v)| *s += wy * wx * f64::from(*v));
                }
            }
            texel.iter_mut().zip(&sum).for_each(|(t, s)| *t = *s as f32);
        }
    });
    Some(WorldMap::new(shape, bands, values))
}

/// Which of n texels lie under texel i of m, in the same length, with their shares of it. Twice as many on both sides
/// change nothing, so widths may count on beyond n.
fn shares(i: usize, n: usize, m: usize) -> impl Iterator<Item = (usize, f64)> {
    // In units of 1/(n m): whole numbers, so a texel that only touches is left out.
    let (lo, hi) = (i * n, (i + 1) * n);
    (lo / m..hi.div_ceil(m)).map(move |k| (k, ((hi.min((k + 1) * m) - lo.max(k * m)) as f64) / n as f64))
}

/// Largest angle between a direction and four others, radians.
pub(super) fn spread(axis: DVec3, corners: &[DVec3]) -> f64 {
    corners.iter().map(|c| axis.angle_between(*c)).fold(0.0, f64::max)
}
