//! Scenes built in code, and the exact values the program is held to.
#![allow(dead_code)] // Each test uses its own part.

use etalon::math::DVec3;
use etalon::raycast::KernelKind;
use etalon::scene::{Face, Grid, Material, Scene, Stage, Surface};
use etalon::view::Photometry;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A file under `references/`.
pub fn reference_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("references").join(name)
}

/// The cases of a truth file.
pub fn truth_cases(name: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(reference_file("truth").join(name)).expect("the truth file is there");
    let root: Value = serde_json::from_str(&text).expect("the truth file is JSON");
    root["cases"].as_array().expect("cases").clone()
}

/// A number that a truth file holds as text or as number.
pub fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| v.as_str().expect("a number or its text").parse().expect("digits"))
}

/// Vertices of a polygon.
pub fn vertices(v: &Value) -> Vec<DVec3> {
    let point = |p: &Value| DVec3::new(number(&p[0]), number(&p[1]), number(&p[2]));
    v["vertices"].as_array().expect("vertices").iter().map(point).collect()
}

/// A scene of one-patch polygons with a reflectance and an emission each, in bands of equal weight.
pub struct Polygons {
    scene: Scene,
}

impl Polygons {
    pub fn new(bands: usize) -> Self {
        let photometry = if bands == 3 {
            Photometry::rec709()
        } else {
            Photometry { bands: (0..bands).map(|b| format!("b{b}")).collect(), weights: vec![1.0; bands] }
        };
        let scene = Scene {
            name: "test".into(),
            photometry,
            enclosure: None,
            materials: Vec::new(),
            surfaces: Vec::new(),
            absent: Vec::new(),
            edits: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            receivers: Vec::new(),
            notices: Vec::new(),
        };
        Self { scene }
    }

    /// Adds a polygon divided into `grid`.
    pub fn add(&mut self, corners: Vec<DVec3>, grid: Grid, reflectance: &[f64], emission: &[f64]) -> &mut Self {
        let k = self.scene.surfaces.len();
        let (reflectance, emission) = (reflectance.to_vec(), emission.to_vec());
        self.scene.materials.push(Material { name: format!("m{k}"), reflectance, emission });
        let elements = match corners.len() {
            3 => Grid::Triangle { n: 1 },
            4 => Grid::Quad { na: 1, nb: 1 },
            _ => Grid::Whole,
        };
        let face =
            Face { vertices: corners, material: k as u32, patches: grid, elements, two_sided: false, group: None };
        self.scene.surfaces.push(Surface {
            name: format!("s{k}"),
            object: format!("o{k}"),
            faces: vec![face],
            groups: Vec::new(),
            from_mesh: true,
        });
        self
    }

    /// Adds a black polygon of one patch.
    pub fn black(&mut self, corners: Vec<DVec3>) -> &mut Self {
        let zeros = vec![0.0; self.scene.photometry.bands.len()];
        let grid = one_patch(&corners);
        self.add(corners, grid, &zeros, &zeros)
    }

    pub fn stage(&self) -> Stage {
        self.scene.at(0).expect("a sound scene")
    }
}

/// The undivided grid of a polygon.
pub fn one_patch(corners: &[DVec3]) -> Grid {
    match corners.len() {
        3 => Grid::Triangle { n: 1 },
        4 => Grid::Quad { na: 1, nb: 1 },
        _ => Grid::Whole,
    }
}

/// Faces of the unit cube seen from inside, in the order z=0, z=1, x=0, x=1, y=0, y=1.
pub fn unit_cube() -> [Vec<DVec3>; 6] {
    let p = |x: u8, y: u8, z: u8| DVec3::new(x.into(), y.into(), z.into());
    [
        vec![p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)],
        vec![p(0, 0, 1), p(0, 1, 1), p(1, 1, 1), p(1, 0, 1)],
        vec![p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1)],
        vec![p(1, 0, 0), p(1, 0, 1), p(1, 1, 1), p(1, 1, 0)],
        vec![p(0, 0, 0), p(0, 0, 1), p(1, 0, 1), p(1, 0, 0)],
        vec![p(0, 1, 0), p(1, 1, 0), p(1, 1, 1), p(0, 1, 1)],
    ]
}

/// Kernels to test: the built-in always, Embree where there is one.
pub fn kernels() -> Vec<KernelKind> {
    let any = Polygons::new(1).black(unit_cube()[0].clone()).stage();
    match etalon::raycast::open_kernel(KernelKind::Embree, &any) {
        Ok(_) => vec![KernelKind::Embree, KernelKind::Builtin],
        Err(e) => {
            eprintln!("notice: Embree is left out: {e}");
            vec![KernelKind::Builtin]
        }
    }
}

/// Progress that nobody watches.
pub struct Silent;

impl etalon::reference::Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}
