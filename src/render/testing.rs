//! Small real scenes and a brute-force kernel for the tests of pictures and reports.

use crate::math::{Bilinear, DVec3, area, triangle_cell_corners, unit_normal};
use crate::raycast::{KernelInfo, RayBatch, RayKernel, Tracer};
use crate::scene::{Element, Facet, Grid, Material, NO_FACET, Patch, Region, Stage, StageSurface};
use crate::solution::Radiosity;
use crate::view::{Camera, Photometry};
use std::sync::Arc;

/// Tries every facet, in double precision.
struct BruteForce {
    info: KernelInfo,
    facets: Vec<Facet>,
}

impl RayKernel for BruteForce {
    fn info(&self) -> &KernelInfo {
        &self.info
    }

    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        for k in 0..rays.len() {
            let (o, d) = (rays.origin_of(k), rays.direction_of(k));
            let hits = self.facets.iter().enumerate().filter_map(|(f, facet)| Some((distance(facet, o, d)?, f as u32)));
            facets[k] = hits.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(NO_FACET, |(_, f)| f);
        }
    }
}

fn distance(facet: &Facet, o: DVec3, d: DVec3) -> Option<f64> {
    let (v, n) = (&facet.vertices, facet.normal);
    let t = n.dot(v[0] - o) / n.dot(d);
    let p = o + d * t;
    let inside = (0..v.len()).all(|i| n.cross(v[(i + 1) % v.len()] - v[i]).dot(p - v[i]) >= 0.0);
    (t > 0.0 && inside).then_some(t)
}

/// A tracer on the brute-force kernel.
pub(crate) fn tracer(stage: &Stage) -> Tracer<'_> {
    let info = KernelInfo { name: "brute force".into(), version: "1".into(), path: None, instruction_set: None };
    let kernel = Arc::new(BruteForce { info, facets: stage.facets.clone() });
    Tracer::new(stage, kernel.clone(), kernel, false)
}

/// Builds stages surface by surface.
struct Builder(Stage);

impl Builder {
    fn new(name: &str, materials: &[(&str, [f64; 3], f64)]) -> Self {
        let material = |&(name, rho, e): &(&str, [f64; 3], f64)| Material {
            name: name.into(),
            reflectance: rho.to_vec(),
            emission: [1.0, 0.9, 0.7].map(|c| c * e).to_vec(),
        };
        Self(Stage {
            name: name.into(),
            state: 0,
            photometry: Photometry::rec709(),
            enclosure: None,
            materials: materials.iter().map(material).collect(),
            surfaces: Vec::new(),
            facets: Vec::new(),
            patches: Vec::new(),
            elements: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            receivers: Vec::new(),
        })
    }

    fn surface(&mut self, name: &str, material: u32, vertices: &[[f64; 3]], grid: Grid, two_sided: bool) -> &mut Self {
        let vertices: Vec<DVec3> = vertices.iter().map(|v| DVec3::from_array(*v)).collect();
        let stage = &mut self.0;
        let (surface, facet) = (stage.surfaces.len() as u32, stage.facets.len() as u32);
        let first_patch = stage.patches.len() as u32;
        stage.surfaces.push(StageSurface { name: name.into(), object: "scene".into() });
        for back in [false, true].into_iter().take(1 + usize::from(two_sided)) {
            for number in 0..grid.count() {
                let (a, b) = grid.place(number);
                let mut corners = cell_corners(&vertices, grid, a, b);
                if back {
                    corners.reverse();
                }
                stage.push(Cell { surface, material, facet, a, b, corners });
            }
        }
        stage.facets.push(Facet {
            normal: unit_normal(&vertices),
            vertices,
            surface,
            grid,
            elements: Grid::Whole,
            first_patch,
            first_back_patch: two_sided.then_some(first_patch + grid.count() as u32),
            twins: Vec::new(),
        });
        self
    }
}

struct Cell {
    surface: u32,
    material: u32,
    facet: u32,
    a: u32,
    b: u32,
    corners: Vec<DVec3>,
}

trait PushPatch {
    fn push(&mut self, cell: Cell);
}

impl PushPatch for Stage {
    fn push(&mut self, Cell { surface, material, facet, a, b, corners }: Cell) {
        let n = self.patches.len() as u32;
        let (size, region) = (area(&corners), Region::whole(corners.clone()));
        self.elements.push(Element {
            patch: n,
            a: 0,
            b: 0,
            corners: corners.clone(),
            area: size,
            region: region.clone(),
        });
        let normal = unit_normal(&corners);
        self.patches.push(Patch {
            surface,
            material,
            facet,
            a,
            b,
            corners,
            normal,
            area: size,
            region,
            elements: n..n + 1,
        });
    }
}

fn cell_corners(v: &[DVec3], grid: Grid, a: u32, b: u32) -> Vec<DVec3> {
    match grid {
        Grid::Quad { na, nb } => Bilinear::new([v[0], v[1], v[2], v[3]]).cell(a, b, na, nb).to_vec(),
        Grid::Triangle { n } => triangle_cell_corners([v[0], v[1], v[2]], n, a, b).to_vec(),
        Grid::Whole => v.to_vec(),
    }
}

fn quad(na: u32, nb: u32) -> Grid {
    Grid::Quad { na, nb }
}

/// A closed room of 3 x 4 x 2.4 m with a ceiling lamp and a two-sided triangular sail.
pub(crate) fn room() -> Stage {
    let mut b = Builder::new(
        "little room",
        &[
            ("white", [0.75, 0.75, 0.73], 0.0),
            ("red", [0.6, 0.08, 0.06], 0.0),
            ("blue", [0.1, 0.2, 0.55], 0.0),
            ("lamp", [0.7, 0.7, 0.7], 20.0),
        ],
    );
    let (x, y, z) = (3.0, 4.0, 2.4);
    b.surface("floor", 0, &[[0., 0., 0.], [x, 0., 0.], [x, y, 0.], [0., y, 0.]], quad(12, 16), false);
    b.surface("ceiling", 0, &[[0., 0., z], [0., y, z], [x, y, z], [x, 0., z]], quad(8, 6), false);
    b.surface("back wall", 0, &[[x, y, 0.], [x, y, z], [0., y, z], [0., y, 0.]], quad(8, 10), false);
    b.surface("front wall", 0, &[[0., 0., 0.], [0., 0., z], [x, 0., z], [x, 0., 0.]], quad(6, 6), false);
    b.surface("red wall", 1, &[[0., 0., 0.], [0., y, 0.], [0., y, z], [0., 0., z]], quad(10, 8), false);
    b.surface("blue wall", 2, &[[x, 0., 0.], [x, 0., z], [x, y, z], [x, y, 0.]], quad(8, 10), false);
    let lamp = [[1.0, 1.6, 2.39], [1.0, 2.4, 2.39], [2.0, 2.4, 2.39], [2.0, 1.6, 2.39]];
    b.surface("lamp", 3, &lamp, quad(2, 2), false);
    let sail = [[0.5, 2.6, 0.4], [1.5, 3.2, 0.5], [0.8, 2.9, 1.7]];
    b.surface("sail", 0, &sail, Grid::Triangle { n: 5 }, true);
    b.0.cameras.push(Camera {
        name: "main".into(),
        eye: DVec3::new(2.4, 0.25, 1.5),
        target: DVec3::new(1.3, 3.0, 1.0),
        up: DVec3::Z,
        fov: 68.0,
        size: [160, 120],
    });
    b.0
}

/// A square of four patches in the plane z = 0, front up or, turned, down. No camera.
pub(crate) fn plate(turned: bool) -> Stage {
    let mut b = Builder::new("plate", &[("white", [0.5; 3], 1.0)]);
    let mut v = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    if turned {
        v.reverse();
    }
    b.surface("plate", 0, &v, quad(2, 2), false);
    b.0
}

/// Emission plus what the lamps send directly, unobstructed, to the middle of each patch: Lambert's formula for a
/// polygon, B = E + rho E_lamp F. With `coarse` each lamp is a point in its middle instead: a method with an error.
/// Standard errors of 0.4 % of the reflected light, more in the dark.
pub(crate) fn direct_light(stage: &Stage, coarse: bool) -> Radiosity {
    let bands = stage.band_count();
    let (mut values, mut errors) = (Vec::new(), Vec::new());
    for i in 0..stage.patch_count() {
        let factor: f64 =
            lamps(stage).map(|j| if coarse { point_factor(stage, i, j) } else { lambert(stage, i, j) }).sum();
        for c in 0..bands {
            let lamp = lamps(stage).next().map_or(0.0, |j| stage.emission(j)[c]);
            let reflected = stage.reflectance(i)[c] * lamp * factor;
            values.push(stage.emission(i)[c] + reflected);
            errors.push(if stage.emission(i)[c] > 0.0 { 0.0 } else { 0.004 * reflected + 0.002 });
        }
    }
    Radiosity { bands, values, std_err: (!coarse).then_some(errors) }
}

fn lamps(stage: &Stage) -> impl Iterator<Item = usize> + '_ {
    (0..stage.patch_count()).filter(|j| stage.emission(*j)[0] > 0.0)
}

fn middle(patch: &Patch) -> DVec3 {
    patch.region.centroid().unwrap_or_default()
}

/// Form factor from the middle of patch i to polygon j, wholly in front of it or not at all.
fn lambert(stage: &Stage, i: usize, j: usize) -> f64 {
    let (from, to) = (&stage.patches[i], &stage.patches[j]);
    let p = middle(from);
    let seen: Vec<DVec3> = crate::math::clip_to_half_space(&to.corners, from.normal, from.normal.dot(p) + 1e-9);
    if to.normal.dot(p - to.corners[0]) <= 0.0 || seen.len() < 3 {
        return 0.0;
    }
    let edge = |k: usize| {
        let (a, b) = ((seen[k] - p).normalize(), (seen[(k + 1) % seen.len()] - p).normalize());
        a.cross(b).normalize_or_zero().dot(from.normal) * a.angle_between(b)
    };
    (0..seen.len()).map(edge).sum::<f64>().abs() / (2.0 * std::f64::consts::PI)
}

/// The same with all of polygon j in its middle.
fn point_factor(stage: &Stage, i: usize, j: usize) -> f64 {
    let (from, to) = (&stage.patches[i], &stage.patches[j]);
    let r = middle(to) - middle(from);
    if i == j {
        return 0.0;
    }
    let cosines = (from.normal.dot(r).max(0.0), to.normal.dot(-r).max(0.0));
    cosines.0 * cosines.1 * to.area / (std::f64::consts::PI * r.length_squared().powi(2))
}
