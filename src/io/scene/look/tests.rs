use super::super::{SceneOptions, open_scene, open_staged, open_with_look, read_lighting};
use super::*;
use crate::compositing::{Cluster, SpanFace, SpanImage};
use crate::io::image::png;
use crate::math::DVec3;
use crate::scene::{Distribution, SkyModel};
use crate::view::{Camera, Photometry};
use std::path::{Path, PathBuf};

/// A floor, a lamp of two faces of which one emits, a ceiling; `more` follows.
fn text(material: &str, more: &str) -> String {
    format!(
        "format = \"etalon-scene/1\"
[[material]]
name = \"white\"
reflectance = 0.5
{material}
[[material]]
name = \"glow\"
reflectance = 0.1
emission = [3, 2, 1]
[[surface]]
name = \"floor\"
material = \"white\"
polygon = [[0,0,0],[1,0,0],[1,1,0],[0,1,0]]
[[surface]]
name = \"lamp\"
object = \"lamp\"
material = \"glow\"
polygon = [[0,0,2],[0,1,2],[1,1,2],[1,0,2]]
[[surface]]
name = \"lid\"
object = \"lamp\"
material = \"white\"
polygon = [[0,0,2.1],[1,0,2.1],[1,1,2.1],[0,1,2.1]]
[[surface]]
name = \"side\"
object = \"lamp\"
material = \"glow\"
polygon = [[0,0,2],[1,0,2],[1,0,2.1],[0,0,2.1]]
{more}"
    )
}

struct Files {
    folder: tempfile::TempDir,
}

impl Files {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("folder");
        let rgba: Vec<u8> = (0..24).collect();
        std::fs::create_dir(folder.path().join("sub")).expect("folder");
        for name in ["a.png", "sub/b.png"] {
            std::fs::write(folder.path().join(name), png(2, 3, &rgba).expect("encodes")).expect("written");
        }
        std::fs::write(folder.path().join("no.png"), b"nothing").expect("written");
        Self { folder }
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    }

    fn staged(&self, material: &str, more: &str) -> Result<(Scene, Appearance), SceneFileError> {
        let path = self.write("s.toml", &text(material, more));
        open_staged(&path.to_string_lossy(), &SceneOptions::default())
    }
}

use crate::scene::Scene;

const EVERYTHING: &str = "
[[tree]]
name = \"oak\"
foot = [1, 2, 0]
size = [3, 4]
picture = \"sub/b.png\"
[fog]
extinction = 0.01
radiance = [0.1, 0.2, 0.3]
background_at = 100
[background]
radiance = 2
picture = \"a.png\"
sky = true
clouds = { picture = \"sub/../a.png\", height = 900, tile = [10, 20], radiance = 1 }
[[light]]
type = \"parallel\"
direction = [0, 0, -2]
irradiance = [1, 2, 3]
[[light]]
name = \"flood\"
type = \"point\"
position = [0.5, 0.5, 1]
intensity = 4
direction = [0, 3, 0]
curve = [[0, 1], [30, 0.8], [90, 0]]
[[light]]
type = \"point\"
position = [0.5, 0.5, 1]
intensity = 4
distribution = \"lambert\"
direction = [0, 0, -1]
[[light]]
type = \"linear\"
from = [0, 0, 1]
to = [1, 0, 1]
intensity = 5
[[light]]
type = \"area\"
polygon = [[0,0,1],[0,1,1],[1,1,1]]
radiosity = 6
[[light]]
name = \"by surface\"
type = \"area\"
surface = \"lamp\"
[[light]]
name = \"by object\"
type = \"polyhedron\"
object = \"lamp\"
[[light]]
name = \"all of it\"
type = \"polyhedron\"
object = \"lamp\"
radiosity = 7
[[light]]
name = \"body\"
type = \"polyhedron\"
faces = [[[0,0,1],[0,1,1],[1,1,1]], [[0,0,1],[1,1,1],[0,1,1]]]
radiosity = 8
[[light]]
type = \"sky\"
model = \"clear\"
radiance = 9
sun = [0, 4, 3]
[[light]]
type = \"sky\"
model = \"overcast\"
radiance = 9
up = [0, 0, 2]
";

const FINISH: &str = "texture = { picture = \"a.png\", tile = [1.2, 0.6], origin = [1, 2, 3] }
bump = { picture = \"sub/b.png\", tile = [1, 1], height = 0.01 }
reflection = 0.25
transparency = { share = 0.5, picture = \"a.png\", tile = [2, 2] }
refraction = 1.5";

#[test]
fn everything_is_read_as_it_is_written() {
    let files = Files::new();
    let (scene, look) = files.staged(FINISH, &EVERYTHING.replace("sub/../a.png", "./a.png")).expect("reads");
    assert!(scene.notices.iter().all(|n| !n.contains("left out")), "{:?}", scene.notices);
    // Radiosity knows one of them: that without a curve.
    assert_eq!(scene.lights.iter().map(|l| l.name.as_str()).collect::<Vec<_>>(), ["light 3"]);
    assert_eq!(
        look.pictures.iter().map(|p| (p.name.as_str(), p.size)).collect::<Vec<_>>(),
        [("a.png", [2, 3]), ("sub/b.png", [2, 3])]
    );
    assert_eq!(look.pictures[1].rgba, (0..24).collect::<Vec<u8>>());
    let f = look.finish("white").expect("finish");
    let colour = Texture { picture: 0, origin: DVec3::new(1.0, 2.0, 3.0), tile: [1.2, 0.6] };
    assert_eq!(f.colour, Some(colour));
    assert_eq!(f.bump, Some(Texture { picture: 1, origin: DVec3::ZERO, tile: [1.0, 1.0] }));
    assert_eq!((f.bump_height, f.reflection, f.transparency, f.refraction), (0.01, 0.25, 0.5, 1.5));
    assert_eq!((f.reflection_map.is_some(), f.transparency_map.as_ref().map(|t| t.picture)), (false, Some(0)));
    assert_eq!(look.finishes.len(), 1);
    let fog = Fog { extinction: 0.01, radiance: vec![0.1, 0.2, 0.3], background_at: Some(100.0) };
    assert_eq!(look.fog, Some(fog));
    let b = &look.background;
    assert_eq!((b.radiance.as_slice(), b.picture, b.sky), ([2.0; 3].as_slice(), Some(0), true));
    let clouds = b.clouds.as_ref().expect("clouds");
    assert_eq!((clouds.picture, clouds.height, clouds.tile, clouds.radiance.len()), (0, 900.0, [10.0, 20.0], 3));
    let oak = Tree {
        name: "oak".into(),
        object: "trees".into(),
        foot: DVec3::new(1.0, 2.0, 0.0),
        up: DVec3::Z,
        size: [3.0, 4.0],
        picture: 1,
    };
    assert_eq!(look.trees, [oak]);
    assert_eq!(look.lights.len(), 11);
    let shape = |k: usize| &look.lights[k].shape;
    assert_eq!(*shape(0), LightShape::Parallel { direction: -DVec3::Z });
    assert_eq!(look.lights[0].strength, [1.0, 2.0, 3.0]);
    match shape(1) {
        LightShape::Point { distribution: Distribution::Isotropic, curve: Some(c), .. } => {
            assert_eq!((c.axis, c.samples.as_slice()), (DVec3::Y, [(0.0, 1.0), (30.0, 0.8), (90.0, 0.0)].as_slice()));
        }
        other => panic!("{other:?}"),
    }
    let whole = |faces: usize| match shape(faces) {
        LightShape::Polyhedron { faces } => faces.len(),
        LightShape::Area { .. } => 1,
        other => panic!("{other:?}"),
    };
    assert_eq!((whole(4), whole(5), whole(6), whole(7), whole(8)), (1, 1, 2, 3, 2));
    assert_eq!((&look.lights[5].strength, &look.lights[6].strength), (&vec![3.0, 2.0, 1.0], &vec![3.0, 2.0, 1.0]));
    assert_eq!((look.lights[7].strength[0], look.lights[8].strength[1]), (7.0, 8.0));
    // (0, 4, 3) is 5 long; it is made 1 long by way of its largest number.
    let sun = DVec3::new(0.0, 1.0, 0.75).normalize();
    assert_eq!(*shape(9), LightShape::Sky { model: SkyModel::Clear { sun }, up: DVec3::Z });
    assert_eq!(*shape(10), LightShape::Sky { model: SkyModel::Overcast, up: DVec3::Z });
}

#[test]
fn lights_of_surfaces_go_with_their_edits() {
    let files = Files::new();
    let more = "[[light]]\ntype = \"area\"\nsurface = \"lamp\"\n[[edit]]\nmove = \"lamp\"\ntranslate = [0, 0, 1]\n[[edit]]\nremove = \"lamp\"";
    let path = files.write("s.toml", &text("", more));
    let (scene, look) = open_with_look(&path.to_string_lossy(), &SceneOptions::default()).expect("reads");
    let height = |state: usize| match &look.on(&scene.at(state).expect("stage")).expect("look").lights[0].shape {
        LightShape::Area { polygon } => polygon[0].z,
        other => panic!("{other:?}"),
    };
    assert_eq!((height(0), height(1)), (2.0, 3.0));
    // A lamp that was taken away does not shine; one that never was is a mistake.
    assert_eq!(look.on(&scene.at(2).expect("stage")).expect("dark").lights, []);
    let path = files.write("t.toml", &text("", &more.replace("surface = \"lamp\"", "surface = \"lampp\"")));
    let (scene, look) = open_with_look(&path.to_string_lossy(), &SceneOptions::default()).expect("reads");
    let e = look.on(&scene.at(0).expect("stage")).expect_err("unknown").to_string();
    assert!(e.contains("t.toml:") && e.contains("no surface \"lampp\" stands there"), "{e}");
}

#[test]
fn radiosity_passes_over_what_only_pictures_show_and_says_so_once() {
    let files = Files::new();
    let (before, _) = EVERYTHING.split_once("[[light]]").expect("lights");
    // Pictures that are not there do not matter to it.
    let path = files.write("s.toml", &text(&FINISH.replace("a.png", "gone.png"), before));
    let scene = open_scene(&path.to_string_lossy(), &SceneOptions::default()).expect("reads");
    let notices: Vec<_> = scene.notices.iter().filter(|n| n.contains("left out")).collect();
    assert_eq!(notices.len(), 1, "{notices:?}");
    assert!(notices[0].contains("1 material finish, 1 tree, fog, the background"), "{notices:?}");
    for (kind, keys) in [
        ("parallel", "direction = [0,0,-1]\nirradiance = 1"),
        ("linear", "from = [0,0,0]\nto = [0,0,1]\nintensity = 1"),
        ("area", "surface = \"lamp\""),
        ("polyhedron", "object = \"lamp\""),
        ("sky", "model = \"overcast\"\nradiance = 1"),
    ] {
        let path = files.write("s.toml", &text("", &format!("[[light]]\ntype = \"{kind}\"\n{keys}")));
        assert!(open_staged(&path.to_string_lossy(), &SceneOptions::default()).is_ok(), "{kind}");
        let e = open_scene(&path.to_string_lossy(), &SceneOptions::default()).expect_err(kind);
        assert_eq!(e.refusal(), Refusal::Reserved);
        let e = e.to_string();
        assert!(e.contains(&format!("type \"{kind}\"")) && e.contains("--lighting") && e.contains(", light"), "{e}");
    }
    let e = open_scene(&files.write("s.toml", &text("", EVERYTHING)).to_string_lossy(), &SceneOptions::default());
    assert!(e.expect_err("a curve too").to_string().contains("parallel"));
}

#[test]
fn every_refusal_names_place_and_mend() {
    let files = Files::new();
    let light = |keys: &str| format!("[[light]]\n{keys}");
    let finish = |keys: &str| (keys.to_string(), String::new());
    let more = |keys: String| (String::new(), keys);
    let cases = [
        (finish("texture = \"a.png\""), &["s.toml:5, material \"white\""][..]),
        (finish("texture = { picture = \"a.png\" }"), &["missing field `tile`", "add tile"]),
        (finish("texture = { picture = \"a.png\", tile = [1, 0] }"), &[":5, material", "both greater than zero"]),
        (finish("texture = { picture = \"a.png\", tile = [1] }"), &["[breadth, height]"]),
        (finish("texture = { picture = \"a.png\", tile = [1, 1], orgin = [0,0,0] }"), &["did you mean \"origin\""]),
        (finish("texture = { picture = \"../a.png\", tile = [1, 1] }"), &["leaves the scene's folder", "beside"]),
        (finish("texture = { picture = \"/etc/x.png\", tile = [1, 1] }"), &["leaves the scene's folder"]),
        (finish("texture = { picture = \"gone.png\", tile = [1, 1] }"), &["no such file", "check the name"]),
        (finish("texture = { picture = \"no.png\", tile = [1, 1] }"), &["no sound PNG", "save it as PNG"]),
        (finish("texture = { picture = \"sub\", tile = [1, 1] }"), &["it is a folder"]),
        (finish("bump = { picture = \"a.png\", tile = [1, 1] }"), &["missing field `height`"]),
        (finish("bump = { picture = \"a.png\", tile = [1, 1], height = nan }"), &["height is NaN"]),
        (finish("reflection = 1.5"), &["outside [0, 1]", ":5"]),
        (finish("reflection = \"much\""), &["a number or a table"]),
        (finish("reflection = { share = -1, picture = \"a.png\", tile = [1, 1] }"), &["reflection -1 is outside"]),
        (finish("reflection = { shore = 1, picture = \"a.png\", tile = [1, 1] }"), &["did you mean \"share\""]),
        (finish("reflection = 0.6\ntransparency = 0.5"), &["more than all light", ":6"]),
        (finish("refraction = 0"), &["refractive index", "glass"]),
        (finish("specular = 1"), &["material.specular is reserved"]),
        (more("[fog]\nextinction = -1\nradiance = 1".into()), &["extinction -1 is negative", "visibility"]),
        (more("[fog]\nextinction = 1\nradiance = [1, 2]".into()), &["radiance has 2 numbers"]),
        (more("[fog]\nextinction = 1\nradiance = -1".into()), &["radiance -1 is negative"]),
        (more("[fog]\nextinction = 1\nradiance = 1\nbackground_at = 0".into()), &["background_at is 0"]),
        (more("[background]\npicture = \"a.png\"".into()), &["has no radiance", "white"]),
        (more("[background]\nclouds = { picture = \"a.png\", height = 1, tile = [1, 1] }".into()), &["`radiance`"]),
        (
            more("[[tree]]\nname = \"t\"\nfoot = [0, 0]\nsize = [1, 1]\npicture = \"a.png\"".into()),
            &[", tree \"t\"", "three"],
        ),
        (more("[[tree]]\nname = \"t\"\nfoot = [0,0,0]\nsize = [1, -1]\npicture = \"a.png\"".into()), &["size is"]),
        (
            more("[[tree]]\nname = \"t\"\nfoot = [0,0,0]\nsize = [1, 1]\npicture = \"a.png\"\nup = [0,0,0]".into()),
            &["up has no direction"],
        ),
        (more(light("type = \"paralel\"")), &["did you mean \"parallel\"", ", light"]),
        (more(light("type = \"parallel\"\nirradiance = 1")), &["needs direction", "add direction"]),
        (more(light("type = \"parallel\"\ndirection = [0,0,1]")), &["needs irradiance"]),
        (
            more(light("type = \"parallel\"\ndirection = [0,0,1]\nintensity = 1")),
            &["has no intensity", "direction, irradiance"],
        ),
        (more(light("type = \"parallel\"\ndirection = [0,0,1]\nirradiance = -1")), &["irradiance -1 is negative"]),
        (more(light("type = \"point\"\nintensity = 1\nposition = [0,0,0]\ncurve = [[0, 1]]")), &["needs direction"]),
        (
            more(light("type = \"point\"\nintensity = 1\nposition = [0,0,0]\ndirection = [0,0,1]\ncurve = []")),
            &["curve is empty"],
        ),
        (
            more(light("type = \"point\"\nintensity = 1\nposition = [0,0,0]\ndirection = [0,0,1]\ncurve = [[1, 1]]")),
            &["goes wrong at [1.0, 1.0]"],
        ),
        (
            more(light(
                "type = \"point\"\nintensity = 1\nposition = [0,0,0]\ndirection = [0,0,1]\ncurve = [[0, 1], [30, 1], [20, 1]]",
            )),
            &["goes wrong at [20.0"],
        ),
        (
            more(light(
                "type = \"point\"\nintensity = 1\nposition = [0,0,0]\ndirection = [0,0,1]\ncurve = [[0, 1], [200, 1]]",
            )),
            &["goes wrong at [200.0"],
        ),
        (
            more(light(
                "type = \"point\"\nintensity = 1\nposition = [0,0,0]\ndirection = [0,0,1]\ncurve = [[0, 1], [9, -1]]",
            )),
            &["at [9.0, -1.0]"],
        ),
        (
            more(light("type = \"point\"\nintensity = 1\nposition = [0,0,0]\ndirection = [0,0,1]")),
            &["an isotropic light has no direction"],
        ),
        (more(light("type = \"linear\"\nfrom = [0,0,0]\nto = [0,0,0]\nintensity = 1")), &["the same point"]),
        (more(light("type = \"area\"\nradiosity = 1")), &["needs one of polygon, surface"]),
        (
            more(light("type = \"area\"\nsurface = \"lamp\"\npolygon = [[0,0,1],[0,1,1],[1,1,1]]\nradiosity = 1")),
            &["say once what shines"],
        ),
        (more(light("type = \"area\"\npolygon = [[0,0,1],[0,1,1],[1,1,1]]")), &["needs radiosity"]),
        (more(light("type = \"area\"\npolygon = [[0,0,1],[0,1,1]]\nradiosity = 1")), &["2 vertices"]),
        (more(light("type = \"area\"\nsurface = \"lamb\"")), &["no surface \"lamb\"", "did you mean \"lamp\""]),
        (more(light("type = \"area\"\nsurface = \"floor\"")), &["emits nothing", "radiosity"]),
        (more(light("type = \"area\"\nobject = \"lamp\"")), &["has no object"]),
        (more(light("type = \"polyhedron\"\nobject = \"scene\"")), &["the object \"scene\" emits nothing"]),
        (more(light("type = \"polyhedron\"\nfaces = []\nradiosity = 1")), &["needs one of faces, surface, object"]),
        (more(light("type = \"sky\"\nradiance = 1")), &["needs model"]),
        (
            more(light("type = \"sky\"\nradiance = 1\nmodel = \"cloudy\"")),
            &["no model of the sky \"cloudy\"", "overcast"],
        ),
        (more(light("type = \"sky\"\nradiance = 1\nmodel = \"clear\"")), &["needs sun"]),
        (more(light("type = \"sky\"\nradiance = 1\nmodel = \"clear\"\nsun = [0,0,-1]")), &["below the horizon"]),
        (more(light("type = \"sky\"\nradiance = 1\nmodel = \"uniform\"\nsun = [0,0,1]")), &["has no sun"]),
        (
            more(light(
                "name = \"light 2\"\ntype = \"area\"\nsurface = \"lamp\"\n[[light]]\ntype = \"area\"\nsurface = \"lamp\"",
            )),
            &["a second light \"light 2\""],
        ),
    ];
    for ((material, more), says) in cases {
        let e = files.staged(&material, &more).expect_err(&format!("{material}{more}")).to_string();
        assert!(e.starts_with("s.toml:") && e.contains("; "), "{material}{more}: {e}");
        says.iter().for_each(|s| assert!(e.contains(s), "{material}{more}: {e} has no {s}"));
    }
}

fn span_image() -> SpanImage {
    let camera = Camera { name: "c".into(), eye: DVec3::ZERO, target: DVec3::Y, up: DVec3::Z, fov: 60.0, size: [2, 1] };
    let face = |name: &str, k: u32, cluster: u32, material: u32| SpanFace {
        key: (name.into(), k),
        vertices: vec![DVec3::Y, DVec3::Y + DVec3::X, DVec3::Y + DVec3::Z],
        material,
        cluster,
        two_sided: false,
        tree: None,
    };
    let material = |name: &str, e: f64| crate::scene::Material {
        name: name.into(),
        reflectance: vec![0.5; 3],
        emission: vec![e; 3],
    };
    let cluster = |objects: &[&str]| Cluster {
        name: objects.join("+"),
        objects: objects.iter().map(|o| o.to_string()).collect(),
        hash: String::new(),
    };
    SpanImage {
        camera,
        per_line: 1,
        photometry: Photometry::rec709(),
        materials: vec![material("white", 0.0), material("glow", 2.0)],
        clusters: vec![cluster(&["a", "b"]), cluster(&["lamp"])],
        faces: vec![face("lamp/bulb", 0, 1, 1), face("lamp/foot", 0, 1, 0), face("wall", 0, 0, 0)],
        appearance: Appearance::default(),
        lines: vec![Default::default(); 2],
    }
}

fn lighting(files: &Files, body: &str) -> Result<Look, SceneFileError> {
    let path = files.write("night.toml", &format!("format = \"etalon-lighting/1\"\n{body}"));
    read_lighting(&path, &Photometry::rec709().bands)
}

#[test]
fn a_lighting_file_takes_the_place_of_what_it_speaks_of() {
    let files = Files::new();
    let (_, day) = files.staged(FINISH, &EVERYTHING.replace("sub/../", "")).expect("reads");
    let image = span_image();
    let night = lighting(&files, "[[light]]\ntype = \"area\"\nsurface = \"lamp\"\n[fog]\nextinction = 1\nradiance = 0");
    let look = night.expect("reads").over(&day, &image).expect("fits");
    assert_eq!((look.lights.len(), look.lights[0].strength.as_slice()), (1, [2.0; 3].as_slice()));
    assert!(matches!(&look.lights[0].shape, LightShape::Area { polygon } if *polygon == image.faces[0].vertices));
    assert_eq!(look.fog.map(|f| f.extinction), Some(1.0));
    assert_eq!((&look.background, &look.finishes, &look.trees), (&day.background, &day.finishes, &day.trees));

    let body = "light = []\n[background]\nradiance = 1\npicture = \"a.png\"\n[[finish]]\nmaterial = \"white\"\nreflection = 0.5\n\
                [[finish]]\nmaterial = \"glow\"\ntexture = { picture = \"a.png\", tile = [1, 1] }";
    let look = lighting(&files, body).expect("reads").over(&day, &image).expect("fits");
    assert!(look.lights.is_empty() && look.fog == day.fog && look.finishes.len() == 2);
    let finish = look.finish("white").expect("finish");
    assert_eq!((finish.reflection, &finish.colour, finish.refraction), (0.5, &None, 1.0));
    let picture = look.finish("glow").and_then(|f| f.colour.as_ref()).map(|t| t.picture);
    assert_eq!(picture, look.background.picture);
    assert_eq!(look.pictures[picture.expect("a picture")].name, "a.png");
    assert!(look.background.clouds.is_none() && !look.background.sky);
    // Everything the file says, over nothing.
    assert!(lighting(&files, "").expect("reads").on(&image).expect("fits") == Appearance::default());
}

#[test]
fn lighting_that_does_not_fit_is_refused() {
    let files = Files::new();
    let image = span_image();
    let refused = |body: &str| match lighting(&files, body) {
        Ok(look) => look.on(&image).expect_err(body).to_string(),
        Err(e) => e.to_string(),
    };
    for (body, says) in [
        ("[[finish]]\nmaterial = \"whte\"\nreflection = 1", "did you mean \"white\""),
        ("[[finish]]\nmaterial = \"white\"\n[[finish]]\nmaterial = \"white\"", "a second finish"),
        ("[[light]]\ntype = \"polyhedron\"\nobject = \"a\"", "no object \"a\" stands there by itself"),
        ("[[light]]\ntype = \"area\"\nsurface = \"wal\"", "did you mean \"wall\""),
        ("[[tree]]\nname = \"t\"", "unknown field `tree`"),
        ("[[material]]\nname = \"t\"", "unknown field `material`"),
    ] {
        let e = refused(body);
        assert!(e.starts_with("night.toml:") && e.contains(says), "{body}: {e}");
    }
    let object = "[[light]]\ntype = \"polyhedron\"\nobject = \"lamp\"";
    assert_eq!(lighting(&files, object).expect("reads").on(&image).expect("fits").lights.len(), 1);
    let path = files.write("night.toml", "format = \"etalon-lighting/2\"\nmoon = 1");
    let e = read_lighting(&path, &[]).expect_err("newer").to_string();
    assert!(e.contains("newer") && e.contains("etalon-lighting/1"), "{e}");
    let path = files.write("night.toml", "format = \"etalon-scene/1\"");
    assert!(read_lighting(&path, &[]).expect_err("a scene").to_string().contains("unknown format"));
    let e = read_lighting(Path::new("nowhere.toml"), &[]).expect_err("missing").to_string();
    assert!(e.contains("no such file") && e.contains("etalon-lighting/1"), "{e}");
    let other = read_lighting(&files.write("n.toml", "format = \"etalon-lighting/1\""), &["y".into()]).expect("reads");
    assert!(other.on(&image).expect_err("bands").to_string().contains("for the bands y"));
}

#[test]
fn scenes_without_words_for_pictures_have_their_point_lights() {
    let (scene, look) = open_staged("builtin:furnace", &SceneOptions::default()).expect("reads");
    assert_eq!((scene.lights.len(), look), (0, Appearance::default()));
    let files = Files::new();
    let path = files.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let (_, look) = open_staged(&path.to_string_lossy(), &SceneOptions::default()).expect("reads");
    assert_eq!(look, Appearance::default());
    assert!(open_staged("builtin:furnce", &SceneOptions::default()).is_err());
}
