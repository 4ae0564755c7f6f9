//! Dense solutions with a shooter's own rays, and a scene with objects to edit.
#![allow(dead_code)]

use etalon::KernelKind;
use etalon::estimate::HitCounts;
use etalon::math::DVec3;
use etalon::methods::gather;
use etalon::methods::shooting::{Factors, LogEntry, Params, Shooting, Stop};
use etalon::raycast::specimen::{Numbers, box_polygons};
use etalon::raycast::{RayKernel, Tracer, open_kernels};
use etalon::scene::{Edit, Face, Grid, Material, Scene, Stage, Surface, Transform};
use etalon::view::Photometry;
use std::collections::BTreeMap;
use std::sync::Arc;

pub const SEED: u64 = 5;
pub const RAYS: u64 = 128;
pub const RANDOMISATIONS: u16 = 8;

pub fn params() -> Params {
    let stop = Stop { unshot: 1e-13, shots: None, seconds: None, error: None };
    let factors = Factors::Rays { rays: RAYS, randomisations: RANDOMISATIONS };
    // The gather method knows no lamps with more rays.
    Params { factors, stop, lamps: 1, ..Params::default() }
}

pub fn surface(
    name: &str,
    object: &str,
    polygons: Vec<Vec<DVec3>>,
    material: u32,
    patches: u32,
    elements: u32,
) -> Surface {
    let square = |n: u32| Grid::Quad { na: n, nb: n };
    let face = |vertices| Face {
        vertices,
        material,
        patches: square(patches),
        elements: square(elements),
        two_sided: false,
        group: None,
    };
    Surface {
        name: name.into(),
        object: object.into(),
        faces: polygons.into_iter().map(face).collect(),
        groups: Vec::new(),
        from_mesh: false,
    }
}

/// A room of 24 patches and 96 elements, a lamp under its ceiling, and three objects: a box on the floor, a box in the
/// air that shines, and a thin plate of two faces.
pub fn scene() -> Scene {
    let p = DVec3::new;
    let material = |name: &str, reflectance: [f64; 3], emission: [f64; 3]| Material {
        name: name.into(),
        reflectance: reflectance.to_vec(),
        emission: emission.to_vec(),
    };
    let plate = vec![p(0.1, 0.1, 0.7), p(0.5, 0.1, 0.7), p(0.5, 0.6, 0.7), p(0.1, 0.6, 0.7)];
    let back: Vec<DVec3> = plate.iter().rev().copied().collect();
    let lamp = vec![p(0.4, 0.4, 0.999), p(0.4, 0.6, 0.999), p(0.6, 0.6, 0.999), p(0.6, 0.4, 0.999)];
    Scene {
        name: "random".into(),
        photometry: Photometry { bands: ["r", "g", "b"].map(String::from).to_vec(), weights: vec![0.3, 0.6, 0.1] },
        enclosure: None,
        materials: vec![
            material("walls", [0.7, 0.6, 0.5], [0.0; 3]),
            material("lamp", [0.2; 3], [10.0, 12.0, 9.0]),
            material("box", [0.4, 0.3, 0.8], [0.0; 3]),
            material("glow", [0.5, 0.5, 0.2], [1.0, 0.5, 2.0]),
            material("plate", [0.8, 0.1, 0.3], [0.0; 3]),
        ],
        surfaces: vec![
            surface("room", "scene", box_polygons(DVec3::ZERO, DVec3::ONE, true), 0, 2, 2),
            surface("lamp", "scene", vec![lamp], 1, 1, 1),
            surface("box", "box", box_polygons(p(0.55, 0.1, 0.0), p(0.85, 0.4, 0.3), false), 2, 1, 2),
            surface("glow", "glow", box_polygons(p(0.2, 0.6, 0.4), p(0.35, 0.75, 0.5), false), 3, 1, 1),
            surface("plate", "plate", vec![plate, back], 4, 1, 2),
        ],
        absent: vec!["glow".into()],
        edits: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        receivers: Vec::new(),
        notices: Vec::new(),
    }
}

/// Numbers in 0 .. n.
pub fn below(n: &mut Numbers, count: usize) -> usize {
    ((n.unit() * count as f64) as usize).min(count - 1)
}

pub fn random_edit(n: &mut Numbers, there: &BTreeMap<&'static str, bool>) -> Edit {
    let objects = ["box", "glow", "plate"];
    let object = objects[below(n, 3)];
    let motion = |n: &mut Numbers| Transform {
        axis: n.direction(),
        angle: [0.0, n.between(-1.0, 1.0)][below(n, 2)],
        about: n.point(DVec3::splat(0.3), DVec3::splat(0.6)),
        translate: n.point(DVec3::splat(-0.1), DVec3::splat(0.1)),
    };
    match below(n, 6) {
        0 | 1 if there[object] => Edit::Remove { object: object.into() },
        0 | 1 => Edit::Add { object: object.into() },
        2 | 3 => Edit::Move { object: object.into(), transform: motion(n) },
        4 => Edit::Reshape {
            object: object.into(),
            scale: n.point(DVec3::splat(0.6), DVec3::splat(1.3)),
            about: n.point(DVec3::splat(0.3), DVec3::splat(0.6)),
        },
        _ => {
            let any = |n: &mut Numbers, most: f64| {
                let dark = below(n, 3) == 0;
                (0..3).map(|_| if dark { 0.0 } else { n.between(0.0, most) }).collect::<Vec<f64>>()
            };
            let material = below(n, 5) as u32;
            let reflectance = (below(n, 3) > 0).then(|| any(n, 0.7));
            Edit::Material { material, emission: (below(n, 2) > 0).then(|| any(n, 5.0)), reflectance }
        }
    }
}

/// Rows of all patches by the gather method.
pub fn rows(stage: &Stage, kernel: KernelKind, enclosure: bool) -> HitCounts {
    let kernels = open_kernels(kernel, stage).unwrap();
    let exact: Arc<dyn RayKernel> = kernels.exact;
    let tracer = Tracer::new(stage, kernels.kernel, exact, enclosure);
    let params = gather::Params { rays: RAYS, randomisations: RANDOMISATIONS, ..gather::Params::default() };
    gather::form_factors(&tracer, &params, SEED, &|_| ()).counts
}

/// F_ij of all patches, dense.
pub fn dense(counts: &HitCounts) -> Vec<Vec<f64>> {
    let f = counts.form_factors();
    let n = counts.rows.len();
    (0..n).map(|i| (0..n).map(|j| f.get(i, j)).collect()).collect()
}

/// Solves `(I - rho G) B = E` band by band.
pub fn solve(stage: &Stage, f: &[Vec<f64>]) -> Vec<f64> {
    let emission: Vec<f64> = (0..stage.patch_count()).flat_map(|i| stage.emission(i).to_vec()).collect();
    solve_for(stage, f, &emission)
}

/// Solves `(I - rho G) x = y` band by band.
pub fn solve_for(stage: &Stage, f: &[Vec<f64>], y: &[f64]) -> Vec<f64> {
    let (n, bands) = (stage.patch_count(), stage.band_count());
    let mut out = vec![0.0; n * bands];
    for c in 0..bands {
        let present: Vec<usize> = (0..n).filter(|i| stage.patches[*i].is_present()).collect();
        let area = |i: usize| stage.patches[i].area;
        let mut a: Vec<Vec<f64>> = present
            .iter()
            .map(|i| {
                let mut row: Vec<f64> = present
                    .iter()
                    .map(|j| f64::from(u8::from(i == j)) - stage.reflectance(*i)[c] * area(*j) * f[*j][*i] / area(*i))
                    .collect();
                row.push(y[i * bands + c]);
                row
            })
            .collect();
        let m = present.len();
        for k in 0..m {
            let pivot = (k..m).max_by(|x, y| a[*x][k].abs().total_cmp(&a[*y][k].abs())).unwrap();
            a.swap(k, pivot);
            for r in 0..m {
                if r != k && a[r][k] != 0.0 {
                    let q = a[r][k] / a[k][k];
                    let from = a[k].clone();
                    (k..=m).for_each(|x| a[r][x] -= q * from[x]);
                }
            }
        }
        for (k, i) in present.iter().enumerate() {
            out[i * bands + c] = a[k][m] / a[k][k];
        }
    }
    out
}

/// Form factors of every state that the solver has been in, by state.
pub struct Known {
    pub kernel: KernelKind,
    pub enclosure: bool,
    pub states: BTreeMap<usize, Vec<Vec<f64>>>,
}

impl Known {
    pub fn of(&mut self, state: usize, stage: &Stage) -> &Vec<Vec<f64>> {
        let (kernel, enclosure) = (self.kernel, self.enclosure);
        self.states.entry(state).or_insert_with(|| dense(&rows(stage, kernel, enclosure)))
    }
}

/// The invariant `P = sum over versions of F_v^T Q_v`, and with nothing in the log `B = E + rho F (B - U)`. Returns
/// the largest gap relative to the largest power shot.
pub fn invariant_gap(solver: &Shooting, known: &mut Known) -> f64 {
    let stage = solver.stage().clone();
    let (n, bands) = (stage.patch_count(), stage.band_count());
    let (b, u, log) = (solver.radiosity(), solver.unshot(), solver.log());
    let now = known.of(solver.state(), &stage).clone();
    let mut arrived = vec![0.0; n * bands];
    let mut shot: Vec<f64> =
        (0..n * bands).map(|k| stage.patches[k / bands].area * (b.values[k] - u.values[k])).collect();
    for LogEntry { state, patches, .. } in &log {
        let then = &known.states[state];
        for (j, power) in patches {
            for c in 0..bands {
                shot[j * bands + c] -= power[c];
                (0..n).for_each(|i| arrived[i * bands + c] += then[*j][i] * power[c]);
            }
        }
    }
    for j in (0..n).filter(|j| stage.patches[*j].is_present()) {
        for c in 0..bands {
            (0..n).for_each(|i| arrived[i * bands + c] += now[j][i] * shot[j * bands + c]);
        }
    }
    let emitted =
        (0..n).flat_map(|i| stage.emission(i).iter().map(move |e| (i, e))).map(|(i, e)| stage.patches[i].area * e);
    // Where all lamps are out, what was bright before measures what rounding may leave.
    let size = shot.iter().map(|q| q.abs()).chain(emitted).fold(solver.energy().brightest, f64::max);
    if size == 0.0 {
        return 0.0;
    }
    let mut gap = 0.0f64;
    for i in (0..n).filter(|i| stage.patches[*i].is_present()) {
        for c in 0..bands {
            let (e, rho, area) = (stage.emission(i)[c], stage.reflectance(i)[c], stage.patches[i].area);
            let reflected = (b.values[i * bands + c] - e) * area;
            gap = gap.max((reflected - rho * arrived[i * bands + c]).abs() / size);
        }
    }
    gap
}
