//! Reflection cones filtered by the elliptical weighted average at the right level of a pyramid: nearly constant cost, and
//! close to the exact mean [G86, "Hybrid texture filtering"] (Greene and Heckbert 1986).

use super::cone::{Cone, Ellipse, SHARPNESS};
use super::layout::{Face, Layout, Shape, Spot};
use super::map::WorldMap;
use super::pyramid::Pyramid;
use crate::math::DVec3;
use std::f64::consts::{PI, TAU};

/// At most so many times as long as wide: more is made wider.
const LONGEST: f64 = 8.0;

/// Half the minor axis at the finer level is 2 to 4 texels, at the coarser 1 to 2.
const RADIUS: f64 = 2.0;

/// Bands summed at once.
const BANDS: usize = 4;

/// An ellipse on a panel, by its second moments: [xx, xy, yy] of half axes in texels squared.
type Moments = [f64; 3];

impl Pyramid {
    /// Mean over an elliptical cone, one value a band, weighed by exp(-2 r^2), r from 0 in the middle to 1 at the rim. The
    /// cone is drawn as an ellipse by the slopes of the layout in its middle, goes on beyond the edges of a face, and is
    /// filtered texel by texel at two levels where half its minor axis is 2 to 4 and 1 to 2 texels; linear between them.
    /// Ellipses more than 8 times as long as wide are made wider, those less than 2 texels wide are made 2 wide. Of a
    /// wide cone off the middle of a face (10 degrees and more) the ellipse is but the tangent of the conic that the cone
    /// draws there. A cone about a direction beyond a fish-eye's field is 0.
    pub fn ewa(&self, cone: &Cone) -> Vec<f64> {
        let mut mean = vec![0.0; self.bands()];
        self.ewa_into(cone, &mut mean);
        mean
    }

    /// [`Pyramid::ewa`] into `mean`, one place a band.
    pub fn ewa_into(&self, cone: &Cone, mean: &mut [f64]) {
        mean.fill(0.0);
        let shape = self.base().shape();
        let Some(ellipse) = cone.ellipse() else { return };
        let Some(spot) = shape.place(ellipse.axis) else { return };
        let (moments, minor) = drawn(shape, &ellipse);
        let (k, share) = self.between(minor / RADIUS);
        for (k, share) in [(k, 1.0 - share), (k + 1, share)] {
            if share > 0.0 {
                let squared = self.scale(k).powi(2);
                add_ellipse(self.level(k), self.spot(spot, k), moments.map(|m| m / squared), share, mean);
            }
        }
    }
}

/// A cone as an ellipse on the panel that its axis meets, not too long, and half its minor axis in texels.
fn drawn(shape: Shape, ellipse: &Ellipse) -> (Moments, f64) {
    let [a, b] = [ellipse.a, ellipse.b].map(|t| slope(shape, ellipse.axis, t));
    let moments = [a[0] * a[0] + b[0] * b[0], a[0] * a[1] + b[0] * b[1], a[1] * a[1] + b[1] * b[1]];
    // No further than once around.
    let most = (0.5 * shape.width().max(shape.height()) as f64).powi(2);
    let (major, minor, along) = axes(moments);
    let major = major.min(most);
    let minor = minor.max(major / (LONGEST * LONGEST)).min(most);
    (from_axes(major, minor, along), minor.sqrt())
}

/// Squared half axes, the longer first, and the unit direction of the longer.
pub(super) fn axes([xx, xy, yy]: Moments) -> (f64, f64, [f64; 2]) {
    let (mean, apart) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    let (sine, cosine) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
    (mean + apart, (mean - apart).max(0.0), [cosine, sine])
}

/// Moments of an ellipse with these squared half axes.
fn from_axes(major: f64, minor: f64, [c, s]: [f64; 2]) -> Moments {
    [major * c * c + minor * s * s, (major - minor) * c * s, major * s * s + minor * c * c]
}

/// How the place of the unit direction d moves, in texels, when d moves by t, at right angles to it.
fn slope(shape: Shape, d: DVec3, t: DVec3) -> [f64; 2] {
    let (w, h) = (shape.width() as f64, shape.height() as f64);
    match shape.layout {
        Layout::Cube => {
            let [forward, right, down] = Face::through(d).axes();
            let (depth, deeper) = (d.dot(forward), t.dot(forward));
            let along = |e: DVec3| (t.dot(e) * depth - d.dot(e) * deeper) / (depth * depth);
            [along(right) * 0.5 * w, along(down) * 0.5 * h]
        }
        Layout::LatLong | Layout::SineLatLong => {
            // At a pole itself every longitude is near: a quarter of a texel of latitude off it.
            let cosine = d.x.hypot(d.y).max(0.25 * PI / h);
            let longitude = (t.x * d.y - t.y * d.x) / (cosine * cosine);
            let down = if shape.layout == Layout::LatLong { t.z / cosine / PI } else { 0.5 * t.z };
            [longitude / TAU * w, -down * h]
        }
        Layout::Fisheye { field } => {
            let texels = w / field.to_radians();
            let aside = d.x.hypot(d.z);
            if aside < 1e-9 {
                return [t.x * texels, -t.z * texels];
            }
            let (ex, ez) = (d.x / aside, d.z / aside);
            // Away from the axis, and around it.
            let (out, round) = (-t.y / aside, (t.z * ex - t.x * ez) * aside.atan2(d.y) / aside.max(1e-3));
            [(ex * out - ez * round) * texels, -(ez * out + ex * round) * texels]
        }
    }
}

/// Adds `share` times the weighted mean over an ellipse on one level.
fn add_ellipse(map: &WorldMap, spot: Spot, moments: Moments, share: f64, mean: &mut [f64]) {
    let (major, minor, along) = axes(moments);
    // At least two texels wide: some middle of a texel always lies inside.
    let [xx, xy, yy] = from_axes(major.max(1.0), minor.max(1.0), along);
    let determinant = xx * yy - xy * xy;
    let (p, q, r) = (yy / determinant, -xy / determinant, xx / determinant);
    let (w, h) = (map.shape().width() as i64, map.shape().height() as i64);
    let span = |at: f64, reach: f64| ((at - 0.5 - reach).ceil() as i64, (at - 0.5 + reach).floor() as i64);
    let (y0, y1) = span(spot.y, yy.sqrt());
    // A few bands at a time, in a sum of their own: totals differ from level to level.
    for (chunk, mean) in mean.chunks_mut(BANDS).enumerate() {
        let (mut sum, mut total) = ([0.0; BANDS], 0.0);
        for y in y0..=y1 {
            let dy = y as f64 + 0.5 - spot.y;
            // Where the row meets p x^2 + 2 q x y + r y^2 = 1.
            let (middle, rest) = (-q * dy / p, (q * dy / p).powi(2) - (r * dy * dy - 1.0) / p);
            if rest < 0.0 {
                continue;
            }
            let (x0, x1) = span(spot.x + middle, rest.sqrt());
            for x in x0..=x1 {
                let dx = x as f64 + 0.5 - spot.x;
                let weight = (-SHARPNESS * (p * dx * dx + 2.0 * q * dx * dy + r * dy * dy)).exp();
                let inside = (0..w).contains(&x) && (0..h).contains(&y);
                let index = match inside {
                    true => map.shape().index(spot.panel, x as usize, y as usize),
                    false => map.wrapped(spot.panel, x, y),
                };
                let texel = &map.texel(index)[chunk * BANDS..][..mean.len()];
                sum.iter_mut().zip(texel).for_each(|(s, v)| *s += weight * f64::from(*v));
                total += weight;
            }
        }
        if total > 0.0 {
            mean.iter_mut().zip(sum).for_each(|(m, s)| *m += share * s / total);
        }
    }
}
