//! The hemi-cube against numbers known from elsewhere: closed forms, quadrature, counting by hand.

mod common;

use common::{Build, flat, p};
use etalon::math::DVec3;
use etalon::methods::hemicube::{
    Delta, DeltaTable, Item, Params, delta_side, delta_top, form_factors, item_buffer, solve, solve_with,
};
use etalon::scene::{Grid, Region, Stage};
use etalon::solution::FormFactors;
use std::f64::consts::SQRT_2;

/// All of the top; a quarter of the rest on each side.
const TOP: f64 = 0.554_126_423_979_572;
const SIDE: f64 = 0.111_468_394_005_107;

fn params(resolution: u32) -> Params {
    Params { resolution, ..Params::default() }
}

fn exact(resolution: u32) -> Params {
    Params { delta: Delta::Exact, ..params(resolution) }
}

fn factors(stage: &Stage, params: &Params) -> FormFactors {
    form_factors(stage, params, &|_| ()).unwrap()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

mod table {
    use super::*;

    #[test]
    fn limits_are_the_closed_forms() {
        assert!(close(TOP, 4.0 / (std::f64::consts::PI * SQRT_2) * (1.0 / SQRT_2).atan(), 1e-15));
        assert!(close(TOP + 4.0 * SIDE, 1.0, 1e-15));
    }

    #[test]
    fn midpoint_sums_are_those_of_1985() {
        let known = [
            (10, 0.555583289713908, 0.112469265144273, 1.005460350291),
            (20, 0.554491037559693, 0.111716594376106, 1.001357415064116),
            (50, 0.554184779162951, 0.111508017510079, 1.000216849203267),
            (64, 0.554162041919093, 0.111492574280204, 1.000132339039911),
            (100, 0.554141013375886, 0.111478296734114, 1.000054200312341),
            (128, 0.554135328687931, 0.111474437901905, 1.000033080295551),
            (200, 0.554130071366111, 0.111470869490805, 1.000013549329331),
            (256, 0.554128650170614, 0.111469904906092, 1.000008269794981),
            (512, 0.554126980528204, 0.111468771725778, 1.000002067431315),
            (1000, 0.554126569875513, 0.111468493022020, 1.000000541963591),
        ];
        for (n, top, side, total) in known {
            let t = DeltaTable::new(n, Delta::Midpoint);
            assert!(close(t.top_sum(), top, 1e-12), "top at {n}: {}", t.top_sum());
            assert!(close(t.side_sum(), side, 1e-12), "side at {n}: {}", t.side_sum());
            assert!(close(t.total(), total, 1e-12), "total at {n}: {}", t.total());
            assert!(n < 50 || close((t.total() - 1.0) * f64::from(n).powi(2), 0.541963191716, 2e-4));
        }
    }

    #[test]
    fn exact_sums_are_one() {
        for n in [4, 10, 50, 100, 512, 1000] {
            let t = DeltaTable::new(n, Delta::Exact);
            assert!(close(t.top_sum(), TOP, 1e-12) && close(t.side_sum(), SIDE, 1e-12), "{n}");
            assert!(close(t.total(), 1.0, 1e-12), "{n}: {}", t.total());
        }
    }

    #[test]
    fn single_pixels_exact_and_midpoint() {
        // (resolution, on the top, column from the axis, row from the axis or the horizon, exact, midpoint)
        let known = [
            (50, true, 0, 0, 5.082117481964008e-4, 5.084819213914091e-4),
            (50, true, 24, 24, 5.970952615743057e-5, 5.969891939568165e-5),
            (50, true, 24, 0, 1.324826486402487e-4, 1.324657227742041e-4),
            (50, false, 0, 0, 1.015882154090547e-5, 1.016963842782818e-5),
            (50, false, 0, 24, 1.297976891107969e-4, 1.2981640831872e-4),
            (50, false, 24, 0, 2.648932200660443e-6, 2.649314455484083e-6),
            (50, false, 24, 24, 5.850465066603051e-5, 5.850494100776802e-5),
            (100, true, 0, 0, 1.272560863695477e-4, 1.272730401665281e-4),
            (100, true, 49, 49, 1.453072584071014e-5, 1.453008015401419e-5),
            (100, false, 0, 0, 1.272391247705387e-6, 1.272730401665281e-6),
            (100, false, 49, 0, 3.246960031511881e-7, 3.247072654812292e-7),
        ];
        for (n, top, a, b, exact, midpoint) in known {
            for (delta, value) in [(Delta::Exact, exact), (Delta::Midpoint, midpoint)] {
                let t = DeltaTable::new(n, delta);
                let got = if top { t.top(a, b) } else { t.side(a, b) };
                assert!((got / value - 1.0).abs() < 1e-12, "{delta:?} {n} {a} {b}: {got} for {value}");
            }
        }
    }

    #[test]
    fn the_top_is_symmetric_and_everything_is_positive() {
        for delta in [Delta::Midpoint, Delta::Exact] {
            let t = DeltaTable::new(40, delta);
            for (a, b) in (0..20).flat_map(|a| (0..20).map(move |b| (a, b))) {
                assert_eq!(t.top(a, b), t.top(b, a));
                assert!(t.top(a, b) > 0.0 && t.side(a, b) > 0.0);
            }
        }
        // Towards the horizon a side fades in proportion to the height.
        assert_eq!(delta_side(0.3, 0.0, 1.0), 0.0);
        assert!(close(delta_side(0.3, 1e-9, 1.0) / 1e-9, delta_top(0.3, 0.0, 1.0), 1e-15));
    }
}

/// A unit square at the origin that looks up, patch 0.
fn ground() -> Build {
    let mut b = Build::new();
    b.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.0), Grid::Whole, 0.5, 0.0);
    b
}

/// A horizontal rectangle that looks down. Returns its patch number.
fn ceiling(b: &mut Build, x0: f64, y0: f64, x1: f64, y1: f64, z: f64) -> usize {
    b.back_of(&flat(x0, y0, x1, y1, z), Grid::Whole, 0.5, 0.0)
}

/// Two unit squares face to face.
fn opposed(distance: f64) -> Stage {
    let mut b = ground();
    ceiling(&mut b, -0.5, -0.5, 0.5, 0.5, distance);
    b.0
}

/// Two unit squares at right angles that share an edge.
fn perpendicular() -> Stage {
    let mut b = ground();
    b.surface(&[p(-0.5, -0.5, 0.0), p(-0.5, 0.5, 0.0), p(-0.5, 0.5, 1.0), p(-0.5, -0.5, 1.0)], Grid::Whole, 0.5, 0.0);
    b.0
}

/// Two unit squares face to face 1 m apart, with opaque plates between them.
fn obstructed(plates: &[[DVec3; 4]]) -> Stage {
    let mut b = Build(opposed(1.0));
    for plate in plates {
        b.surface(plate, Grid::Whole, 0.0, 0.0);
        b.back_of(plate, Grid::Whole, 0.0, 0.0);
    }
    b.0
}

/// Mean of |F_01 - wanted| over 16 rotations that fall on no symmetry.
fn mean_error(stage: &Stage, resolution: u32, wanted: f64) -> f64 {
    let turned = |k: u32| Params { rotation: 90.0 * (f64::from(k) + 0.37) / 16.0, ..exact(resolution) };
    let error = |k| (item_sum(stage, &turned(k)) - wanted).abs();
    (0..16).map(error).sum::<f64>() / 16.0
}

/// F_01, from the rows of the first patch alone.
fn item_sum(stage: &Stage, params: &Params) -> f64 {
    factors(stage, params).get(0, 1)
}

/// Slope of log(error) over log(resolution).
fn slope(errors: &[(u32, f64)]) -> f64 {
    let (n, (mut sx, mut sy, mut sxx, mut sxy)) = (errors.len() as f64, (0.0, 0.0, 0.0, 0.0));
    for (resolution, error) in errors {
        let (x, y) = (f64::from(*resolution).ln(), error.ln());
        (sx, sy, sxx, sxy) = (sx + x, sy + y, sxx + x * x, sxy + x * y);
    }
    (n * sxy - sx * sy) / (n * sxx - sx * sx)
}

mod centre_value {
    use super::*;

    /// (distance, value at the centre, true mean over the patch).
    const PARALLEL: [(f64, f64, f64); 8] = [
        (0.1, 0.968339556974, 0.826994522397),
        (0.25, 0.831028500157, 0.632036430014),
        (0.5, 0.554126423980, 0.415253283577),
        (1.0, 0.239456470461, 0.199824895698),
        (2.0, 0.0734776348125, 0.0685895888186),
        (3.0, 0.0341067948997, 0.0329713972195),
        (5.0, 0.0125649724937, 0.0124039773132),
        (10.0, 0.00317252553256, 0.00316205683876),
    ];

    #[test]
    fn inside_a_cube_it_is_exact_where_pixels_and_edges_agree() {
        let mut b = Build::new();
        b.room(DVec3::ZERO, DVec3::ONE, 1, 0.5, [0.0; 6]);
        for n in [4, 100, 400] {
            let f = factors(&b.0, &exact(n));
            for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                // The seams between two walls run through pixel centres, which one of the two gets: 1/N.
                let (wanted, tolerance) = match (i == j, i / 2 == j / 2) {
                    (true, _) => (0.0, 0.0),
                    (_, true) => (0.239456470461, 1e-12),
                    _ => (0.190135882385, 0.08 / f64::from(n)),
                };
                assert!(close(f.get(i, j), wanted, tolerance), "{n}: F[{i}][{j}] = {}", f.get(i, j));
            }
        }
    }

    #[test]
    fn parallel_squares_reach_it_and_not_the_patch_average() {
        for (distance, centre, average) in PARALLEL {
            let f = item_sum(&opposed(distance), &Params { rotation: 11.0, ..exact(1000) });
            assert!((f / centre - 1.0).abs() < 1e-3, "distance {distance}: {f} for {centre}");
            let (left, known) = (f / average - 1.0, centre / average - 1.0);
            assert!(close(left, known, 1e-3), "distance {distance}: {left} for {known}");
        }
    }

    #[test]
    fn perpendicular_squares_reach_it() {
        let f = item_sum(&perpendicular(), &Params { rotation: 11.0, ..exact(1000) });
        assert!((f / 0.190135882385 - 1.0).abs() < 1e-3, "{f}");
    }

    #[test]
    fn the_error_against_it_falls_with_resolution() {
        for (stage, centre) in [(opposed(1.0), 0.239456470461), (perpendicular(), 0.190135882385)] {
            let errors = [16, 32, 64, 128, 256, 512].map(|n| (n, mean_error(&stage, n, centre)));
            let s = slope(&errors);
            // Straight edges in general position do better than 1 / N; a bound of -2 is that of smooth integrands.
            assert!((-2.2..-0.9).contains(&s), "slope {s}, {errors:?}");
        }
    }

    #[test]
    fn so_it_does_behind_a_slit() {
        let stage = obstructed(&[flat(-0.5, -0.5, -0.05, 0.5, 0.5), flat(0.05, -0.5, 0.5, 0.5, 0.5)]);
        let errors = [32, 64, 128, 256, 512].map(|n| (n, mean_error(&stage, n, 0.05464157203)));
        let s = slope(&errors);
        assert!((-2.2..-0.9).contains(&s), "slope {s}, {errors:?}");
    }

    #[test]
    fn the_error_against_the_truth_falls_to_what_the_centre_leaves() {
        let stage = opposed(1.0);
        let (centre, average) = (0.239456470461, 0.199824895698);
        let errors = [10, 50, 200, 800].map(|n| mean_error(&stage, n, average) - (centre - average));
        assert!(errors.windows(2).all(|w| w[1].abs() <= w[0].abs()), "{errors:?}");
        assert!(errors[3].abs() < 1e-5 * centre, "{errors:?}");
    }

    #[test]
    fn only_subdivision_reaches_the_patch_average() {
        // Patch 1 split k x k, patch 2 kept whole: parallel at 1 m, at 0.1 m, and at right angles.
        let known = [
            (1, [0.2394564705, 0.968339557, 0.1901358824]),
            (2, [0.2078425836, 0.9306375716, 0.1980393541]),
            (4, [0.2017353007, 0.8782844469, 0.1995661748]),
            (8, [0.2002972610, 0.8413438256, 0.1999256847]),
        ];
        for (k, values) in known {
            for (stage, value) in [opposed(1.0), opposed(0.1), perpendicular()].iter().zip(values) {
                let mut split = Build::new();
                split.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.0), Grid::Quad { na: k, nb: k }, 0.5, 0.0);
                let other = split.surface(&stage.patches[1].corners, Grid::Whole, 0.5, 0.0);
                let f = factors(&split.0, &Params { rotation: 17.0, ..exact(400) });
                let mean = (0..other).map(|i| f.get(i, other)).sum::<f64>() / other as f64;
                assert!((mean / value - 1.0).abs() < 1e-3, "k = {k}: {mean} for {value}");
            }
        }
    }

    #[test]
    fn plates_between_are_seen_from_the_centre_alone() {
        let z = 0.5;
        let slit = [flat(-0.5, -0.5, -0.05, 0.5, z), flat(0.05, -0.5, 0.5, 0.5, z)];
        let pinhole = [
            flat(-0.5, -0.5, -0.005, 0.5, z),
            flat(0.005, -0.5, 0.5, 0.5, z),
            flat(-0.005, -0.5, 0.005, -0.005, z),
            flat(-0.005, 0.005, 0.005, 0.5, z),
        ];
        let centred = [flat(-0.25, -0.25, 0.25, 0.25, z)];
        // (plates, value at the centre, resolution at which edges and pixels agree)
        let facet = [flat(-0.25, -0.25, 0.25, 0.25, 0.75)];
        let known = [
            (&centred[..], 0.0, 100),
            (&facet[..], 0.1161388811, 300),
            (&slit[..], 0.05464157203, 200),
            (&pinhole[..], 1.273069803e-4, 1000),
        ];
        for (plates, centre, n) in known {
            let f = item_sum(&obstructed(plates), &exact(n));
            assert!(close(f, centre, 6e-11), "{n}: {f} for {centre}");
        }
    }
}

mod aliasing {
    use super::*;

    /// Resolution, edge of the lamp, place of its centre along x and y, pixels hit, form factor.
    const KNOWN: [(u32, f64, f64, usize, f64); 8] = [
        (50, 0.2, 0.0, 0, 0.0),
        (50, 0.2, 0.2, 1, 5.0848192139e-4),
        (50, 0.2, 0.12, 1, 5.0848192139e-4),
        (50, 0.5, 0.0, 4, 2.0339276856e-3),
        (50, 0.5, 0.2, 1, 5.0848192139e-4),
        (100, 0.5, 0.0, 4, 5.0909216067e-4),
        (100, 0.5, 0.1, 9, 1.1442377356e-3),
        (100, 0.4, 0.0, 4, 5.0909216067e-4),
    ];

    fn lamp(edge: f64, at: f64) -> Stage {
        let (lo, hi) = (at - 0.5 * edge, at + 0.5 * edge);
        let mut b = ground();
        ceiling(&mut b, lo, lo, hi, hi, 10.0);
        b.0
    }

    #[test]
    fn a_small_lamp_is_missed_or_doubled_as_known() {
        for (n, edge, at, pixels, value) in KNOWN {
            let stage = lamp(edge, at);
            let seen = item_buffer(&stage, 0, &params(n)).unwrap().unwrap();
            assert_eq!(seen.count(Item::patch(1)), pixels, "N = {n}, lamp {edge} m at {at}");
            let f = item_sum(&stage, &params(n));
            assert!(close(f, value, 1e-13), "N = {n}, lamp {edge} m at {at}: {f} for {value}");
        }
    }

    #[test]
    fn a_lamp_as_large_as_a_pixel_is_seen_once_wherever_it_hangs() {
        // Pixels are half-open: corners on four pixel centres hit one of them.
        for at in [0.0, 0.05, 0.1, 0.2, 0.3] {
            let seen = item_buffer(&lamp(0.4, at), 0, &params(50)).unwrap().unwrap();
            assert_eq!(seen.count(Item::patch(1)), 1, "at {at}");
        }
    }
}

mod closed {
    use super::*;

    /// Rows of a closed scene hold every pixel: none falls through a seam, none on a back.
    fn assert_full(name: &str, stage: &Stage, params: &Params) {
        let total = DeltaTable::new(params.resolution, params.delta).total();
        let f = factors(stage, params);
        for i in 0..f.n {
            assert!(close(f.row_sum(i), total, 1e-13), "{name}, {params}, row {i}: {} for {total}", f.row_sum(i));
            assert_eq!(f.get(i, i), 0.0, "{name}: a planar patch does not see itself");
        }
    }

    fn assert_full_at_all_settings(name: &str, stage: &Stage) {
        for n in [4, 10, 50, 64] {
            for rotation in [0.0, 30.0, 45.0, 77.7] {
                assert_full(name, stage, &Params { rotation, ..params(n) });
                assert_full(name, stage, &Params { rotation, ..exact(n) });
            }
        }
    }

    #[test]
    fn an_empty_room() {
        let mut b = Build::new();
        b.room(p(-0.3, 0.2, 0.1), p(2.4, 1.7, 1.3), 5, 0.5, [0.0; 6]);
        assert_full_at_all_settings("room", &b.0);
    }

    #[test]
    fn walls_whose_grids_do_not_fit() {
        // Seams with corners of one side in the middle of edges of the other, at places with no exact binary form.
        let mut b = Build::new();
        for (face, n) in common::box_faces(p(0.1, 0.2, 0.3), p(1.3, 1.4, 1.6)).iter().zip([1, 2, 3, 4, 5, 7]) {
            let inwards: Vec<DVec3> = face.iter().rev().copied().collect();
            b.surface(&inwards, Grid::Quad { na: n, nb: n + 1 }, 0.5, 0.0);
        }
        assert_full_at_all_settings("odd grids", &b.0);
    }

    #[test]
    fn a_room_with_a_box_in_the_air() {
        let mut b = Build::new();
        b.room(DVec3::ZERO, p(1.0, 1.0, 1.0), 3, 0.5, [0.0; 6]);
        b.solid(p(0.3, 0.35, 0.4), p(0.6, 0.55, 0.7), 2, 0.5);
        assert_full_at_all_settings("box in room", &b.0);
    }

    #[test]
    fn a_room_of_triangles_turned_in_space() {
        let turn = etalon::math::Frame::with_x_axis(p(0.3, -0.5, 0.8).normalize(), p(1.0, 0.2, 0.1));
        let mut b = Build::new();
        for face in common::box_faces(p(-0.5, -0.5, -0.5), p(0.5, 0.5, 0.5)) {
            let v: Vec<DVec3> = face.iter().rev().map(|v| turn.to_world(*v)).collect();
            b.surface(&[v[0], v[1], v[2]], Grid::Triangle { n: 3 }, 0.5, 0.0);
            b.surface(&[v[0], v[2], v[3]], Grid::Triangle { n: 4 }, 0.5, 0.0);
        }
        assert_full_at_all_settings("triangles", &b.0);
    }

    #[test]
    fn a_tetrahedron_sees_its_three_other_faces_alike() {
        let v = [p(1.0, 1.0, 1.0), p(1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, -1.0, 1.0)];
        let mut b = Build::new();
        for k in [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]] {
            b.surface(&k.map(|i| v[i]), Grid::Whole, 0.5, 0.0);
        }
        let inwards = b.0.patches.iter().all(|q| q.normal.dot(q.corners[0]) < 0.0);
        assert!(inwards);
        assert_full_at_all_settings("tetrahedron", &b.0);
        let f = factors(&b.0, &exact(400));
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            assert!(close(f.get(i, j), 1.0 / 3.0, 2e-3), "{}", f.get(i, j));
        }
    }
}

mod sides {
    use super::*;

    #[test]
    fn a_back_takes_light_and_gives_none() {
        let mut b = Build(opposed(1.0));
        b.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.5), Grid::Whole, 0.9, 0.0);
        let f = factors(&b.0, &params(50));
        assert_eq!((f.get(0, 1), f.get(0, 2)), (0.0, 0.0), "the back of the plate hides what is behind it");
        assert!(f.get(1, 2) > 0.5 && f.get(2, 1) > 0.5 && f.get(1, 0) == 0.0);
        let seen = item_buffer(&b.0, 0, &params(50)).unwrap().unwrap();
        assert_eq!(seen.count(Item::BACK), 50 * 50);
        assert_eq!(seen.count(Item::NOTHING), 4 * 50 * 25);
    }

    #[test]
    fn of_two_plates_back_to_back_each_shows_its_front() {
        // Tilted, so that the two planes are computed with different rounding; in either order.
        let plate =
            [(-0.4, -0.3), (0.5, -0.31), (0.45, 0.4), (-0.45, 0.41)].map(|(x, y)| p(x, y, 0.5 + 0.11 * x + 0.13 * y));
        for front_first in [true, false] {
            let mut b = Build(opposed(1.0));
            let front = |b: &mut Build| b.surface(&plate, Grid::Quad { na: 3, nb: 2 }, 0.5, 0.0);
            let back = |b: &mut Build| b.back_of(&plate, Grid::Whole, 0.5, 0.0);
            let (up, down) = if front_first {
                let up = front(&mut b);
                (up, back(&mut b))
            } else {
                let down = back(&mut b);
                (front(&mut b), down)
            };
            for (patch, sees) in [(0, down..down + 1), (1, up..up + 6)] {
                let seen = item_buffer(&b.0, patch, &params(100)).unwrap().unwrap();
                assert_eq!(seen.count(Item::BACK), 0, "patch {patch}");
                assert!(sees.map(|j| seen.count(Item::patch(j as u32))).sum::<usize>() > 3000);
            }
        }
    }

    #[test]
    fn the_sides_of_a_plate_may_be_rounded_apart() {
        for gap in [-1e-9, 1e-9] {
            let mut b = Build(opposed(1.0));
            let up = b.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.5), Grid::Whole, 0.5, 0.0);
            let down = b.back_of(&flat(-0.5, -0.5, 0.5, 0.5, 0.5 + gap), Grid::Whole, 0.5, 0.0);
            let f = factors(&b.0, &params(50));
            for (i, j) in [(0, down), (1, up), (up, 1), (down, 0)] {
                assert_eq!((f.row(i).count(), f.row(i).next().unwrap().0), (1, j), "gap {gap}, row {i}");
            }
        }
    }

    #[test]
    fn a_wall_wholly_behind_is_not_seen() {
        let mut b = ground();
        b.surface(&[p(2.0, -1.0, -1.0), p(2.0, -1.0, 0.0), p(2.0, 1.0, 0.0), p(2.0, 1.0, -1.0)], Grid::Whole, 0.5, 0.0);
        b.surface(&flat(3.0, 3.0, 4.0, 4.0, 0.0), Grid::Whole, 0.5, 0.0);
        assert_eq!(factors(&b.0, &params(50)).stored(), 0);
    }
}

mod by_rays {
    use super::*;
    use etalon::methods::hemicube::Face;

    /// What a ray from `eye` meets first, by trying every polygon: no projection, no clipping, no buffers.
    fn first_seen(stage: &Stage, from: usize, eye: DVec3, direction: DVec3) -> Item {
        let mut nearest = (f64::INFINITY, Item::NOTHING);
        for (j, patch) in stage.patches.iter().enumerate().filter(|(j, _)| *j != from) {
            let (n, v) = (patch.normal, &patch.corners);
            let distance = n.dot(v[0] - eye) / n.dot(direction);
            let at = eye + direction * distance;
            let edges = (0..v.len()).map(|k| (v[(k + 1) % v.len()] - v[k]).cross(at - v[k]).dot(n));
            if distance > 0.0 && distance < nearest.0 && edges.into_iter().all(|side| side >= 0.0) {
                let front = n.dot(direction) < 0.0;
                nearest = (distance, if front { Item::patch(j as u32) } else { Item::BACK });
            }
        }
        nearest.1
    }

    /// Numbers in [-1, 1) from a linear congruential generator.
    fn scatter(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn every_pixel_shows_what_a_ray_through_its_centre_meets() {
        let mut seed = 20;
        for round in 0..6 {
            let mut point = |reach: f64| p(scatter(&mut seed), scatter(&mut seed), scatter(&mut seed)) * reach;
            let mut b = ground();
            for k in 0..40 {
                let (at, size) = (point(2.0), if k % 4 == 0 { 3.0 } else { 0.5 });
                b.surface(&[at + point(size), at + point(size), at + point(size)], Grid::Triangle { n: 2 }, 0.5, 0.0);
            }
            let set = Params { rotation: f64::from(round) * 31.0, ..params(34) };
            let seen = item_buffer(&b.0, 0, &set).unwrap().unwrap();
            for (face, items) in Face::ALL.into_iter().zip(&seen.faces) {
                for (k, item) in items.iter().enumerate() {
                    let direction = seen.direction(face, k % 34, k / 34);
                    let wanted = first_seen(&b.0, 0, seen.eye, direction);
                    assert_eq!(*item, wanted, "round {round}, {face:?}, pixel {} {}", k % 34, k / 34);
                }
            }
            let (backs, nothing) = (seen.count(Item::BACK), seen.count(Item::NOTHING));
            assert!(backs > 100 && nothing < 2500, "too empty to prove anything: {backs} backs, {nothing} nothing");
        }
    }
}

mod contact {
    use super::*;
    use etalon::math::subtract_convex;
    use etalon::scene::NO_FACET;

    /// Takes what lies under a polygon out of a patch, as the scene loader does where two fronts touch.
    fn cover(stage: &mut Stage, patch: usize, by: &[DVec3]) {
        let q = &mut stage.patches[patch];
        q.region = Region { pieces: q.region.pieces.iter().flat_map(|piece| subtract_convex(piece, by)).collect() };
        q.area = q.region.area();
    }

    /// A room with a 3 x 3 floor and a box that stands on it, its base across four floor patches or within one.
    fn box_on_floor(lo: DVec3, hi: DVec3) -> (Stage, usize) {
        let mut b = Build::new();
        b.room(DVec3::ZERO, DVec3::ONE, 3, 0.5, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let first = b.0.patches.len();
        b.solid(lo, hi, 1, 0.5);
        let base = b.0.patches[first].corners.clone();
        for floor in 0..9 {
            cover(&mut b.0, floor, &base);
        }
        cover(&mut b.0, first, &flat(0.0, 0.0, 1.0, 1.0, 0.0));
        (b.0, first)
    }

    #[test]
    fn covered_floor_neither_sees_nor_is_seen() {
        for (lo, hi) in [
            (p(0.4, 0.35, 0.0), p(0.62, 0.6, 0.5)),
            (p(0.15, 0.2, 0.0), p(0.7, 0.8, 0.3)),
            (p(1.0 / 3.0, 1.0 / 3.0, 0.0), p(2.0 / 3.0, 2.0 / 3.0, 0.4)),
        ] {
            let (stage, base) = box_on_floor(lo, hi);
            for rotation in [0.0, 33.0] {
                let set = Params { rotation, ..params(50) };
                let f = factors(&stage, &set);
                let total = DeltaTable::new(50, Delta::Midpoint).total();
                for i in 0..f.n {
                    let wanted = if stage.patches[i].is_present() { total } else { 0.0 };
                    assert!(close(f.row_sum(i), wanted, 1e-13), "row {i} from {lo}: {}", f.row_sum(i));
                    assert_eq!(f.get(i, base), 0.0, "the base is seen by {i}");
                }
                assert_eq!(f.row(base).count(), 0);
            }
        }
    }

    #[test]
    fn the_hemicube_moves_out_from_under_the_box() {
        let (stage, _) = box_on_floor(p(0.4, 0.35, 0.0), p(0.62, 0.6, 0.5));
        let eye = item_buffer(&stage, 4, &params(10)).unwrap().unwrap().eye;
        let inside = |lo: f64, v: f64, hi: f64| (lo..=hi).contains(&v);
        assert!(inside(1.0 / 3.0, eye.x, 2.0 / 3.0) && inside(1.0 / 3.0, eye.y, 2.0 / 3.0), "{eye}");
        assert!(!(inside(0.4, eye.x, 0.62) && inside(0.35, eye.y, 0.6)), "{eye}");
    }

    #[test]
    fn a_plate_lying_face_down_shows_its_back() {
        let mut b = Build(opposed(1.0));
        let plate = flat(-0.25, -0.25, 0.25, 0.25, 0.0);
        let down = b.back_of(&plate, Grid::Whole, 0.5, 0.0);
        cover(&mut b.0, 0, &plate);
        cover(&mut b.0, down, &flat(-0.5, -0.5, 0.5, 0.5, 0.0));
        let seen = item_buffer(&b.0, 1, &params(100)).unwrap().unwrap();
        // The plate's half-width is a quarter of its distance: 25 of 100 pixels each way.
        assert_eq!((seen.count(Item::BACK), seen.count(Item::patch(0))), (25 * 25, 50 * 50 - 25 * 25));
        assert!(item_buffer(&b.0, down, &params(100)).unwrap().is_none());
    }

    #[test]
    fn what_is_absent_is_not_there() {
        let mut b = Build(opposed(1.0));
        let plate = b.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.5), Grid::Whole, 0.5, 3.0);
        let q = &mut b.0.patches[plate];
        (q.corners, q.normal, q.area, q.region, q.facet) = (vec![], DVec3::ZERO, 0.0, Region::default(), NO_FACET);
        let set = params(50);
        let f = factors(&b.0, &set);
        assert_eq!(f.get(0, 1), item_sum(&opposed(1.0), &set));
        assert_eq!((f.n, f.row(plate).count()), (3, 0));
        let (radiosity, info) = solve(&b.0, &set, &|_| ()).unwrap();
        assert_eq!(radiosity.of(plate), &[0.0], "an absent lamp is dark");
        let sums = info.row_sums.expect("a hemi-cube keeps its rows");
        assert!(sums.min > 0.2, "absent patches do not count in the row sums: {sums:?}");
    }
}

mod builtin {
    use super::*;
    use etalon::io::scene::builtin;

    #[test]
    fn closed_rooms_with_furniture_on_the_floor_are_full() {
        for name in ["furnace", "furnace-l", "l-room", "furnished-room", "dynamic-cube"] {
            let scene = builtin(name).unwrap();
            let stage = scene.at(scene.edits.len()).unwrap();
            for set in [params(20), Params { rotation: 45.0, ..params(50) }] {
                let total = DeltaTable::new(set.resolution, set.delta).total();
                let f = factors(&stage, &set);
                for (i, patch) in stage.patches.iter().enumerate() {
                    let wanted = if patch.is_present() { total } else { 0.0 };
                    assert!(close(f.row_sum(i), wanted, 1e-12), "{name}, {set}, patch {i}: {}", f.row_sum(i));
                }
            }
        }
    }

    #[test]
    fn in_the_cornell_box_nothing_is_seen_from_behind() {
        let stage = builtin("cornell-box-coarse").unwrap().at(0).unwrap();
        let (f, total) = (factors(&stage, &params(50)), DeltaTable::new(50, Delta::Midpoint).total());
        for i in 0..f.n {
            let seen = item_buffer(&stage, i, &params(50)).unwrap();
            let backs = seen.map_or(0, |s| s.count(Item::BACK));
            assert_eq!(backs, 0, "patch {i} on {}", stage.surface_name(i));
            assert!(f.row_sum(i) < total + 1e-12);
        }
        // Light leaves through the open front.
        assert!((0..f.n).any(|i| f.row_sum(i) < 0.9));
    }
}

mod solution {
    use super::*;

    #[test]
    fn a_white_furnace_shows_the_excess_of_the_table() {
        let mut b = Build::new();
        b.room(DVec3::ZERO, DVec3::ONE, 4, 0.9, [1.0; 6]);
        for (set, wanted) in [(params(50), 10.0195546), (exact(50), 10.0)] {
            let (radiosity, info) = solve(&b.0, &Params { tolerance: 1e-14, ..set }, &|_| ()).unwrap();
            assert!(radiosity.values.iter().all(|v| close(*v, wanted, 1e-7)), "{set}: {}", radiosity.values[0]);
            let sums = info.row_sums.expect("a hemi-cube keeps its rows");
            assert!(close(sums.max, sums.min, 1e-13) && info.residual[0] < 1e-13);
        }
    }

    #[test]
    fn form_factors_serve_again_when_the_lights_change() {
        let mut b = Build::new();
        b.room(DVec3::ZERO, DVec3::ONE, 3, 0.6, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let set = params(50);
        let f = factors(&b.0, &set);
        let (direct, _) = solve(&b.0, &set, &|_| ()).unwrap();
        assert_eq!(solve_with(&b.0, &f, &set).unwrap().0, direct);
        b.0.materials[0].emission = vec![2.0];
        let (doubled, _) = solve_with(&b.0, &f, &set).unwrap();
        assert!(doubled.values.iter().zip(&direct.values).all(|(two, one)| close(two / one, 2.0, 1e-13)));
        let refused = solve_with(&b.0, &FormFactors::from_exact_rows(vec![vec![]; 3]), &set).unwrap_err();
        assert!(refused.to_string().contains("3 patches and the scene has 54"), "{refused}");
    }

    #[test]
    fn the_same_bytes_on_one_thread_and_on_two() {
        let mut b = Build::new();
        b.room(DVec3::ZERO, p(1.0, 1.1, 0.9), 5, 0.6, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        b.solid(p(0.2, 0.3, 0.2), p(0.5, 0.6, 0.5), 2, 0.5);
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| (factors(&b.0, &params(64)), solve(&b.0, &params(64), &|_| ()).unwrap()))
        };
        assert_eq!(on(1), on(2));
    }

    /// `size` x `size` patches per face of a unit cube whose floor emits.
    fn iterations(size: u32, reflectance: f64) -> usize {
        let mut b = Build::new();
        b.room(DVec3::ZERO, DVec3::ONE, size, reflectance, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        solve(&b.0, &params(50), &|_| ()).unwrap().1.iterations[0]
    }

    #[test]
    fn iterations_depend_on_reflectance_and_not_on_size() {
        // The paper sees six to eight "regardless of the size of the matrix"; the whole table is printed by
        // `cargo run --release --example hemicube_iterations`.
        let counts = [0.3, 0.5, 0.7, 0.9].map(|rho| [4, 8].map(|size| iterations(size, rho)));
        assert!(counts.iter().all(|[small, large]| small.abs_diff(*large) <= 1), "{counts:?}");
        assert!(counts.windows(2).all(|w| w[0][0] < w[1][0]), "{counts:?}");
        assert!((6..=8).contains(&counts[1][0]), "{counts:?}");
    }
}
