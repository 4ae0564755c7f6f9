//! What single points see past exact shadows: against published closed forms, closure, and fine hemi-cubes.

use etalon::estimate::PointSight;
use etalon::formfactor::{Eye, Obstacle, Screen, point_to_polygon};
use etalon::io::scene::builtin;
use etalon::math::{DVec3, Polytope};
use etalon::methods::hemicube::{self, Delta, Params};
use etalon::scene::{Patch, Stage};
use rayon::prelude::*;

fn stage(name: &str) -> Stage {
    builtin(name).expect("built in").at(0).expect("a state")
}

fn square(half: f64, z: f64) -> Vec<DVec3> {
    [[-1., -1.], [-1., 1.], [1., 1.], [1., -1.]].map(|[x, y]| DVec3::new(x * half, y * half, z)).to_vec()
}

fn plate(x: [f64; 2], y: [f64; 2], z: f64) -> Polytope {
    let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| DVec3::new(x, y, z));
    Polytope::flat(&corners).expect("a polygon")
}

/// Values at the centre of a unit square of another one 1 m above it, computed elsewhere with 30 digits.
#[test]
fn known_values_past_plates() {
    let cases: [(&str, Vec<Polytope>, f64); 4] = [
        ("plate over all", vec![plate([-0.25, 0.25], [-0.25, 0.25], 0.5)], 0.0),
        ("facet", vec![plate([-0.25, 0.25], [-0.25, 0.25], 0.75)], 0.116_138_881_1),
        ("slit", vec![plate([-0.5, -0.05], [-0.5, 0.5], 0.5), plate([0.05, 0.5], [-0.5, 0.5], 0.5)], 0.054_641_572_03),
        (
            "pinhole",
            vec![
                plate([-0.5, -0.005], [-0.5, 0.5], 0.5),
                plate([0.005, 0.5], [-0.5, 0.5], 0.5),
                plate([-0.005, 0.005], [-0.5, -0.005], 0.5),
                plate([-0.005, 0.005], [0.005, 0.5], 0.5),
            ],
            1.273_069_803e-4,
        ),
    ];
    for (name, plates, known) in cases {
        let obstacles: Vec<Obstacle> = plates.into_iter().map(Obstacle::new).collect();
        let target = square(0.5, 1.0);
        let screen = Screen::new(&target);
        let mut eye = Eye::new(DVec3::ZERO, DVec3::Z, &obstacles, None, 1.5);
        let open = point_to_polygon(DVec3::ZERO, DVec3::Z, &target);
        let seen = eye.onto(&screen, None).map_or(0.0, |mut view| view.factors(&target).1);
        assert!((open - 0.239_456_470_5).abs() < 1e-10, "{name}: {open}");
        assert!((seen - known).abs() < 1e-10, "{name}: {seen} against {known}");
    }
}

/// In a closed room whose backs nobody sees, everything that a point sees adds up to one.
#[test]
fn rows_of_closed_rooms_sum_to_one() {
    for name in ["furnace", "furnace-l", "furnished-room", "cube-room", "robot-room"] {
        let stage = stage(name);
        let stand = |p: &Patch| hemicube::stand(p, &Params::default()).map(|(eye, frame)| (p.facet, eye, frame.z));
        let sight = PointSight::new(&stage);
        let all: Vec<_> = stage.patches.iter().filter_map(stand).collect();
        let some: Vec<_> = all.iter().step_by(all.len().div_ceil(300)).collect();
        let gap = |s: &&(u32, DVec3, DVec3)| {
            let sum: f64 = sight.row(s.0, s.1, s.2).iter().map(|s| s.seen).sum();
            (1.0 - sum).abs()
        };
        let worst = some.par_iter().map(gap).reduce(|| 0.0, f64::max);
        println!("{name}: {} points, worst gap {worst:.1e}", some.len());
        // Corners of the vase are rounded to nine digits, and its quadrilaterals are as flat as that.
        assert!(worst < if name == "robot-room" { 2e-9 } else { 1e-13 }, "{name}: {worst}");
    }
}

/// A hemi-cube of exact deltas comes to the exact value as its pixels shrink: it shares no step with it.
#[test]
fn fine_hemicubes_come_to_it() {
    let stage = stage("furnished-room");
    let sight = PointSight::new(&stage);
    let error = |resolution: u32| {
        let params = Params { resolution, delta: Delta::Exact, ..Params::default() };
        let f = hemicube::form_factors(&stage, &params, &|_| ()).expect("it runs");
        let rows = (0..f.n).into_par_iter().filter(|i| f.row(*i).next().is_some());
        let of = |i: usize| {
            let (eye, frame) = hemicube::stand(&stage.patches[i], &params).expect("a row");
            let exact = sight.row(stage.patches[i].facet, eye, frame.z);
            exact.iter().map(|s| (f.get(i, s.patch as usize) - s.seen).powi(2)).sum::<f64>()
        };
        rows.map(of).sum::<f64>().sqrt()
    };
    let (coarse, fine) = (error(64), error(512));
    // Patches are cut by pixels at random: between first and three halves' order.
    assert!(fine < coarse / 7.0, "{coarse} {fine}");
}
