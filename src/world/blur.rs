//! Motion blur: the region that a pixel sweeps over while the shutter is open, filtered
//! [G86, "Modeling background objects"].

use super::cone::{Cone, VARIANCE, WIDEST};
use super::ewa::axes;
use super::exact::exact_into;
use super::map::WorldMap;
use super::pyramid::Pyramid;
use crate::math::DVec3;

/// Instants looked at in each piece of a path.
const INSTANTS: usize = 8;

/// A piece of a path is no longer than so many times the pixel's width.
const LONGEST: f64 = 4.0;

/// More pieces than this are not made.
const MOST: usize = 64;

impl Cone {
    /// The ellipse with the middle and the variance of all that a pixel sees from t0 to t1, each instant alike: `path`
    /// gives its corners. `None` where the path has no directions.
    pub fn swept(path: impl Fn(f64) -> [DVec3; 4], [t0, t1]: [f64; 2]) -> Option<Self> {
        let at = |k: usize| t0 + (t1 - t0) * (k as f64 + 0.5) / INSTANTS as f64;
        let pixels: Vec<_> = (0..INSTANTS).filter_map(|k| Self::elliptical(&path(at(k))).ellipse()).collect();
        let axis = pixels.iter().map(|p| p.axis).sum::<DVec3>().try_normalize()?;
        let (e, f) = axis.any_orthonormal_pair();
        let limit = WIDEST.tan();
        let flat = |d: DVec3| {
            let depth = d.dot(axis).max(1e-6);
            [d.dot(e) / depth, d.dot(f) / depth].map(|v| v.clamp(-limit, limit))
        };
        let n = pixels.len() as f64;
        let mut moments = [0.0; 3];
        let middles: Vec<_> = pixels.iter().map(|p| flat(p.axis)).collect();
        let mean = [0, 1].map(|i| middles.iter().map(|m| m[i]).sum::<f64>() / n);
        // Instants in the middles of n equal times leave out 1/n^2 of the variance along the path.
        let between = 1.0 / (n * (1.0 - 1.0 / (n * n)));
        for (pixel, m) in pixels.iter().zip(&middles) {
            let (x, y) = (m[0] - mean[0], m[1] - mean[1]);
            for (sum, product) in moments.iter_mut().zip([x * x, x * y, y * y]) {
                *sum += product * if n > 1.0 { between } else { 0.0 };
            }
            for t in [pixel.a, pixel.b] {
                let (x, y) = (t.dot(e), t.dot(f));
                for (sum, product) in moments.iter_mut().zip([x * x, x * y, y * y]) {
                    *sum += product * VARIANCE / n;
                }
            }
        }
        let (major, minor, [c, s]) = axes(moments);
        let reach = |variance: f64| (variance / VARIANCE).sqrt().min(limit);
        let middle = (axis + e * mean[0] + f * mean[1]).normalize();
        let upright = |t: DVec3| t - middle * t.dot(middle);
        let (a, b) = (upright(e * c + f * s) * reach(major), upright(f * c - e * s) * reach(minor));
        Some(Self::Ellipse { axis: middle, a, b })
    }
}

/// Mean over what a pixel sweeps over while t goes from 0 to 1, one value a band: the path is cut into pieces no
/// longer than four times the pixel's ellipse is wide (64 pieces at most), each of which is one ellipse ([`Cone::swept`], [`Pyramid::ewa`]).
pub fn swept(pyramid: &Pyramid, path: impl Fn(f64) -> [DVec3; 4]) -> Vec<f64> {
    let mut mean = vec![0.0; pyramid.bands()];
    let middle = |t: f64| Cone::Quad(path(t)).axis();
    let steps: Vec<DVec3> = (0..=INSTANTS).filter_map(|k| middle(k as f64 / INSTANTS as f64)).collect();
    let length: f64 = steps.windows(2).map(|w| w[0].angle_between(w[1])).sum();
    let width = Cone::elliptical(&path(0.5)).ellipse().map_or(0.0, |e| 2.0 * e.b.length());
    let pieces = if width > 0.0 { ((length / (LONGEST * width)).ceil() as usize).clamp(1, MOST) } else { MOST };
    let mut part = mean.clone();
    let mut seen = 0.0;
    for k in 0..pieces {
        let time = |k: usize| k as f64 / pieces as f64;
        if let Some(cone) = Cone::swept(&path, [time(k), time(k + 1)]) {
            pyramid.ewa_into(&cone, &mut part);
            mean.iter_mut().zip(&part).for_each(|(m, p)| *m += p);
            seen += 1.0;
        }
    }
    if seen > 0.0 {
        mean.iter_mut().for_each(|m| *m /= seen);
    }
    mean
}

/// The yardstick of [`swept`]: the mean of `instants` exact means, each over the Gaussian about the pixel at that instant.
pub fn swept_exactly(map: &WorldMap, path: impl Fn(f64) -> [DVec3; 4], instants: usize) -> Vec<f64> {
    let mut mean = vec![0.0; map.bands()];
    let mut part = mean.clone();
    for k in 0..instants {
        let cone = Cone::elliptical(&path((k as f64 + 0.5) / instants as f64));
        exact_into(map, &cone, &mut part);
        mean.iter_mut().zip(&part).for_each(|(m, p)| *m += p / instants as f64);
    }
    mean
}
