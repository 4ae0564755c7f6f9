//! `etalon scan`, `composite`, `shade` and `audit compositing` as a script runs them.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused, run};
use std::fs;
use std::path::Path;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

/// A floor with a table and a lamp over it, under every kind of light, in four objects; a mirror, fog, a tree.
const SCENE: &str = r#"
format = "etalon-scene/1"
[[material]]
name = "grey"
reflectance = 0.5
[[material]]
name = "mirror"
reflectance = 0.2
reflection = 0.7
[[material]]
name = "glow"
reflectance = 0.1
emission = 4.0
[[surface]]
name = "floor"
object = "ground"
material = "grey"
polygon = [[-6, -1, 0], [6, -1, 0], [6, 12, 0], [-6, 12, 0]]
[[surface]]
name = "top"
object = "table"
material = "grey"
polygon = [[-1, 4, 1], [1, 4, 1], [1, 6, 1], [-1, 6, 1]]
two_sided = true
[[surface]]
name = "leg"
object = "table"
material = "grey"
polygon = [[-0.1, 5, 0], [0.1, 5, 0], [0.1, 5, 1], [-0.1, 5, 1]]
two_sided = true
[[surface]]
name = "glass"
object = "wall"
material = "mirror"
polygon = [[-3, 9, 0], [3, 9, 0], [3, 9, 3], [-3, 9, 3]]
two_sided = true
[[surface]]
name = "panel"
object = "lamp"
material = "glow"
polygon = [[1, 3, 3], [1, 4, 3], [2, 4, 3], [2, 3, 3]]
[[camera]]
name = "front"
eye = [0, -0.5, 1.7]
target = [0, 6, 1]
size = [48, 36]
[[light]]
name = "sun"
type = "parallel"
direction = [0.4, 0.3, -1]
irradiance = 2.0
[[light]]
name = "bulb"
type = "point"
position = [-2, 3, 2.5]
intensity = 3.0
[[light]]
name = "tube"
type = "linear"
from = [-2, 7, 2.5]
to = [2, 7, 2.5]
intensity = 1.5
[[light]]
name = "lamp"
type = "area"
surface = "panel"
[[light]]
name = "sky"
type = "sky"
model = "overcast"
radiance = 0.3
[fog]
extinction = 0.02
radiance = 0.4
[background]
radiance = 0.05
sky = true
[[edit]]
move = "table"
translate = [0.5, 0, 0]
"#;

fn scene(here: &Path) {
    fs::write(here.join("s.toml"), SCENE).expect("written");
}

const OBJECTS: [&str; 4] = ["ground", "lamp", "table", "wall"];

/// Radiances of an .exr, by the largest difference of two.
fn far_apart(a: &Path, b: &Path) -> f64 {
    let read = |p: &Path| -> Vec<f32> {
        let image = exr::prelude::read_first_flat_layer_from_file(p).expect("readable");
        image.layer_data.channel_data.list.iter().flat_map(|c| c.sample_data.values_as_f32()).collect()
    };
    let (a, b) = (read(a), read(b));
    assert_eq!(a.len(), b.len());
    a.iter().zip(&b).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
}

#[test]
fn clusters_in_any_order_make_the_picture_of_the_whole() {
    let place = folder();
    let here = place.path();
    scene(here);
    let whole = json(here, "scan s.toml --state initial -o whole.span");
    assert_eq!(whole["clusters"].as_array().map(Vec::len), Some(4), "{whole}");
    ok(here, "scan s.toml --state initial --each -o parts");
    ok(here, "shade whole.span -o whole.exr");
    for (k, order) in [[0, 1, 2, 3], [3, 1, 0, 2], [2, 3, 1, 0]].iter().enumerate() {
        let files: Vec<String> = order.iter().map(|o| format!("parts/{}.span", OBJECTS[*o])).collect();
        ok(here, &format!("composite {} -o c{k}.span", files.join(" ")));
        ok(here, &format!("shade c{k}.span -o c{k}.exr"));
        let off = far_apart(&here.join("whole.exr"), &here.join(format!("c{k}.exr")));
        assert!(off <= 1e-6, "order {order:?}: {off}");
        // Any order, the same bytes.
        assert_eq!(
            fs::read(here.join("c0.span")).expect("there"),
            fs::read(here.join(format!("c{k}.span"))).expect("there")
        );
    }
    let shown = json(here, "shade c0.span -o c.png --threads 1");
    assert_eq!(shown["width"], 48);
    let traced = shown["traced_share"].as_f64().expect("a share");
    assert!(traced > 0.05 && traced < 0.6, "{traced}");
    ok(here, "shade c0.span -o again.exr --threads 1");
    assert_eq!(fs::read(here.join("c0.exr")).expect("there"), fs::read(here.join("again.exr")).expect("there"));
}

#[test]
fn after_an_edit_only_the_moved_cluster_is_scanned() {
    let place = folder();
    let here = place.path();
    scene(here);
    let scanned = |value: &serde_json::Value| -> Vec<bool> {
        value["files"].as_array().expect("files").iter().map(|f| f["scanned"].as_bool().expect("told")).collect()
    };
    assert_eq!(scanned(&json(here, "scan s.toml --state initial --each -o parts")), [true; 4]);
    assert_eq!(scanned(&json(here, "scan s.toml --state initial --each -o parts")), [false; 4]);
    assert_eq!(scanned(&json(here, "scan s.toml --state final --each -o parts")), [false, false, true, false]);
    ok(here, "composite parts/ground.span parts/lamp.span parts/table.span parts/wall.span -o c.span");
    ok(here, "scan s.toml -o whole.span");
    ok(here, "shade c.span -o c.exr");
    ok(here, "shade whole.span -o whole.exr");
    assert!(far_apart(&here.join("whole.exr"), &here.join("c.exr")) <= 1e-6);
    assert_eq!(scanned(&json(here, "scan s.toml --each --force -o parts")), [true; 4]);
    assert_eq!(scanned(&json(here, "scan s.toml --each --sub-scanlines 4 -o parts")), [true; 4]);
}

#[test]
fn lights_are_chosen_when_the_picture_is_made() {
    let place = folder();
    let here = place.path();
    scene(here);
    ok(here, "scan s.toml -o w.span");
    let names = |value: &serde_json::Value| -> Vec<String> {
        value["lights"].as_array().expect("lights").iter().map(|l| l.as_str().expect("a name").into()).collect()
    };
    assert_eq!(names(&json(here, "shade w.span -o a.exr --light sun,sky")), ["sun", "sky"]);
    fs::write(
        here.join("night.toml"),
        "format = \"etalon-lighting/1\"\n[[light]]\nname = \"moon\"\ntype = \"parallel\"\ndirection = [0, 0.2, -1]\n\
         irradiance = 0.01\n",
    )
    .expect("written");
    let night = json(here, "shade w.span -o n.exr --lighting night.toml");
    // The panel emits, and no light of the night stands for it.
    assert_eq!(names(&night), ["moon", "panel"]);
    // A scan under that light is the same picture.
    ok(here, "scan s.toml --lighting night.toml -o n.span");
    ok(here, "shade n.span -o n2.exr");
    assert!(far_apart(&here.join("n.exr"), &here.join("n2.exr")) == 0.0);
    let said = refused(here, "shade w.span -o a.exr --light sum");
    assert!(said.contains("\"sum\"") && said.contains("sun"), "{said}");
}

#[test]
fn a_solution_is_the_diffuse_term() {
    let place = folder();
    let here = place.path();
    ok(here, "scan builtin:furnace --size 24x18 -o f.span");
    ok(here, "solve builtin:furnace --method gather --rays 256 -o f.csv");
    ok(here, "shade f.span -o f.exr --solution f.csv --scene builtin:furnace");
    ok(here, "render builtin:furnace --solution f.csv --size 24x18 -o r.exr --style constant");
    // A furnace is as bright everywhere: B = E / (1 - rho), radiance B / pi.
    let image = exr::prelude::read_first_flat_layer_from_file(here.join("f.exr")).expect("readable");
    let values: Vec<f32> = image.layer_data.channel_data.list[0].sample_data.values_as_f32().collect();
    let text = fs::read_to_string(here.join("f.csv")).expect("a solution");
    let row = text.lines().last().expect("a row");
    let b: f64 = row.split(',').nth(1).expect("a number").parse().expect("a number");
    let worst = values.iter().map(|v| (f64::from(*v) * std::f64::consts::PI / b - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst < 0.05, "{worst} of {b}");
    let said = refused(here, "shade f.span -o f.exr --solution f.csv");
    assert!(said.contains("--scene"), "{said}");
}

#[test]
fn what_is_broken_is_refused_and_nothing_is_overwritten() {
    let place = folder();
    let here = place.path();
    scene(here);
    ok(here, "scan s.toml -o w.span");
    ok(here, "scan s.toml --cluster table -o table.span");
    ok(here, "scan s.toml --cluster wall,ground --sub-scanlines 5 -o other.span");
    let bytes = fs::read(here.join("w.span")).expect("there");
    fs::write(here.join("cut.span"), &bytes[..bytes.len() / 2]).expect("written");
    let mut changed = bytes.clone();
    changed[bytes.len() / 2] ^= 0x10;
    fs::write(here.join("changed.span"), &changed).expect("written");
    let head = bytes.iter().position(|b| *b == b'\n').expect("a first line");
    let mut foreign = b"etalon-span/7\n".to_vec();
    foreign.extend(&bytes[head + 1..]);
    fs::write(here.join("foreign.span"), &foreign).expect("written");
    fs::write(here.join("scene.span"), SCENE).expect("written");
    fs::write(here.join("kept.png"), "kept").expect("written");
    fs::write(here.join("kept.span"), "kept").expect("written");
    for (file, word) in
        [("cut", "cut"), ("changed", "changed"), ("foreign", "version 7"), ("scene", "scene"), ("none", "none")]
    {
        for command in [format!("shade {file}.span -o kept.png"), format!("composite w.span {file}.span -o kept.span")]
        {
            let said = refused(here, &command);
            assert!(said.contains(word), "{command}: {said}");
        }
    }
    let twice = refused(here, "composite w.span table.span -o kept.span");
    assert!(twice.contains("both hold"), "{twice}");
    let differs = refused(here, "composite table.span other.span -o kept.span");
    assert!(differs.contains("sub-scanlines"), "{differs}");
    for (command, word) in [
        ("shade w.span -o kept.png --scale-y 4", "--sub-scanlines 4"),
        ("shade w.span -o kept.png --scale-x 0", "above 0"),
        ("shade w.span -o kept.jpg", ".png"),
        ("shade w.span -o kept.png --lighting s.toml", "unknown format"),
        ("scan s.toml --cluster tables -o kept.span", "ground, lamp, table, wall"),
        ("scan s.toml --camera back -o kept.span", "front"),
        ("scan s.toml -o kept.exr", ".span"),
        ("composite w.span -o kept.png", ".span"),
        ("reference s.toml -o kept.ref", "for pictures"),
        ("audit compositing s.toml -o kept.audit --scales 0", "--scales"),
    ] {
        let said = refused(here, command);
        assert!(said.contains(word), "{command}: {said}");
    }
    for kept in ["kept.png", "kept.span"] {
        assert_eq!(fs::read(here.join(kept)).expect("there"), b"kept", "{kept}");
    }
    assert!(!here.join("kept.ref").exists() && !here.join("kept.audit").exists());
}

/// The whole audit on the scene above and on one of others, small. Every light is within the judge's errors, whose false
/// alarms are one in a thousand for each light.
#[test]
fn the_audit_finds_every_light_within_the_judges_errors() {
    let place = folder();
    let here = place.path();
    scene(here);
    let few = "--sub-scanlines 1,3,9 --scales 0.5,1.2 --samples 64 --points 60 --rays 4096";
    let value = json(here, &format!("audit compositing s.toml -o audit {few}"));
    let lights = value["lights"].as_array().expect("lights");
    assert_eq!(lights.len(), 5);
    for light in lights.iter().filter(|l| l["kind"] != "sky") {
        assert_eq!(light["within"], true, "{light}");
    }
    // Half planes make the sky inexact: by how much is told.
    let sky = lights.iter().find(|l| l["kind"] == "sky").expect("a sky");
    assert!(sky["error"].as_f64().expect("a number") < 0.01, "{sky}");
    assert_eq!(value["composite"]["same_segments"], true);
    assert!(value["composite"]["worst"].as_f64().expect("a number") < 1e-9);
    let edges: Vec<f64> = value["edges"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|r| r["error"]["value"].as_f64().expect("a number"))
        .collect();
    assert!(edges[0] > 2.0 * edges[1], "{edges:?}");
    for file in ["index.html", "audit.json", "edges.csv", "lights.csv"] {
        assert!(here.join("audit").join(file).is_file(), "{file}");
    }
    let box_ = json(here, &format!("audit compositing builtin:cornell-box-coarse --size 64x64 -o box {few}"));
    assert!(box_["lights"].as_array().expect("lights").iter().all(|l| l["within"] == true), "{box_}");
    let of = |value: &serde_json::Value, path: &str| {
        value["picture"].pointer(path).and_then(|v| v.as_f64()).expect("a number")
    };
    assert!(of(&value, "/error/interval/0") < 0.05, "{}", value["picture"]);
    // The lamp in the box is so bright that its edge is nearly all of the error; few pixels are off.
    assert!(of(&box_, "/off_by_a_step") < 0.02, "{}", box_["picture"]);
    // Limits make verdicts and exit codes.
    assert_eq!(run(here, &format!("audit compositing s.toml -o a1 {few} --max-error 50%")).0, 0);
    assert_eq!(run(here, &format!("audit compositing s.toml -o a2 {few} --max-error 0.00001")).0, 1);
}
