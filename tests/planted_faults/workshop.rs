//! Solutions with one known mistake each, made without the code that looks for them: scenes edited as an author would
//! edit them and solved by another method with another seed, formulas written out here.

use etalon::estimate::{Estimator, PairFactors, PairPlan, Plan, pair_form_factors};
use etalon::io::StoredReference;
use etalon::io::scene::builtin;
use etalon::methods::{PatchVectors, gather, hemicube};
use etalon::raycast::KernelKind;
use etalon::reference::{Options, Progress};
use etalon::scene::{Scene, Stage};
use etalon::solution::{FormFactors, Radiosity};
use etalon::solver::{Transport, gauss_seidel};
use etalon::study::{self, Cause, CauseOptions, Session, causes};

struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}

/// A scene with its reference and a candidate that is right.
pub struct Bench {
    pub scene: Scene,
    pub stage: Stage,
    pub reference: StoredReference,
    /// The candidate's own form factors.
    pub matrix: FormFactors,
    /// Its right solution.
    pub right: Radiosity,
}

/// What is expected of one planted mistake.
pub struct Fault {
    pub what: String,
    pub kind: &'static str,
    pub place: Option<String>,
    pub solution: Radiosity,
}

/// The candidate: pairs without rays where they can be had, its own rays elsewhere.
pub fn solved(stage: &Stage, seed: u64, rays: u64, estimator: Estimator) -> (Radiosity, FormFactors) {
    let session = Session::open(stage, KernelKind::Builtin).expect("kernels");
    let params = gather::Params { rays, randomisations: 16, estimator };
    let (mut b, _, f) = gather::solve(&session.tracer(), &params, seed, &|_| ()).expect("a solution");
    b.std_err = None;
    (b, f)
}

/// A right solution, by pairs to a relative error of 3e-5 where no pair needs rays.
fn right(stage: &Stage, seed: u64) -> (Radiosity, FormFactors) {
    let pairs = settled(stage);
    if pairs.tally.left > 0 {
        return solved(stage, seed, 4096, Estimator::Auto);
    }
    let (b, _) = gather::solve_with(stage, &pairs.form_factors).expect("a solution");
    (b, pairs.form_factors)
}

fn settled(stage: &Stage) -> PairFactors {
    let plan = PairPlan { target_error: Some(FINE), ..PairPlan::default() };
    pair_form_factors(stage, &plan, &|_| ())
}

/// Relative error of form factors where rays are not needed.
const FINE: f64 = 3e-5;

impl Bench {
    pub fn new(name: &str) -> Self {
        Self::of(builtin(name).expect("a built-in scene"))
    }

    /// The coarse Cornell box with a green wall that glows.
    pub fn with_two_lamps() -> Self {
        let mut scene = builtin("cornell-box-coarse").expect("a built-in scene");
        let green = scene.materials.iter_mut().find(|m| m.name == "green").expect("a material");
        green.emission = vec![0.2, 0.6, 0.3];
        Self::of(scene)
    }

    pub fn of(scene: Scene) -> Self {
        let state = scene.edits.len();
        let stage = scene.at(state).expect("a state");
        let session = Session::open(&stage, KernelKind::Builtin).expect("kernels");
        let target_error = (settled(&stage).tally.left == 0).then_some(FINE);
        let plan = Plan { rays: 4096, target_error, estimator: Estimator::Auto, ..Plan::default() };
        let (reference, _) = study::reference(&session, &Options { plan, seed: 1 }, &Silent).expect("a reference");
        drop(session);
        let (right, matrix) = right(&stage, 77);
        Self { scene, stage, reference, matrix, right }
    }

    pub fn causes_of(&self, solution: &Radiosity) -> Vec<Cause> {
        let session = Session::open(&self.stage, KernelKind::Builtin).expect("kernels");
        causes(&session, &self.reference, solution, &CauseOptions::default())
    }

    /// Eq. 7 against the reference.
    pub fn rms(&self, solution: &Radiosity) -> f64 {
        let truth = self.reference.patches.mean();
        let (mut off, mut all) = (0.0, 0.0);
        for (i, p) in self.stage.patches.iter().enumerate() {
            let y = |b: &Radiosity| self.stage.photometry.luminance(b.of(i));
            off += p.area * (y(solution) - y(&truth)).powi(2);
            all += p.area * y(&truth).powi(2);
        }
        (off / all).sqrt()
    }

    /// The right solution with every value of a present patch changed: patch, band, value.
    pub fn mapped(&self, to: impl Fn(usize, usize, f64) -> f64) -> Radiosity {
        let mut b = self.right.clone();
        for i in (0..b.len()).filter(|i| self.stage.patches[*i].area > 0.0) {
            (0..b.bands).for_each(|c| b.values[i * b.bands + c] = to(i, c, self.right.values[i * b.bands + c]));
        }
        b
    }

    /// The solution of the scene after an edit.
    pub fn edited(&self, edit: impl Fn(&mut Scene)) -> Radiosity {
        let mut scene = self.scene.clone();
        edit(&mut scene);
        let stage = scene.at(scene.edits.len()).expect("a state");
        let (mut b, _) = right(&stage, 78);
        // What takes no part in the reference's scene has no value here.
        for i in (0..b.len()).filter(|i| self.stage.patches[*i].area == 0.0) {
            b.values[i * b.bands..(i + 1) * b.bands].fill(0.0);
        }
        b
    }

    /// Bounces `0 ..= last` of the candidate's own system, one by one.
    pub fn bounces(&self, last: usize) -> Vec<Vec<f64>> {
        let v = PatchVectors::of(&self.stage);
        let mut all = vec![v.emission.clone()];
        for k in 0..last {
            let mut next = vec![0.0; v.emission.len()];
            self.matrix.apply(&all[k], v.bands, &mut next);
            next.iter_mut().zip(&v.reflectance).for_each(|(x, rho)| *x *= rho);
            all.push(next);
        }
        all
    }

    fn with(&self, values: Vec<f64>) -> Radiosity {
        Radiosity { bands: self.right.bands, values, std_err: None }
    }

    /// The sum of bounces up to `last`.
    pub fn cut_off(&self, last: usize) -> Radiosity {
        let mut sum = vec![0.0; self.right.values.len()];
        for bounce in self.bounces(last) {
            sum.iter_mut().zip(bounce).for_each(|(s, b)| *s += b);
        }
        self.with(sum)
    }

    /// The state of a Gauss-Seidel iteration after some rounds.
    pub fn rounds(&self, rounds: usize) -> Radiosity {
        let v = PatchVectors::of(&self.stage);
        let mut state = None;
        let params = gauss_seidel::Params { tolerance: 1e-12, max_iterations: rounds };
        // It ends with "not converged", as it should.
        let _ = gauss_seidel::solve(&v.system(), &self.matrix, &params, |step| state = Some(step.radiosity.to_vec()));
        self.with(state.expect("a round"))
    }

    /// The object lit and lighting, but hiding nothing from anybody.
    pub fn seen_through(&self, object: &str) -> Radiosity {
        let mut scene = self.scene.clone();
        scene.absent.push(object.to_string());
        let gone = scene.at(scene.edits.len()).expect("a state");
        let (_, behind) = right(&gone, 79);
        let own = |i: usize| self.stage.surfaces[self.stage.patches[i].surface as usize].object == object;
        let row = |i: usize| -> Vec<(u32, f64)> {
            let whole = self.matrix.row(i).map(|(j, f)| (j as u32, f));
            if own(i) {
                return whole.collect();
            }
            let mut row: Vec<(u32, f64)> = whole.filter(|(j, _)| own(*j as usize)).collect();
            row.extend(behind.row(i).map(|(j, f)| (j as u32, f)));
            row.sort_unstable_by_key(|e| e.0);
            row
        };
        let f = FormFactors::from_exact_rows((0..self.stage.patch_count()).map(row).collect());
        let (mut b, _) = gather::solve_with(&self.stage, &f).expect("a solution");
        b.std_err = None;
        b
    }

    pub fn hemicube(&self, resolution: u32) -> Radiosity {
        let params = hemicube::Params { resolution, ..hemicube::Params::default() };
        let (mut b, ..) = hemicube::solve(&self.stage, &params, &|_| ()).expect("a solution");
        b.std_err = None;
        b
    }

    pub fn material(&self, name: &str) -> usize {
        self.scene.materials.iter().position(|m| m.name == name).expect("a material")
    }

    /// First patch of a surface.
    pub fn first_patch(&self, surface: &str) -> usize {
        (0..self.stage.patch_count()).find(|i| self.stage.surface_name(*i) == surface).expect("a surface")
    }
}

/// `t` of the way from a right solution to a wrong one.
pub fn mixed(right: &Radiosity, wrong: &Radiosity, t: f64) -> Radiosity {
    let values = right.values.iter().zip(&wrong.values).map(|(r, w)| r + t * (w - r)).collect();
    Radiosity { bands: right.bands, values, std_err: None }
}

/// The sRGB transfer function, IEC 61966-2-1.
fn srgb(x: f64) -> f64 {
    if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// What the edit of a scene is known by.
type Edit<'a> = &'a dyn Fn(&mut Scene);

/// What there is to be planted in a scene.
pub struct Targets<'a> {
    /// Two materials to swap.
    pub materials: [&'a str; 2],
    /// A material to repaint.
    pub repainted: &'a str,
    /// An object to take away.
    pub object: &'a str,
    /// A surface of several rows of patches.
    pub surface: &'a str,
    /// One of several lamps.
    pub lamp: Option<&'a str>,
}

/// In the Cornell box.
pub const CORNELL: Targets =
    Targets { materials: ["red", "green"], repainted: "white", object: "tall-block", surface: "floor", lamp: None };

/// All planted mistakes, whole.
pub fn faults(b: &Bench, t: &Targets) -> Vec<Fault> {
    let mut out = Vec::new();
    let mut plant = |what: &str, kind: &'static str, place: Option<String>, solution: Radiosity| {
        out.push(Fault { what: what.to_string(), kind, place, solution });
    };
    let emission = b.stage.emissions();
    let reflectance = b.stage.reflectances();
    let bands = b.right.bands;
    let e = |i: usize, c: usize| emission[i * bands + c];
    plant("all 1 % bright", "scale", None, b.mapped(|_, _, v| 1.01 * v));
    plant("radiance", "radiance", None, b.mapped(|_, _, v| v / std::f64::consts::PI));
    plant("irradiance", "irradiance", None, b.mapped(|i, c, v| (v - e(i, c)) / reflectance[i * bands + c]));
    plant("emission missing", "emission-missing", None, b.mapped(|i, c, v| v - e(i, c)));
    plant("emission twice", "emission-twice", None, b.mapped(|i, c, v| v + e(i, c)));
    plant("sRGB-encoded", "srgb", None, b.mapped(|_, _, v| srgb(v)));
    plant("gamma 2.2", "gamma", None, b.mapped(|_, _, v| v.powf(1.0 / 2.2)));
    let swapped = b.mapped(|i, c, _| b.right.values[i * bands + [2, 1, 0][c]]);
    plant("red and blue swapped", "bands-swapped", None, swapped);
    for k in [0, 1, 2, 5] {
        plant(&format!("sum of {k} bounces"), "missing-bounces", None, b.cut_off(k));
    }
    let bounces = b.bounces(2);
    plant("bounce 2 missing", "one-bounce-missing", None, b.mapped(|i, c, v| v - bounces[2][i * bands + c]));
    plant("bounce 1 twice", "bounce-twice", None, b.mapped(|i, c, v| v + bounces[1][i * bands + c]));
    plant("3 bounces, last twice", "last-bounce-twice", None, {
        let (sum, three) = (b.cut_off(3), b.bounces(3));
        b.mapped(|i, c, _| sum.values[i * bands + c] + three[3][i * bands + c])
    });
    plant("Gauss-Seidel, 2 rounds", "not-converged", None, b.rounds(2));
    let [x, y] = t.materials.map(|m| b.material(m));
    let (low, high) = (x.min(y), x.max(y));
    let names = format!("{}, {}", b.scene.materials[low].name, b.scene.materials[high].name);
    let swap: Edit = &|s| {
        let kept = s.materials[x].reflectance.clone();
        s.materials[x].reflectance = std::mem::replace(&mut s.materials[y].reflectance, kept);
    };
    plant("materials swapped", "materials-swapped", Some(names), b.edited(swap));
    let m = b.material(t.repainted);
    let repaint = b.edited(|s| s.materials[m].reflectance.iter_mut().for_each(|r| *r *= 0.8));
    plant("material 20 % darker", "material", Some(t.repainted.to_string()), repaint);
    let gone = b.edited(|s| s.absent.push(t.object.to_string()));
    plant("object missing", "missing-object", Some(t.object.to_string()), gone);
    plant("no shadow of object", "missing-occluder", Some(t.object.to_string()), b.seen_through(t.object));
    if let Some(lamp) = t.lamp {
        let m = b.material(lamp);
        let dim = b.edited(|s| s.materials[m].emission.iter_mut().for_each(|e| *e *= 0.7));
        plant("one lamp 30 % dark", "lamp", Some(lamp.to_string()), dim);
        let off = b.edited(|s| s.materials[m].emission.fill(0.0));
        plant("one lamp off", "lamp-off", Some(lamp.to_string()), off);
    }
    for f in of_patches(b, t.surface) {
        out.push(f);
    }
    out
}

/// Mistakes of single values.
fn of_patches(b: &Bench, surface: &str) -> Vec<Fault> {
    let first = b.first_patch(surface);
    let n = b.stage.patch_count();
    let own: Vec<usize> = (0..n).filter(|i| b.stage.surface_name(*i) == surface).collect();
    let mine = |i: usize| own.contains(&i);
    let bands = b.right.bands;
    let fault = |what: &str, kind, place: String, solution| Fault {
        what: what.to_string(),
        kind,
        place: Some(place),
        solution,
    };
    let middle = own[own.len() / 2];
    let one = b.mapped(|i, _, v| if i == middle { 1.05 * v } else { v });
    let factor = b.mapped(|i, _, v| if mine(i) { 1.1 * v } else { v });
    let zero = b.mapped(|i, _, v| if mine(i) { 0.0 } else { v });
    let reversed = b.mapped(|i, c, v| {
        let at = own.iter().position(|o| *o == i);
        at.map_or(v, |k| b.right.values[own[own.len() - 1 - k] * bands + c])
    });
    let (p, q) = (first, middle);
    let swapped = b.mapped(|i, c, v| match i {
        i if i == p => b.right.values[q * bands + c],
        i if i == q => b.right.values[p * bands + c],
        _ => v,
    });
    vec![
        fault("one patch 5 % bright", "one-patch", format!("patch {middle}"), one),
        fault("one surface 10 % bright", "one-surface", surface.to_string(), factor),
        fault("one surface is 0", "surface-missing", surface.to_string(), zero),
        fault("one surface reversed", "numbering", surface.to_string(), reversed),
        fault("two patches swapped", "patches-swapped", format!("patches {p}, {q}"), swapped),
    ]
}
