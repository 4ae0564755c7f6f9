//! Maps from maps: other layouts and sizes, and perspective pictures, each texel or pixel the exact mean over what it
//! shows Greene (1986).

use super::cone::Cone;
use super::exact::exact_into;
use super::layout::{Layout, Shape, Spot};
use super::map::WorldMap;
use crate::math::{DVec3, compensated_sum};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Parts of a target texel are no wider than this (radians) where its sides are not great circles.
const PART: f64 = 0.1;

/// A map in another layout or size: each texel the exact mean of `map` over its own directions, so the mean over the
/// whole world stays. On a cube exact to rounding; else sides of texels are drawn as great circles, shared with the
/// neighbour, wider ones than 0.1 radians cut up. Texels outside of a fish-eye's circle stay 0; what a fish-eye does not
/// show is 0 in the other layout.
pub fn resample(map: &WorldMap, to: Shape) -> WorldMap {
    let bands = map.bands();
    WorldMap::filled(to, bands, |index, out| {
        if to.middle(index).is_none() {
            return;
        }
        let counts = parts(to);
        let (mut sum, mut total) = (vec![0.0; bands], 0.0);
        let mut mean = vec![0.0; bands];
        for k in 0..counts[0] * counts[1] {
            let cone = Cone::Quad(corners(to, index, [k % counts[0], k / counts[0]], counts));
            let weight = if counts == [1, 1] { 1.0 } else { cone.solid_angle() };
            exact_into(map, &cone, &mut mean);
            sum.iter_mut().zip(&mean).for_each(|(s, m)| *s += weight * m);
            total += weight;
        }
        if total > 0.0 {
            out.iter_mut().zip(&sum).for_each(|(o, s)| *o = (s / total) as f32);
        }
    })
}

/// Into how many parts a texel is cut, across and down.
fn parts(shape: Shape) -> [usize; 2] {
    let count = |angle: f64| ((angle / PART).ceil() as usize).max(1);
    let (w, h) = (shape.width() as f64, shape.height() as f64);
    match shape.layout {
        Layout::Cube => [1, 1],
        Layout::LatLong => [count(TAU / w), count(PI / h)],
        // Rows at the poles are high: 2 / sqrt(h).
        Layout::SineLatLong => [count(TAU / w), count(2.0 / h.sqrt()).min(count(PI / h) * 4)],
        Layout::Fisheye { field } => [count(field.to_radians() / w); 2],
    }
}

/// Directions of the corners of a part of a texel; of a fish-eye, drawn in to the rim.
fn corners(shape: Shape, index: usize, part: [usize; 2], counts: [usize; 2]) -> [DVec3; 4] {
    let (panel, x, y) = shape.texel(index);
    let at = |i: usize, j: usize| {
        let px = x as f64 + (part[0] + i) as f64 / counts[0] as f64;
        let py = y as f64 + (part[1] + j) as f64 / counts[1] as f64;
        let inner = match shape.layout {
            Layout::Fisheye { .. } => {
                let half = 0.5 * shape.width() as f64;
                let inwards = (half * (1.0 - 1e-12) / (px - half).hypot(py - half)).min(1.0);
                Spot { panel, x: half + (px - half) * inwards, y: half + (py - half) * inwards }
            }
            _ => Spot { panel, x: px, y: py },
        };
        shape.direction(inner).unwrap_or(DVec3::ZERO)
    };
    [at(0, 0), at(1, 0), at(1, 1), at(0, 1)]
}

/// A picture of width x height pixels, rows from the top, bands side by side: `filter` is given the cone between the
/// corners of each pixel and room for the bands, all 0. `corner` says where the ray through a point of the picture goes,
/// pixels from the upper left corner; of pixels where rays are missing see [`Cone::given`]: what has no cone stays 0.
pub fn picture(
    bands: usize,
    [width, height]: [usize; 2],
    corner: impl Fn(f64, f64) -> Option<DVec3> + Sync,
    filter: impl Fn(&Cone, &mut [f64]) + Sync,
) -> Vec<f32> {
    let mut pixels = vec![0.0_f32; width * height * bands];
    pixels.par_chunks_mut((width * bands).max(1)).enumerate().for_each(|(y, row)| {
        let rays = |y: usize| (0..=width).map(|x| corner(x as f64, y as f64)).collect::<Vec<_>>();
        let (upper, lower) = (rays(y), rays(y + 1));
        let mut mean = vec![0.0; bands];
        for (x, pixel) in row.chunks_mut(bands).enumerate() {
            if let Some(cone) = Cone::given(&[upper[x], upper[x + 1], lower[x + 1], lower[x]]) {
                mean.fill(0.0);
                filter(&cone, &mut mean);
                pixel.iter_mut().zip(&mean).for_each(|(p, m)| *p = *m as f32);
            }
        }
    });
    pixels
}

/// [`picture`] of a map, each pixel the exact mean over what it shows.
pub fn exact_picture(map: &WorldMap, size: [usize; 2], corner: impl Fn(f64, f64) -> Option<DVec3> + Sync) -> Vec<f32> {
    picture(map.bands(), size, corner, |cone, mean| {
        exact_into(map, cone, mean);
    })
}

/// What a map lost on its way to another layout and back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundTrip {
    /// Root mean square of the difference over the world, by solid angle, all bands alike.
    pub rms: f64,
    /// Largest difference of a value.
    pub worst: f64,
    /// `rms` as a share of the root mean square of the map.
    pub relative: f64,
    /// Mean over the world and bands there and back, less that of the map, as a share of it.
    pub mean_change: f64,
}

/// Converts a map to another shape and back. Where the other is a fish-eye, what it does not show is lost.
pub fn round_trip(map: &WorldMap, other: Shape) -> RoundTrip {
    let back = resample(&resample(map, other), map.shape());
    let shape = map.shape();
    let solid: Vec<f64> = (0..shape.texels()).map(|k| shape.solid_angle(k)).collect();
    let over = |value: &dyn Fn(f64, f64) -> f64| {
        compensated_sum((0..shape.texels()).map(|k| {
            let texels = map.texel(k).iter().zip(back.texel(k));
            solid[k] * texels.map(|(a, b)| value(f64::from(*a), f64::from(*b))).sum::<f64>()
        }))
    };
    let weight = solid.iter().sum::<f64>() * map.bands() as f64;
    let rms = (over(&|a, b| (a - b).powi(2)) / weight).sqrt();
    let size = (over(&|a, _| a * a) / weight).sqrt();
    let mean = over(&|a, _| a);
    let share = |part: f64, whole: f64| if whole == 0.0 { 0.0 } else { part / whole };
    let worst = map.values().iter().zip(back.values()).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
    RoundTrip { rms, worst, relative: share(rms, size), mean_change: share(over(&|a, b| b - a), mean) }
}

/// Mean over the world, by solid angle, one value a band.
pub fn mean(map: &WorldMap) -> Vec<f64> {
    let shape = map.shape();
    let solid: Vec<f64> = (0..shape.texels()).map(|k| shape.solid_angle(k)).collect();
    let total = compensated_sum(solid.iter().copied());
    let band = |b: usize| compensated_sum(solid.iter().enumerate().map(|(k, w)| w * f64::from(map.texel(k)[b])));
    (0..map.bands()).map(|b| band(b) / total).collect()
}
