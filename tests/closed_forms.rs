//! Form factors in closed form against exact values, conservation laws and brute-force quadrature.

#[path = "common/truth.rs"]
mod common;

use common::{number, truth_cases, vertices};
use etalon::formfactor::{point_to_polygon, polygon_to_polygon};
use etalon::math::{DMat3, DVec3, area, clip_to_half_space, convex_defect, unit_normal};
use glam::DQuat;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use serde_json::Value;
use std::f64::consts::PI;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(11), failure_persistence: None, ..ProptestConfig::default() }
}

fn is_polygon(s: &Value) -> bool {
    s["type"] == "polygon" && convex_defect(&vertices(s)) > -1e-9
}

/// Cases with nothing between that end on a convex polygon and start from `kind`.
fn open_cases(kind: &str) -> Vec<Value> {
    let wanted = |c: &Value| {
        let first = &c["surface1"];
        first["type"] == kind
            && (kind == "point" || is_polygon(first))
            && is_polygon(&c["surface2"])
            && c["blockers"].as_array().expect("blockers").is_empty()
    };
    truth_cases("form_factors.json").into_iter().filter(wanted).collect()
}

/// One row of the table; whether it is within 1e-12 absolute and 1e-9 relative (1e-20 where the truth is 0).
fn agrees(id: &Value, name: &str, got: f64, exact: f64) -> bool {
    let error = (got - exact).abs();
    println!("{:28} {name} {exact:.15e} {error:.1e} {:.1e}", id.as_str().expect("id"), error / exact);
    error <= 1e-12 && error <= 1e-9 * exact
}

#[test]
fn polygons_of_the_truth_file() {
    println!("case, direction, exact, absolute error, relative error");
    let cases = open_cases("polygon");
    assert!(cases.len() >= 50, "{}", cases.len());
    for case in cases {
        let (a, b) = (vertices(&case["surface1"]), vertices(&case["surface2"]));
        let (there, back) = (polygon_to_polygon(&a, &b), polygon_to_polygon(&b, &a));
        assert!(agrees(&case["id"], "F12", there, number(&case["values"]["F12"])));
        assert!(agrees(&case["id"], "F21", back, number(&case["values"]["F21"])));
        assert!((area(&a) * there - area(&b) * back).abs() <= 1e-13 * area(&a).max(area(&b)));
    }
}

#[test]
fn points_of_the_truth_file() {
    println!("case, direction, exact, absolute error, relative error");
    let cases = open_cases("point");
    assert!(cases.len() >= 10, "{}", cases.len());
    for case in cases {
        let vector = |v: &Value| DVec3::new(number(&v[0]), number(&v[1]), number(&v[2]));
        let from = &case["surface1"];
        let got = point_to_polygon(vector(&from["position"]), vector(&from["normal"]), &vertices(&case["surface2"]));
        let exact = number(&case["values"]["F12"]);
        assert!(agrees(&case["id"], "F12", got, exact));
        assert!((got - exact).abs() <= 1e-13);
    }
}

/// A point close before the middle of an edge: the wall on it fills half the view, less what escapes past its rim.
#[test]
fn points_that_touch() {
    let wall = [[-1., 0., 0.], [-1., 0., 1.], [1., 0., 1.], [1., 0., 0.]].map(DVec3::from_array);
    for gap in [1e-3, 1e-6, 1e-9, 1e-12] {
        // Sparrow and Cess: plane element at the foot of a rectangle, twice the half of width 1 and height 1.
        let (x, y) = (1.0f64, gap);
        let half = ((x / y).atan() - y / (y * y + 1.0).sqrt() * (x / (y * y + 1.0).sqrt()).atan()) / (2.0 * PI);
        let got = point_to_polygon(DVec3::new(0.0, -gap, 0.0), DVec3::Z, &wall.map(|p| DVec3::new(p.x, -p.y, p.z)));
        let turned = point_to_polygon(DVec3::new(0.0, gap, 0.0), DVec3::Z, &wall);
        let (seen, hidden) = if got > turned { (got, turned) } else { (turned, got) };
        assert!((seen - 2.0 * half).abs() < 1e-13, "gap {gap}: {seen} {}", 2.0 * half);
        assert_eq!(hidden, 0.0, "one side only");
    }
    assert_eq!(point_to_polygon(DVec3::ZERO, DVec3::Z, &wall), 0.0, "edge-on");
    assert_eq!(point_to_polygon(DVec3::new(3.0, 0.0, 0.5), DVec3::Z, &wall), 0.0, "edge-on, outside");
}

/// The faces of the cube [-1, 1]^3 cut by half spaces `normal . p <= offset`: a closed convex room, seen from inside.
fn room(cuts: &[(DVec3, f64)]) -> Vec<Vec<DVec3>> {
    let axes = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let planes: Vec<(DVec3, f64)> = axes.into_iter().map(|n| (n, 1.0)).chain(cuts.iter().copied()).collect();
    let face = |k: usize| {
        let (normal, offset) = planes[k];
        let u = normal.any_orthonormal_vector();
        // Counter-clockwise seen against the outward normal, so from inside.
        let v = u.cross(normal);
        let start = [(-9., -9.), (9., -9.), (9., 9.), (-9., 9.)].map(|(s, t)| normal * offset + u * s + v * t);
        let clip = |p: Vec<DVec3>, (n, d): (DVec3, f64)| if p.len() < 3 { p } else { clip_to_half_space(&p, -n, -d) };
        planes.iter().enumerate().filter(|(j, _)| *j != k).fold(start.to_vec(), |p, (_, plane)| clip(p, *plane))
    };
    (0..planes.len()).map(face).filter(|p| p.len() >= 3 && area(p) > 1e-9).collect()
}

fn assert_closed(faces: &[Vec<DVec3>], within: f64) {
    for (i, a) in faces.iter().enumerate() {
        let sum: f64 = faces.iter().map(|b| polygon_to_polygon(a, b)).sum();
        assert!((sum - 1.0).abs() < within, "face {i} of {}: {sum:.16}", faces.len());
    }
}

/// Each quadrilateral of a room into n x n.
fn divided(faces: &[Vec<DVec3>], n: usize) -> Vec<Vec<DVec3>> {
    let step = |k: usize| k as f64 / n as f64;
    let cell = |f: &[DVec3], i: usize, j: usize| {
        let at = |i: usize, j: usize| f[0] + (f[1] - f[0]) * step(i) + (f[3] - f[0]) * step(j);
        vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    faces.iter().flat_map(|f| (0..n * n).map(move |k| cell(f, k / n, k % n))).collect()
}

#[test]
fn a_divided_cube_is_closed() {
    assert_closed(&divided(&room(&[]), 4), 1e-12);
}

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0f64, 0.0..2.0 * PI)
        .prop_map(|(z, t)| DVec3::new(t.cos(), t.sin(), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z)
}

/// A convex polygon of 3 to 6 corners on a circle in any plane.
fn polygon(spread: f64) -> impl Strategy<Value = Vec<DVec3>> {
    let centre = prop::array::uniform3(-spread..spread).prop_map(DVec3::from_array);
    let angles = prop::collection::vec(0.05..0.9f64, 3..7);
    (centre, direction(), angles).prop_map(|(c, n, angles)| {
        let u = n.any_orthonormal_vector();
        let v = n.cross(u);
        let k = angles.len() as f64;
        let angle = |(i, t): (usize, &f64)| 2.0 * PI * (i as f64 + t) / k;
        angles.iter().enumerate().map(angle).map(|t| c + u * t.cos() + v * t.sin()).collect()
    })
}

/// Midpoint sums with n^2 points per fan triangle of a, Richardson-extrapolated twice: no shared code.
fn brute_force(a: &[DVec3], b: &[DVec3]) -> f64 {
    let rule = |p: &[DVec3], n: usize| -> Vec<(DVec3, f64)> {
        let mut out = Vec::new();
        for w in p[1..].windows(2) {
            let (u, v) = ((w[0] - p[0]) / n as f64, (w[1] - p[0]) / n as f64);
            let share = u.cross(v).length() / 2.0;
            for i in 0..n {
                for j in 0..n - i {
                    out.push((p[0] + u * (i as f64 + 1.0 / 3.0) + v * (j as f64 + 1.0 / 3.0), share));
                    if i + j + 1 < n {
                        out.push((p[0] + u * (i as f64 + 2.0 / 3.0) + v * (j as f64 + 2.0 / 3.0), share));
                    }
                }
            }
        }
        out
    };
    let (na, nb) = (unit_normal(a), unit_normal(b));
    let sum = |n: usize| {
        let there = rule(b, n);
        let from = |x: &DVec3, y: &DVec3| (*y - *x).dot(na) * (*x - *y).dot(nb) / x.distance_squared(*y).powi(2);
        let total =
            rule(a, n).iter().map(|(x, w)| w * there.iter().map(|(y, v)| v * from(x, y)).sum::<f64>()).sum::<f64>();
        total / (PI * area(a))
    };
    let (s, t, r) = (sum(4), sum(8), sum(16));
    let (st, tr) = ((4.0 * t - s) / 3.0, (4.0 * r - t) / 3.0);
    (16.0 * tr - st) / 15.0
}

proptest! {
    #![proptest_config(config(40))]

    #[test]
    fn convex_rooms_are_closed(cuts in prop::collection::vec((direction(), 0.5..1.6f64), 1..5)) {
        assert_closed(&room(&cuts), 1e-12);
    }

    #[test]
    fn parts_add_up(a in polygon(1.5), b in polygon(1.5), n in direction(), d in -0.7..0.7f64) {
        let centre = b.iter().sum::<DVec3>() / b.len() as f64;
        let offset = n.dot(centre) + d;
        let halves = [clip_to_half_space(&b, n, offset), clip_to_half_space(&b, -n, -offset)];
        let whole = polygon_to_polygon(&a, &b);
        let parts: f64 = halves.iter().map(|h| polygon_to_polygon(&a, h)).sum();
        prop_assert!((whole - parts).abs() < 1e-12, "{whole} {parts}");
    }

    #[test]
    fn reciprocity_and_motions(a in polygon(2.0), b in polygon(2.0), axis in direction(), angle in 0.0..6.0f64,
                               scale in -3.0..3.0f64, shift in prop::array::uniform3(-5.0..5.0f64)) {
        let (there, back) = (polygon_to_polygon(&a, &b), polygon_to_polygon(&b, &a));
        prop_assert!((area(&a) * there - area(&b) * back).abs() < 1e-13);
        let turn = DMat3::from_quat(DQuat::from_axis_angle(axis, angle)) * 10f64.powf(scale);
        let shift = DVec3::from_array(shift) * 10f64.powf(scale);
        let moved = |p: &[DVec3]| p.iter().map(|v| turn * *v + shift).collect::<Vec<_>>();
        prop_assert!((polygon_to_polygon(&moved(&a), &moved(&b)) - there).abs() < 1e-12);
        let from_last: Vec<DVec3> = a[1..].iter().chain(&a[..1]).copied().collect();
        prop_assert!((polygon_to_polygon(&from_last, &b) - there).abs() < 1e-13);
    }

    #[test]
    fn quadrature_agrees_where_all_is_smooth(a in polygon(0.01), b in polygon(0.01), far in 3.0..40.0f64, way in direction()) {
        let b: Vec<DVec3> = b.iter().map(|p| *p + way * far).collect();
        let (na, nb) = (unit_normal(&a), unit_normal(&b));
        let faces = |p: &[DVec3], q: &[DVec3], n: DVec3| q.iter().all(|y| (*y - p[0]).dot(n) > 0.0);
        let backs = |p: &[DVec3], q: &[DVec3], n: DVec3| q.iter().all(|y| (*y - p[0]).dot(n) < 0.0);
        let got = polygon_to_polygon(&a, &b);
        if backs(&a, &b, na) || backs(&b, &a, nb) {
            prop_assert_eq!(got, 0.0);
        } else if faces(&a, &b, na) && faces(&b, &a, nb) {
            let sum = brute_force(&a, &b);
            prop_assert!((got - sum).abs() <= 1e-6 * far.powi(-4) + 1e-13, "{got} {sum} at {far}");
        }
    }
}

/// Needles and specks that touch a wall: additivity over a cut, and the exact limit of a speck at a corner.
#[test]
fn needles_and_specks_keep_their_digits() {
    let wall = [[0., 0., 0.], [0., 0., 1.], [1., 0., 1.], [1., 0., 0.]].map(DVec3::from_array);
    for width in [1e-2, 1e-4, 1e-6] {
        // A floor strip along the wall, as a whole and in two: also against the wall as a tall polygon in two.
        let strip = |from: f64, to: f64| {
            [[from, 0., 0.], [to, 0., 0.], [to, width, 0.], [from, width, 0.]].map(DVec3::from_array)
        };
        let whole = polygon_to_polygon(&strip(0.0, 1.0), &wall);
        let parts =
            0.25 * polygon_to_polygon(&strip(0.0, 0.25), &wall) + 0.75 * polygon_to_polygon(&strip(0.25, 1.0), &wall);
        assert!((whole - parts).abs() < 1e-12, "width {width}: {whole} {parts}");
        let exact = perpendicular(width, 1.0);
        assert!((whole - exact).abs() < 1e-12 + 1e-16 / width, "width {width}: {whole} {exact}");
    }
}

/// Two rectangles with a common edge of length 1 at right angles, depth w of the first, height h of the second
/// (Howell C-14).
fn perpendicular(w: f64, h: f64) -> f64 {
    let (w2, h2) = (w * w, h * h);
    let both = (h2 + w2).sqrt();
    let logs = (1.0 + w2).ln() + (1.0 + h2).ln() - (1.0 + w2 + h2).ln()
        + w2 * (w2 * (1.0 + w2 + h2) / ((1.0 + w2) * (w2 + h2))).ln()
        + h2 * (h2 * (1.0 + h2 + w2) / ((1.0 + h2) * (h2 + w2))).ln();
    (w * (1.0 / w).atan() + h * (1.0 / h).atan() - both * (1.0 / both).atan() + 0.25 * logs) / (PI * w)
}

#[test]
fn what_has_no_area_or_number_is_answered() {
    let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]].map(DVec3::from_array);
    let line = [DVec3::Z, DVec3::Z + DVec3::X, DVec3::Z + DVec3::X * 2.0];
    assert_eq!(polygon_to_polygon(&square, &line), 0.0);
    assert_eq!(polygon_to_polygon(&line, &square), 0.0);
    assert_eq!(polygon_to_polygon(&square, &[]), 0.0);
    assert_eq!(point_to_polygon(DVec3::Z, -DVec3::Z, &square[..2]), 0.0);
    assert_eq!(polygon_to_polygon(&square, &square), 0.0);
    let broken = [DVec3::Z, DVec3::Z * f64::NAN, DVec3::X];
    assert!(polygon_to_polygon(&square, &broken).is_nan());
    assert!(point_to_polygon(DVec3::Z, DVec3::Z, &broken).is_nan());
}
