//! Scenes of Mitsuba 3 and Radiance: the same rooms as in our own format, and what is refused.

#[path = "common/program.rs"]
mod program;

use etalon::io::scene::{SceneOptions, open_scene};
use etalon::math::DVec3;
use etalon::scene::{Scene, Stage};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

fn file(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name).display().to_string()
}

fn read(path: &str, max_edge: Option<f64>) -> Scene {
    let options = SceneOptions { max_edge_override: max_edge };
    open_scene(path, &options).unwrap_or_else(|e| panic!("{e}"))
}

fn stage(scene: &Scene) -> Stage {
    scene.at(0).expect("a stage")
}

/// A scene of some text in a folder of its own.
fn written(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("writable");
    (folder, path)
}

fn centre(corners: &[DVec3]) -> DVec3 {
    corners.iter().sum::<DVec3>() / corners.len() as f64
}

/// Areas, normals and centres, patch by patch.
fn same_geometry(a: &Stage, b: &Stage, patches: &[usize]) {
    for (i, k) in patches.iter().enumerate() {
        let (p, q) = (&a.patches[*k], &b.patches[i]);
        assert!((p.area - q.area).abs() < 1e-14, "patch {i}: {} {}", p.area, q.area);
        assert!((p.normal - q.normal).length() < 1e-14, "patch {i}: {:?} {:?}", p.normal, q.normal);
        assert!((centre(&p.corners) - centre(&q.corners)).length() < 1e-14, "patch {i}");
    }
}

#[test]
fn a_room_of_mitsuba_is_the_room_of_our_own_format() {
    let scene = read(&file("mitsuba/room.xml"), None);
    let (theirs, ours) = (stage(&scene), stage(&read("builtin:cube-one-emitter", None)));
    assert_eq!(theirs.patch_count(), 6);
    same_geometry(&theirs, &ours, &[0, 1, 2, 3, 4, 5]);
    for i in 0..6 {
        assert_eq!(theirs.reflectance(i), [0.5; 3]);
        let emission = ours.emission(i)[0];
        assert!(theirs.emission(i).iter().all(|e| (e - emission).abs() < 1e-15), "{:?}", theirs.emission(i));
    }
    let names: Vec<&str> = scene.surfaces.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["floor", "ceiling", "west", "east", "south", "north"]);
    assert_eq!(scene.photometry, etalon::view::Photometry::rec709());
    let [camera] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert!((camera.eye - DVec3::new(0.5, 0.5, 0.9)).length() < 1e-15 && camera.size == [200, 100]);
    // 90 degrees across, half as many pixels down.
    assert!((camera.fov - 2.0 * 0.5f64.atan().to_degrees()).abs() < 1e-12, "{}", camera.fov);
    assert_eq!(scene.notices.len(), 1, "{:?}", scene.notices);
    assert!(scene.notices[0].starts_with("room.xml:4: integrators are left out"), "{:?}", scene.notices);
}

#[test]
fn a_room_of_radiance_is_the_room_of_our_own_format() {
    let scene = read(&file("radiance/room.rad"), None);
    let (theirs, ours) = (stage(&scene), stage(&read("builtin:cube-one-emitter", None)));
    // The lamp has no back; of the others the back follows the front.
    let fronts = [0, 1, 3, 5, 7, 9];
    assert_eq!(theirs.patch_count(), 11);
    same_geometry(&theirs, &ours, &fronts);
    for (i, k) in fronts.into_iter().enumerate() {
        assert_eq!(theirs.reflectance(k), [if i == 0 { 0.0 } else { 0.5 }; 3]);
        assert!((theirs.emission(k)[1] - ours.emission(i)[0]).abs() < 1e-15);
    }
    for k in &fronts[1..] {
        assert_eq!(theirs.patches[*k].normal, -theirs.patches[k + 1].normal);
        assert_eq!(theirs.reflectance(k + 1), [0.5; 3]);
    }
    let weights = &scene.photometry.weights;
    assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12 && (weights[1] - 0.670114631).abs() < 1e-9);
}

/// The 6 x 6 system of the cube has an exact solution; the floor of the Mitsuba room emits 1 W/m^2.
/// Seed and rays are fixed: with `--estimator auto` the form factors are exact, and so is the solution to 1e-9.
#[test]
fn radiosities_of_the_room_are_exact() {
    let folder = tempfile::tempdir().expect("a folder");
    let room = file("mitsuba/room.xml");
    program::ok(folder.path(), &format!("solve {room} --method gather -o room.csv --rays 256 --kernel builtin"));
    let solution = etalon::io::read_solution(&folder.path().join("room.csv")).expect("a solution");
    let found = solution.fit(&["r", "g", "b"].map(String::from), &[true; 6]).expect("it fits");
    // Opposite and adjacent unit squares, Howell C-11 and C-14.
    let (opposite, adjacent) = (0.199_824_895_698_387_38, 0.200_043_776_075_403_15);
    // By symmetry: floor, ceiling, and four walls alike. Iterated to the fixed point.
    let (mut floor, mut ceiling, mut wall) = (1.0, 0.0, 0.0);
    for _ in 0..200 {
        (floor, ceiling, wall) = (
            1.0 + 0.5 * (opposite * ceiling + 4.0 * adjacent * wall),
            0.5 * (opposite * floor + 4.0 * adjacent * wall),
            0.5 * (adjacent * (floor + ceiling) + (2.0 * adjacent + opposite) * wall),
        );
    }
    let exact = [floor, ceiling, wall, wall, wall, wall];
    for (i, exact) in exact.iter().enumerate() {
        for band in 0..3 {
            let value = found.values[3 * i + band];
            assert!((value - exact).abs() < 1e-6, "patch {i}, band {band}: {value}, exactly {exact}");
        }
    }
}

#[test]
fn patches_follow_the_largest_edge_in_the_world() {
    // The wall from a mesh is placed first and divided then.
    let text = r#"<scene version="3.0.0"><shape type="cube"><transform name="to_world"><scale x="1" y="2" z="0.5"/></transform></shape></scene>"#;
    let (_folder, path) = written("bar.xml", text);
    let whole = stage(&read(path.to_str().unwrap(), None));
    let fine = stage(&read(path.to_str().unwrap(), Some(0.5)));
    assert_eq!(whole.patch_count(), 6);
    // 2 x 4 x 1 m: faces of 4 x 2, 8 x 2 and 4 x 8 cells, each twice.
    assert_eq!(fine.patch_count(), 2 * (8 + 16 + 32));
    let sum = |s: &Stage| s.areas().iter().sum::<f64>();
    assert!((sum(&whole) - 28.0).abs() < 1e-12 && (sum(&fine) - 28.0).abs() < 1e-12);
}

#[test]
fn sides_follow_normals_flips_and_mirrors() {
    let shape = |kind: &str, inner: &str| {
        let text = format!(r#"<scene version="3.0.0"><shape type="{kind}">{inner}</shape></scene>"#);
        let (_folder, path) = written("a.xml", &text);
        stage(&read(path.to_str().unwrap(), None))
    };
    let normal = |inner: &str| shape("rectangle", inner).patches[0].normal;
    let flip = r#"<boolean name="flip_normals" value="true"/>"#;
    let mirror = r#"<transform name="to_world"><scale x="-1"/></transform>"#;
    assert_eq!(normal(""), DVec3::Z);
    assert_eq!(normal(flip), -DVec3::Z);
    assert_eq!(normal(mirror), DVec3::Z, "normals go by the inverse transpose");
    assert_eq!(normal(&format!("{flip}{mirror}")), -DVec3::Z);
    for (inner, way) in [("", 1.0), (flip, -1.0), (mirror, 1.0)] {
        for p in &shape("cube", inner).patches {
            assert!((centre(&p.corners) - p.normal * way).length() < 1e-15, "{inner}: {:?}", p.normal);
        }
    }
    // A lamp with two sides shines from its front alone.
    let both = r#"<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.25"/></bsdf></bsdf>"#;
    let lamp = r#"<emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter>"#;
    let plate = shape("rectangle", both);
    assert_eq!((plate.patch_count(), plate.reflectance(1)), (2, &[0.25; 3][..]));
    let plate = shape("rectangle", &format!("{both}{lamp}"));
    assert_eq!(plate.patch_count(), 2);
    assert_eq!(plate.patches[0].normal, -plate.patches[1].normal);
    assert_eq!((plate.emission(0), plate.emission(1)), (&[PI, 2.0 * PI, 3.0 * PI][..], &[0.0; 3][..]));
    assert_eq!((plate.reflectance(0), plate.reflectance(1)), (&[0.25; 3][..], &[0.25; 3][..]));
    // Without a BSDF: grey, and black for lamps.
    assert_eq!(shape("rectangle", "").reflectance(0), [0.5; 3]);
    assert_eq!(shape("rectangle", lamp).reflectance(0), [0.0; 3]);
}

#[test]
fn a_box_a_hole_and_what_cannot_be_read() {
    let scene = read(&file("radiance/box.rad"), None);
    let stage = stage(&scene);
    let area = |name: &str| {
        let own = |i: &usize| stage.surface_name(*i) == name;
        (0..stage.patch_count()).filter(own).map(|i| stage.patches[i].area).sum::<f64>()
    };
    let names: Vec<&str> = scene.surfaces.iter().map(|s| s.name.as_str()).collect();
    let sides = ["room.1540", "room.4620", "room.2310", "room.3267", "room.5137", "room.6457"];
    assert_eq!(names, [&sides[..], &["lamp", "plate", "plate#9"]].concat());
    // Inwards, with the back of each as large.
    for (k, (name, size)) in sides.iter().zip([3.0, 6.0, 2.0, 3.0, 6.0, 2.0]).enumerate() {
        assert!((area(name) - 2.0 * size).abs() < 1e-12, "{name} {}", area(name));
        let patch = &stage.patches[2 * k];
        let inwards = DVec3::new(0.5, 1.0, 1.5) - centre(&patch.corners);
        assert!((patch.normal - inwards.normalize()).length() < 1e-12, "{name} {:?}", patch.normal);
    }
    // A square of 1 m with a hole of 0.5 m, both sides.
    assert!((area("plate") - 2.0 * 0.75).abs() < 1e-12, "{}", area("plate"));
    assert!((area("lamp") - 0.18).abs() < 1e-12);
    let material = |name: &str| scene.materials.iter().find(|m| m.name == name).expect("a material");
    let close = |found: &[f64], exact: [f64; 3]| found.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-14);
    // A quarter of what meets the white paint is mirrored.
    assert!(close(&material("white").reflectance, [0.6, 0.45, 0.3]), "{:?}", material("white"));
    assert!(close(&material("shine").emission, [PI, 2.0 * PI, 3.0 * PI]));
    let told = |what: &str| assert!(scene.notices.iter().any(|n| n.contains(what)), "{what}: {:?}", scene.notices);
    told("box.rad: the 8 polygons of plastic radiate from both sides");
    told("box.rad:7: the plastic \"white\" mirrors a share of 0.25, which is left out (7 in all)");
    told("box.rad:9: the plastic \"wood\" is even here: \"grain\" is left out");
    told("box.rad:12: polygons of glass are left out");
    told("box.rad:13: surfaces of type sphere are left out");
    told("box.rad:14: polygons of void are left out");
    told("box.rad:9: polygons that are not planar or not convex were split into triangles (1 in all)");
    told("1 polygons share their names with others");
}

/// Line of the fault, the file from its second line on, parts of the message.
type Broken = (usize, &'static str, &'static [&'static str]);

#[rustfmt::skip]
const BROKEN_XML: &[Broken] = &[
    (1, "<shape type=\"cube\"/>", &["not well-formed XML", "correct the XML"]),
    (2, "<shape type=\"cube></scene>", &["not well-formed XML"]),
    (2, "<shape type=\"rectangle\"><ref id=\"whit\"/></shape><bsdf type=\"diffuse\" id=\"white\"/></scene>", &["nothing has the id \"whit\"", "did you mean \"white\""]),
    (2, "<shape type=\"sphere\"/></scene>", &["shape of type \"sphere\" is not read", "mesh"]),
    (2, "<shape/></scene>", &["<shape> has no type"]),
    (2, "<shape type=\"cube\"><bsdf type=\"dielectric\"/></shape></scene>", &["\"dielectric\" is not diffuse", "take its shapes out"]),
    (3, "<shape type=\"cube\"><bsdf type=\"diffuse\">\n<rgb name=\"reflectance\" value=\"0.5, 1.0, 0.5\"/></bsdf></shape></scene>", &["reflectance 1 is outside [0, 1)"]),
    (2, "<shape type=\"cube\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5, 0.1\"/></bsdf></shape></scene>", &["2 numbers", "give three"]),
    (2, "<shape type=\"cube\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"/></bsdf></shape></scene>", &["colour of kind <texture>", "one <rgb>"]),
    (2, "<shape type=\"cube\"><bsdf type=\"diffuse\"><rgb name=\"refletance\" value=\"0.5\"/></bsdf></shape></scene>", &["no parameter \"refletance\"", "did you mean \"reflectance\""]),
    (2, "<shape type=\"cube\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"500:0.5, 400:0.5\"/></bsdf></shape></scene>", &["400 comes after 500", "rising order"]),
    (2, "<shape type=\"cube\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"-1\"/></emitter></shape></scene>", &["radiance -1 is negative"]),
    (2, "<shape type=\"cube\"><emitter type=\"area\"/></shape></scene>", &["no radiance", "add <rgb"]),
    (2, "<emitter type=\"envmap\"/><shape type=\"cube\"/></scene>", &["emitter of type \"envmap\"", "take this one out"]),
    (2, "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0\"/></transform></shape></scene>", &["scale of 0"]),
    (2, "<shape type=\"cube\"><transform name=\"to_world\"><rotate angle=\"9\"/></transform></shape></scene>", &["axis has no direction"]),
    (2, "<shape type=\"cube\"><transform name=\"to_world\"><matrix value=\"1 0 0 0 1 0\"/></transform></shape></scene>", &["matrix has 6 numbers", "16"]),
    (2, "<shape type=\"cube\"><transform name=\"to_world\"><translate x=\"1e20\"/></transform></shape></scene>", &["beyond"]),
    (2, "<shape type=\"cube\"><transform name=\"to_world\"><translate X=\"1\"/></transform></shape></scene>", &["unknown attribute \"X\""]),
    (2, "<shape type=\"cube\"><transform name=\"to_world\"><translate x=\"left\"/></transform></shape></scene>", &["\"left\" is not a number"]),
    (2, "<shape type=\"cube\"><transform name=\"toWorld\"/></shape></scene>", &["no parameter \"toWorld\"", "to_world"]),
    (2, "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"yes\"/></shape></scene>", &["neither true nor false"]),
    (2, "<shape type=\"obj\"/></scene>", &["the obj has no filename"]),
    (2, "<shape type=\"obj\"><string name=\"filename\" value=\"gone.obj\"/></shape></scene>", &["cannot open \"gone.obj\""]),
    (2, "<shape type=\"ply\"><string name=\"filename\" value=\"../x.ply\"/></shape></scene>", &["leaves the scene's folder"]),
    (2, "<shape type=\"obj\"><string name=\"filename\" value=\"x.ply\"/></shape></scene>", &["has not the ending .obj"]),
    (2, "<include filename=\"a.xml\"/></scene>", &["includes itself"]),
    (2, "<include filename=\"b.xml\"/></scene>", &["cannot open \"b.xml\""]),
    (2, "<shape type=\"cube\"><bsdf type=\"$kind\"/></shape></scene>", &["\"$kind\" has no value", "<default"]),
    (2, "<bsdf type=\"diffuse\" id=\"a\"/><shape type=\"cube\" id=\"a\"/></scene>", &["second element with the id \"a\""]),
    (2, "<path value=\"/tmp\"/></scene>", &["search paths"]),
    (2, "<volume type=\"grid\"/></scene>", &["<volume> is not read"]),
    (1, "</scene>", &["no shape with an area", "add a <shape"]),
];

#[rustfmt::skip]
const BROKEN_RAD: &[Broken] = &[
    (2, "white polygon p 0 0 9 0 0 0 1 0 0 0 1 0", &["modifier \"white\" is not defined"]),
    (3, "void plastic white 0 0 5 1 1 1 .5 0\nwite polygon p 0 0 9 0 0 0 1 0 0 0 1 0", &["modifier \"wite\"", "did you mean \"white\""]),
    (2, "void plastik white 0 0 5 1 1 1 .5 0", &["no type \"plastik\"", "did you mean \"plastic\""]),
    (2, "void teapot t 0 0 0", &["no type \"teapot\"", "modifier type identifier"]),
    (2, "void plastic white 0 0 3 1 1 1", &["has 3 numbers", "give 5"]),
    (2, "void plastic white 0 0 5 1 1 .5 0 0", &["reflects 1, outside [0, 1)"]),
    (2, "void plastic white 0 0 5 -.1 .5 .5 0 0", &["reflects -0.1"]),
    (2, "void plastic white 0 0 5 .5 .5 .5 2 0", &["specularity 2"]),
    (2, "void light l 0 0 3 1 -1 1", &["shines with -1"]),
    (2, "void light l 0 0 5 1 1 1 1 1", &["has 5 numbers", "give 3"]),
    (3, "void brightdata d 3 corr a.dat src.cal 0 0\nd light l 0 0 3 1 1 1", &["modified by \"d\"", "void"]),
    (2, "void plastic white 0 x", &["count of whole numbers is \"x\""]),
    (2, "void plastic white 0 0 5 .5 .5 .5", &["ends before its numbers", "complete"]),
    (2, "void plastic white", &["ends before the count of strings"]),
    (2, "void plastic white 0 0 5 .5 .5 half 0 0", &["\"half\" is not a number"]),
    (2, "void plastic white 0 0 5 .5 .5 1e999 0 0", &["not finite"]),
    (2, "void plastic white 0 0 -5", &["count of numbers is \"-5\""]),
    (3, "void plastic w 0 0 5 .5 .5 .5 0 0\nw polygon p 0 0 8 0 0 0 1 0 0 0 1", &["has 8 numbers", "three or more corners"]),
    (3, "void plastic w 0 0 5 .5 .5 .5 0 0\nw polygon p 0 0 12 0 0 0 2 2 0 2 0 0 0 1 0", &["crosses itself", "split it"]),
    (2, "!xform -t 1 0 0 other.rad", &["\"!xform\" is not run", "xform scene.rad > expanded.rad"]),
    (2, "!rm -rf somewhere", &["\"!rm\" is not run"]),
    (2, "!genbox w b 1 2", &["genbox is not read"]),
    (2, "!genbox w b 1 2 0", &["\"0\" is not a length"]),
    (2, "!genbox w b 1 2 3 -r .1", &["genbox is not read", "write it out"]),
    (2, "void alias a b", &["modifier \"b\" is not defined"]),
    (1, "void plastic white 0 0 5 .5 .5 .5 0 0", &["no polygon that can be used", "add polygons"]),
];

/// Each broken file: its place with the line, what is wrong, and a mend.
fn each_is_refused(ending: &str, first_line: &str, broken: &[Broken]) {
    assert!(broken.len() >= 20);
    for (line, body, parts) in broken {
        let name = format!("a.{ending}");
        let (folder, path) = written(&name, &format!("{first_line}\n{body}\n"));
        let e = open_scene(path.to_str().unwrap(), &SceneOptions::default()).expect_err(body);
        let text = e.to_string();
        // What ends too early is found at its beginning or at its end.
        let at_line = text.starts_with(&format!("{name}:{line}")) || (*line == 1 && text.starts_with(&name));
        assert!(at_line, "{body}\n{text}");
        assert!(parts.iter().all(|p| text.contains(p)), "{body}\n{text}");
        assert!(text.contains("; ") && !text.contains('\n'), "no mend: {text}");
        assert!(!text.contains(folder.path().to_str().unwrap()), "{text}");
    }
}

#[test]
fn broken_scenes_of_mitsuba_are_refused_with_place_and_mend() {
    each_is_refused("xml", "<scene version=\"3.0.0\">", BROKEN_XML);
    for (text, part) in [
        ("<scene>\n</scene>", "has no version"),
        ("<scene version=\"0.6.0\"></scene>", "version 0.6.0"),
        ("<scene version=\"new\"></scene>", "\"new\" is not known"),
        ("<html version=\"3.0.0\"></html>", "a <html>, not a <scene>"),
        ("<!DOCTYPE scene [<!ENTITY a \"b\">]><scene version=\"3.0.0\">&a;</scene>", "DOCTYPE"),
        ("", "not well-formed XML"),
    ] {
        let (_folder, path) = written("a.xml", text);
        let e = open_scene(path.to_str().unwrap(), &SceneOptions::default()).expect_err(text).to_string();
        assert!(e.starts_with("a.xml:1: ") && e.contains(part), "{e}");
    }
}

#[test]
fn broken_scenes_of_radiance_are_refused_with_place_and_mend() {
    each_is_refused("rad", "# broken", BROKEN_RAD);
}

#[test]
fn nothing_grows_without_bound() {
    // Defaults that double, and elements in elements.
    let doubling: String =
        (1..60).map(|k| format!("<default name=\"a{k}_\" value=\"$a{}_$a{}_\"/>", k - 1, k - 1)).collect();
    let text = format!("<scene version=\"3.0.0\"><default name=\"a0_\" value=\"xy\"/>{doubling}</scene>");
    let deep = format!("<scene version=\"3.0.0\">{}{}</scene>", "<a>".repeat(100_000), "</a>".repeat(100_000));
    for (text, part) in [(text, "too long"), (deep, "deep in one another")] {
        let (_folder, path) = written("a.xml", &text);
        let e = open_scene(path.to_str().unwrap(), &SceneOptions::default()).expect_err("refused").to_string();
        assert!(e.contains(part), "{e}");
    }
}

#[test]
fn the_program_ends_with_two_and_one_message() {
    for (name, text) in [("a.xml", "<scene version=\"3.0.0\"><shape type=\"disk\"/></scene>"), ("a.rad", "!ls\n")] {
        let (folder, _path) = written(name, text);
        let message = program::refused(folder.path(), &format!("scene check {name}"));
        assert!(message.contains(name), "{message}");
        let message = program::refused(folder.path(), &format!("form-factors {name} -o f.npz"));
        assert!(message.contains(name) && !folder.path().join("f.npz").exists(), "{message}");
    }
}
