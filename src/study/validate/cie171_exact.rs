//! The cases of CIE 171:2006 that geometry alone decides, in closed form. A test holds them against printed digits.

use crate::formfactor::point_to_polygon;
use crate::math::DVec3;
use crate::scene::Receiver;
use std::f64::consts::PI;

/// 5.2: a source of 1000 cd at height 3 over (2, 2), intensity by the cosine: `I0 h^2 / d^4`, lx.
pub(super) fn point_source(receiver: &Receiver) -> f64 {
    let to = DVec3::new(2.0, 2.0, 3.0) - receiver.position;
    1000.0 * to.z * to.z / to.length_squared().powi(2)
}

/// 5.3: the ceiling's square of 1000 cd/m^2, lx.
pub(super) fn area_source(receiver: &Receiver) -> f64 {
    let source = [[1.5, 1.5], [1.5, 2.5], [2.5, 2.5], [2.5, 1.5]].map(|[x, y]| DVec3::new(x, y, 3.0));
    1000.0 * PI * point_to_polygon(receiver.position, receiver.normal, &source)
}

/// 5.6: the floor's square of this side, percent of what it reflects.
pub(super) fn reflector(receiver: &Receiver, side: f64) -> f64 {
    let (lo, hi) = (2.0 - 0.5 * side, 2.0 + 0.5 * side);
    let square = [[lo, lo], [hi, lo], [hi, hi], [lo, hi]].map(|[x, y]| DVec3::new(x, y, 0.0));
    100.0 * point_to_polygon(receiver.position, receiver.normal, &square)
}

/// 5.7: what the box leaves of the wall y = 4, percent of what the wall reflects.
pub(super) fn reflector_behind_box(receiver: &Receiver) -> f64 {
    let low = shadow_height(receiver.position.y, receiver.position.z);
    if low >= 3.0 {
        return 0.0;
    }
    let seen = [[0.0, low], [4.0, low], [4.0, 3.0], [0.0, 3.0]].map(|[x, z]| DVec3::new(x, 4.0, z));
    100.0 * point_to_polygon(receiver.position, receiver.normal, &seen)
}

/// Height on the wall y = 4 below which the box (y 2.5 to 2.7, z 0 to 1, as wide as the wall) hides it from (y, z).
fn shadow_height(y: f64, z: f64) -> f64 {
    // Rising lines graze the near upper edge, falling ones the far one.
    let edge = if z < 1.0 { 2.5 } else { 2.7 };
    (z + (1.0 - z) * (4.0 - y) / (edge - y)).max(0.0)
}

/// 5.8: mean indirect illuminance of a cube of 96 m^2 with 10 klm in it, lx.
pub(super) fn interreflection(reflectance: f64) -> f64 {
    1e4 / 96.0 * reflectance / (1.0 - reflectance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::scene::builtin;

    /// Closed forms to as many digits as the tables print, at the points of the built-in scenes.
    fn agrees(scene: &str, exact: impl Fn(&Receiver) -> f64, printed: &[f64], digit: f64) {
        let receivers = builtin(scene).expect("a built-in scene").receivers;
        assert_eq!(receivers.len(), printed.len(), "{scene}");
        for (r, p) in receivers.iter().zip(printed) {
            let e = exact(r);
            assert!((e - p).abs() <= 0.5001 * digit, "{scene} {}: {e} {p}", r.name);
        }
    }

    #[test]
    fn printed_digits() {
        let floor = [111.11, 105.19, 90.00, 71.11, 99.72, 85.66, 68.05, 74.38, 59.98, 49.38];
        agrees("cie171-5-2", point_source, &floor, 0.01);
        let room = [32.68, 75.19, 81.32, 69.06, 53.40, 40.00, 61.42, 79.26, 95.67, 105.78];
        agrees("cie171-5-3", area_source, &room, 0.01);
        let four = [45.123, 35.901, 27.992, 21.639, 16.716, 12.967, 26.795, 30.939, 33.976, 35.567];
        agrees("cie171-5-6", |r| reflector(r, 4.0), &four, 0.001);
        agrees("cie171-5-6-small", |r| reflector(r, 0.5), &[0.491, 0.639, 0.778, 0.864], 0.001);
        agrees("cie171-5-6-large", |r| reflector(r, 500.0), &[99.988; 4], 0.001);
        let boxed = [16.07, 16.33, 15.40, 13.32, 10.32, 7.08, 3.38, 3.63, 3.01, 0.0, 0.0];
        agrees("cie171-5-7", reflector_behind_box, &boxed, 0.01);
        let rho = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95];
        let mean = [5.48, 11.57, 26.04, 44.64, 69.44, 104.17, 156.25, 243.06, 416.67, 937.50, 1979.17];
        for (r, m) in rho.into_iter().zip(mean) {
            assert!((interreflection(r) - m).abs() <= 0.005, "{r}");
        }
    }
}
