//! Level (b): the true mean radiosity of each patch, by paths; no patch is taken for evenly bright.

use super::ReferenceError;
use super::patch_system::{Inputs, Options, Progress, relative_noise};
use super::self_check::{self, Evidence};
use crate::estimate::{Emitter, Estimator, Gathering, PathGatherer, PathSums, Plan, element_emitters, patch_emitters};
use crate::raycast::Tracer;
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::solution::{Check, Provenance, Replicates, SelfCheck, TruthLevel};
use crate::stats::mean_interval;

/// Keeps the paths of level (b) apart from the rays of level (a) under the same seed.
const PATHS: u64 = 0x7061_7468;
/// Energy may be off by so much through leaks that the scene's own check lets pass, and through rounding.
const ENERGY_SLACK: f64 = 1e-4;

/// A finished reference of the continuous problem.
#[derive(Debug)]
pub struct ContinuousReference {
    /// Replicate radiosities of the patches: independent, each unbiased.
    pub patches: Replicates,
    /// Replicate radiosities of the elements, where patches have more than one.
    pub elements: Option<Replicates>,
    /// How it was computed.
    pub provenance: Provenance,
    /// What it found about itself.
    pub self_check: SelfCheck,
    /// Relative error in the norm of eq. 7 after each wave of paths.
    pub waves: Vec<(u64, f64)>,
    /// True if a target error was asked for and not reached.
    pub missed_target: bool,
}

/// Follows the judge's paths: R replicates of `E + rho H`, H the mean irradiance of each patch. Any reflectance below 1,
/// no limit on bounces. `plan.rays` counts paths per patch; a path casts two rays and more.
///
/// # Errors
/// None today; the signature is that of [`super::compute`].
pub fn compute_continuous(
    tracer: &Tracer,
    options: &Options,
    evidence: &Evidence,
    progress: &dyn Progress,
) -> Result<ContinuousReference, ReferenceError> {
    let stage = tracer.stage();
    let inputs = Inputs::of(stage);
    let stream = Stream::new(Role::Judge, options.seed).child(PATHS);
    progress.begin("a pilot of paths", None);
    let gatherer = PathGatherer::new(tracer, stream);
    let emitters = patch_emitters(stage);
    let every: Vec<u32> = (0..emitters.len() as u32).collect();
    begin(progress, "following paths", &options.plan, &emitters);
    let radiosities = |sums: &PathSums| to_radiosity(&inputs, &every, &emitters, sums);
    let error = |sums: &PathSums| relative_noise(stage, &radiosities(sums));
    let patches = gatherer.gather(&emitters, &every, &options.plan, &error, &|n| progress.advance(n));
    let elements = stage.has_elements().then(|| gather_elements(&gatherer, stage, &inputs, &patches, progress));
    let checks = vec![
        self_check::leaks_of(stage, &patches.sums.tally, tracer.is_enclosure(), evidence.declared_enclosure),
        self_check::witness(evidence),
        energy(stage, &inputs, &patches.sums, tracer.is_enclosure()),
    ];
    Ok(ContinuousReference {
        patches: radiosities(&patches.sums),
        elements,
        provenance: provenance(tracer, options, &patches),
        self_check: SelfCheck { checks },
        missed_target: patches.reached.missed_target,
        waves: patches.waves,
    })
}

fn begin(progress: &dyn Progress, what: &str, plan: &Plan, emitters: &[Option<Emitter>]) {
    let each = plan.rays_per_randomisation() * u64::from(plan.randomisations);
    progress.begin(what, plan.target_error.is_none().then_some(each * emitters.iter().flatten().count() as u64));
}

/// `E + rho H` of every receiver and randomisation; 0 for what takes no part.
fn to_radiosity(inputs: &Inputs, patch_of: &[u32], emitters: &[Option<Emitter>], sums: &PathSums) -> Replicates {
    let bands = inputs.bands;
    let replicate = |r: usize| -> Vec<f64> {
        let h = sums.irradiance(r);
        let value = |k: usize| {
            let i = patch_of[k / bands] as usize * bands + k % bands;
            let present = emitters[k / bands].is_some();
            if present { inputs.emission[i] + inputs.reflectance[i] * h[k] } else { 0.0 }
        };
        (0..h.len()).map(value).collect()
    };
    Replicates { bands, replicates: (0..usize::from(sums.randomisations)).map(replicate).collect() }
}

/// Elements by paths of their own, as many as the patches had.
fn gather_elements(
    gatherer: &PathGatherer,
    stage: &Stage,
    inputs: &Inputs,
    patches: &Gathering,
    progress: &dyn Progress,
) -> Replicates {
    let emitters = element_emitters(stage);
    let patch_of: Vec<u32> = stage.elements.iter().map(|e| e.patch).collect();
    let plan = Plan {
        rays: patches.reached.rays_per_patch,
        randomisations: patches.sums.randomisations,
        target_error: None,
        max_time: None,
        estimator: Estimator::Rays,
    };
    begin(progress, "following paths of elements", &plan, &emitters);
    let gathered = gatherer.gather(&emitters, &patch_of, &plan, &|_| 0.0, &|n| progress.advance(n));
    to_radiosity(inputs, &patch_of, &emitters, &gathered.sums)
}

/// In a closed scene what is emitted is absorbed: `sum A E = sum A (1 - rho) H` in every band.
fn energy(stage: &Stage, inputs: &Inputs, sums: &PathSums, enclosure: bool) -> Check {
    let name = "energy";
    if !enclosure {
        return self_check::check(name, true, "not tested: the scene is open, light may leave it".into());
    }
    let (bands, r) = (inputs.bands, usize::from(sums.randomisations));
    let irradiances: Vec<Vec<f64>> = (0..r).map(|k| sums.irradiance(k)).collect();
    let mut findings = Vec::new();
    for c in 0..bands {
        let area = |k: usize| stage.patches[k].area;
        let total = |of: &dyn Fn(usize) -> f64| -> f64 { (0..stage.patch_count()).map(|k| area(k) * of(k)).sum() };
        let emitted = total(&|k| inputs.emission[k * bands + c]);
        if emitted > 0.0 {
            let absorbed = |h: &Vec<f64>| total(&|k| (1.0 - inputs.reflectance[k * bands + c]) * h[k * bands + c]);
            let defects: Vec<f64> = irradiances.iter().map(|h| absorbed(h) / emitted - 1.0).collect();
            let e = mean_interval(&defects, 0.95);
            findings.push((e.value, e.std_err.unwrap_or(f64::INFINITY)));
        }
    }
    let p = findings.iter().map(|(m, se)| self_check::t_or_one(*m, *se, r)).fold(1.0, f64::min);
    let largest = findings.iter().map(|(m, _)| m.abs()).fold(0.0, f64::max);
    let noise = findings.iter().map(|(_, se)| *se).fold(0.0, f64::max);
    let passed = p * findings.len() as f64 >= self_check::FALSE_ALARM || largest <= ENERGY_SLACK;
    let finding =
        format!("emitted and absorbed energy differ by {largest:.1e} (standard error {noise:.1e}), p = {p:.2e}");
    self_check::check(name, passed, finding)
}

fn provenance(tracer: &Tracer, options: &Options, gathering: &Gathering) -> Provenance {
    let (kernel, tally) = (tracer.kernel(), gathering.sums.tally);
    Provenance {
        version: env!("CARGO_PKG_VERSION").into(),
        truth: TruthLevel::Continuous,
        seed: options.seed,
        rays_per_patch: gathering.reached.rays_per_patch,
        randomisations: options.plan.randomisations,
        rays: tally.rays,
        escapes: tally.escapes,
        back_hits: tally.back_hits,
        kernel: kernel.name.clone(),
        kernel_version: kernel.version.clone(),
        instruction_set: kernel.instruction_set.clone(),
        enclosure: tracer.is_enclosure(),
        relative_error: gathering.reached.relative_error,
        estimator: options.plan.estimator.name().into(),
    }
}
