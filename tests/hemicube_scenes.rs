//! The scenes made to show errors of hemi-cubes: each has the errors it was made for, and no other.

use etalon::doctor::examine;
use etalon::io::scene::{SceneOptions, builtin, open_scene, read_scene};
use etalon::io::{PatchFormat, write_patches};
use etalon::methods::hemicube::{Params, form_factors, stand};
use etalon::scene::{FindingKind, Stage};
use std::path::Path;

fn stage(name: &str, state: usize) -> Stage {
    builtin(name).expect("a built-in scene").at(state).expect("a state")
}

fn patch(stage: &Stage, surface: &str) -> usize {
    (0..stage.patch_count()).find(|i| stage.surface_name(*i) == surface).expect("a surface of that name")
}

/// The form factor between two patches as a hemi-cube counts it.
fn counted(stage: &Stage, settings: &str, from: usize, to: usize) -> f64 {
    let f = form_factors(stage, &settings.parse().expect("settings"), &|_| ()).expect("form factors");
    let mut row = f.row_starts[from]..f.row_starts[from + 1];
    row.find(|k| f.columns[*k] as usize == to).map_or(0.0, |k| f.values[k])
}

/// Mean over rectangle `a` of the form factor to rectangle `b` in a parallel plane `height` above, by midpoints,
/// where `seen(x_a, x_b)` says which lines count. Rectangles are [x0, x1, y0, y1].
fn mean_form_factor(a: [f64; 4], b: [f64; 4], height: f64, seen: impl Fn(f64, f64) -> bool) -> f64 {
    let points = |r: [f64; 4], n: usize| {
        let at = move |k: usize, lo: f64, hi: f64| lo + (hi - lo) * (k as f64 + 0.5) / n as f64;
        (0..n * n).map(move |k| [at(k % n, r[0], r[1]), at(k / n, r[2], r[3])])
    };
    // Of different steps, so that no shadow edge runs along the middles of both.
    let (n, m) = (64, 15);
    let area = (b[1] - b[0]) * (b[3] - b[2]);
    let mut sum = 0.0;
    for p in points(a, n) {
        for q in points(b, m).filter(|q| seen(p[0], q[0])) {
            let r2 = (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2) + height * height;
            sum += height * height / (std::f64::consts::PI * r2 * r2);
        }
    }
    sum * area / ((n * n * m * m) as f64)
}

/// (state, resolution, probe, hemi-cube), by the printed table of deltas at the pixels whose centres the lamp covers.
const TABLE: [(usize, u32, &str, f64); 8] = [
    (2, 50, "probe-axis", 0.0),
    (2, 50, "probe-centred-50", 5.0848192139e-4),
    (2, 50, "probe-off-centre", 5.0848192139e-4),
    (0, 50, "probe-axis", 2.0339276856e-3),
    (0, 50, "probe-centred-50", 5.0848192139e-4),
    (0, 100, "probe-axis", 5.0909216067e-4),
    (0, 100, "probe-centred-100", 1.1442377356e-3),
    (1, 100, "probe-axis", 5.0909216067e-4),
];

#[test]
fn the_small_lamp_is_missed_and_doubled_as_in_the_table() {
    for (state, resolution, probe, expected) in TABLE {
        let stage = stage("small-lamp", state);
        let edge = (stage.areas()[patch(&stage, "lamp")]).sqrt();
        assert!((edge - [0.5, 0.4, 0.2][state]).abs() < 1e-12);
        let f = counted(&stage, &format!("resolution={resolution}"), patch(&stage, probe), patch(&stage, "lamp"));
        assert!((f - expected).abs() < 1e-13, "{probe} at {resolution}, state {state}: {f}");
    }
}

#[test]
fn floors_see_the_lamp_whole_and_at_every_phase() {
    let stage = stage("small-lamp", 2);
    let f = form_factors(&stage, &"resolution=200".parse().expect("settings"), &|_| ()).expect("form factors");
    let lamp = patch(&stage, "lamp");
    for name in ["floor-", "platform-5m", "platform-2.5m"] {
        let of = |i: &usize| stage.surface_name(*i).starts_with(name) && stage.patches[*i].normal.z > 0.0;
        for i in (0..stage.patch_count()).filter(of) {
            let seen = f.columns[f.row_starts[i]..f.row_starts[i + 1]].contains(&(lamp as u32));
            assert!(seen, "patch {i} of {name} does not see the lamp");
        }
    }
}

#[test]
fn aliasing_only_counts_whole_pixels_and_nothing_else_is_wrong() {
    let stage = stage("aliasing-only", 0);
    let lamp = patch(&stage, "lamp");
    let f = form_factors(&stage, &"resolution=50,delta=exact".parse().expect("settings"), &|_| ()).expect("rows");
    let mut counts = std::collections::BTreeSet::new();
    for i in 0..81 {
        let (eye, _) = stand(&stage.patches[i], &Params::default()).expect("a stand");
        let source = [-0.25, 0.25, -0.25, 0.25];
        let around = |h: f64| [eye.x - h, eye.x + h, eye.y - h, eye.y + h];
        let (mean, centre) = (
            mean_form_factor(around(0.01), source, 10.0, |_, _| true),
            mean_form_factor(around(1e-9), source, 10.0, |_, _| true),
        );
        assert!((mean / centre - 1.0).abs() < 1e-5, "receiver {i}: proximity {}", mean / centre - 1.0);
        assert_eq!(f.columns[f.row_starts[i]..f.row_starts[i + 1]], [lamp as u32], "receiver {i} sees the lamp alone");
        // The lamp covers 1.25 x 1.25 pixels.
        counts.insert((f.values[f.row_starts[i]] / mean * 1.5625).round() as u32);
    }
    assert_eq!(counts.into_iter().collect::<Vec<_>>(), [1, 2, 4]);
}

#[test]
fn proximity_only_has_no_pixel_half_covered() {
    let stage = stage("proximity-only", 0);
    for resolution in [10, 50, 256] {
        let f = counted(&stage, &format!("resolution={resolution},delta=exact"), 0, 1);
        assert!((f - 0.554_126_423_979_572).abs() < 1e-13, "{resolution}: {f}");
    }
    // The mean, from the closed form: 33 % less.
    let mean = etalon::formfactor::polygon_to_polygon(&stage.patches[0].corners, &stage.patches[1].corners);
    assert!((mean - 0.415253283577).abs() < 1e-11);
}

#[test]
fn visibility_only_differs_by_the_shadow_alone() {
    let stage = stage("visibility-only", 0);
    let lamp = patch(&stage, "lamp");
    let source = [-0.125, 0.125, -0.125, 0.125];
    // Lines pass the plate's height half way.
    let lit = |a: f64, b: f64| 0.5 * (a + b) < 0.125;
    let cases = [
        ("half-shaded", [-0.5, 0.5, -0.5, 0.5], 1.0, 0.75),
        ("mostly-shaded", [0.0, 1.0, 1.0, 2.0], 0.0, 0.25),
        ("unshaded", [-2.0, -1.0, -0.5, 0.5], 1.0, 1.0),
    ];
    for (name, square, centre, share) in cases {
        let open = mean_form_factor(square, source, 16.0, |_, _| true);
        let truth = mean_form_factor(square, source, 16.0, lit);
        assert!((truth / open - share).abs() < 3e-3, "{name}: {}", truth / open);
        for resolution in [256, 512] {
            let f = counted(&stage, &format!("resolution={resolution},delta=exact"), patch(&stage, name), lamp);
            assert!((f / open - centre).abs() < 1.5e-3, "{name} at {resolution}: {}", f / open);
        }
    }
}

/// Lamps over specks, as in the other two scenes, take the doctor's rays many seconds to find.
#[test]
fn the_doctor_has_notes_at_most() {
    for name in ["office", "proximity-only", "visibility-only"] {
        let (scene, stage) = (builtin(name).expect("a built-in scene"), stage(name, 0));
        let found = examine(&scene, &stage).expect("an examination");
        let noted = |kind| matches!(kind, FindingKind::ManyRays | FindingKind::TJunction);
        assert!(found.iter().all(|f| noted(f.kind)), "{name}: {found:#?}");
    }
    let office = stage("office", 0);
    assert!((5000..=15_000).contains(&office.patch_count()));
    assert!(office.patches.iter().all(|p| p.is_present()), "nothing is covered");
}

/// The rooms of View3D with lamps: their geometry lies beside the repository, if at all.
#[test]
fn lamps_are_put_into_rooms_of_view3d() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rooms =
        [("jos-box345", "box345", 1702), ("jdg-pinney-bean-test-4", "pinney-bean", 438), ("jdg-cube", "cube", 390)];
    for (input, name, patches) in rooms {
        let input = root.join("../shared/scenes/view3d").join(format!("{input}.vs3"));
        if !input.exists() {
            eprintln!("skipped: {} is not there", input.display());
            return;
        }
        let folder = tempfile::tempdir().expect("a folder");
        let room = open_scene(input.to_str().expect("a path"), &SceneOptions::default()).expect("a View3D input");
        let mesh = write_patches(&room.at(0).expect("a state"), PatchFormat::Obj);
        std::fs::write(folder.path().join(format!("{name}.obj")), mesh).expect("a mesh");
        let file = folder.path().join("scene.toml");
        std::fs::copy(root.join(format!("references/scenes/with-lamps/{name}.toml")), &file).expect("a scene");
        let scene = read_scene(&file, &SceneOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        let lit = scene.at(0).expect("a state");
        assert_eq!(lit.patch_count(), patches, "{name}");
        let noted = |kind| matches!(kind, FindingKind::ManyRays | FindingKind::TJunction);
        let found = examine(&scene, &lit).expect("an examination");
        assert!(found.iter().all(|f| noted(f.kind)), "{name}: {found:#?}");
    }
}
