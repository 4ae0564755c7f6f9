//! The filters against closed forms, numerical integration by other routes, and each other.

use super::*;
use crate::math::DVec3;
use std::f64::consts::TAU;

const WHOLE: [Layout; 3] = [Layout::Cube, Layout::LatLong, Layout::SineLatLong];
const ALL: [Layout; 5] = [
    Layout::Cube,
    Layout::LatLong,
    Layout::SineLatLong,
    Layout::Fisheye { field: 180.0 },
    Layout::Fisheye { field: 360.0 },
];

/// Numbers from 0 to 1 that look drawn (splitmix64).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64
    }

    fn direction(&mut self) -> DVec3 {
        let (z, phi) = (2.0 * self.next() - 1.0, TAU * self.next());
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * phi.cos(), r * phi.sin(), z)
    }
}

fn map(layout: Layout, size: u32, f: impl Fn(DVec3) -> f64 + Sync) -> WorldMap {
    let shape = Shape { layout, size };
    WorldMap::filled(shape, 1, |k, v| v[0] = shape.middle(k).map_or(0.0, |d| f(d) as f32))
}

/// Directions where layouts have edges, corners and poles, and some others.
fn directions() -> Vec<DVec3> {
    let mut all = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    all.extend(
        [(1, 1, 0), (1, 1, 1), (-1, 1, 1), (0, 1, -1), (-1, -1, -1)]
            .map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)).normalize()),
    );
    all.push(DVec3::new(1e-9, 1e-9, 1.0).normalize());
    all.push(DVec3::new(0.001, -1.0, 0.0).normalize());
    let mut draw = Draw(5);
    all.extend((0..6).map(|_| draw.direction()));
    all
}

/// A pixel's quadrilateral about an axis: half sides in the plane at unit distance, turned.
fn pixel(axis: DVec3, half: [f64; 2], turn: f64) -> [DVec3; 4] {
    let (e, f) = axis.any_orthonormal_pair();
    let (a, b) = (e * turn.cos() + f * turn.sin(), f * turn.cos() - e * turn.sin());
    let at = |s: f64, t: f64| (axis + a * (s * half[0]) + b * (t * half[1])).normalize();
    [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]
}

#[test]
fn a_uniform_world_stays_so_in_every_filter() {
    for layout in ALL {
        let half_world = layout == Layout::Fisheye { field: 180.0 };
        for size in [1, 5, 32] {
            let shape = Shape { layout, size };
            let map = WorldMap::filled(shape, 2, |k, v| {
                v.copy_from_slice(if shape.middle(k).is_some() { &[3.0, 0.1] } else { &[0.0, 0.0] })
            });
            let pyramid = Pyramid::new(map.clone());
            for degrees in [0.01, 5.0, 40.0, 170.0_f64] {
                let half = (0.5 * degrees).to_radians();
                let step = if matches!(layout, Layout::Fisheye { .. }) { 4 } else { 1 };
                for axis in directions().into_iter().skip(1).step_by(3 * step) {
                    if half_world && axis.y <= 1e-6 {
                        continue;
                    }
                    let round = Cone::round(axis, half);
                    let quad = Cone::Quad(pixel(axis, [half.tan(), 0.3 * half.tan()], 0.7));
                    for cone in [round, quad] {
                        for (name, mean) in [
                            ("box", pyramid.box_filter(&cone)),
                            ("ewa", pyramid.ewa(&cone)),
                            ("exact", exact(&map, &cone)),
                        ] {
                            let off = (mean[0] / 3.0 - 1.0).abs().max((mean[1] / f64::from(0.1_f32) - 1.0).abs());
                            assert!(off < 1e-6, "{name} {layout:?} {size} {degrees} {axis} {cone:?}: {mean:?}");
                        }
                    }
                }
            }
        }
    }
}

/// Solid angle of a quadrilateral from the angles at its corners (Girard): another route than the code's.
fn girard(c: &[DVec3; 4]) -> f64 {
    let angle = |i: usize| {
        let (here, next, last) = (c[i], c[(i + 1) % 4], c[(i + 3) % 4]);
        let along = |to: DVec3| (to - here * here.dot(to)).normalize();
        along(next).angle_between(along(last))
    };
    (0..4).map(angle).sum::<f64>() - TAU
}

#[test]
fn exact_weights_of_a_quadrilateral_are_its_solid_angle() {
    let mut draw = Draw(1);
    for layout in WHOLE {
        for size in [3, 32, 200] {
            let shape = Shape { layout, size };
            let mut worst: f64 = 0.0;
            for k in 0..60 {
                let half = [0.003, 0.05, 0.6][k % 3] * (0.5 + draw.next());
                let axis = if k < 13 { directions()[k] } else { draw.direction() };
                let corners = pixel(axis, [half, half * (0.1 + draw.next())], 6.0 * draw.next());
                let cone = Cone::Quad(corners);
                let closed = girard(&corners);
                // The check's own angles at the corners, each right to rounding of pi, leave 1e-12.
                assert!((cone.solid_angle() - closed).abs() < 1e-12, "{} {closed}", cone.solid_angle());
                let mut sum = 0.0;
                for_each_weight(shape, &cone, &mut |_, w| sum += w);
                worst = worst.max((sum / cone.solid_angle() - 1.0).abs());
            }
            let tolerance = if layout == Layout::Cube { 1e-9 } else { 2e-5 };
            assert!(worst < tolerance, "{layout:?} {size}: {worst}");
        }
    }
}

#[test]
fn exact_weights_of_an_ellipse_are_the_gaussian_over_it() {
    // Integrated in polar coordinates of the ellipse: dw = |a x b| exp(-2 r^2) r dr dphi / (1 + |p|^2)^(3/2).
    let closed = |a: f64, b: f64| {
        let (n, m) = (400, 400);
        let mut sum = 0.0;
        for i in 0..n {
            let r = (f64::from(i) + 0.5) / f64::from(n);
            for j in 0..m {
                let phi = TAU * (f64::from(j) + 0.5) / f64::from(m);
                let p2 = (a * r * phi.cos()).powi(2) + (b * r * phi.sin()).powi(2);
                sum += (-2.0 * r * r).exp() * r * (1.0 + p2).powf(-1.5);
            }
        }
        sum * a * b * TAU / f64::from(n * m)
    };
    for layout in WHOLE {
        for (size, half) in [(4, [0.01, 0.003]), (32, [0.1, 0.1]), (64, [0.4, 0.05]), (16, [4.0, 2.0])] {
            let wanted = closed(half[0], half[1]);
            let mut worst: f64 = 0.0;
            for axis in directions().into_iter().take(13) {
                let (e, f) = axis.any_orthonormal_pair();
                let (a, b) = ((e + f) * (half[0] / 2f64.sqrt()), (f - e) * (half[1] / 2f64.sqrt()));
                let mut sum = 0.0;
                for_each_weight(Shape { layout, size }, &Cone::Ellipse { axis, a, b }, &mut |_, w| sum += w);
                worst = worst.max((sum / wanted - 1.0).abs());
            }
            assert!(worst < 2e-4, "{layout:?} {size} {half:?}: {worst}");
        }
    }
}

#[test]
fn exact_means_are_those_of_many_points() {
    // Every texel another value; points spread evenly over the pixel, weighed by their solid angle.
    let mut draw = Draw(7);
    for layout in WHOLE {
        let shape = Shape { layout, size: 24 };
        let map = WorldMap::filled(shape, 1, |k, v| v[0] = Draw(k as u64).next() as f32);
        let mut worst: [f64; 2] = [0.0; 2];
        for k in 0..12 {
            let axis = if k < 6 { directions()[k + 5] } else { draw.direction() };
            let corners = pixel(axis, [0.2, 0.09], 1.1 * k as f64);
            let cone = Cone::elliptical(&corners);
            let Cone::Ellipse { a, b, .. } = cone else { panic!("an ellipse") };
            let n = 1200;
            let mut sums = [[0.0; 2]; 2];
            for i in 0..n * n {
                let at = |i: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
                let (s, t) = (at(i % n), at(i / n));
                let mut add = |which: usize, d: DVec3, gauss: f64| {
                    let weight = gauss * d.length().powi(-3);
                    let value = f64::from(map.nearest(d).expect("whole")[0]);
                    sums[which][0] += weight * value;
                    sums[which][1] += weight;
                };
                let r2 = s * s + t * t;
                if r2 <= 1.0 {
                    add(1, axis + a * s + b * t, (-2.0 * r2).exp());
                }
                add(0, axis + a * (s / 2f64.sqrt()) + b * (t / 2f64.sqrt()), 1.0);
            }
            for (which, cone) in [Cone::Quad(corners), cone].iter().enumerate() {
                let off = exact(&map, cone)[0] - sums[which][0] / sums[which][1];
                worst[which] = worst[which].max(off.abs());
            }
        }
        assert!(worst[0] < 2e-4 && worst[1] < 2e-4, "{layout:?} {worst:?}");
    }
}

/// A world with something in it everywhere.
fn world(d: DVec3) -> f64 {
    2.0 + (3.0 * d.x).sin() + (4.0 * d.y + 1.0).cos() * d.z + 0.5 * (5.0 * d.z).sin()
}

/// Root mean square of a filter's error over directions, cones as wide as `texels` texels of a cube of this size.
fn error(f: impl Fn(&Cone) -> f64, g: impl Fn(&Cone) -> f64, half: [f64; 2], n: usize) -> f64 {
    let mut draw = Draw(11);
    let mut square = 0.0;
    for _ in 0..n {
        let cone = Cone::elliptical(&pixel(draw.direction(), half, TAU * draw.next()));
        square += (f(&cone) - g(&cone)).powi(2);
    }
    (square / n as f64).sqrt()
}

#[test]
fn ewa_tends_to_the_exact_mean_as_texels_and_cones_become_small() {
    for layout in [Layout::Cube, Layout::LatLong] {
        let at = |size: u32| {
            let map = map(layout, size, world);
            let pyramid = Pyramid::new(map.clone());
            // Four texels of the cube wide.
            let half = 4.0 / f64::from(size);
            error(|c| pyramid.ewa(c)[0], |c| exact(&map, c)[0], [half, 0.5 * half], 200)
        };
        let errors = [at(16), at(32), at(64), at(128)];
        // Of first order at the least: both see cones a few texels wide, whose rims cut texels differently.
        assert!(errors[3] < 0.003 && errors.windows(2).all(|e| e[1] < 0.55 * e[0]), "{layout:?} {errors:?}");
    }
}

#[test]
fn squares_are_worse_than_ellipses_on_long_cones() {
    for layout in [Layout::Cube, Layout::LatLong] {
        let map = map(layout, 128, |d| f64::from(u8::from((12.0 * d.x + 9.0 * d.z).sin() * (11.0 * d.y).sin() > 0.0)));
        let pyramid = Pyramid::new(map.clone());
        for half in [[0.02, 0.02], [0.06, 0.06], [0.1, 0.02], [0.3, 0.3], [0.8, 0.8]] {
            let quad = |c: &Cone| Cone::Quad(c.quad());
            let boxed = error(|c| pyramid.box_filter(&quad(c))[0], |c| exact(&map, &quad(c))[0], half, 40);
            let ewa = error(|c| pyramid.ewa(c)[0], |c| exact(&map, c)[0], half, 40);
            println!("{layout:?} {half:?} box {boxed:.5} ewa {ewa:.5}");
            assert!(half[0] > 0.5 || ewa < 0.5 * boxed, "{layout:?} {half:?}: {boxed} {ewa}");
        }
    }
}

#[test]
fn edges_of_the_cube_are_crossed_as_faces_are() {
    // What was in the middle of a face lies across an edge, the world turned with it: the fast filters are as right there.
    let turn = crate::math::DMat3::from_rotation_z(std::f64::consts::FRAC_PI_4);
    let straight = Pyramid::new(map(Layout::Cube, 128, world));
    let turned = Pyramid::new(map(Layout::Cube, 128, |d| world(turn.transpose() * d)));
    // Narrow cones: an ellipse is the tangent of a conic, and leans the more the farther from the middle of a face.
    for half in [0.01, 0.05] {
        let mut draw = Draw(3);
        let mut square = [[0.0; 2]; 2];
        for _ in 0..60 {
            let axis = DVec3::new(0.1 * draw.next() - 0.05, 1.0, 0.6 * draw.next() - 0.3).normalize();
            let corners = pixel(axis, [half, 0.5 * half], TAU * draw.next());
            let there = corners.map(|d| turn * d);
            for (k, (pyramid, c)) in [(&straight, corners), (&turned, there)].into_iter().enumerate() {
                let (quad, round) = (Cone::Quad(c), Cone::elliptical(&c));
                square[0][k] += (pyramid.ewa(&round)[0] - exact(pyramid.base(), &round)[0]).powi(2);
                square[1][k] += (pyramid.box_filter(&quad)[0] - exact(pyramid.base(), &quad)[0]).powi(2);
            }
        }
        for (name, [middle, edge]) in ["ewa", "box"].iter().zip(square) {
            println!(
                "{name} {half}: {:.2e} in the middle of a face, {:.2e} across an edge",
                middle.sqrt(),
                edge.sqrt()
            );
            assert!(edge.sqrt() < 2.5 * middle.sqrt(), "{name} {half}: {square:?}");
        }
    }
}

#[test]
fn cube_against_latitude_longitude() {
    // A checkered world, cones of equal width everywhere and near a pole; measured, and held where it holds.
    let checks = |d: DVec3| f64::from(u8::from((12.0 * d.x + 9.0 * d.z).sin() * (11.0 * d.y).sin() > 0.0));
    for (name, polar) in [("anywhere", false), ("near a pole", true)] {
        for half in [0.01, 0.03, 0.1, 0.3, 0.8] {
            let mut sums = vec![];
            // The same number of texels within 1 percent: 6 n^2 against 2 m^2.
            for (layout, size) in [(Layout::Cube, 128), (Layout::LatLong, 222)] {
                let pyramid = Pyramid::new(map(layout, size, checks));
                let mut draw = Draw(17);
                let (mut boxed, mut ewa) = (0.0, 0.0);
                for _ in 0..80 {
                    let mut axis = draw.direction();
                    if polar {
                        axis = DVec3::new(0.2 * axis.x, 0.2 * axis.y, 1.0).normalize();
                    }
                    let corners = pixel(axis, [half, half], TAU * draw.next());
                    let (quad, round) = (Cone::Quad(corners), Cone::elliptical(&corners));
                    boxed += (pyramid.box_filter(&quad)[0] - exact(pyramid.base(), &quad)[0]).powi(2) / 80.0;
                    ewa += (pyramid.ewa(&round)[0] - exact(pyramid.base(), &round)[0]).powi(2) / 80.0;
                }
                sums.push([boxed.sqrt(), ewa.sqrt()]);
            }
            println!(
                "{name} {half}: box cube {:.4} latlong {:.4}; ewa cube {:.4} latlong {:.4}",
                sums[0][0], sums[1][0], sums[0][1], sums[1][1]
            );
            if polar && half < 0.2 {
                assert!(sums[0][0] < sums[1][0] && sums[0][1] < sums[1][1], "{half} {sums:?}");
            }
        }
    }
}

#[test]
fn there_and_back_loses_less_in_larger_maps_and_keeps_the_mean() {
    let trip =
        |size: u32| round_trip(&map(Layout::Cube, size, world), Shape { layout: Layout::LatLong, size: 2 * size });
    let (coarse, fine) = (trip(16), trip(32));
    println!("{coarse:?} {fine:?}");
    assert!(fine.rms < 0.6 * coarse.rms && fine.relative < 0.02);
    assert!(coarse.mean_change.abs() < 1e-5 && fine.mean_change.abs() < 1e-5);
    for to in [Layout::Cube, Layout::LatLong, Layout::SineLatLong] {
        let from = map(Layout::SineLatLong, 40, world);
        let other = resample(&from, Shape { layout: to, size: 27 });
        println!("{to:?} {:e}", mean(&other)[0] / mean(&from)[0] - 1.0);
        assert!((mean(&other)[0] / mean(&from)[0] - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_swept_pixel_is_the_mean_of_its_instants() {
    let map = map(Layout::Cube, 256, world);
    let pyramid = Pyramid::new(map.clone());
    let corners = pixel(DVec3::new(0.8, 0.6, 0.2).normalize(), [0.01, 0.01], 0.3);
    for turn in [0.0, 0.02, 0.2, 1.0] {
        let path = |t: f64| {
            let by = crate::math::DMat3::from_axis_angle(DVec3::new(0.3, 0.1, 1.0).normalize(), turn * t);
            corners.map(|c| by * c)
        };
        let (fast, slow) = (swept(&pyramid, path)[0], swept_exactly(&map, path, 200)[0]);
        println!("swept {turn}: {fast} {slow}");
        assert!((fast - slow).abs() < 5e-3, "{turn}: {fast} {slow}");
    }
}

#[test]
fn outlines_lie_on_the_cone_and_end_at_edges() {
    for layout in [Layout::Cube, Layout::LatLong] {
        let shape = Shape { layout, size: 64 };
        for axis in directions() {
            let cone = Cone::round(axis, 0.4);
            let lines = outline(shape, &cone, 0.5);
            let wanted = (0.5 * 0.4f64.tan()).atan();
            let mut points = 0;
            for (panel, line) in &lines {
                for p in line {
                    let d = shape.direction(Spot { panel: *panel, x: p[0], y: p[1] }).expect("whole");
                    assert!((d.angle_between(axis) - wanted).abs() < 1e-6, "{layout:?} {axis}");
                    points += 1;
                }
                // A line begins and ends at an edge, or is closed.
                let (a, b) = (line[0], line[line.len() - 1]);
                let on_edge = |p: [f64; 2]| {
                    let near = |v: f64, n: usize| v.min(n as f64 - v) < 1e-6;
                    near(p[0], shape.width()) || near(p[1], shape.height())
                };
                let closed = lines.iter().any(|(_, l)| (l[0][0] - b[0]).hypot(l[0][1] - b[1]) < 1e-6);
                let follows = lines.iter().any(|(_, l)| {
                    let e = l[l.len() - 1];
                    (e[0] - a[0]).hypot(e[1] - a[1]) < 1e-6
                });
                assert!((on_edge(b) || closed) && (on_edge(a) || follows), "{layout:?} {axis} {a:?} {b:?}");
            }
            assert!(points > 250);
        }
    }
}
