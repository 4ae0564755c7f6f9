//! The part of a texel above a horizon: integral of the cosine over it, in closed form.

use super::layout::{Face, Layout, Shape};
use super::weights::Band;
use crate::math::{DVec3, clip_to_half_space};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// Cosines up to this of a horizon count as on it.
const GRAZING: f64 = 1e-13;

impl Shape {
    /// Integral of the cosine to `normal` (of unit length) over the part of a texel above its horizon, sr; `moment` is
    /// that of the texel. Exact, but for texels of a fish-eye that the horizon cuts: their integral is that of 64 points
    /// each.
    pub(super) fn above(self, index: usize, normal: DVec3, moment: DVec3) -> f64 {
        match self.layout {
            Layout::Cube => {
                let (panel, x, y) = self.texel(index);
                let at = |k: usize| 2.0 * k as f64 / self.size as f64 - 1.0;
                let corner = |dx: usize, dy: usize| Face::ALL[panel].towards(at(x + dx), at(y + dy));
                let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                let heights = corners.map(|c| c.dot(normal));
                if heights.iter().all(|h| *h >= 0.0) {
                    return moment.dot(normal).max(0.0);
                }
                if heights.iter().all(|h| *h <= 0.0) {
                    return 0.0;
                }
                lambert(&clip_to_half_space(&corners, normal, 0.0), normal)
            }
            Layout::LatLong | Layout::SineLatLong => {
                let (_, x, y) = self.texel(index);
                Piece { band: Band::of(self, y), longitudes: self.longitudes(x) }.above(normal)
            }
            Layout::Fisheye { field } => {
                // No texel reaches further from its middle than its diagonal does on the axis.
                let reach = 2f64.sqrt() * field.to_radians() / self.size as f64;
                let (height, length) = (moment.dot(normal), moment.length());
                let least = length * reach.min(0.5 * PI).sin();
                if height >= least {
                    return height;
                }
                if height <= -least {
                    return 0.0;
                }
                let mut sum = 0.0;
                self.fisheye_points(index, |d, weight| sum += weight * d.dot(normal).max(0.0));
                sum
            }
        }
    }
}

/// Lambert's formula: integral of the cosine over the cone of a polygon above the horizon.
fn lambert(corners: &[DVec3], normal: DVec3) -> f64 {
    let side = |k: usize| arc(corners[k], corners[(k + 1) % corners.len()], normal);
    // The corners go to the right and then down as seen from the centre, whatever the face.
    (0.5 * (0..corners.len()).map(side).sum::<f64>()).abs()
}

/// Angle between two directions of any length, times the cosine of the normal of their plane to `normal`.
fn arc(a: DVec3, b: DVec3, normal: DVec3) -> f64 {
    let cross = a.cross(b);
    let length = cross.length();
    if length == 0.0 { 0.0 } else { length.atan2(a.dot(b)) / length * cross.dot(normal) }
}

/// A piece of a row of a latitude-longitude map.
#[derive(Debug, Clone, Copy)]
struct Piece {
    band: Band,
    longitudes: [f64; 2],
}

impl Piece {
    /// Integral of the cosine over what of the piece lies above the horizon.
    ///
    /// By Stokes' theorem it is a sum over the border: half the integral of `normal . (d x dd)`. Taking off the azimuth
    /// about the normal, whose integral about a piece without the normal in it is 0, leaves nothing along the horizon
    /// itself, so only the borders have to be followed, where they are above it.
    fn above(self, normal: DVec3) -> f64 {
        let ([low, high], [from, to]) = (self.band.latitudes, self.longitudes);
        // Pieces that are small against the distance between a normal and its horizon.
        if high - low > FRAC_PI_4 + 1e-9 || to - from > FRAC_PI_4 + 1e-9 {
            let (tall, middle) = (high - low > to - from, [0.5 * (low + high), 0.5 * (from + to)]);
            return [0, 1]
                .into_iter()
                .map(|k| {
                    let half = |r: [f64; 2], m: f64| if k == 0 { [r[0], m] } else { [m, r[1]] };
                    let latitudes = if tall { half([low, high], middle[0]) } else { [low, high] };
                    let longitudes = if tall { [from, to] } else { half([from, to], middle[1]) };
                    Self { band: Band { latitudes }, longitudes }.above(normal)
                })
                .sum();
        }
        let horizon = Horizon::of(normal);
        let (least, most) = horizon.heights(self);
        if least >= -GRAZING {
            return self.band.moment(from, to).dot(normal).max(0.0);
        }
        if most <= GRAZING {
            return 0.0;
        }
        let border = horizon.parallel(low, from, to) - horizon.parallel(high, from, to)
            + horizon.meridian(to, low, high)
            - horizon.meridian(from, low, high);
        // Longitudes run clockwise as seen from above.
        (-0.5 * border).max(0.0)
    }
}

/// A horizon and its normal.
struct Horizon {
    normal: DVec3,
    /// Longitude of the normal.
    longitude: f64,
    /// Length of the normal's level part.
    level: f64,
}

impl Horizon {
    fn of(normal: DVec3) -> Self {
        Self { normal, longitude: normal.x.atan2(normal.y), level: normal.x.hypot(normal.y) }
    }

    /// Cosine at a latitude, with that of the longitude from the normal's.
    fn height(&self, latitude: f64, towards: f64) -> f64 {
        self.level * latitude.cos() * towards + self.normal.z * latitude.sin()
    }

    /// Least and greatest cosine over the parallels of a piece. Their signs hold for all of it: along a meridian the cosine
    /// is a sine wave, which cannot change its sign twice within a piece.
    fn heights(&self, piece: Piece) -> (f64, f64) {
        let ([low, high], [from, to]) = (piece.band.latitudes, piece.longitudes);
        let start = (from - self.longitude).rem_euclid(TAU);
        let end = start + (to - from);
        let passes = |turn: f64| (start..=end).contains(&turn);
        let mut towards = vec![start.cos(), end.cos()];
        towards.extend([(TAU, 1.0), (PI, -1.0), (3.0 * PI, -1.0)].into_iter().filter(|t| passes(t.0)).map(|t| t.1));
        let (mut least, mut most) = (f64::MAX, f64::MIN);
        for t in towards {
            for latitude in [low, high] {
                let h = self.height(latitude, t);
                (least, most) = (least.min(h), most.max(h));
            }
        }
        (least, most)
    }

    /// The border's integral along a parallel, over its part above the horizon, towards growing longitudes.
    fn parallel(&self, latitude: f64, from: f64, to: f64) -> f64 {
        let reach = reach(self.level * latitude.cos(), self.normal.z * latitude.sin());
        let start = (from - self.longitude).rem_euclid(TAU);
        let end = start + (to - from);
        // The part above is centred on the normal's longitude, met at 0 and one turn on.
        [0.0, TAU]
            .into_iter()
            .map(|turn| (start.max(turn - reach), end.min(turn + reach)))
            .filter(|(a, b)| a < b)
            .map(|(a, b)| self.along_parallel(latitude, a + self.longitude, b + self.longitude))
            .sum()
    }

    fn along_parallel(&self, latitude: f64, from: f64, to: f64) -> f64 {
        let (sine, cosine) = latitude.sin_cos();
        let (across, ahead) = (0.5 * (from + to)).sin_cos();
        let chord = 2.0 * (0.5 * (to - from)).sin();
        let swept =
            DVec3::new(sine * cosine * chord * across, sine * cosine * chord * ahead, -cosine * cosine * (to - from));
        self.normal.dot(swept) - self.azimuth(direction(latitude, from), direction(latitude, to))
    }

    /// The same along a meridian, towards growing latitudes.
    fn meridian(&self, longitude: f64, low: f64, high: f64) -> f64 {
        let level = self.level * (longitude - self.longitude).cos();
        let height = |b: f64| level * b.cos() + self.normal.z * b.sin();
        let (low, high) = match (height(low) > 0.0, height(high) > 0.0) {
            (true, true) => (low, high),
            (false, false) => return 0.0,
            (rises, _) => {
                let crossing = (-level / self.normal.z).atan().clamp(low, high);
                if rises { (low, crossing) } else { (crossing, high) }
            }
        };
        let (a, b) = (direction(low, longitude), direction(high, longitude));
        arc(a, b, self.normal) - self.azimuth(a, b)
    }

    /// Angle about the normal from one direction to another.
    fn azimuth(&self, a: DVec3, b: DVec3) -> f64 {
        self.normal.dot(a.cross(b)).atan2(a.dot(b) - self.normal.dot(a) * self.normal.dot(b))
    }
}

/// How far from the normal's longitude `level cos(longitude) + z` stays above 0.
pub(super) fn reach(level: f64, z: f64) -> f64 {
    if z >= level {
        PI
    } else if z <= -level {
        0.0
    } else {
        (-z / level).acos()
    }
}

fn direction(latitude: f64, longitude: f64) -> DVec3 {
    let ((sine, cosine), (across, ahead)) = (latitude.sin_cos(), longitude.sin_cos());
    DVec3::new(cosine * across, cosine * ahead, sine)
}
