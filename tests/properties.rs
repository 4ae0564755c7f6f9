//! Properties of geometry, meshes and readers that hold for all inputs.

#[path = "../fuzz/src/lib.rs"]
mod fuzz;

use etalon::io::scene::{SceneOptions, open_scene, read_scene};
use etalon::io::{PatchFormat, write_patches};
use etalon::math::{Bilinear, DVec3, area, compensated_sum, intersect_convex, subtract_convex, unit_normal};
use etalon::scene::{Scene, Stage};
use glam::{DMat3, DQuat};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::path::Path;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() }
}

const HEAD: &str = "format = \"etalon-scene/1\"\n[[material]]\nname = \"m\"\nreflectance = 0.5\n";

fn scene_in(folder: &Path, body: &str) -> Scene {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{HEAD}{body}")).unwrap();
    read_scene(&path, &SceneOptions::default()).unwrap_or_else(|e| panic!("{e}\n{body}"))
}

fn stage(body: &str) -> Stage {
    scene_in(tempfile::tempdir().unwrap().path(), body).at(0).unwrap()
}

fn surface(name: &str, object: &str, corners: &[DVec3], extra: &str) -> String {
    let corners: Vec<String> = corners.iter().map(|c| format!("{:?}", c.to_array())).collect();
    let corners = corners.join(", ");
    format!("[[surface]]\nname = \"{name}\"\nobject = \"{object}\"\nmaterial = \"m\"\npolygon = [{corners}]\n{extra}\n")
}

/// A plane anywhere: two axes and an origin.
fn plane() -> impl Strategy<Value = (DMat3, DVec3)> {
    let angle = 0.0..6.3f64;
    ((angle.clone(), angle.clone(), angle), prop::array::uniform3(-5.0..5.0f64))
        .prop_map(|((a, b, c), o)| (DMat3::from_quat(DQuat::from_euler(glam::EulerRot::ZXZ, a, b, c)), DVec3::from(o)))
}

/// Corners of a convex polygon in the plane z = 0: points of an ellipse, counter-clockwise.
fn convex(corners: std::ops::Range<usize>) -> impl Strategy<Value = Vec<DVec3>> {
    let ellipse = (0.3..2.0f64, 0.3..2.0f64, -1.0..1.0f64, -1.0..1.0f64);
    (prop::collection::vec(0.05..1.0f64, corners), ellipse).prop_map(|(steps, (a, b, x, y))| {
        let whole: f64 = steps.iter().sum();
        let turns = steps.iter().scan(0.0, |t, s| {
            *t += s / whole * std::f64::consts::TAU;
            Some(*t)
        });
        turns.map(|t| DVec3::new(x + a * t.cos(), y + b * t.sin(), 0.0)).collect()
    })
}

fn placed(polygon: &[DVec3], (turn, origin): (DMat3, DVec3)) -> Vec<DVec3> {
    polygon.iter().map(|p| turn * *p + origin).collect()
}

fn area_of(polygon: &[DVec3]) -> f64 {
    if polygon.len() < 3 { 0.0 } else { area(polygon) }
}

proptest! {
    #![proptest_config(config(2000))]

    #[test]
    fn what_is_cut_out_and_what_is_left_make_the_whole(a in convex(3..8), b in convex(3..8), at in plane()) {
        let (a, b) = (placed(&a, at), placed(&b, at));
        let (whole, common) = (area(&a), area_of(&intersect_convex(&a, &b)));
        let left: f64 = subtract_convex(&a, &b).iter().map(|p| area(p)).sum();
        prop_assert!((common + left - whole).abs() < 1e-10 * whole, "{common} + {left} != {whole}");
        prop_assert!((common - area_of(&intersect_convex(&b, &a))).abs() < 1e-10 * whole);
        prop_assert!((area_of(&intersect_convex(&a, &a)) - whole).abs() < 1e-10 * whole);
        for piece in subtract_convex(&a, &b) {
            prop_assert!(area_of(&intersect_convex(&piece, &b)) < 1e-10 * whole, "a piece lies within what was taken");
        }
    }

    #[test]
    fn the_bilinear_map_is_undone(corners in convex(4..5), at in plane(), u in 0.0..1.0f64, v in 0.0..1.0f64) {
        let corners = placed(&corners, at);
        let map = Bilinear::new([corners[0], corners[1], corners[2], corners[3]]);
        let p = map.at(u, v);
        let (s, t) = map.inverse(p);
        prop_assert!((map.at(s, t) - p).length() < 1e-9, "({u}, {v}) came back as ({s}, {t})");
        // Away from corners that are nearly straight the coordinates themselves come back.
        let sine = |i: usize| {
            let (e, f) = (corners[(i + 1) % 4] - corners[i], corners[(i + 2) % 4] - corners[(i + 1) % 4]);
            e.normalize().cross(f.normalize()).length()
        };
        if (0..4).all(|i| sine(i) > 0.05) {
            prop_assert!((s - u).abs() + (t - v).abs() < 1e-9, "({u}, {v}) came back as ({s}, {t})");
        }
    }
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn contact_does_not_depend_on_who_comes_first(base in convex(3..7), height in 0.1..1.0f64, floor in convex(4..5), at in plane()) {
        let k = base.len();
        let top: Vec<DVec3> = base.iter().map(|p| *p + DVec3::Z * height).collect();
        let bottom: Vec<DVec3> = base.iter().rev().copied().collect();
        let mut prism = surface("bottom", "prism", &placed(&bottom, at), "") + &surface("top", "prism", &placed(&top, at), "");
        for i in 0..k {
            let j = (i + 1) % k;
            prism += &surface(&format!("side {i}"), "prism", &placed(&[base[i], base[j], top[j], top[i]], at), "");
        }
        let floor_text = surface("floor", "floor", &placed(&floor, at), "patches = [3, 2]");
        let areas = |stage: Stage| {
            let sum = |name: &str| compensated_sum((0..stage.patch_count()).filter(|i| stage.surface_name(*i) == name).map(|i| stage.patches[i].area));
            [sum("floor"), sum("bottom"), sum("top")]
        };
        let (one, other) = (areas(stage(&(floor_text.clone() + &prism))), areas(stage(&(prism + &floor_text))));
        let common = area_of(&intersect_convex(&floor, &base));
        for (found, expected) in one.iter().zip([area(&floor) - common, area(&base) - common, area(&base)]) {
            prop_assert!((found - expected).abs() < 1e-6, "{one:?}, common {common}");
        }
        for (a, b) in one.iter().zip(other) {
            prop_assert!((a - b).abs() < 1e-9, "{one:?} {other:?}");
        }
    }

    #[test]
    fn areas_stay_under_motion_and_grow_with_the_square_of_scale(
        polygon in convex(3..6), n in 1u32..6, at in plane(), scale in 0.01..100.0f64,
    ) {
        let extra = match polygon.len() {
            3 => format!("patches = [{n}]"),
            4 => format!("patches = [{n}, 2]\nelements = [2, {n}]"),
            _ => String::new(),
        };
        let larger: Vec<DVec3> = polygon.iter().map(|p| *p * scale).collect();
        let [still, moved, grown] = [polygon.clone(), placed(&polygon, at), larger].map(|p| stage(&surface("s", "s", &p, &extra)));
        for ((a, b), c) in still.patches.iter().zip(&moved.patches).zip(&grown.patches) {
            prop_assert!((a.area - b.area).abs() < 1e-12 * area(&polygon).max(1.0));
            prop_assert!((a.area * scale * scale / c.area - 1.0).abs() < 1e-9);
            prop_assert!((at.0 * a.normal - b.normal).length() < 1e-12);
            prop_assert_eq!((a.a, a.b), (b.a, b.b));
        }
        let total: f64 = still.areas().iter().sum();
        prop_assert!((total - area(&polygon)).abs() < 1e-12 * total.max(1.0));
    }

    #[test]
    fn patches_written_and_read_back_are_the_same(
        quad in convex(4..5), triangle in convex(3..4), seven in convex(7..8), at in plane(), n in 1u32..5,
    ) {
        let far = DVec3::Z * 3.0;
        let up = |p: &[DVec3], k: f64| p.iter().map(|c| *c + far * k).collect::<Vec<_>>();
        let body = surface("a b", "s", &placed(&quad, at), &format!("patches = [{n}, 3]\ntwo_sided = true"))
            + &surface("t", "s", &placed(&up(&triangle, 1.0), at), &format!("patches = [{n}]"))
            + &surface("seven", "s", &placed(&up(&seven, 2.0), at), "");
        let stage = stage(&body);
        for (format, name) in [(PatchFormat::Obj, "m.obj"), (PatchFormat::Ply, "m.ply")] {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join(name), write_patches(&stage, format)).unwrap();
            let body = format!("[[surface]]\nname = \"m\"\nmaterial = \"m\"\nmesh = \"{name}\"\n");
            // Coincident backs and fronts are read as a thin plate: nothing is lost.
            let back = scene_in(folder.path(), &body).at(0).unwrap();
            prop_assert_eq!(back.patch_count(), stage.patch_count());
            for (a, b) in stage.patches.iter().zip(&back.patches) {
                prop_assert!((a.area - b.area).abs() <= 1e-12 * a.area, "{} {}", a.area, b.area);
                prop_assert!((a.normal - b.normal).length() < 1e-9);
                // Adding zero turns -0 into 0, as the writer does.
                prop_assert!(a.corners.iter().zip(&b.corners).all(|(p, q)| *p + 0.0 == *q + 0.0));
            }
            // Given as a scene the file stands for itself.
            let alone = open_scene(folder.path().join(name).to_str().unwrap(), &SceneOptions::default()).unwrap();
            prop_assert_eq!(alone.at(0).unwrap().areas(), back.areas());
        }
    }

    #[test]
    fn faces_are_numbered_in_file_order(
        kinds in prop::collection::vec((3usize..6, any::<bool>()), 1..8), na in 1u32..4, nb in 1u32..4, two_sided in any::<bool>(),
    ) {
        let mut obj = String::new();
        for (k, (corners, grouped)) in kinds.iter().enumerate() {
            for i in 0..*corners {
                let t = i as f64 / *corners as f64 * std::f64::consts::TAU;
                obj += &format!("v {:?} {:?} {k}\n", t.cos(), t.sin());
            }
            let group = if *grouped { format!("g group{}\n", k % 2) } else { "g\n".into() };
            let face: String = (1..=*corners).map(|i| format!(" -{}", corners + 1 - i)).collect();
            obj += &format!("{group}f{face}\n");
        }
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("m.obj"), obj).unwrap();
        let body = format!("[[surface]]\nname = \"s\"\nmaterial = \"m\"\nmesh = \"m.obj\"\npatches = [{na}, {nb}]\ntwo_sided = {two_sided}\n");
        let stage = scene_in(folder.path(), &body).at(0).unwrap();
        let count = |corners: usize| match corners {
            3 => na.max(nb).pow(2),
            4 => na * nb,
            _ => 1,
        };
        let fronts: u32 = kinds.iter().map(|k| count(k.0)).sum();
        prop_assert_eq!(stage.patch_count() as u32, if two_sided { 2 * fronts } else { fronts });
        let mut next = 0;
        for (k, (corners, grouped)) in kinds.iter().enumerate() {
            for number in next..next + count(*corners) {
                let name = if *grouped { format!("s/group{}", k % 2) } else { "s".into() };
                let mut sides = vec![number];
                sides.extend(two_sided.then_some(number + fronts));
                for side in sides {
                    prop_assert_eq!(stage.surface_name(side as usize), &name);
                    prop_assert!(stage.patches[side as usize].corners.iter().all(|c| c.z == k as f64));
                }
                if two_sided {
                    prop_assert_eq!(stage.patches[number as usize].normal, -stage.patches[(number + fronts) as usize].normal);
                }
            }
            next += count(*corners);
        }
        prop_assert!(stage.patches.iter().all(|p| (unit_normal(&p.corners) - p.normal).length() < 1e-9));
    }
}

// ---- readers never panic ----

/// A small generator of its own: the mutations stay the same whatever crates do.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, below: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % below.max(1) as u64) as usize
    }
}

/// What stands in files where it hurts.
const WORDS: &[&str] = &[
    "-1",
    "0",
    "1e308",
    "nan",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "-9223372036854775808",
    "2",
    "999999",
    ",",
    "\n",
    "\0",
    "\"",
    "[",
    "]",
    "{}",
    "null",
    "true",
    "\u{feff}",
    "é",
    "..",
    "//",
    "1e-320",
];

/// A file with a few changes.
fn mutated(seed: &[u8], other: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut out = seed.to_vec();
    for _ in 0..1 + dice.roll(4) {
        let (from, length) = (dice.roll(out.len() + 1), dice.roll(24));
        let to = (from + length).min(out.len());
        match dice.roll(7) {
            0 if from < out.len() => out[from] ^= 1 << dice.roll(8),
            1 if from < out.len() => out[from] = [0, 1, 127, 128, 255][dice.roll(5)],
            2 => drop(out.drain(from..to)),
            3 => out.truncate(from),
            4 => drop(out.splice(from..from, WORDS[dice.roll(WORDS.len())].bytes())),
            5 => {
                // A number or word in the place of another.
                let is_word = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b'_');
                let start = out[..from].iter().rposition(|b| !is_word(b)).map_or(0, |i| i + 1);
                let end = out[from..].iter().position(|b| !is_word(b)).map_or(out.len(), |i| from + i);
                drop(out.splice(start..end, WORDS[dice.roll(WORDS.len())].bytes()));
            }
            _ => {
                let (a, b) = (dice.roll(other.len() + 1), dice.roll(64));
                drop(out.splice(from..to, other[a..(a + b).min(other.len())].iter().copied()));
            }
        }
    }
    out
}

/// A body of a fuzz target.
type Target = (&'static str, fn(&[u8]) -> bool);

const TARGETS: &[Target] = &[
    ("scene", fuzz::scene),
    ("obj", fuzz::obj),
    ("mtl", fuzz::mtl),
    ("ply", fuzz::ply),
    ("gltf", fuzz::gltf),
    ("glb", fuzz::glb),
    ("mitsuba", fuzz::mitsuba),
    ("radiance", fuzz::radiance),
    ("solution_csv", fuzz::solution_csv),
    ("solution_json", fuzz::solution_json),
    ("solution_npy", fuzz::solution_npy),
    ("solution_npz", fuzz::solution_npz),
    ("matrix_csv", fuzz::matrix_csv),
    ("matrix_mtx", fuzz::matrix_mtx),
    ("matrix_npz", fuzz::matrix_npz),
    ("values_ply", fuzz::values_ply),
    ("values_obj", fuzz::values_obj),
    ("values_table", fuzz::values_table),
    ("values_gltf", fuzz::values_gltf),
    ("values_glb", fuzz::values_glb),
    ("values_vtu", fuzz::values_vtu),
    ("values_exr", fuzz::values_exr),
];

fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(target);
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths.iter().map(|p| std::fs::read(p).unwrap()).collect()
}

/// Runs a target on mutated seeds; returns how many were accepted.
fn tried(name: &str, target: fn(&[u8]) -> bool, seeds: &[Vec<u8>], rounds: usize) -> usize {
    let mut dice = Dice(name.bytes().map(u64::from).sum());
    let mut accepted = 0;
    for round in 0..rounds {
        let (seed, other) = (dice.roll(seeds.len()), dice.roll(seeds.len()));
        let data = mutated(&seeds[seed], &seeds[other], &mut dice);
        match std::panic::catch_unwind(|| target(&data)) {
            Ok(sound) => accepted += usize::from(sound),
            Err(_) => panic!("{name}, round {round}: a panic on {:?}", String::from_utf8_lossy(&data)),
        }
    }
    accepted
}

#[test]
fn every_seed_is_sound_and_no_change_of_it_makes_a_reader_panic() {
    for (name, target) in TARGETS {
        let seeds = seeds(name);
        assert!(!seeds.is_empty() && seeds.iter().all(|s| target(s)), "{name}: a seed is refused");
        let accepted = tried(name, *target, &seeds, 600);
        // Changes must reach beyond the first check: some are harmless, most are not.
        assert!((1..600).contains(&accepted), "{name}: {accepted} of 600 accepted");
    }
}

#[test]
fn no_change_of_a_reference_makes_its_reader_panic() {
    let seeds: Vec<Vec<u8>> =
        fuzz::sound_reference().iter().enumerate().map(|(k, (_, bytes))| [&[k as u8][..], bytes].concat()).collect();
    assert!(seeds.len() > 3 && seeds.iter().all(|s| fuzz::reference(s)));
    tried("reference", fuzz::reference, &seeds, 600);
}

/// Every reader for as long as is asked (`ETALON_FUZZ_SECONDS`, five minutes each without), on changes that the short test
/// does not make: `cargo test --release --test properties long -- --ignored --nocapture`. `ETALON_FUZZ_TARGETS` names some.
#[test]
#[ignore = "takes minutes for each reader"]
fn a_long_run_makes_no_reader_panic() {
    let of = |name: &str| std::env::var(name).ok();
    let seconds: u64 = of("ETALON_FUZZ_SECONDS").map_or(300, |s| s.parse().expect("a number of seconds"));
    let chosen = of("ETALON_FUZZ_TARGETS");
    let wanted = |name: &str| chosen.as_ref().is_none_or(|c| c.split(',').any(|c| c == name));
    for (name, target) in TARGETS.iter().filter(|(name, _)| wanted(name)) {
        let (seeds, begin) = (seeds(name), std::time::Instant::now());
        let mut dice = Dice(0x5eed ^ name.bytes().map(u64::from).sum::<u64>());
        let (mut tried, mut slowest) = (0u64, std::time::Duration::ZERO);
        while begin.elapsed().as_secs() < seconds {
            let (seed, other) = (dice.roll(seeds.len()), dice.roll(seeds.len()));
            let data = mutated(&seeds[seed], &seeds[other], &mut dice);
            let since = std::time::Instant::now();
            if std::panic::catch_unwind(|| target(&data)).is_err() {
                panic!("{name}, change {tried}: a panic on {:?}", String::from_utf8_lossy(&data));
            }
            slowest = slowest.max(since.elapsed());
            tried += 1;
        }
        println!("{name}: {tried} changed files in {seconds} s, none panics, the slowest took {slowest:.2?}");
    }
}
