//! Points on faces, at edges, in closed rooms; lamps whose body stands in the scene.

use super::*;
use crate::compositing::NO_CASTER;
use crate::formfactor::point_to_polygon;

/// A mesh of a rectangle's triangles.
fn mesh(corner: DVec3, u: DVec3, v: DVec3, n: usize) -> Vec<Vec<DVec3>> {
    let at = |i: usize, j: usize| corner + u * (i as f64 / n as f64) + v * (j as f64 / n as f64);
    let cell = |k: usize| {
        let (i, j) = (k % n, k / n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [vec![a, b, c], vec![a, c, d]]
    };
    (0..n * n).flat_map(cell).collect()
}

fn soft() -> Vec<Lamp> {
    let mut ceiling = rectangle([0.7, 1.6], [0.4, 1.1], 2.5);
    ceiling.reverse();
    vec![
        lamp(LightShape::Linear { from: DVec3::new(0.3, 0.5, 2.4), to: DVec3::new(1.7, 1.4, 2.3) }),
        lamp(LightShape::Area { polygon: ceiling }),
        lamp(LightShape::Polyhedron { faces: cuboid(DVec3::new(0.8, 0.6, 2.0), DVec3::new(1.2, 0.9, 2.4)) }),
        sky(SkyModel::Uniform),
        sky(SkyModel::Overcast),
        sky(CLEAR),
    ]
}

#[test]
fn an_open_box_lets_in_what_its_opening_shows() {
    // White uniform sky: pi times the form factor of the opening, from points on the floor up to its very edges.
    let faces = cuboid(DVec3::ZERO, DVec3::new(2.0, 1.5, 1.0));
    let walls: Vec<Vec<DVec3>> = faces.iter().enumerate().filter(|(k, _)| *k != 1).map(|(_, f)| f.clone()).collect();
    let mut opening = faces[1].clone();
    opening.reverse();
    let white = sky(SkyModel::Uniform);
    let all = volumes(&white, &walls, 3.0);
    for (x, y) in [(1.0, 0.75), (0.3, 1.1), (1.9, 0.05), (1e-6, 0.7), (1e-12, 0.7), (0.0, 0.7), (2.0, 1.5)] {
        let point = DVec3::new(x, y, 0.0);
        let expected = PI * point_to_polygon(point, DVec3::Z, &opening);
        let value = white.seen(point, DVec3::Z, 0, &all);
        // On the rim of a wall itself the wall is seen edge-on, and hides nothing.
        if x > 1e-9 && x < 2.0 {
            assert!((value - expected).abs() < 2e-4, "{x} {y}: {value} {expected}");
        }
        let fine = sky(SkyModel::Uniform).with_bands(400).seen(point, DVec3::Z, 0, &all);
        if x > 1e-9 && x < 2.0 {
            assert!((fine - expected).abs() < 1e-8, "{x} {y}: {fine} {expected}");
        }
    }
}

#[test]
fn a_closed_room_is_dark() {
    let mut dice = Dice(9);
    let (lo, hi) = (DVec3::ZERO, DVec3::new(2.0, 1.5, 1.0));
    // Walls of many triangles: no light through the seams.
    let mut walls = mesh(DVec3::new(0.0, 0.0, 1.0), 2.0 * DVec3::X, 1.5 * DVec3::Y, 7);
    walls.extend(mesh(lo, 2.0 * DVec3::X, DVec3::Z, 7));
    walls.extend(mesh(DVec3::new(0.0, 1.5, 0.0), 2.0 * DVec3::X, DVec3::Z, 7));
    walls.extend(mesh(lo, 1.5 * DVec3::Y, DVec3::Z, 7));
    walls.extend(mesh(DVec3::new(2.0, 0.0, 0.0), 1.5 * DVec3::Y, DVec3::Z, 7));
    let mut lamps = soft();
    lamps.push(lamp(LightShape::Parallel { direction: DVec3::new(0.1, 0.2, -0.9).normalize() }));
    for lamp in lamps {
        let all = volumes(&lamp, &walls, 3.0);
        for k in 0..150 {
            let mut point = lo + (hi - lo) * dice.point(1e-5, 1.0 - 1e-5);
            // Also right under a seam.
            if k % 3 == 0 {
                point.x = 2.0 / 7.0;
            }
            point.z = 0.0;
            let value = lamp.seen(point, DVec3::Z, NO_CASTER, &all);
            assert!(value.abs() < 1e-9, "{k} {point}: {value}");
        }
    }
}

#[test]
fn a_wall_in_pieces_hides_what_a_whole_wall_hides() {
    let mut dice = Dice(10);
    let (corner, u, v) = (DVec3::new(0.4, 0.2, 1.2), DVec3::new(1.1, 0.1, 0.0), DVec3::new(0.1, 0.9, 0.3));
    let whole = vec![vec![corner, corner + u, corner + u + v, corner + v]];
    let pieces = mesh(corner, u, v, 9);
    for lamp in soft() {
        let lamp = lamp.with_bands(600);
        let (one, many) = (volumes(&lamp, &whole, 3.0), volumes(&lamp, &pieces, 3.0));
        for _ in 0..20 {
            let point = DVec3::new(dice.within(-0.5, 2.5), dice.within(-0.5, 2.0), 0.0);
            let (a, b) = (lamp.seen(point, DVec3::Z, 0, &volumes(&lamp, &[], 1.0)), lamp.open(point, DVec3::Z));
            assert!((a - b).abs() < 1e-13, "{a} {b}");
            let normal = dice.cosine(DVec3::Z);
            let (a, b) = (lamp.seen(point, normal, NO_CASTER, &one), lamp.seen(point, normal, NO_CASTER, &many));
            let slack = if matches!(lamp.towards(point).1, f64::INFINITY) { 1e-5 } else { 1e-12 };
            assert!((a - b).abs() < slack, "{a} {b}");
        }
    }
}

#[test]
fn a_body_that_shines_does_not_hide_itself() {
    let mut dice = Dice(11);
    let body = cuboid(DVec3::new(-0.3, -0.2, 1.0), DVec3::new(0.4, 0.5, 1.9));
    let shining = lamp(LightShape::Polyhedron { faces: body.clone() });
    // The body, one face of it again the other way round, and the ceiling that it hangs from.
    let mut polygons = body.clone();
    polygons.push(body[0].iter().rev().copied().collect());
    polygons.push(rectangle([-3.0, 3.0], [-3.0, 3.0], 1.9));
    let all = volumes(&shining, &polygons, 5.0);
    for _ in 0..500 {
        let (point, normal) = (dice.point(-2.0, 1.8), dice.direction());
        if point.cmpgt(DVec3::new(-0.3, -0.2, 1.0)).all() && point.cmplt(DVec3::new(0.4, 0.5, 1.9)).all() {
            continue;
        }
        let (seen, open) = (shining.seen(point, normal, NO_CASTER, &all), shining.open(point, normal));
        assert!((seen - open).abs() < 1e-12, "{point}: {seen} {open}");
    }
    // A tube under the ceiling it is fixed to.
    let tube = lamp(LightShape::Linear { from: DVec3::new(-1.0, 0.0, 1.9), to: DVec3::new(1.0, 0.3, 1.9) });
    let all = volumes(&tube, &polygons[7..], 5.0);
    let point = DVec3::new(0.5, 0.5, 0.0);
    assert_eq!(tube.seen(point, DVec3::Z, NO_CASTER, &all), tube.open(point, DVec3::Z));
}

#[test]
fn faces_touch_at_edges_and_cast_no_shadow_on_themselves() {
    // A box on a floor, points on all its faces and on their edges; the floor is a caster, too.
    let mut polygons = cuboid(DVec3::new(-0.5, -0.5, 0.0), DVec3::new(0.5, 0.5, 1.0));
    polygons.push(rectangle([-4.0, 4.0], [-4.0, 4.0], 0.0));
    let sun = lamp(LightShape::Parallel { direction: DVec3::new(0.3, 0.4, -0.8).normalize() });
    let all = volumes(&sun, &polygons, 5.0);
    let mut out = Vec::new();
    // The top, edge to edge, and the foot of the lit wall y = -0.5, from side to side.
    sun.hidden(DVec3::new(-0.5, -0.5, 1.0), DVec3::new(0.5, 0.5, 1.0), 1, &all, &mut out);
    assert_eq!(out, []);
    sun.hidden(DVec3::new(-0.5, -0.5, 0.0), DVec3::new(0.5, -0.5, 0.0), 2, &all, &mut out);
    assert_eq!(out, []);
    // The floor across the box: dark from its lit wall (x = -0.5) to the tip of the shadow of the far edge; under it, too.
    sun.hidden(DVec3::new(-4.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 0.0), 6, &all, &mut out);
    assert_eq!(out.len(), 1);
    assert!((out[0].0 - 3.5 / 8.0).abs() < 1e-8, "{out:?}");
    // The shadow moves 0.375 in x and 0.5 in y over the height: at y = 0 it ends at x = 0.5 + 0.375.
    assert!((out[0].1 - 4.875 / 8.0).abs() < 1e-8, "{out:?}");
}

#[test]
fn soft_lamps_lose_nothing_by_culling() {
    let mut dice = Dice(12);
    let polygons = dice.triangles(300, DVec3::splat(-2.0), DVec3::splat(3.0), 0.25);
    let receivers = Bounds { lo: DVec3::new(0.2, 0.3, 0.0), hi: DVec3::new(0.7, 0.6, 0.1) };
    for lamp in soft() {
        let (few, all) =
            (Volumes::new(&lamp, &Casters::new(polygons.clone()), &receivers), volumes(&lamp, &polygons, 4.0));
        assert!(few.count() < all.count() && few.bytes() < all.bytes() && few.count() > 0);
        for _ in 0..30 {
            let point = receivers.lo + (receivers.hi - receivers.lo) * dice.point(0.0, 1.0);
            let normal = dice.cosine(DVec3::Z);
            let (a, b) = (lamp.seen(point, normal, NO_CASTER, &few), lamp.seen(point, normal, NO_CASTER, &all));
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}

#[test]
fn nonsense_is_dark_and_never_ends_in_a_panic() {
    let nan = DVec3::splat(f64::NAN);
    let polygons = vec![vec![], vec![DVec3::ONE], vec![nan; 3], vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]];
    let mut lamps = soft();
    lamps.push(lamp(LightShape::Area { polygon: vec![] }));
    lamps.push(lamp(LightShape::Area { polygon: vec![nan; 4] }));
    lamps.push(lamp(LightShape::Polyhedron { faces: vec![] }));
    lamps.push(lamp(LightShape::Linear { from: DVec3::ONE, to: DVec3::ONE }));
    lamps.push(lamp(LightShape::Sky { model: SkyModel::Overcast, up: DVec3::ZERO }));
    lamps.push(lamp(LightShape::Parallel { direction: DVec3::ZERO }));
    let mut out = Vec::new();
    for lamp in lamps {
        let all = volumes(&lamp, &polygons, 5.0);
        assert_eq!(all.count(), 0);
        assert!(lamp.seen(DVec3::ZERO, DVec3::Z, NO_CASTER, &all) >= 0.0);
        let walls = volumes(&lamp, &cuboid(DVec3::ZERO, DVec3::ONE), 5.0);
        for point in [DVec3::ZERO, DVec3::ONE, nan, DVec3::INFINITY] {
            for normal in [DVec3::Z, DVec3::ZERO, nan] {
                let _ = (lamp.seen(point, normal, 0, &walls), lamp.open(point, normal));
                let _ = (lamp.sky(normal), lamp.towards(point));
            }
            lamp.hidden(point, nan, 0, &walls, &mut out);
        }
        let empty = Volumes::new(&lamp, &Casters::new(cuboid(DVec3::ZERO, DVec3::ONE)), &Bounds::NOTHING);
        assert_eq!(empty.count(), 0);
    }
}

/// A single screen takes pi times its form factor from an evenly bright sky, whichever way it stands from the point: also
/// behind it near the horizon, where its angles wrap round.
#[test]
fn a_screen_anywhere_around_hides_its_form_factor() {
    let uniform = sky(SkyModel::Uniform).with_bands(96);
    let mut hidden = 0;
    for tilt in [0.0, 0.3, 1.0, 1.5] {
        let normal = DVec3::new(0.0, -f64::sin(tilt), f64::cos(tilt));
        for k in 0..48 {
            let azimuth = 2.0 * PI * (f64::from(k) + 0.25) / 48.0;
            let at = |a: f64, z: f64| DVec3::new(a.cos(), a.sin(), z) * 2.0;
            let screen =
                vec![at(azimuth - 0.3, 0.01), at(azimuth + 0.3, 0.01), at(azimuth + 0.3, 0.3), at(azimuth - 0.3, 0.3)];
            let facing: Vec<DVec3> = screen.iter().rev().copied().collect();
            let all = volumes(&uniform, std::slice::from_ref(&screen), 4.0);
            // From whichever side the point sees it.
            let factor =
                [&screen, &facing].map(|p| point_to_polygon(DVec3::ZERO, normal, p)).into_iter().fold(0.0, f64::max);
            let open = uniform.open(DVec3::ZERO, normal);
            let seen = uniform.seen(DVec3::ZERO, normal, NO_CASTER, &all);
            assert!((open - seen - PI * factor).abs() < 5e-5 * open, "{tilt} {k}: {} {}", open - seen, PI * factor);
            hidden += usize::from(factor > 1e-3);
        }
    }
    assert!(hidden > 100, "{hidden}");
}
