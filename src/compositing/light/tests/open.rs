//! Nothing standing between.

use super::*;
use crate::scene::{Distribution, IntensityCurve};

#[test]
fn a_rectangle_over_a_floor_follows_the_closed_form() {
    let (a, b, h) = (1.3f64, 0.7f64, 0.9f64);
    let mut polygon = rectangle([0.0, a], [0.0, b], h);
    polygon.reverse();
    let (x, y) = (a / h, b / h);
    let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    let expected = (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / (2.0 * PI);
    let value = lamp(LightShape::Area { polygon }).open(DVec3::ZERO, DVec3::Z);
    assert!((value - expected).abs() < 1e-14, "{value} {expected}");
}

#[test]
fn a_tube_is_its_integral_also_across_the_horizon() {
    let mut dice = Dice(1);
    let mut cut = 0;
    for _ in 0..200 {
        let (from, to) = (dice.point(-2.0, 2.0), dice.point(-2.0, 2.0));
        let (point, normal) = (dice.point(-3.0, 3.0), dice.direction());
        let axis = (to - from).normalize();
        let bring = |t: f64| {
            let way = from.lerp(to, t) - point;
            let d = way.length();
            axis.cross(way / d).length() * (normal.dot(way) / d).max(0.0) / (d * d) * from.distance(to)
        };
        // Simpson's rule, to where the tube crosses the horizon.
        let (ha, hb) = (normal.dot(from - point), normal.dot(to - point));
        let (mut lo, mut hi) = (0.0, 1.0);
        if ha * hb < 0.0 {
            cut += 1;
            if ha < 0.0 { lo = ha / (ha - hb) } else { hi = ha / (ha - hb) }
        }
        let n = 4000;
        let at = |k: usize| bring(lo + (hi - lo) * k as f64 / n as f64);
        let inner: f64 = (1..n).map(|k| at(k) * if k % 2 == 1 { 4.0 } else { 2.0 }).sum();
        let expected = (at(0) + inner + at(n)) * (hi - lo) / (3.0 * n as f64);
        let value = lamp(LightShape::Linear { from, to }).open(point, normal);
        assert!((value - expected).abs() < 1e-9 * (1.0 + expected), "{value} {expected}");
    }
    assert!(cut > 20, "{cut}");
}

#[test]
fn a_tube_seen_end_on_brings_nothing() {
    let tube = lamp(LightShape::Linear { from: DVec3::Z, to: 2.0 * DVec3::Z });
    assert_eq!(tube.open(DVec3::ZERO, DVec3::Z), 0.0);
    let mut last = 1.0;
    for off in [1e-2, 1e-4, 1e-6, 1e-8] {
        // Close by it: the integral of off * l / l^4 over the tube, 3/8 of off.
        let value = tube.open(DVec3::new(off, 0.0, 0.0), DVec3::Z);
        assert!((value / (0.375 * off) - 1.0).abs() < 3.0 * off * off + 1e-7 && value < last, "{off} {value}");
        last = value;
    }
}

#[test]
fn a_body_is_the_sum_of_the_faces_it_turns_to_the_point() {
    let faces = cuboid(DVec3::new(1.0, -0.5, 1.0), DVec3::new(2.0, 0.5, 1.6));
    let (point, normal) = (DVec3::new(0.2, -0.9, 0.1), DVec3::new(0.5, 0.3, 0.8).normalize());
    let n = 400;
    let mut expected = 0.0;
    for face in &faces {
        let (u, v) = (face[1] - face[0], face[3] - face[0]);
        let front = u.cross(v);
        for k in 0..n * n {
            let at = |k: usize| (k as f64 + 0.5) / n as f64;
            let way = face[0] + u * at(k % n) + v * at(k / n) - point;
            let square = way.length_squared();
            expected += normal.dot(way).max(0.0) * (-front.dot(way)).max(0.0) / (square * square * PI * (n * n) as f64);
        }
    }
    let value = lamp(LightShape::Polyhedron { faces }).open(point, normal);
    // The midpoint rule of 400 x 400 errs by about its second derivative / (24 n^2).
    assert!((value - expected).abs() < 1e-6, "{value} {expected}");
}

#[test]
fn parallel_and_point_lights() {
    let sun = lamp(LightShape::Parallel { direction: DVec3::new(0.0, -0.6, -0.8) });
    assert!((sun.open(DVec3::ONE, DVec3::Z) - 0.8).abs() < 1e-15 && sun.is_hard());
    assert_eq!(sun.open(DVec3::ONE, -DVec3::Z), 0.0);
    assert_eq!(sun.towards(DVec3::ZERO).1, f64::INFINITY);
    let curve = IntensityCurve { axis: -DVec3::Z, samples: vec![(0.0, 1.0), (90.0, 0.0)] };
    let shape =
        LightShape::Point { position: 3.0 * DVec3::Z, distribution: Distribution::Isotropic, curve: Some(curve) };
    // At 45 degrees: half of the curve, cosine 1/sqrt(2), distance squared 18.
    let value = lamp(shape).open(DVec3::new(3.0, 0.0, 0.0), DVec3::Z);
    assert!((value - 0.5 * 0.5f64.sqrt() / 18.0).abs() < 1e-15);
}

/// The irradiance of a sky by the midpoint rule over elevations and azimuths.
fn by_midpoints(sky: &Lamp, normal: DVec3) -> f64 {
    let n = 1100;
    let step = PI / (2 * n) as f64;
    let mut sum = 0.0;
    for row in 0..n {
        let (sine, cosine) = ((row as f64 + 0.5) * step).sin_cos();
        for k in 0..4 * n {
            let (y, x) = ((k as f64 + 0.5) * step).sin_cos();
            let d = DVec3::new(cosine * x, cosine * y, sine);
            sum += sky.sky(d) * normal.dot(d).max(0.0) * cosine;
        }
    }
    sum * step * step
}

#[test]
fn open_skies_on_tilted_planes() {
    assert!((sky(SkyModel::Uniform).open(DVec3::ONE, DVec3::Z) - PI).abs() < 1e-14);
    assert!((sky(SkyModel::Overcast).open(DVec3::ONE, DVec3::Z) - 7.0 * PI / 9.0).abs() < 1e-14);
    assert!((sky(SkyModel::Uniform).open(DVec3::ONE, DVec3::X) - PI / 2.0).abs() < 1e-14);
    // A wall under an overcast sky: (pi / 2 + 4 / 3) / 3.
    assert!((sky(SkyModel::Overcast).open(DVec3::ONE, DVec3::Y) - (PI / 2.0 + 4.0 / 3.0) / 3.0).abs() < 1e-14);
    let low = SkyModel::Clear { sun: DVec3::new(0.9, 0.3, 0.05).normalize() };
    for model in [SkyModel::Uniform, SkyModel::Overcast, CLEAR, low] {
        let sky = sky(model);
        for normal in [(0.0, 0.0), (0.4, 0.6), (1.2, 3.9), (1.6, 0.5), (2.6, 5.1)] {
            let (tilt, azimuth): (f64, f64) = normal;
            let normal = DVec3::new(tilt.sin() * azimuth.cos(), tilt.sin() * azimuth.sin(), tilt.cos());
            let (value, expected) = (sky.open(DVec3::ZERO, normal), by_midpoints(&sky, normal));
            // The rule's own error: about step^2 / 24 of the second derivatives, 1e-6 where the sun's tip is in it.
            assert!((value - expected).abs() < 2e-6 * expected.max(0.3), "{model:?} {tilt}: {value} {expected}");
        }
    }
    assert_eq!(sky(SkyModel::Uniform).open(DVec3::ZERO, -DVec3::Z), 0.0);
}

#[test]
fn the_clear_sky_is_good_to_a_millionth() {
    // Against the same integral in polar coordinates about the sun, where the tip is smooth.
    let sun = DVec3::new(0.48, 0.6, 0.64);
    let clear = sky(CLEAR);
    let (u, v) = sun.any_orthonormal_pair();
    let (rings, turns) = (2000, 1200);
    let mut sum = 0.0;
    let normal = DVec3::Z;
    for ring in 0..rings {
        let (sine, cosine) = ((ring as f64 + 0.5) * PI / rings as f64).sin_cos();
        for turn in 0..turns {
            let (y, x) = ((turn as f64 + 0.5) * 2.0 * PI / turns as f64).sin_cos();
            let d = sun * cosine + (u * x + v * y) * sine;
            sum += clear.sky(d) * normal.dot(d).max(0.0) * sine;
        }
    }
    let expected = sum * 2.0 * PI * PI / (rings * turns) as f64;
    let value = clear.open(DVec3::ZERO, normal);
    assert!((value / expected - 1.0).abs() < 1e-6, "{value} {expected}");
}
