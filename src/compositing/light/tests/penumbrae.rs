//! Soft shadows against brute force: fine grids on tubes, Monte Carlo with fixed seeds on panels and skies.

use super::*;
use crate::compositing::NO_CASTER;

fn clutter(dice: &mut Dice, count: usize) -> Vec<Vec<DVec3>> {
    dice.triangles(count, DVec3::new(-1.5, -1.5, 0.3), DVec3::new(1.5, 1.5, 1.8), 0.5)
}

#[test]
fn hidden_parts_of_a_tube_as_rays_find_them() {
    let mut dice = Dice(5);
    let ends = [DVec3::new(-1.0, 0.2, 2.2), DVec3::new(1.2, -0.1, 2.0)];
    let tube = lamp(LightShape::Linear { from: ends[0], to: ends[1] });
    let mut shadowed = 0;
    for _ in 0..25 {
        let polygons = clutter(&mut dice, 12);
        let all = volumes(&tube, &polygons, 3.0);
        let (point, normal) = (DVec3::new(dice.within(-2.0, 2.0), dice.within(-2.0, 2.0), 0.0), dice.cosine(DVec3::Z));
        let n = 8000;
        let axis = (ends[1] - ends[0]).normalize();
        let (mut expected, mut most): (f64, f64) = (0.0, 0.0);
        for k in 0..n {
            let at = ends[0].lerp(ends[1], (k as f64 + 0.5) / n as f64);
            let way = at - point;
            let d = way.length();
            let bring = axis.cross(way / d).length() * (normal.dot(way) / d).max(0.0) / (d * d)
                * ends[0].distance(ends[1])
                / n as f64;
            most = most.max(bring);
            if !blocked(&polygons, NO_CASTER, point, at) {
                expected += bring;
            }
        }
        let (value, open) = (tube.seen(point, normal, NO_CASTER, &all), tube.open(point, normal));
        shadowed += usize::from(value < 0.99 * open);
        // Every end of a hidden stretch may cut one cell: two ends a caster, half a cell off at most.
        assert!((value - expected).abs() <= 12.0 * most + 1e-6 * open, "{value} {expected} {open}");
    }
    assert!(shadowed > 12, "{shadowed}");
}

/// Mean and standard error of what samples bring.
fn moments(count: usize, mut sample: impl FnMut() -> f64) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..count {
        let x = sample();
        sum += x;
        squares += x * x;
    }
    let n = count as f64;
    let mean = sum / n;
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

#[test]
fn hidden_parts_of_panels_within_five_standard_errors() {
    // 24 comparisons at 5 standard errors: a false alarm in 7e4 choices of the seed.
    let mut dice = Dice(6);
    let mut square = rectangle([-0.8, 0.9], [-0.7, 0.6], 2.1);
    square.reverse();
    let body = cuboid(DVec3::new(-0.4, -0.5, 1.9), DVec3::new(0.5, 0.3, 2.5));
    let mut shadowed = 0;
    for round in 0..24 {
        let faces = if round % 2 == 0 { vec![square.clone()] } else { body.clone() };
        let panel = if round % 2 == 0 {
            lamp(LightShape::Area { polygon: square.clone() })
        } else {
            lamp(LightShape::Polyhedron { faces: body.clone() })
        };
        // The body of the lamp is among the casters.
        let mut polygons = clutter(&mut dice, if round < 16 { 8 } else { 60 });
        polygons.extend(faces.iter().cloned());
        let all = volumes(&panel, &polygons, 3.0);
        let (point, normal) = (DVec3::new(dice.within(-1.5, 1.5), dice.within(-1.5, 1.5), 0.0), dice.cosine(DVec3::Z));
        let (mean, error) = moments(20_000, || {
            let face = &faces[(dice.unit() * faces.len() as f64) as usize];
            let (u, v) = (face[1] - face[0], face[3] - face[0]);
            let at = face[0] + u * dice.unit() + v * dice.unit();
            let way = at - point;
            let front = -u.cross(v).dot(way);
            if front <= 0.0 || normal.dot(way) <= 0.0 || blocked(&polygons, NO_CASTER, point, at) {
                return 0.0;
            }
            let square = way.length_squared();
            normal.dot(way) * front / (square * square * PI) * faces.len() as f64
        });
        let (value, open) = (panel.seen(point, normal, NO_CASTER, &all), panel.open(point, normal));
        shadowed += usize::from(value < 0.95 * open && value > 0.02 * open);
        assert!((value - mean).abs() <= 5.0 * error + 1e-9, "{round}: {value} {mean} +- {error}, open {open}");
    }
    assert!(shadowed > 10, "{shadowed}");
}

#[test]
fn hidden_parts_of_skies_within_five_standard_errors() {
    // 18 comparisons at 5 standard errors: a false alarm in 9e4 choices of the seed.
    let mut dice = Dice(7);
    for model in [SkyModel::Uniform, SkyModel::Overcast, CLEAR] {
        for round in 0..6 {
            let polygons = clutter(&mut dice, [2, 6, 12, 20, 40, 60][round]);
            let sky = sky(model).with_bands(400);
            let all = volumes(&sky, &polygons, 3.0);
            let (point, normal) = (DVec3::new(dice.within(-1.5, 1.5), dice.within(-1.5, 1.5), 0.0), dice.direction());
            let (mean, error) = moments(20_000, || {
                let d = dice.cosine(normal);
                if blocked(&polygons, NO_CASTER, point, point + d * 100.0) { 0.0 } else { PI * sky.sky(d) }
            });
            let value = sky.seen(point, normal, NO_CASTER, &all);
            assert!((value - mean).abs() <= 5.0 * error + 1e-9, "{model:?} {round}: {value} {mean} +- {error}");
        }
    }
}

#[test]
fn more_half_planes_bring_the_sky_nearer() {
    let mut dice = Dice(8);
    let bands = [6, 12, 24, 48, 96];
    for (model, count) in [(SkyModel::Uniform, 10), (SkyModel::Overcast, 40), (CLEAR, 150)] {
        let mut squares = [0.0; 5];
        for _ in 0..20 {
            let polygons = clutter(&mut dice, count);
            let best = sky(model).with_bands(6000);
            let all = volumes(&best, &polygons, 3.0);
            let (point, normal) =
                (DVec3::new(dice.within(-1.5, 1.5), dice.within(-1.5, 1.5), 0.0), dice.cosine(DVec3::Z));
            let (exact, open) = (best.seen(point, normal, NO_CASTER, &all), best.open(point, normal));
            for (n, sum) in bands.iter().zip(&mut squares) {
                let value = sky(model).with_bands(*n).seen(point, normal, NO_CASTER, &all);
                *sum += ((value - exact) / open).powi(2) / 20.0;
            }
        }
        let errors = squares.map(f64::sqrt);
        println!("{model:?}, {count} casters: {errors:?} of the open sky at {bands:?} half planes");
        assert!(errors[2] < 2e-3 && errors[4] < 0.3 * errors[0], "{model:?} {errors:?}");
    }
}

/// What lies behind two overlapping boards is what lies behind the whole board: nothing counts twice, however the corners
/// of shadows are rounded in the plane of an upright lamp.
#[test]
fn overlapping_boards_hide_what_the_whole_board_hides() {
    let mut dice = Dice(11);
    let window = vec![
        DVec3::new(5.0, 1.2, 0.9),
        DVec3::new(5.0, 1.2, 2.2),
        DVec3::new(5.0, 3.0, 2.2),
        DVec3::new(5.0, 3.0, 0.9),
    ];
    let panel = lamp(LightShape::Area { polygon: window });
    let mut shadowed = 0;
    for _ in 0..3000 {
        let (mut whole, mut halves) = (Vec::new(), Vec::new());
        for _ in 0..3 {
            let corner = DVec3::new(dice.within(2.0, 4.5), dice.within(0.5, 3.0), dice.within(0.2, 1.5));
            let (u, v) = (dice.point(-0.4, 0.4), dice.point(-0.4, 0.4));
            let board = |a: f64, b: f64| vec![corner + u * a, corner + u * b, corner + u * b + v, corner + u * a + v];
            whole.push(board(0.0, 1.0));
            halves.extend([board(0.0, 0.7), board(0.3, 1.0)]);
        }
        let point = DVec3::new(dice.within(0.2, 2.0), dice.within(0.3, 3.7), 0.0);
        let value = |polygons: &[Vec<DVec3>]| panel.seen(point, DVec3::Z, NO_CASTER, &volumes(&panel, polygons, 8.0));
        let (a, b) = (value(&whole), value(&halves));
        let open = panel.open(point, DVec3::Z);
        shadowed += usize::from(a < 0.98 * open);
        assert!((a - b).abs() < 1e-9 * open, "{a} {b} {open}");
    }
    assert!(shadowed > 500, "{shadowed}");
}
