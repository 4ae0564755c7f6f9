//! Hemi-cubes anywhere: several over a patch, turned and shifted at random, against closed forms and each other.

mod common;

use common::{Build, flat, p};
use etalon::io::scene::builtin;
use etalon::math::{DVec3, area, centroid, subtract_convex};
use etalon::methods::hemicube::{
    Delta, DeltaTable, Face, Hemicube, Item, Params, Stand, World, divided, drawn, element_form_factors, form_factors,
    item_buffer, item_buffer_at, rows_of, stand, stands,
};
use etalon::scene::{Grid, Patch, Region, Stage};
use etalon::solution::FormFactors;

fn params(resolution: u32) -> Params {
    Params { resolution, ..Params::default() }
}

fn exact(resolution: u32) -> Params {
    Params { delta: Delta::Exact, ..params(resolution) }
}

fn rows(stage: &Stage, stands: &[Vec<Stand>], params: &Params) -> FormFactors {
    rows_of(stage, stands, params, &|_| ()).unwrap()
}

/// A unit square that looks up and one that looks down from `height`, `edge` m wide.
fn opposed(height: f64, edge: f64) -> Stage {
    let mut b = Build::new();
    b.surface(&flat(-0.5, -0.5, 0.5, 0.5, 0.0), Grid::Whole, 0.5, 0.0);
    b.back_of(&flat(-0.5 * edge, -0.5 * edge, 0.5 * edge, 0.5 * edge, height), Grid::Whole, 0.5, 0.0);
    b.0
}

/// A closed room with a box in the air, nothing parallel to anything in the patches' frames.
fn room() -> Stage {
    let mut b = Build::new();
    b.room(DVec3::ZERO, p(1.3, 1.0, 0.9), 3, 0.5, [0.0; 6]);
    b.solid(p(0.31, 0.35, 0.4), p(0.6, 0.55, 0.7), 2, 0.5);
    b.0
}

mod bits {
    use super::*;

    /// All bits of a matrix in one word.
    fn hash(f: &FormFactors) -> u64 {
        let words = f.row_starts.iter().map(|x| *x as u64);
        let words = words.chain(f.columns.iter().map(|j| u64::from(*j))).chain(f.values.iter().map(|v| v.to_bits()));
        words.fold(0xcbf2_9ce4_8422_2325, |h, w| (h ^ w).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(17))
    }

    #[test]
    fn matrices_are_those_of_the_first_version() {
        // Hashes written down before stands and the faster scan: (scene, settings, of what, hash).
        let known = [
            ("cornell-box-coarse", "resolution=10", "patches", 0x98d9fc6d3094d955),
            ("cornell-box-coarse", "resolution=10", "elements", 0x98d9fc6d3094d955),
            ("cornell-box-coarse", "resolution=50", "patches", 0xdd482bbb86e6bc21),
            ("cornell-box-coarse", "resolution=64,rotation=30", "patches", 0x96c76d7087e578ac),
            ("cornell-box-coarse", "resolution=100,delta=exact", "patches", 0xe31a3b3dc6682d66),
            ("furnished-room", "resolution=10", "patches", 0xde8bb694e5a463ef),
            ("furnished-room", "resolution=10", "elements", 0xde8bb694e5a463ef),
            ("furnished-room", "resolution=50", "patches", 0x68e12558a1a485d1),
            ("furnished-room", "resolution=64,rotation=30", "patches", 0x80121168f60b1bc7),
            ("furnished-room", "resolution=100,delta=exact", "patches", 0x8efa15f536bbab7b),
            ("l-room", "resolution=10", "patches", 0x38cacaf5364c9152),
            ("l-room", "resolution=10", "elements", 0x38cacaf5364c9152),
            ("l-room", "resolution=50", "patches", 0xa4b95701a7151cd3),
            ("l-room", "resolution=64,rotation=30", "patches", 0xbd53b6199b6355ea),
            ("l-room", "resolution=100,delta=exact", "patches", 0x40b8fc09decb4007),
            ("dynamic-cube", "resolution=10", "patches", 0x3a40b243a69dbb9d),
            ("dynamic-cube", "resolution=10", "elements", 0x19b47985218e5f48),
            ("dynamic-cube", "resolution=50", "patches", 0xb7dee549f58cc269),
            ("dynamic-cube", "resolution=64,rotation=30", "patches", 0x07fd5b0734b5fbe6),
            ("dynamic-cube", "resolution=100,delta=exact", "patches", 0x9e663465e46f3560),
        ];
        for (scene, set, what, wanted) in known {
            let stage = builtin(scene).unwrap().at(0).unwrap();
            let set: Params = set.parse().unwrap();
            let f = match what {
                "patches" => form_factors(&stage, &set, &|_| ()).unwrap(),
                _ => element_form_factors(&stage, &set).unwrap(),
            };
            assert_eq!(hash(&f), wanted, "{scene}, {set}, {what}");
        }
    }

    #[test]
    fn threads_do_not_matter() {
        let set = Params { turn: Some(3), jitter: Some(4), ..params(20) };
        let stage = room();
        let of = |(i, patch): (usize, &Patch)| drawn(divided(patch, 3, &set), i, &set);
        let stands: Vec<_> = stage.patches.iter().enumerate().map(of).collect();
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| rows(&stage, &stands, &set))
        };
        assert!(on(1) == on(3));
    }

    #[test]
    fn a_row_is_the_weighted_mean_of_its_stands() {
        let (stage, set) = (room(), params(30));
        let all = stands(&stage, &set);
        let half = |i: usize, weight: f64| Stand { weight, ..all[i][0] };
        let mixed = rows(&stage, &[vec![half(0, 0.25), half(7, 0.75)], vec![], vec![half(7, 1.0)]], &set);
        let single = form_factors(&stage, &set, &|_| ()).unwrap();
        for j in 0..single.n {
            let wanted = 0.25 * single.get(0, j) + 0.75 * single.get(7, j);
            assert!((mixed.get(0, j) - wanted).abs() < 1e-16, "{j}");
            assert_eq!(mixed.get(2, j), single.get(7, j));
        }
        assert_eq!((mixed.row(1).count(), mixed.row_starts.len()), (0, 4));
    }
}

mod shifted {
    use super::*;

    #[test]
    fn a_closed_room_stays_full_wherever_in_the_pixel_it_is_sampled() {
        let stage = room();
        let places = [-0.5, -0.5 + 1e-9, -0.27, 0.0, 0.31, 0.5 - 1e-9, 0.5];
        for set in [exact(4), params(10), Params { rotation: 30.0, ..params(50) }] {
            let total = DeltaTable::new(set.resolution, set.delta).total();
            for shift in places.iter().flat_map(|x| places.iter().map(move |y| [*x, *y])) {
                let mut all = stands(&stage, &set);
                all.iter_mut().flatten().for_each(|s| s.shift = shift);
                let f = rows(&stage, &all, &set);
                for i in 0..f.n {
                    assert!((f.row_sum(i) - total).abs() < 1e-13, "{set}, {shift:?}, row {i}: {}", f.row_sum(i));
                }
            }
        }
    }

    #[test]
    fn random_turns_and_shifts_leave_a_closed_room_full() {
        for seed in 0..12 {
            let set = Params { turn: Some(seed), jitter: Some(seed), ..params(20) };
            let total = DeltaTable::new(20, Delta::Midpoint).total();
            let f = form_factors(&room(), &set, &|_| ()).unwrap();
            assert!((0..f.n).all(|i| (f.row_sum(i) - total).abs() < 1e-13), "seed {seed}");
        }
    }

    #[test]
    fn the_shift_moves_the_sampling_point_and_nothing_else() {
        // The rim of a square 1 m up and 0.47 m wide lies at 0.235 on the top: sampled at pixel k of 20 + shift.
        let stage = opposed(1.0, 0.47);
        let (eye, frame) = stand(&stage.patches[0], &params(20)).unwrap();
        for (sx, sy) in [(0.0, 0.0), (0.4, 0.0), (-0.3, 0.2), (0.1, -0.45)] {
            let one = Stand { shift: [sx, sy], ..Stand::at(eye, frame) };
            let seen = item_buffer_at(&stage, &one, &params(20)).unwrap();
            for (k, item) in seen.faces[0].iter().enumerate() {
                let at = |k: usize, s: f64| (k as f64 + 0.5 + s) / 10.0 - 1.0;
                let inside = at(k % 20, sx).abs() < 0.235 && at(k / 20, sy).abs() < 0.235;
                let wanted = if inside { Item::patch(1) } else { Item::NOTHING };
                assert_eq!(*item, wanted, "shift {sx} {sy}, pixel {k}");
                let d = seen.direction(Face::Top, k % 20, k / 20);
                assert!((d - p(at(k % 20, sx), at(k / 20, sy), 1.0)).length() < 1e-14);
            }
        }
    }

    #[test]
    fn jitter_turns_a_missed_lamp_into_noise_about_its_value() {
        // A lamp of 0.2 m at 10 m lies between four pixels of 50: without jitter it is missed.
        let stage = opposed(10.0, 0.2);
        let set = exact(50);
        assert_eq!(form_factors(&stage, &set, &|_| ()).unwrap().get(0, 1), 0.0);
        let (eye, frame) = stand(&stage.patches[0], &set).unwrap();
        let draws = 4096;
        let one = |number: usize| {
            let set = Params { jitter: Some(11), ..set };
            drawn(vec![Stand::at(eye, frame)], number, &set)
        };
        let f = rows(&stage, &(0..draws).map(one).collect::<Vec<_>>(), &set);
        let values: Vec<f64> = (0..draws).map(|i| f.get(i, 1)).collect();
        let mean = values.iter().sum::<f64>() / draws as f64;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (draws - 1) as f64;
        let (wanted, se) = (4.0 * 0.1 * 0.1 / (std::f64::consts::PI * 100.0), (variance / draws as f64).sqrt());
        // Four standard errors, 2.6 % each: false alarm 6e-5. The delta of a whole pixel is 0.2 % below the lamp's.
        assert!((mean - wanted).abs() < 4.0 * se, "{mean} +- {se} for {wanted}");
        assert!(se < 0.03 * wanted);
    }
}

mod random {
    use super::*;

    #[test]
    fn turns_are_even_over_a_quarter_and_differ_by_patch_and_seed() {
        let stage = room();
        let (n, set) = (2000, Params { turn: Some(5), jitter: Some(5), ..params(10) });
        let (eye, frame) = stand(&stage.patches[0], &set).unwrap();
        let turned: Vec<Stand> = (0..n).map(|i| drawn(vec![Stand::at(eye, frame)], i, &set)[0]).collect();
        let angle = |s: &Stand| s.frame.x.dot(frame.y).atan2(s.frame.x.dot(frame.x)).to_degrees();
        assert!(turned.iter().all(|s| (0.0..90.0).contains(&angle(s)) && s.frame.z == frame.z && s.eye == eye));
        // Means of 2000 even numbers: five standard errors, three tests, false alarm 2e-6.
        let mean = |of: &dyn Fn(&Stand) -> f64| turned.iter().map(of).sum::<f64>() / n as f64;
        let error = |width: f64| 5.0 * width / 12f64.sqrt() / (n as f64).sqrt();
        assert!((mean(&angle) - 45.0).abs() < error(90.0));
        assert!((0..2).all(|d| mean(&|s| s.shift[d]).abs() < error(1.0)));
        let other = drawn(vec![Stand::at(eye, frame)], 0, &Params { turn: Some(6), ..set })[0];
        assert!(angle(&other) != angle(&turned[0]) && other.shift == turned[0].shift);
        assert!(angle(&turned[0]) != angle(&turned[1]));
    }

    #[test]
    fn buffers_and_rows_draw_alike() {
        let (stage, set) = (room(), Params { turn: Some(1), jitter: Some(2), ..params(16) });
        let f = form_factors(&stage, &set, &|_| ()).unwrap();
        let table = DeltaTable::new(16, Delta::Midpoint);
        let seen = item_buffer(&stage, 5, &set).unwrap().unwrap();
        assert!(seen.shift != [0.0; 2]);
        let from = |k: usize| if k < 8 { 7 - k } else { k - 8 };
        for j in 0..f.n {
            let hit = |k: &usize, face: usize| seen.faces[face][*k] == Item::patch(j as u32);
            let top = (0..256).filter(|k| hit(k, 0)).map(|k| table.top(from(k % 16), from(k / 16))).sum::<f64>();
            let side = |s: usize| (0..128).filter(move |k| hit(k, s)).map(|k| table.side(from(k % 16), k / 16));
            let sum = top + (1..5).flat_map(side).sum::<f64>();
            assert!((sum - f.get(5, j)).abs() < 1e-15, "{j}");
        }
    }
}

mod parts {
    use super::*;

    fn patch(corners: Vec<DVec3>, pieces: Vec<Vec<DVec3>>) -> Patch {
        let mut patch = opposed(1.0, 1.0).patches.remove(0);
        let region = Region { pieces };
        (patch.area, patch.corners, patch.region) = (region.area(), corners, region);
        patch
    }

    fn whole(corners: &[DVec3]) -> Patch {
        patch(corners.to_vec(), vec![corners.to_vec()])
    }

    #[test]
    fn parts_reach_the_patch_average_as_subdivision_does() {
        // The patch split k x k, its mean: parallel at 1 m. Values by quadrature.
        for (k, wanted) in [(1, 0.2394564705), (2, 0.2078425836), (4, 0.2017353007), (8, 0.2002972610)] {
            let (stage, set) = (opposed(1.0, 1.0), Params { rotation: 17.0, ..exact(400) });
            let f = rows(&stage, &[divided(&stage.patches[0], k, &set)], &set).get(0, 1);
            assert!((f / wanted - 1.0).abs() < 1e-3, "k = {k}: {f} for {wanted}");
        }
    }

    #[test]
    fn weights_add_to_one_and_balance_about_the_centre_of_what_takes_part() {
        let square = flat(0.0, 0.0, 2.0, 1.0, 0.0).to_vec();
        let triangle = vec![p(0.0, 0.0, 0.0), p(2.0, 0.1, 0.0), p(0.3, 1.4, 0.0)];
        let pentagon = vec![p(0., 0., 0.), p(2., 0., 0.), p(2.5, 1., 0.), p(1., 2., 0.), p(-0.2, 1.0, 0.)];
        let cut = subtract_convex(&square, &flat(0.33, 0.21, 1.13, 0.77, 0.0));
        assert!(cut.len() > 2);
        let cases = [
            ("square", whole(&square)),
            ("triangle", whole(&triangle)),
            ("pentagon", whole(&pentagon)),
            ("cut", patch(square, cut)),
        ];
        for (name, patch) in &cases {
            for cells in 2..7 {
                let all = divided(patch, cells, &params(10));
                let total: f64 = all.iter().map(|s| s.weight).sum();
                assert!((total - 1.0).abs() < 1e-14, "{name} {cells}: {total}");
                let mean: DVec3 = all.iter().map(|s| s.eye * s.weight).sum();
                let wanted = patch.region.centroid().unwrap();
                assert!(mean.distance(wanted) < 1e-14, "{name} {cells}: {mean} for {wanted}");
                let number = all.len() as f64;
                assert!(number >= 0.5 * f64::from(cells * cells), "{name} {cells}: {number} parts");
            }
        }
    }

    #[test]
    fn no_part_stands_under_what_covers_the_patch() {
        let square = flat(0.0, 0.0, 2.0, 1.0, 0.0).to_vec();
        let cut = patch(square.clone(), subtract_convex(&square, &flat(0.33, 0.21, 1.13, 0.77, 0.0)));
        let under = |e: DVec3| e.x > 0.33 && e.x < 1.13 && e.y > 0.21 && e.y < 0.77;
        assert!((2..9).all(|k| divided(&cut, k, &params(10)).iter().all(|s| !under(s.eye))));
        assert!(divided(&patch(square, vec![]), 3, &params(10)).is_empty());
    }

    #[test]
    fn an_uneven_quadrilateral_weighs_its_parts_by_area() {
        let corners = vec![p(0.0, 0.0, 0.0), p(3.0, 0.0, 0.0), p(2.0, 1.0, 0.0), p(0.0, 1.0, 0.0)];
        let (all, true_centre) = (divided(&whole(&corners), 16, &params(10)), centroid(&corners));
        let mean: DVec3 = all.iter().map(|s| s.eye * s.weight).sum();
        assert!(mean.distance(true_centre) < 1e-3, "{mean} for {true_centre}");
        let first =
            area(&[p(0.0, 0.0, 0.0), p(3.0 / 16.0, 0.0, 0.0), p(47.0 / 256.0, 0.0625, 0.0), p(0.0, 0.0625, 0.0)]);
        assert!((all[0].weight - first / 2.5).abs() < 1e-15);
        assert_eq!(divided(&whole(&corners), 1, &params(10)).len(), 1);
    }
}

#[test]
fn stands_that_cannot_be_are_refused_with_their_row() {
    let stage = opposed(1.0, 1.0);
    let good = stands(&stage, &params(10))[0][0];
    let said = |bad: Stand| rows_of(&stage, &[vec![], vec![bad]], &params(10), &|_| ()).unwrap_err().to_string();
    assert!(said(Stand { shift: [0.0, 0.51], ..good }).contains("row 1"));
    assert!(said(Stand { shift: [f64::NAN, 0.0], ..good }).contains("half a pixel"));
    assert!(said(Stand { weight: -0.1, ..good }).contains("not negative"));
    assert!(said(Stand { eye: DVec3::NAN, ..good }).contains("finite"));
}

#[test]
fn counts_add_up_to_all_pixels() {
    for (stage, set) in [(room(), params(30)), (opposed(1.0, 0.5), params(20))] {
        let (world, table) = (World::new(&stage), DeltaTable::new(set.resolution, set.delta));
        let mut cube = Hemicube::new(&world, &table);
        for (i, list) in stands(&stage, &set).iter().enumerate() {
            let counted = cube.row_with_counts(&list[0]);
            let (row, lost) = cube.row_at(&list[0]);
            let seen = item_buffer(&stage, i, &set).unwrap().unwrap();
            assert_eq!(counted.row.iter().map(|(j, f, _)| (*j, *f)).collect::<Vec<_>>(), row);
            assert!(counted.row.iter().all(|(j, _, n)| *n as usize == seen.count(Item::patch(*j))));
            assert_eq!(counted.lost, lost);
            let all = counted.row.iter().map(|(_, _, n)| *n).sum::<u32>() + counted.lost_pixels;
            assert_eq!(all, 3 * set.resolution.pow(2));
        }
    }
}
