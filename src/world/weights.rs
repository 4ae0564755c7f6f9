//! First moments of texels: what a texel of radiance 1 sends through a surface, for every normal that sees all of it.

use super::layout::{Face, Layout, Shape};
use crate::math::DVec3;
use std::f64::consts::{PI, TAU};

/// Points and weights of Gauss and Legendre's rule of order 8 on -1 to 1, the positive half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_361_96),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

impl Shape {
    /// Integral of the unit direction over the solid angle of a texel, sr: its dot product with a normal is the share of
    /// the texel in the irradiance of a surface that sees all of it, for radiance 1. Exact for cubes and both
    /// latitude-longitude layouts; of a fish-eye to about 1e-9 sr for all texels together, its circle cut out.
    ///
    /// No closed form here subtracts numbers that agree in more than their first digits: of a texel of a 1,024 cube 12
    /// digits remain.
    pub fn moment(self, index: usize) -> DVec3 {
        let (panel, x, y) = self.texel(index);
        match self.layout {
            Layout::Cube => {
                let at = |k: usize| 2.0 * k as f64 / self.size as f64 - 1.0;
                let [towards, right, down] = Face::ALL[panel].axes();
                let (across, below) = ([at(x), at(x + 1)], [at(y), at(y + 1)]);
                let (u, v) = (sideways(across, below), sideways(below, across));
                towards * ahead(across, below) + right * u + down * v
            }
            Layout::LatLong | Layout::SineLatLong => {
                let [from, to] = self.longitudes(x);
                Band::of(self, y).moment(from, to)
            }
            Layout::Fisheye { .. } => {
                let mut sum = DVec3::ZERO;
                self.fisheye_points(index, |d, weight| sum += d * weight);
                sum
            }
        }
    }

    /// Longitudes of the left and right border of a column of a latitude-longitude map, from the front to the right,
    /// radians.
    pub(super) fn longitudes(self, x: usize) -> [f64; 2] {
        [x, x + 1].map(|x| (x as f64 / self.width() as f64 - 0.5) * TAU)
    }

    /// Directions and weights (sr) that integrate smooth functions over what a texel of a fish-eye has within the circle.
    pub(super) fn fisheye_points(self, index: usize, mut point: impl FnMut(DVec3, f64)) {
        let Layout::Fisheye { field } = self.layout else { return };
        // Coarse texels fall into parts, in which the border of the circle is nearly straight.
        let parts = 16usize.div_ceil(self.size as usize).max(1);
        let (_, column, row) = self.texel(index);
        let at = |k: usize| 2.0 * k as f64 / (self.size as usize * parts) as f64 - 1.0;
        for part in 0..parts * parts {
            let (x, y) = (column * parts + part % parts, row * parts + part / parts);
            fisheye_square([at(x), at(x + 1)], [-at(y + 1), -at(y)], 0.5 * field.to_radians(), &mut point);
        }
    }
}

/// [`Shape::fisheye_points`] of a square of the picture, the circle having radius 1 and standing for the angle `half`.
fn fisheye_square(across: [f64; 2], up: [f64; 2], half: f64, point: &mut impl FnMut(DVec3, f64)) {
    let middle = |r: [f64; 2]| 0.5 * (r[0] + r[1]);
    // Stripes run along the axis in which the circle's border is flatter, so that it never ends a stripe's
    // neighbourhood with a vertical slope.
    let upright = middle(across).abs() > middle(up).abs();
    let (outer, inner) = if upright { (up, across) } else { (across, up) };
    // Where the border enters or leaves through a side along the stripes, its slope breaks.
    let mut breaks = vec![outer[0], outer[1]];
    for side in inner {
        let at = (1.0 - side * side).max(0.0).sqrt();
        breaks.extend([-at, at].into_iter().filter(|b| outer[0] < *b && *b < outer[1]));
    }
    breaks.sort_by(f64::total_cmp);
    for piece in breaks.windows(2) {
        gauss(piece[0], piece[1], |a, wa| {
            let border = (1.0 - a * a).max(0.0).sqrt();
            let (from, to) = (inner[0].max(-border), inner[1].min(border));
            if from < to {
                gauss(from, to, |b, wb| {
                    let (x, z) = if upright { (b, a) } else { (a, b) };
                    let r = x.hypot(z);
                    let angle = r * half;
                    let slope = if r > 0.0 { angle.sin() / r } else { half };
                    point(DVec3::new(x * slope, angle.cos(), z * slope), wa * wb * half * slope);
                });
            }
        });
    }
}

/// Calls `at` with the points and weights of an integral from `from` to `to`.
fn gauss(from: f64, to: f64, mut at: impl FnMut(f64, f64)) {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    for (x, weight) in GAUSS {
        at(middle - half * x, half * weight);
        at(middle + half * x, half * weight);
    }
}

/// Integral of `1 / (1 + u^2 + v^2)^2` over a rectangle of a face: of the direction towards its middle.
fn ahead(u: [f64; 2], v: [f64; 2]) -> f64 {
    let along = |at: f64, over: [f64; 2]| at / (1.0 + at * at).sqrt() * spanned(at, over);
    0.5 * ((along(u[1], v) - along(u[0], v)) + (along(v[1], u) - along(v[0], u)))
}

/// Integral of `u / (1 + u^2 + v^2)^2`: of the direction along `u`.
fn sideways(u: [f64; 2], v: [f64; 2]) -> f64 {
    let at = |u: f64| spanned(u, v) / (1.0 + u * u).sqrt();
    0.5 * (at(u[0]) - at(u[1]))
}

/// Angle at the world centre that the range `over` takes on the line at distance `at` from the middle of a face: a
/// difference of arc tangents as one.
fn spanned(at: f64, over: [f64; 2]) -> f64 {
    let square = 1.0 + at * at;
    ((over[1] - over[0]) * square.sqrt()).atan2(square + over[0] * over[1])
}

/// A row of a latitude-longitude map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Band {
    /// Lower and upper border, radians.
    pub(super) latitudes: [f64; 2],
}

impl Band {
    /// Row `y` of a map in either latitude-longitude layout.
    pub(super) fn of(shape: Shape, y: usize) -> Self {
        let h = shape.size as f64;
        let latitude = |y: usize| {
            let t = y as f64 / h;
            match shape.layout {
                Layout::SineLatLong => (1.0 - 2.0 * t).atan2((4.0 * t * (1.0 - t)).max(0.0).sqrt()),
                _ => (0.5 - t) * PI,
            }
        };
        Self { latitudes: [latitude(y + 1), latitude(y)] }
    }

    /// Integral of the unit direction over the part of the row between two longitudes, sr.
    pub(super) fn moment(self, from: f64, to: f64) -> DVec3 {
        let [low, high] = self.latitudes;
        let (middle, breadth) = (0.5 * (low + high), high - low);
        let (sine, cosine) = middle.sin_cos();
        // Integral of the squared cosine of the latitude.
        let level = breadth.sin() * cosine * cosine + 0.5 * less_its_sine(breadth);
        let (across, ahead) = (0.5 * (from + to)).sin_cos();
        let chord = 2.0 * (0.5 * (to - from)).sin();
        DVec3::new(level * chord * across, level * chord * ahead, sine * cosine * breadth.sin() * (to - from))
    }
}

/// x - sin x.
fn less_its_sine(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x - x.sin();
    }
    // Its series, in which nothing cancels: x^3/3! - x^5/5! + ...
    let (mut term, mut sum, mut k) = (x * x * x / 6.0, 0.0, 4.0);
    while term != 0.0 && sum + term != sum {
        sum += term;
        term *= -x * x / (k * (k + 1.0));
        k += 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::layout::Spot;
    use super::*;
    use crate::math::compensated_sum;

    const WHOLE: [Layout; 3] = [Layout::Cube, Layout::LatLong, Layout::SineLatLong];

    fn sum(shape: Shape, of: impl Fn(DVec3) -> f64) -> f64 {
        compensated_sum((0..shape.texels()).map(|k| of(shape.moment(k))))
    }

    #[test]
    fn moments_of_the_whole_world_cancel_and_those_of_half_a_world_are_pi() {
        for layout in WHOLE {
            for size in [2, 6, 64, 256] {
                let shape = Shape { layout, size };
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    let all = sum(shape, |m| m.dot(axis));
                    assert!(all.abs() < 1e-12, "{layout:?} {size}: {all}");
                    // No texel of an even size reaches across a plane between axes, save columns of latitude-longitude
                    // maps whose number is no multiple of four; 2 x 2 and 2 x 6 are.
                    let half = sum(shape, |m| m.dot(axis).max(0.0));
                    assert!((half - PI).abs() < 1e-11, "{layout:?} {size}: {half}");
                }
            }
        }
    }

    #[test]
    fn a_moment_is_the_solid_angle_in_its_middle_direction_up_to_second_order() {
        for layout in WHOLE {
            let off = |size: u32| {
                let shape = Shape { layout, size };
                let one = |k: usize| {
                    let (d, m, s) = (shape.middle(k).expect("whole"), shape.moment(k), shape.solid_angle(k));
                    assert!(m.length() < s * (1.0 + 1e-9) && m.length() > 0.0, "{layout:?} {size} {k}");
                    m.distance(d * s)
                };
                (0..shape.texels()).map(one).sum::<f64>()
            };
            let (coarse, fine) = (off(32), off(128));
            // Sine-latitude texels at the poles are not small: one order less.
            assert!(fine < 0.3 * coarse && fine < 0.06, "{layout:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn small_texels_keep_their_digits() {
        // Against Gauss and Legendre's rule, which subtracts nothing.
        let shape = Shape { layout: Layout::Cube, size: 1024 };
        for (x, y) in [(0, 0), (511, 512), (700, 3), (1023, 600)] {
            let at = |k: usize| 2.0 * k as f64 / 1024.0 - 1.0;
            let mut expected = DVec3::ZERO;
            gauss(at(x), at(x + 1), |u, wu| {
                gauss(at(y), at(y + 1), |v, wv| {
                    expected += Face::Right.towards(u, v) * (wu * wv / (1.0 + u * u + v * v).powi(2));
                });
            });
            let found = shape.moment(shape.index(Face::Right as usize, x, y));
            assert!(found.distance(expected) < 1e-12 * expected.length(), "{x} {y}: {found} {expected}");
        }
        let shape = Shape { layout: Layout::LatLong, size: 1024 };
        for y in [0, 1, 300, 1023] {
            let [low, high] = Band::of(shape, y).latitudes;
            let [from, to] = shape.longitudes(1700);
            let mut expected = DVec3::ZERO;
            gauss(low, high, |b, wb| {
                gauss(from, to, |l, wl| {
                    let d = DVec3::new(b.cos() * l.sin(), b.cos() * l.cos(), b.sin());
                    expected += d * (wb * wl * b.cos());
                });
            });
            let found = shape.moment(shape.index(0, 1700, y));
            // The latitude of a border next to a pole is itself rounded, to 1e-16 of 0.003.
            assert!(found.distance(expected) < 1e-11 * expected.length(), "{y}: {found} {expected}");
        }
    }

    #[test]
    fn a_fish_eye_holds_its_circle() {
        for (field, axis) in [(180.0f64, PI), (120.0, PI * 0.75), (360.0, 0.0)] {
            for size in [1, 2, 3, 7, 32] {
                let shape = Shape { layout: Layout::Fisheye { field }, size };
                let (mut angle, mut moment) = (0.0, DVec3::ZERO);
                for k in 0..shape.texels() {
                    shape.fisheye_points(k, |_, w| angle += w);
                    moment += shape.moment(k);
                }
                let cap = TAU * (1.0 - (0.5 * field.to_radians()).cos());
                assert!((angle - cap).abs() < 1e-9, "{field} {size}: {angle} {cap}");
                assert!(moment.distance(DVec3::Y * axis) < 1e-9, "{field} {size}: {moment}");
            }
        }
    }

    /// [G86, "Modeling background objects with world projections"]: "about 6 percent".
    #[test]
    fn the_viewing_pyramid_of_45_degrees_sees_6_percent_of_the_world() {
        let tall = 22.5f64.to_radians().tan();
        let wide = tall * 4.0 / 3.0;
        let share = 4.0 * (wide * tall / (1.0 + wide * wide + tall * tall).sqrt()).atan() / (4.0 * PI);
        assert!((share - 0.059_23).abs() < 5e-6, "{share}");
        for layout in WHOLE {
            let off = |size: u32| {
                let shape = Shape { layout, size };
                let within = |k: &usize| {
                    let at = Face::Front.on_plane(shape.middle(*k).expect("whole"));
                    at.is_some_and(|(u, v)| u.abs() < wide && v.abs() < tall)
                };
                let inside = compensated_sum((0..shape.texels()).filter(within).map(|k| shape.solid_angle(k)));
                (inside / (4.0 * PI) - share).abs()
            };
            // Texels count by their middles: what the border gets wrong shrinks with them.
            assert!(off(64) < 2e-3 && off(512) < 2e-4, "{layout:?}: {} {}", off(64), off(512));
        }
    }

    #[test]
    fn a_texel_lies_where_its_moment_points() {
        for layout in WHOLE.into_iter().chain([Layout::Fisheye { field: 180.0 }]) {
            let shape = Shape { layout, size: 8 };
            for k in 0..shape.texels() {
                let m = shape.moment(k);
                if shape.middle(k).is_none() {
                    continue;
                }
                let Spot { panel, x, y } = shape.place(m).expect("drawn");
                assert_eq!(shape.index(panel, x as usize, y as usize), k, "{layout:?}");
            }
        }
    }
}
