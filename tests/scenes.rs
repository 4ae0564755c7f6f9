//! Scenes set up: numbers, areas, contact, states, and other people's files.

use etalon::io::scene::{SceneOptions, builtin, builtin_names, builtin_text, open_scene, read_scene};
use etalon::io::{PatchFormat, write_patches};
use etalon::math::{DVec3, area, compensated_sum, unit_normal};
use etalon::scene::{NO_FACET, Scene, Stage};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

const HEAD: &str = "format = \"etalon-scene/1\"\n[photometry]\nprimaries = \"mono\"\n\
                    [[material]]\nname = \"m\"\nreflectance = 0.5\n[[material]]\nname = \"lamp\"\nreflectance = 0.1\nemission = 3\n";

/// A scene from text, through a file, as users come.
fn scene(body: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    scene_in(folder.path(), body)
}

fn scene_in(folder: &Path, body: &str) -> Scene {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{HEAD}{body}")).unwrap();
    read_scene(&path, &SceneOptions::default()).unwrap_or_else(|e| panic!("{e}\n{body}"))
}

fn surface(name: &str, object: &str, corners: &[[f64; 3]], extra: &str) -> String {
    let corners: Vec<String> = corners.iter().map(|c| format!("{c:?}")).collect();
    format!(
        "[[surface]]\nname = \"{name}\"\nobject = \"{object}\"\nmaterial = \"m\"\npolygon = [{}]\n{extra}\n",
        corners.join(", ")
    )
}

fn square(name: &str, z: f64, up: bool, extra: &str) -> String {
    let corners = [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let down = [corners[0], corners[3], corners[2], corners[1]];
    surface(name, "scene", if up { &corners } else { &down }, extra)
}

/// The six outward faces of a box turned by `angle` about its vertical axis through `middle`.
fn turned_box(name: &str, middle: [f64; 2], half: [f64; 2], z: [f64; 2], angle: f64, extra: &str) -> String {
    let (s, c) = angle.sin_cos();
    let at = |x: f64, y: f64, z: f64| {
        let (x, y) = (x * half[0], y * half[1]);
        [middle[0] + c * x - s * y, middle[1] + s * x + c * y, z]
    };
    let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let low = ring.map(|(x, y)| at(x, y, z[0]));
    let high = ring.map(|(x, y)| at(x, y, z[1]));
    let mut text = surface(&format!("{name}-bottom"), name, &[low[0], low[3], low[2], low[1]], extra);
    text += &surface(&format!("{name}-top"), name, &high, extra);
    for k in 0..4 {
        let j = (k + 1) % 4;
        text += &surface(&format!("{name}-side-{k}"), name, &[low[k], low[j], high[j], high[k]], extra);
    }
    text
}

fn area_of(stage: &Stage, surface: &str) -> f64 {
    compensated_sum(
        (0..stage.patch_count()).filter(|i| stage.surface_name(*i) == surface).map(|i| stage.patches[i].area),
    )
}

fn present(stage: &Stage) -> usize {
    stage.patches.iter().filter(|p| p.is_present()).count()
}

/// What must hold in every stage.
fn check_consistent(stage: &Stage) {
    for (number, patch) in stage.patches.iter().enumerate() {
        let elements = &stage.elements[patch.elements.start as usize..patch.elements.end as usize];
        assert!(!elements.is_empty() && elements.iter().all(|e| e.patch as usize == number));
        if number > 0 {
            assert_eq!(patch.elements.start, stage.patches[number - 1].elements.end);
        }
        let sum = compensated_sum(elements.iter().map(|e| e.area));
        assert!((sum - patch.area).abs() <= 1e-9 * patch.area.max(1e-6), "patch {number}: {sum} {}", patch.area);
        assert!((patch.region.area() - patch.area).abs() <= 1e-15);
        if patch.facet == NO_FACET {
            assert!(patch.area == 0.0 && patch.corners.is_empty());
            continue;
        }
        let facet = &stage.facets[patch.facet as usize];
        assert!((unit_normal(&patch.corners) - patch.normal).length() < 1e-6, "patch {number} winds the wrong way");
        assert!(patch.area <= area(&patch.corners) * (1.0 + 1e-12));
        let offset = number as u32
            - if patch.normal.dot(facet.normal) > 0.0 { facet.first_patch } else { facet.first_back_patch.unwrap() };
        assert_eq!(facet.grid.place(offset as usize), (patch.a, patch.b));
    }
}

// ---- numbers ----

#[test]
fn quadrilaterals_count_along_the_first_edge() {
    let stage = scene(&square("floor", 0.0, true, "patches = [4, 3]\nelements = [2, 1]")).at(0).unwrap();
    assert_eq!(stage.patch_count(), 12);
    for (number, p) in stage.patches.iter().enumerate() {
        let (a, b) = (number as u32 % 4, number as u32 / 4);
        assert_eq!((p.a, p.b), (a, b));
        assert!((p.corners[0] - DVec3::new(f64::from(a) / 4.0, f64::from(b) / 3.0, 0.0)).length() < 1e-15);
        assert!((p.corners[1] - p.corners[0] - DVec3::X / 4.0).length() < 1e-15);
        let e = &stage.elements[p.elements.start as usize + 1];
        assert_eq!((e.a, e.b), (1, 0));
        assert!((e.corners[0] - (p.corners[0] + DVec3::X / 8.0)).length() < 1e-15);
    }
    check_consistent(&stage);
}

#[test]
fn triangles_count_row_by_row() {
    let t = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
    let stage = scene(&surface("t", "scene", &t, "patches = [3]\nelements = [2]")).at(0).unwrap();
    assert_eq!(stage.patch_count(), 9);
    let first: Vec<[f64; 2]> = stage.patches.iter().map(|p| [p.corners[0].x, p.corners[0].y]).collect();
    // Row 0: upright, inverted, upright, inverted, upright; then row 1; then row 2.
    let expected = [[0, 0], [1, 0], [1, 0], [2, 0], [2, 0], [0, 1], [1, 1], [1, 1], [0, 2]].map(|c| c.map(f64::from));
    for (number, (found, expected)) in first.iter().zip(expected).enumerate() {
        assert!((found[0] - expected[0]).abs() + (found[1] - expected[1]).abs() < 1e-15, "patch {number}: {found:?}");
    }
    let places: Vec<(u32, u32)> = stage.patches.iter().map(|p| (p.a, p.b)).collect();
    assert_eq!(places, [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (0, 1), (1, 1), (2, 1), (0, 2)]);
    assert_eq!(stage.elements.len(), 36);
    check_consistent(&stage);
}

#[test]
fn backs_follow_the_fronts_of_their_surface() {
    let body = square("plate", 0.0, true, "patches = [2, 2]\ntwo_sided = true") + &square("lid", 2.0, false, "");
    let stage = scene(&body).at(0).unwrap();
    assert_eq!(stage.patch_count(), 9);
    for k in 0..4 {
        let (front, back) = (&stage.patches[k], &stage.patches[k + 4]);
        assert_eq!((front.a, front.b), (back.a, back.b));
        assert_eq!(front.normal, -back.normal);
        let mut corners = back.corners.clone();
        corners[1..].reverse();
        assert_eq!(corners, front.corners);
    }
    assert_eq!(stage.surface_name(8), "lid");
    check_consistent(&stage);
}

#[test]
fn mesh_faces_count_in_file_order_and_their_backs_after_all_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v 0 0 0\nv 1000 0 0\nv 1000 1000 0\nv 0 1000 0\nv 500 1500 0\nv 0 0 1000\nv 1000 0 1000\n\
               f 1 2 3 4\nf 4 3 5\nf 1 6 7 2\nf 1 1 2\n";
    std::fs::write(folder.path().join("m.obj"), obj).unwrap();
    let body = "[[surface]]\nname = \"m\"\nmaterial = \"m\"\nmesh = \"m.obj\"\nscale = 0.001\npatches = [2, 3]\ntwo_sided = true\n";
    let scene = scene_in(folder.path(), body);
    let stage = scene.at(0).unwrap();
    // 6 of the first quadrilateral, 9 of the triangle (the larger count), 6 of the second quadrilateral; backs.
    assert_eq!(stage.patch_count(), 42);
    let firsts: Vec<(u32, Option<u32>)> = stage.facets.iter().map(|f| (f.first_patch, f.first_back_patch)).collect();
    assert_eq!(firsts, [(0, Some(21)), (6, Some(27)), (15, Some(36))]);
    assert!(scene.notices.iter().any(|n| n.contains("m.obj:11") && n.contains("without area")), "{:?}", scene.notices);
    check_consistent(&stage);
}

#[test]
fn the_largest_edge_divides_what_has_no_counts() {
    let body = "[discretisation]\nmax_edge = 0.3\n".to_string()
        + &square("a", 0.0, true, "")
        + &square("b", 1.0, false, "patches = [2, 5]")
        + &surface("t", "scene", &[[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]], "");
    let counts = |options: &SceneOptions| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        std::fs::write(&path, format!("{HEAD}{body}")).unwrap();
        let stage = read_scene(&path, options).unwrap().at(0).unwrap();
        ["a", "b", "t"].map(|s| (0..stage.patch_count()).filter(|i| stage.surface_name(*i) == s).count())
    };
    assert_eq!(counts(&SceneOptions::default()), [16, 10, 25]);
    assert_eq!(counts(&SceneOptions { max_edge_override: Some(0.5) }), [4, 10, 9]);
}

// ---- contact ----

#[test]
fn a_box_takes_its_footprint_from_the_floor() {
    for angle in [0.0, 0.3] {
        let body = square("floor", 0.0, true, "patches = [8, 8]\nelements = [2, 2]")
            + &turned_box("box", [0.53, 0.47], [0.2, 0.15], [0.0, 0.4], angle, "patches = [3, 2]");
        let stage = scene(&body).at(0).unwrap();
        assert!((area_of(&stage, "floor") - (1.0 - 0.12)).abs() < 1e-14);
        assert_eq!(area_of(&stage, "box-bottom"), 0.0);
        assert!((area_of(&stage, "box-top") - 0.12).abs() < 1e-14);
        let covered = stage.patches.iter().filter(|p| p.surface == 0 && !p.is_present()).count();
        let partly = stage.patches.iter().filter(|p| p.surface == 0 && p.is_present() && p.area < 0.999 / 64.0).count();
        assert!(covered > 0 && partly >= 10, "{covered} {partly}");
        let floor = stage.facets.iter().position(|f| f.surface == 0).unwrap();
        assert_eq!(stage.facets[floor].twins, [1]);
        assert_eq!(stage.facets[1].twins, [0]);
        check_consistent(&stage);
    }
}

#[test]
fn contact_is_found_whatever_surrounds_it() {
    // In a closed room, everything in one object; a pillar that fills the height; a box on the pillar's side.
    let room = [
        [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [2.0, 2.0, 1.0], [2.0, 0.0, 1.0]],
        [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 2.0, 1.0], [0.0, 0.0, 1.0]],
        [[2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [2.0, 2.0, 1.0], [2.0, 2.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 0.0, 0.0]],
        [[0.0, 2.0, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 1.0], [0.0, 2.0, 1.0]],
    ];
    let mut body: String =
        room.iter().enumerate().map(|(k, c)| surface(&format!("wall-{k}"), "scene", c, "")).collect();
    body += &turned_box("pillar", [1.0, 1.0], [0.25, 0.25], [0.0, 1.0], 0.0, "");
    body += &turned_box("box", [1.5, 1.0], [0.25, 0.1], [0.25, 0.75], 0.0, "");
    let body =
        body.replace("object = \"pillar\"", "object = \"scene\"").replace("object = \"box\"", "object = \"scene\"");
    let stage = scene(&body).at(0).unwrap();
    for (name, expected) in [
        ("wall-0", 4.0 - 0.25),
        ("wall-1", 4.0 - 0.25),
        ("pillar-top", 0.0),
        ("pillar-bottom", 0.0),
        ("pillar-side-1", 0.5 - 0.1),
        ("box-side-3", 0.0),
        ("box-side-1", 0.1),
    ] {
        assert!((area_of(&stage, name) - expected).abs() < 1e-14, "{name}: {}", area_of(&stage, name));
    }
    let leak: DVec3 = stage.patches.iter().map(|p| p.normal * p.area).sum();
    assert!(leak.length() < 1e-13, "what takes part is no closed surface: {leak}");
}

#[test]
fn a_face_with_a_vertex_written_twice_is_in_contact_like_any_other() {
    let folder = tempfile::tempdir().unwrap();
    // A tetrahedron standing on the floor; the first two vertices are one point.
    let obj = "v .2 .2 0\nv .2 .2 0\nv .2 .6 0\nv .6 .2 0\nv .3 .3 .5\nf 1 2 3 4\nf 1 4 5\nf 4 3 5\nf 3 1 5\n";
    std::fs::write(folder.path().join("m.obj"), obj).unwrap();
    let body = square("floor", 0.0, true, "") + "[[surface]]\nname = \"m\"\nmaterial = \"m\"\nmesh = \"m.obj\"\n";
    let stage = scene_in(folder.path(), &body).at(0).unwrap();
    assert_eq!(stage.patches[1].area, 0.0);
    assert!((area_of(&stage, "floor") - 0.92).abs() < 1e-14);
}

#[test]
fn a_low_block_between_two_plates_touches_both() {
    // Nearly all that is seen from its inside is its own top, which coincides with the upper plate.
    let body = square("below", 0.0, true, "")
        + &square("above", 0.02, false, "")
        + &turned_box("block", [0.5, 0.5], [0.4, 0.4], [0.0, 0.02], 0.0, "");
    let stage = scene(&body).at(0).unwrap();
    for (name, expected) in [("below", 0.36), ("above", 0.36), ("block-top", 0.0), ("block-bottom", 0.0)] {
        assert!((area_of(&stage, name) - expected).abs() < 1e-14, "{name}: {}", area_of(&stage, name));
    }
}

#[test]
fn a_thin_plate_loses_nothing() {
    for surroundings in ["", "room"] {
        let mut body = square("up", 0.5, true, "patches = [2, 2]") + &square("down", 0.5, false, "patches = [3, 3]");
        if surroundings == "room" {
            body += &square("floor", 0.0, true, "");
            body += &square("ceiling", 1.0, false, "");
        }
        let stage = scene(&body).at(0).unwrap();
        assert_eq!((area_of(&stage, "up"), present(&stage)), (1.0, stage.patch_count()));
        assert_eq!(stage.facets[0].twins, [1]);
        assert_eq!(stage.facets[1].twins, [0]);
    }
}

#[test]
fn walls_between_rooms_are_thin_plates() {
    let room = |name: &str, x: f64| {
        let (l, r) = (x, x + 1.0);
        let faces = [
            [[l, 0.0, 0.0], [r, 0.0, 0.0], [r, 1.0, 0.0], [l, 1.0, 0.0]],
            [[l, 0.0, 1.0], [l, 1.0, 1.0], [r, 1.0, 1.0], [r, 0.0, 1.0]],
            [[l, 0.0, 0.0], [l, 1.0, 0.0], [l, 1.0, 1.0], [l, 0.0, 1.0]],
            [[r, 0.0, 0.0], [r, 0.0, 1.0], [r, 1.0, 1.0], [r, 1.0, 0.0]],
            [[l, 0.0, 0.0], [l, 0.0, 1.0], [r, 0.0, 1.0], [r, 0.0, 0.0]],
            [[l, 1.0, 0.0], [r, 1.0, 0.0], [r, 1.0, 1.0], [l, 1.0, 1.0]],
        ];
        faces.iter().enumerate().map(|(k, c)| surface(&format!("{name}-{k}"), name, c, "")).collect::<String>()
    };
    let row = room("left", 0.0) + &room("middle", 1.0) + &room("right", 2.0);
    let one = row.replace("\"left\"", "\"house\"").replace("\"middle\"", "\"house\"").replace("\"right\"", "\"house\"");
    for body in [row, one] {
        let stage = scene(&body).at(0).unwrap();
        assert_eq!(present(&stage), 18);
        assert_eq!(stage.areas(), [1.0; 18]);
        assert_eq!(stage.facets.iter().filter(|f| !f.twins.is_empty()).count(), 4);
    }
}

#[test]
fn stacked_boxes_touch_in_what_they_share() {
    let body = turned_box("lower", [0.0, 0.0], [0.5, 0.5], [0.0, 0.5], 0.0, "")
        + &turned_box("upper", [0.25, 0.0], [0.5, 0.25], [0.5, 1.0], 0.0, "");
    let stage = scene(&body).at(0).unwrap();
    // They share 0.75 x 0.5; the upper one overhangs by 0.25 x 0.5.
    assert!((area_of(&stage, "lower-top") - (1.0 - 0.375)).abs() < 1e-15);
    assert!((area_of(&stage, "upper-bottom") - 0.125).abs() < 1e-15);
}

#[test]
fn a_box_stands_on_both_kinds_of_floor() {
    let body = square("table", 0.5, true, "two_sided = true")
        + &turned_box("cup", [0.5, 0.5], [0.1, 0.1], [0.5, 0.7], 0.2, "");
    let stage = scene(&body).at(0).unwrap();
    assert!((stage.patches[0].area - 0.96).abs() < 1e-15, "the upper side lies under the cup");
    assert_eq!(stage.patches[1].area, 1.0, "the lower side is free");
    assert_eq!(area_of(&stage, "cup-bottom"), 0.0);
}

#[test]
fn mesh_faces_that_lie_twice_radiate_once() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 3 4 1\nf 1 5 6 4\n";
    std::fs::write(folder.path().join("m.obj"), obj).unwrap();
    let scene = scene_in(folder.path(), "[[surface]]\nname = \"m\"\nmaterial = \"m\"\nmesh = \"m.obj\"\n");
    let stage = scene.at(0).unwrap();
    let areas: Vec<f64> = stage.patches.iter().map(|p| p.area).collect();
    assert_eq!(areas, [1.0, 0.0, 1.0]);
    assert_eq!(stage.facets.len(), 2, "the face that lies wholly under another is gone");
    assert!(scene.notices.iter().any(|n| n.contains("overlap in one plane")), "{:?}", scene.notices);
    check_consistent(&stage);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn covered_and_uncovered_make_the_whole(
        angle in 0.0..6.3f64, x in 0.3..0.7f64, y in 0.3..0.7f64, hx in 0.02..0.2f64, hy in 0.02..0.2f64,
        na in 1u32..9, nb in 1u32..9,
    ) {
        let body = square("floor", 0.0, true, &format!("patches = [{na}, {nb}]\nelements = [2, 3]"))
            + &turned_box("box", [x, y], [hx, hy], [0.0, 0.3], angle, "patches = [2, 2]");
        let stage = scene(&body).at(0).unwrap();
        prop_assert!((area_of(&stage, "floor") - (1.0 - 4.0 * hx * hy)).abs() < 1e-9);
        prop_assert_eq!(area_of(&stage, "box-bottom"), 0.0);
        check_consistent(&stage);
        // What is left of the floor lies outside the box.
        let (s, c) = angle.sin_cos();
        for patch in stage.patches.iter().filter(|p| p.surface == 0) {
            for piece in &patch.region.pieces {
                let m = etalon::math::centroid(piece) - DVec3::new(x, y, 0.0);
                let (u, v) = (c * m.x + s * m.y, c * m.y - s * m.x);
                prop_assert!(u.abs() > hx - 1e-6 || v.abs() > hy - 1e-6, "{u} {v} in {hx} {hy}");
            }
        }
    }
}

// ---- states ----

#[test]
fn numbers_stay_when_things_come_move_and_go() {
    let scene = builtin("dynamic-cube").unwrap();
    let stages: Vec<Stage> = (0..=scene.edits.len()).map(|k| scene.at(k).unwrap()).collect();
    let cube: Vec<usize> =
        (0..stages[0].patch_count()).filter(|i| stages[0].surface_name(*i).starts_with("cube")).collect();
    assert_eq!(cube.len(), 24);
    for stage in &stages {
        assert_eq!((stage.patch_count(), stage.elements.len()), (192, 768));
        check_consistent(stage);
    }
    let stands: Vec<usize> =
        stages.iter().map(|s| cube.iter().filter(|i| s.patches[**i].facet != NO_FACET).count()).collect();
    assert_eq!(stands, [0, 24, 24, 24, 24, 24, 24, 0]);
    let corner = |state: usize| stages[state].patches[cube[4]].corners[0];
    assert!((corner(1) - DVec3::new(0.4, 0.4, 0.5)).length() < 1e-15);
    assert!((corner(2) - DVec3::new(1.1, 0.9, 0.5)).length() < 1e-15);
    let (s, c) = 30f64.to_radians().sin_cos();
    let turned = DVec3::new(1.35 + c * -0.25 - s * -0.25, 1.15 + s * -0.25 + c * -0.25, 0.5);
    assert!((corner(3) - turned).length() < 1e-15);
    assert!((corner(4) - turned - DVec3::Z * 0.5).length() < 1e-15);
    assert_eq!(stages[5].reflectance(cube[4]), [0.2, 0.2, 0.7]);
    assert_eq!(stages[4].reflectance(cube[4]), [0.6, 0.2, 0.2]);
    let ceiling = (0..192).find(|i| stages[0].surface_name(*i) == "ceiling").unwrap();
    assert_eq!(
        (stages[5].emission(ceiling), stages[6].emission(ceiling)),
        (&[10.0, 10.0, 9.0][..], &[20.0, 20.0, 18.0][..])
    );
    for (state, covered) in [(0, 0.0), (1, 0.25), (3, 0.25), (7, 0.0)] {
        assert!((area_of(&stages[state], "floor") - (4.0 - covered)).abs() < 1e-14);
    }
    assert_eq!(stages[0].areas(), stages[7].areas());
    assert_eq!(scene.state_named("final").unwrap(), 7);
    assert!(scene.at(8).is_err() && scene.state_named("8").is_err());
}

#[test]
fn rotation_comes_before_translation() {
    let body = square("floor", 0.0, true, "")
        + &surface("plate", "plate", &[[1.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0], [1.0, 1.0, 1.0]], "")
        + "[[edit]]\nmove = \"plate\"\ntranslate = [0, 0, 5]\nrotate = { axis = [0, 0, 2], degrees = 90 }\n";
    let stage = scene(&body).at(1).unwrap();
    let corner = stage.patches[1].corners[1];
    assert!((corner - DVec3::new(0.0, 2.0, 6.0)).length() < 1e-14, "{corner}");
}

#[test]
fn a_replacement_of_the_same_size_keeps_the_numbers_and_another_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let mut cube = String::new();
    for z in [0, 1] {
        for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            cube += &format!("v {x} {y} {}\n", 2 * z);
        }
    }
    let faces = ["f 1 4 3 2\n", "f 5 6 7 8\n", "f 1 2 6 5\n", "f 2 3 7 6\n", "f 3 4 8 7\n", "f 4 1 5 8\n"];
    std::fs::write(folder.path().join("six.obj"), cube.clone() + &faces.concat()).unwrap();
    std::fs::write(folder.path().join("five.obj"), cube + &faces[1..].concat()).unwrap();
    let body = |file: &str| {
        square("floor", -1.0, true, "")
            + &turned_box("cube", [0.5, 0.5], [0.5, 0.5], [0.0, 1.0], 0.0, "patches = [2, 2]")
            + &square("roof", 9.0, false, "")
            + &format!(
                "[[edit]]\nreplace = \"cube\"\nmesh = \"{file}\"\n[[edit]]\nmove = \"cube\"\ntranslate = [0, 0, 1]\n"
            )
    };
    let same = scene_in(folder.path(), &body("six.obj"));
    let (before, after) = (same.at(0).unwrap(), same.at(1).unwrap());
    assert_eq!((before.patch_count(), after.patch_count()), (26, 26));
    assert_eq!(after.surface_name(5), "cube (edit 1)");
    assert_eq!(after.surface_name(25), "roof");
    assert_eq!(after.reflectance(5), [0.5], "the material is inherited");
    assert_eq!(after.patches[5].corners[0].z, 2.0);
    assert_eq!(same.at(2).unwrap().patches[5].corners[0].z, 3.0, "later edits move what stands there now");
    let other = scene_in(folder.path(), &body("five.obj"));
    let (before, after) = (other.at(0).unwrap(), other.at(1).unwrap());
    assert_eq!((before.patch_count(), after.patch_count()), (46, 46));
    assert!((1..25).all(|i| before.patches[i].is_present() && after.patches[i].facet == NO_FACET));
    assert!((26..46).all(|i| !before.patches[i].is_present() && after.patches[i].is_present()));
    [before, after].iter().for_each(check_consistent);
}

// ---- built-in scenes ----

#[test]
fn the_cornell_box_has_its_measures() {
    let stage = builtin("cornell-box").unwrap().at(0).unwrap();
    assert!((800..=1200).contains(&stage.patch_count()), "{}", stage.patch_count());
    assert!((area_of(&stage, "light") - 0.130 * 0.105).abs() < 1e-15);
    let footprint = |p: [[f64; 2]; 4]| {
        0.5 * (0..4).map(|k| p[k][0] * p[(k + 1) % 4][1] - p[(k + 1) % 4][0] * p[k][1]).sum::<f64>().abs()
    };
    let short = footprint([[0.130, 0.065], [0.082, 0.225], [0.240, 0.272], [0.290, 0.114]]);
    let tall = footprint([[0.423, 0.247], [0.265, 0.296], [0.314, 0.456], [0.472, 0.406]]);
    let floor = footprint([[0.5528, 0.0], [0.0, 0.0], [0.0, 0.5592], [0.5496, 0.5592]]);
    assert!((area_of(&stage, "floor") - (floor - short - tall)).abs() < 1e-14);
    assert_eq!(area_of(&stage, "tall-block-bottom"), 0.0);
    let white: Vec<f64> = stage.patches.iter().filter(|p| p.is_present()).map(|p| area(&p.corners)).collect();
    let (least, most) = white.iter().fold((f64::MAX, 0f64), |(l, m), a| (l.min(*a), m.max(*a)));
    assert!(most / least < 2.0, "patches of similar size: {least} to {most}");
    let coarse = builtin("cornell-box-coarse").unwrap().at(0).unwrap();
    assert!((130..=170).contains(&coarse.patch_count()));
    assert!((coarse.areas().iter().sum::<f64>() - stage.areas().iter().sum::<f64>()).abs() < 1e-12);
}

#[test]
fn closed_built_in_scenes_are_closed() {
    let rooms = ["furnished-room", "dynamic-cube", "cube-room", "cube-room-edits", "robot-room", "office"];
    for name in ["furnace", "furnace-l", "l-room", "cube-one-emitter"].into_iter().chain(rooms) {
        let scene = builtin(name).unwrap();
        assert_eq!(scene.enclosure, Some(true), "{name}");
        for state in 0..=scene.edits.len() {
            let stage = scene.at(state).unwrap();
            let leak: DVec3 = stage.patches.iter().map(|p| p.normal * p.area).sum();
            assert!(leak.length() < 1e-12, "{name}: {leak}");
            check_consistent(&stage);
        }
    }
    assert_eq!(builtin_names().len(), 26);
    assert!((1000..=1500).contains(&builtin("furnished-room").unwrap().at(0).unwrap().patch_count()));
}

#[test]
fn built_in_scenes_open_by_name_and_as_files() {
    for name in builtin_names() {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("references/scenes/{name}.toml"));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), builtin_text(name).unwrap());
        let by_name = open_scene(&format!("builtin:{name}"), &SceneOptions::default()).unwrap();
        let by_path = open_scene(path.to_str().unwrap(), &SceneOptions::default()).unwrap();
        assert_eq!(by_name.name, name);
        assert_eq!(by_name.at(0).unwrap().areas(), by_path.at(0).unwrap().areas());
    }
}

// ---- patches as files ----

#[test]
fn the_patch_table_says_everything_in_full() {
    let body = square("floor, \"worn\"", 0.0, true, "patches = [3, 1]").replace("\"worn\"", "\\\"worn\\\"")
        + &turned_box("box", [0.5, 0.5], [0.1, 0.2], [0.0, 0.4], 0.0, "")
        + "[[edit]]\nremove = \"box\"\n";
    let scene = scene(&body);
    let table = String::from_utf8(write_patches(&scene.at(0).unwrap(), PatchFormat::Csv)).unwrap();
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let header =
        "patch,surface,object,a,b,centroid_x,centroid_y,centroid_z,normal_x,normal_y,normal_z,area,material,corners";
    assert_eq!(rows.headers().unwrap().iter().collect::<Vec<_>>().join(","), header);
    let rows: Vec<csv::StringRecord> = rows.records().map(|r| r.unwrap()).collect();
    assert_eq!(rows.len(), 9);
    assert_eq!((&rows[1][0], &rows[1][1], &rows[1][3], &rows[1][12]), ("1", "floor, \"worn\"", "1", "m"));
    assert_eq!(rows[1][11].parse::<f64>().unwrap(), scene.at(0).unwrap().patches[1].area);
    assert_eq!(rows[0][13].split(';').count(), 4);
    assert!(rows[0][13].starts_with("0.0 0.0 0.0;0.3333333333333333 0.0 0.0;"), "{}", &rows[0][13]);
    assert_eq!((&rows[3][1], &rows[3][11]), ("box-bottom", "0.0"));
    let absent = String::from_utf8(write_patches(&scene.at(1).unwrap(), PatchFormat::Csv)).unwrap();
    let last = absent.lines().last().unwrap();
    assert_eq!(last, "8,box-side-3,box,0,0,,,,,,,0.0,m,");
}

#[test]
fn meshes_hold_one_face_per_present_patch() {
    let stage = builtin("cornell-box-coarse").unwrap().at(0).unwrap();
    let obj = String::from_utf8(write_patches(&stage, PatchFormat::Obj)).unwrap();
    let ply = String::from_utf8(write_patches(&stage, PatchFormat::Ply)).unwrap();
    let faces = obj.lines().filter(|l| l.starts_with("f ")).count();
    assert_eq!(faces, present(&stage));
    assert!(ply.contains(&format!("element face {faces}\n")));
    assert!(obj.contains("left out: ") && ply.contains("left out: "));
    let numbers: Vec<usize> = obj.lines().filter_map(|l| l.strip_prefix("# patch ")?.parse().ok()).collect();
    let last: Vec<usize> =
        ply.lines().rev().take(faces).map(|l| l.rsplit(' ').next().unwrap().parse().unwrap()).collect();
    assert_eq!(numbers, last.into_iter().rev().collect::<Vec<_>>());
    assert!(numbers.iter().all(|i| stage.patches[*i].is_present()));
    // Read back, the mesh has the areas of the cells.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), &obj).unwrap();
    let back =
        scene_in(folder.path(), "[[surface]]\nname = \"m\"\nmaterial = \"m\"\nmesh = \"m.obj\"\n").at(0).unwrap();
    for (patch, number) in back.patches.iter().zip(numbers) {
        assert_eq!(patch.corners, stage.patches[number].corners);
    }
}

// ---- other people's files ----

fn shared(part: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared").join(part);
    if !path.exists() {
        eprintln!("skipped: {} is not there", path.display());
    }
    path.exists().then_some(path)
}

#[test]
fn the_peers_scenes_are_read() {
    let Some(folder) = shared("peers") else { return };
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let stage = read_scene(&path, &SceneOptions::default()).unwrap().at(0).unwrap();
            let tail = path.file_stem().unwrap().to_str().unwrap().rsplit('-').next().unwrap().parse::<usize>();
            if let Some(n) = tail.ok().filter(|n| *n > 64) {
                assert_eq!(stage.patch_count(), n);
            }
            assert_eq!(present(&stage), stage.patch_count());
            count += 1;
        }
    }
    assert!(count > 5);
}

/// Copies files beside a scene of one mesh and reads it.
fn foreign(files: &[&str], mesh: &str, extra: &str) -> Option<Scene> {
    let folder = tempfile::tempdir().unwrap();
    for file in files {
        let from = shared(file)?;
        std::fs::copy(&from, folder.path().join(from.file_name().unwrap())).unwrap();
    }
    let body = format!(
        "format = \"etalon-scene/1\"\n[[material]]\nname = \"m\"\nreflectance = 0.5\n[[surface]]\nname = \"box\"\nmesh = \"{mesh}\"\n{extra}"
    );
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, body).unwrap();
    Some(read_scene(&path, &SceneOptions::default()).unwrap_or_else(|e| panic!("{e}")))
}

#[test]
fn the_cornell_box_of_tinyobjloader_is_read() {
    let files = ["scenes/tinyobj/cornell_box.obj", "scenes/tinyobj/cornell_box.mtl"];
    let Some(scene) = foreign(&files, "cornell_box.obj", "scale = 0.001\nup = \"y\"\nmaterial = \"m\"\n") else {
        return;
    };
    let stage = scene.at(0).unwrap();
    // 18 faces, the red wall split in two.
    assert_eq!(stage.patch_count(), 19);
    assert!(
        scene.notices.iter().any(|n| n.contains("cornell_box.obj:77") && n.contains("split into triangles")),
        "{:?}",
        scene.notices
    );
    // The blocks stand on the floor, and their bottoms are faces of the floor object: contact.
    let ours = builtin("cornell-box-coarse").unwrap().at(0).unwrap();
    assert!((stage.patches[0].area - area_of(&ours, "floor")).abs() < 1e-12, "{}", stage.patches[0].area);
    assert_eq!((stage.patches[1].area, stage.patches[2].area), (0.0, 0.0));
    assert_eq!(stage.patches[0].normal, DVec3::Z);
}

#[test]
fn the_cornell_box_of_mcguire_is_read_with_its_materials() {
    let files = ["scenes/mcguire/CornellBox-Original.obj", "scenes/mcguire/CornellBox-Original.mtl"];
    let Some(scene) = foreign(&files, "CornellBox-Original.obj", "up = \"y\"\n") else { return };
    let stage = scene.at(0).unwrap();
    let red = scene.materials.iter().find(|m| m.name == "box/leftWall").unwrap();
    assert_eq!(red.reflectance, [0.63, 0.065, 0.05]);
    let lamp = scene.materials.iter().find(|m| m.emission.iter().any(|e| *e > 0.0)).unwrap();
    assert_eq!(lamp.emission, [17.0, 12.0, 4.0]);
    eprintln!("{:?} {:?}", scene.notices, stage.areas());
    assert!(scene.notices.iter().any(|n| n.contains("overlap in one plane")), "its short box has one side twice");
}
