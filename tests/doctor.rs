//! The scene doctor on scenes with one defect each, against what geometry says.

use etalon::doctor::examine;
use etalon::io::scene::{SceneOptions, open_scene};
use etalon::math::DVec3;
use etalon::scene::{Finding, FindingKind, Severity};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/defects")
}

fn findings(name: &str) -> Vec<Finding> {
    let path = folder().join(format!("{name}.toml"));
    let scene = open_scene(path.to_str().expect("a plain path"), &SceneOptions::default()).expect("a readable scene");
    examine(&scene, &scene.at(scene.edits.len()).expect("a stage")).expect("an examination")
}

/// The only finding of a scene.
fn only(name: &str, kind: FindingKind, severity: Severity) -> Finding {
    let mut found = findings(name);
    assert_eq!(found.len(), 1, "{name}: {found:#?}");
    let f = found.remove(0);
    assert_eq!((f.kind, f.severity), (kind, severity), "{name}: {f:#?}");
    f
}

fn value(f: &Finding) -> f64 {
    f.consequence.as_ref().expect("a consequence").value
}

/// Within 6 standard errors: a false alarm of 5e-4 each by Student t with 7 degrees, but the seed is fixed.
fn agrees(f: &Finding, truth: f64) {
    let c = f.consequence.as_ref().expect("a consequence");
    let error = c.std_err.expect("a standard error");
    assert!((c.value - truth).abs() <= 6.0 * error + 1e-12, "{} against {truth}: {}", c.value, c.text);
    assert!(error < 0.05 * truth + 1e-9, "the error {error} is too large to say anything about {truth}");
}

#[test]
fn a_sound_room_has_no_finding() {
    assert_eq!(findings("none"), []);
}

#[test]
fn one_wall_turned_over() {
    let f = only("winding-one", FindingKind::Winding, Severity::Error);
    assert_eq!(f.place.surfaces, ["north"]);
    assert_eq!(f.place.patches.len(), 16);
    // Reciprocity: five walls of area 1 send 1 of 5 to the sixth.
    agrees(&f, 0.2);
}

#[test]
fn a_body_inside_out() {
    let f = only("winding-body", FindingKind::Winding, Severity::Error);
    assert_eq!(f.place.surfaces.len(), 6);
    assert!(f.place.surfaces.iter().all(|s| s.starts_with("box-")));
    // A convex body gets all its light from the room: its area 0.96 of the room's 6.
    agrees(&f, 0.96 / 6.0);
}

#[test]
fn a_room_inside_out() {
    let f = only("winding-room", FindingKind::Winding, Severity::Warning);
    assert_eq!((f.place.surfaces.len(), value(&f)), (6, 1.0));
}

#[test]
fn a_gap_with_its_place_and_its_share_of_the_light() {
    let f = only("gap", FindingKind::Gap, Severity::Warning);
    let place = f.place.point.expect("a place");
    assert!(DVec3::from_array(place).distance(DVec3::new(1.0, 0.5, 0.99)) < 1e-6);
    // Reciprocity in a convex room: the hole receives its own area's worth of the light of the rest.
    agrees(&f, 0.02 / 5.98);
    assert!(f.what.contains("1 m by 20 mm"), "{}", f.what);
    assert!(f.consequence.expect("light").text.contains("of the light of \"ceiling\""));
    only("gap-declared", FindingKind::Gap, Severity::Error);
}

#[test]
fn a_crack_with_its_width() {
    let f = only("crack", FindingKind::Gap, Severity::Warning);
    agrees(&f, 4.0 * 0.0005 / 6.0);
    assert!(f.what.contains("0.5 mm wide"), "{}", f.what);
}

#[test]
fn corners_inside_edges() {
    let f = only("t-junction", FindingKind::TJunction, Severity::Note);
    assert!(f.what.starts_with("2 corners") && value(&f) < 1e-12, "{f:?}");
}

#[test]
fn contact_with_what_of_each_patch_is_covered() {
    let f = only("contact", FindingKind::Contact, Severity::Note);
    assert!((value(&f) - 0.25).abs() < 1e-12);
    let mut patches = f.place.patches.clone();
    patches.sort_unstable();
    assert_eq!(patches, [5, 6, 9, 10]);
    assert!(f.place.values.iter().all(|v| (v - 1.0).abs() < 1e-9));
    assert_eq!(f.place.surfaces, ["floor", "box-bottom"]);
}

#[test]
fn the_middle_of_a_patch_under_a_post() {
    let found = findings("buried-centre");
    let [contact, buried] = &found[..] else { panic!("{found:#?}") };
    assert_eq!((contact.kind, buried.kind), (FindingKind::Contact, FindingKind::BuriedCentre));
    assert_eq!(buried.place.patches, [5]);
    assert!((contact.place.values[0] - 0.01 / 0.0625).abs() < 1e-9);
    // What is left of that patch, of the room with the post's sides and top.
    assert!((value(buried) - 0.0525 / (6.0 - 0.01 + 0.01 + 4.0 * 0.1 * 0.5)).abs() < 1e-9);
}

#[test]
fn a_body_that_others_reach_into() {
    let found = findings("sunk");
    let kinds: Vec<FindingKind> = found.iter().map(|f| f.kind).collect();
    assert!(!kinds.contains(&FindingKind::Winding), "{found:#?}");
    let buried = found.iter().find(|f| f.kind == FindingKind::BuriedCentre).expect("buried middles");
    assert_eq!((buried.severity, &buried.place.patches[..]), (Severity::Warning, &[5, 6, 9, 10][..]));
    let reached = found.iter().find(|f| f.what.contains("reaches into the body")).expect("the floor reaches in");
    // All light of a quarter of the floor, of 7.3 m^2 in all, falls on the box's inside.
    agrees(reached, 0.25 / 7.3);
}

#[test]
fn a_black_back_in_sight() {
    let f = only("backs-seen", FindingKind::BacksSeen, Severity::Warning);
    assert_eq!(f.place.surfaces[0], "plate");
    // The back receives its own area's worth, half the hemisphere's full view of the room: 0.16 of 6.16.
    agrees(&f, 0.16 / 6.16);
}

#[test]
fn needles() {
    let f = only("sliver", FindingKind::Sliver, Severity::Warning);
    assert!(f.what.contains("patches 80, 81, 82, 83 and 196 more"), "{}", f.what);
    assert!((value(&f) - 0.005).abs() < 1e-6);
}

#[test]
fn units() {
    let f = only("units", FindingKind::Units, Severity::Warning);
    assert!((value(&f) - 3f64.sqrt() * 1000.0).abs() < 1e-9);
    let f = only("units-object", FindingKind::Units, Severity::Warning);
    assert!((value(&f) - 1000.0).abs() < 1e-6 && f.what.contains("\"lamp\""));
}

#[test]
fn nothing_emits() {
    only("dark", FindingKind::Dark, Severity::Note);
}

#[test]
fn a_lamp_that_a_board_hides() {
    let found = findings("hidden-lamp");
    let dark = of(&found, FindingKind::Dark);
    assert!(
        dark.len() == 1 && dark[0].severity == Severity::Warning && dark[0].place.surfaces == ["lamp"],
        "{dark:#?}"
    );
    assert!((value(of(&found, FindingKind::Overlap)[0]) - 0.04).abs() < 1e-12);
}

#[test]
fn a_lamp_too_small_for_the_default_number_of_rays() {
    let f = only("many-rays", FindingKind::ManyRays, Severity::Note);
    let worst = f.place.patches[0] as usize;
    let scene = open_scene(folder().join("many-rays.toml").to_str().expect("a path"), &SceneOptions::default());
    let stage = scene.expect("a scene").at(0).expect("a stage");
    let (patch, lamp) = (&stage.patches[worst], DVec3::new(0.5, 0.5, 0.999));
    // F of the patch to a lamp that is small against its distance: A cos cos / (pi r^2), over 16 x 16 places.
    let at = |k: usize| {
        let (u, v) = (((k % 16) as f64 + 0.5) / 16.0, ((k / 16) as f64 + 0.5) / 16.0);
        let [a, b, c, d] = patch.corners[..] else { panic!("a quadrilateral") };
        let to = lamp - a.lerp(b, u).lerp(d.lerp(c, u), v);
        16e-6 * (to.dot(patch.normal) * to.z).max(0.0) / (std::f64::consts::PI * to.length_squared().powi(2))
    };
    let factor = (0..256).map(at).sum::<f64>() / 256.0;
    // Reflected light, as if even: the lamp's power, rho / (1 - rho) = 1/9 times, over the walls.
    let ambient = 16e-6 / 6.0 / 9.0;
    let rays = factor * (1.0 - factor) / (factor + ambient).powi(2) * 1e4;
    assert!((value(&f) / rays - 1.0).abs() < 0.1, "{} against {rays}", value(&f));
    assert_eq!(value(&f), f.place.values[0]);
}

#[test]
fn meshes_with_faces_twice_overlapping_or_bent() {
    let f = only("duplicate", FindingKind::Duplicate, Severity::Warning);
    assert!((value(&f) - 0.16).abs() < 1e-12);
    let f = only("overlap", FindingKind::Overlap, Severity::Warning);
    assert!((value(&f) - 0.04).abs() < 1e-12);
    let f = only("import", FindingKind::Import, Severity::Warning);
    assert!(f.what.contains("bent.obj:6"), "{}", f.what);
}

#[test]
fn every_defect_has_its_scene_and_every_finding_its_mend() {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .map(|p| p.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    let all: Vec<Finding> = names.iter().flat_map(|n| findings(n)).collect();
    assert!(all.iter().all(|f| !f.mend.is_empty() && !f.what.is_empty()));
    let mut kinds: Vec<FindingKind> = all.iter().map(|f| f.kind).collect();
    kinds.sort();
    kinds.dedup();
    assert_eq!(kinds.len(), 13, "{kinds:?}");
}

#[test]
fn the_scenes_that_come_with_the_program_have_no_grave_finding() {
    for name in etalon::io::scene::builtin_names() {
        let scene = open_scene(&format!("builtin:{name}"), &SceneOptions::default()).expect("a scene");
        for state in 0..=scene.edits.len() {
            let found = examine(&scene, &scene.at(state).expect("a stage")).expect("an examination");
            // A reflector of 500 m is what the published case asks for, whatever its unit looks like.
            let meant = |f: &Finding| name == "cie171-5-6-large" && f.kind == FindingKind::Units;
            let grave: Vec<&Finding> = found.iter().filter(|f| f.severity > Severity::Note && !meant(f)).collect();
            assert!(grave.is_empty(), "{name} in state {state}: {grave:#?}");
        }
    }
}

/// Published scenes beside the checkout, where there are any: read where they lie.
fn published(file: &str) -> Option<Vec<Finding>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes").join(file);
    if !path.is_file() {
        eprintln!("{file} is not beside this checkout: left out");
        return None;
    }
    let scene = open_scene(path.to_str()?, &SceneOptions::default()).expect("a readable scene");
    Some(examine(&scene, &scene.at(0).expect("a stage")).expect("an examination"))
}

fn of(findings: &[Finding], kind: FindingKind) -> Vec<&Finding> {
    findings.iter().filter(|f| f.kind == kind).collect()
}

#[test]
fn the_published_cornell_box_in_millimetres() {
    let Some(found) = published("tinyobj/cornell_box.obj") else { return };
    // The footprints of the blocks are faces of the floor that look down onto it.
    let contact = of(&found, FindingKind::Contact);
    let area = |corners: [[f64; 2]; 4]| {
        let cross = |k: usize| {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            a[0] * b[1] - a[1] * b[0]
        };
        (0..4).map(cross).sum::<f64>().abs() / 2.0
    };
    let short = area([[130.0, 65.0], [82.0, 225.0], [240.0, 272.0], [290.0, 114.0]]);
    let tall = area([[423.0, 247.0], [265.0, 296.0], [314.0, 456.0], [472.0, 406.0]]);
    // The floor's patch and both footprints lose the same area.
    assert!((value(contact[0]) - 2.0 * (short + tall)).abs() < 1e-3, "{}", value(contact[0]));
    assert_eq!(of(&found, FindingKind::Units).len(), 1);
    // The light hangs 0.8 mm under the ceiling, one-sided: its back is what the ceiling sees there.
    assert!(of(&found, FindingKind::BacksSeen)[0].what.contains("light\" is seen by \"cornell_box/ceiling\""));
    assert_eq!(of(&found, FindingKind::Dark).len(), 1, "the file's Ke and Kd = 1 are not usable");
}

#[test]
fn the_published_boxes_of_mcguire() {
    let Some(found) = published("mcguire/CornellBox-Original.obj") else { return };
    assert_eq!(of(&found, FindingKind::Duplicate).len(), 2);
    assert!(of(&found, FindingKind::BacksSeen).iter().any(|f| f.what.contains("reaches into the body")));
    let Some(found) = published("mcguire/CornellBox-Sphere.obj") else { return };
    let gap = of(&found, FindingKind::Gap);
    // The missing front wall: its area over that of all the rest sees it only in a convex room; the bodies add to it.
    assert!(gap.len() == 1 && (0.1..0.2).contains(&value(gap[0])), "{gap:#?}");
}
