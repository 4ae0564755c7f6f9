//! Level (a): the patch-constant system, solved with ray-cast form factors.

use super::ReferenceError;
use super::pair_check::check_pairs;
use super::self_check::{self, Evidence};
use super::transport::LeaveOneOut;
use crate::estimate::{Blend, Casting, Checkpoint, Entry, Estimator, HitCounts, NoCheckpoint, PairFactors, Plan};
use crate::estimate::{DirectLight, direct_light, lit_elements, lit_patches};
use crate::estimate::{cast_on, element_emitters, patch_emitters, settle};
use crate::raycast::Tracer;
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::solution::{FormFactors, Provenance, Replicates, SelfCheck, TruthLevel};
use crate::solver::bounds::{self, Bracket};
use crate::solver::{System, krylov};
use crate::stats::normal_quantile;
use std::cell::RefCell;

/// Relative residual to which patch systems are solved.
const RESIDUAL: f64 = 1e-12;

/// Rays per patch that count once more what was settled without them, where a target asks for no number.
const WITNESS_RAYS: u64 = 1_024;

/// Key of the stream that numerical errors are drawn from.
const NUMERICAL_NOISE: u64 = 0x6e75_6d65;
/// Branches of the judge's stream that shadow rays are drawn from: "light" of patches, of elements.
const LIGHT: [u64; 2] = [0x6c69_6768_7401, 0x6c69_6768_7402];

/// What a reference may spend.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Rays, randomisations, target, time.
    pub plan: Plan,
    /// Seed of the judge's streams.
    pub seed: u64,
}

/// What a long computation tells its caller.
pub trait Progress: Sync {
    /// A stage of the work begins; `total` steps, `None` if nobody knows.
    fn begin(&self, what: &str, total: Option<u64>);
    /// So many more steps are done.
    fn advance(&self, steps: u64);
}

/// Where the finished rows of the two castings are kept.
#[derive(Clone, Copy)]
pub struct Kept<'a> {
    /// Rays of patches.
    pub patches: &'a dyn Checkpoint,
    /// Rays of elements.
    pub elements: &'a dyn Checkpoint,
}

impl Kept<'static> {
    /// Nothing is kept.
    pub const NONE: Self = Self { patches: &NoCheckpoint, elements: &NoCheckpoint };
}

/// A finished reference.
#[derive(Debug)]
pub struct Reference {
    /// Replicate radiosities of the patches.
    pub patches: Replicates,
    /// Replicate radiosities of the elements, where patches have more than one.
    pub elements: Option<Replicates>,
    /// Mean form factors with standard errors.
    pub form_factors: FormFactors,
    /// Pairs settled without rays, where they were.
    pub settled: Option<PairFactors>,
    /// Hits of all rays.
    pub counts: HitCounts,
    /// How it was computed.
    pub provenance: Provenance,
    /// What it found about itself.
    pub self_check: SelfCheck,
    /// Relative error in the norm of eq. 7 after each wave of rays.
    pub waves: Vec<(u64, f64)>,
    /// True if a target error was asked for and not reached.
    pub missed_target: bool,
}

impl Reference {
    /// Two-sided bounds on all radiosities, which hold together at this confidence whatever the noise is like:
    /// every form factor within its bounds, rows that sum to one in a closed scene, and nothing else assumed.
    ///
    /// # Errors
    /// A scene with point lights, whose direct light is known by estimates only; as [`bounds::bracket`].
    pub fn bracket(&self, stage: &Stage, confidence: f64) -> Result<Bracket, ReferenceError> {
        if !stage.lights.is_empty() {
            return Err(ReferenceError::PointLights);
        }
        let blend = blend(self.settled.as_ref(), &self.counts);
        let known = blend.bounds(confidence, self.provenance.enclosure);
        let inputs = Inputs::of(stage);
        let system = System { emission: &inputs.emission, reflectance: &inputs.reflectance, bands: inputs.bands };
        Ok(bounds::bracket(&system, &known, &bounds::Params::default())?)
    }
}

/// Emission and reflectance of every patch, row-major.
pub(super) struct Inputs {
    pub(super) emission: Vec<f64>,
    pub(super) reflectance: Vec<f64>,
    pub(super) bands: usize,
}

impl Inputs {
    pub(super) fn of(stage: &Stage) -> Self {
        Self { bands: stage.band_count(), emission: stage.emissions(), reflectance: stage.reflectances() }
    }

    /// What leaves the patches before the first bounce between them: emission, and what they reflect of point lights.
    fn source(&self, irradiance: Option<&Vec<f64>>) -> Vec<f64> {
        let reflected = |k: usize| irradiance.map_or(0.0, |h| self.reflectance[k] * h[k]);
        self.emission.iter().enumerate().map(|(k, e)| e + reflected(k)).collect()
    }

    /// The sources with each randomisation left out, side by side as [`HitCounts::repeated`] lays them out.
    fn sources_left_out(&self, counts: &HitCounts, direct: Option<&DirectLight>) -> Vec<f64> {
        let Some(direct) = direct else { return counts.repeated(&self.emission, self.bands) };
        let each: Vec<Vec<f64>> = direct.left_out.iter().map(|h| self.source(Some(h))).collect();
        let width = each.len() * self.bands;
        let of = |k: usize| each[k % width / self.bands][k / width * self.bands + k % self.bands];
        (0..self.emission.len() * each.len()).map(of).collect()
    }
}

/// Casts the judge's rays and solves the patch system: R replicates, debiased by leaving one out.
///
/// `tracer` casts with the judge's kernel; `evidence` brings what the self-check needs from outside.
pub fn compute(
    tracer: &Tracer,
    options: &Options,
    evidence: &Evidence,
    progress: &dyn Progress,
) -> Result<Reference, ReferenceError> {
    compute_on(tracer, options, evidence, progress, Kept::NONE)
}

/// The same, going on from what an interrupted run has kept: the reference is the same, bit by bit.
///
/// # Errors
/// As [`compute`].
pub fn compute_on(
    tracer: &Tracer,
    options: &Options,
    evidence: &Evidence,
    progress: &dyn Progress,
    kept: Kept,
) -> Result<Reference, ReferenceError> {
    let stage = tracer.stage();
    check_size(stage, &options.plan)?;
    let inputs = Inputs::of(stage);
    let stream = Stream::new(Role::Judge, options.seed);
    let emitters = patch_emitters(stage);
    let present = emitters.iter().flatten().count();
    progress.begin("settling pairs", Some(present as u64));
    let settled = settle(stage, &options.plan, &|patches| progress.advance(patches));
    let plan = plan_of_rays(stage, &options.plan, settled.as_ref());
    begin_casting(progress, "casting rays", &plan, present);

    // The radiosities of the last wave are kept: where the plan stops, they are the answer.
    let last: RefCell<Option<Result<Solved, ReferenceError>>> = RefCell::new(None);
    let error = |counts: &HitCounts| {
        let direct = direct_light(
            tracer,
            &lit_patches(stage, &emitters),
            stream.child(LIGHT[0]),
            counts.rays,
            counts.randomisations,
        );
        let result = solve(stage, &inputs, &blend(settled.as_ref(), counts), direct.as_ref(), stream);
        let relative = result.as_ref().map_or(f64::NAN, |s| relative_noise(stage, &s.replicates));
        *last.borrow_mut() = Some(result);
        relative
    };
    let casting = cast_on(tracer, &emitters, stream, &plan, &error, &|rays| progress.advance(rays), kept.patches);
    let reached = casting.reached.relative_error;
    let solved = last.into_inner().expect("every plan has a wave")?;
    let elements = if stage.has_elements() {
        Some(gather_elements(tracer, &inputs, &solved.replicates, &casting, stream, progress, kept.elements))
    } else {
        None
    };
    let counts = &casting.counts;
    let form_factors = blend(settled.as_ref(), counts).form_factors();
    let mut self_check = self_check::run(stage, counts, &solved.mean, solved.residual, tracer.is_enclosure(), evidence);
    if let Some(pairs) = &settled {
        self_check.checks.extend(check_pairs(stage, pairs, counts, &form_factors, tracer.is_enclosure()));
    }
    Ok(Reference {
        form_factors,
        provenance: provenance(tracer, options, &casting),
        settled,
        self_check,
        patches: solved.replicates,
        elements,
        missed_target: options.plan.target_error.is_some_and(|target| reached > target),
        waves: casting.waves,
        counts: casting.counts,
    })
}

/// Where every pair is settled, rays are witnesses: no number of them brings a target nearer.
fn plan_of_rays(stage: &Stage, plan: &Plan, settled: Option<&PairFactors>) -> Plan {
    let all = settled.is_some_and(|s| s.tally.left == 0) && stage.lights.is_empty();
    if all && plan.target_error.is_some() {
        return Plan { rays: WITNESS_RAYS, target_error: None, ..*plan };
    }
    *plan
}

fn blend<'a>(settled: Option<&'a PairFactors>, counts: &'a HitCounts) -> Blend<'a> {
    settled.map_or_else(|| Blend::of_rays(counts), |s| Blend::new(s, counts))
}

/// Refuses scenes and plans that are larger than the hit counters.
pub fn check_size(stage: &Stage, plan: &Plan) -> Result<(), ReferenceError> {
    let too_large = |what, got: u64, most: u64, mend| Err(ReferenceError::TooLarge { what, got, most, mend });
    if stage.patch_count() >= Entry::MAX_PATCHES {
        return too_large(
            "the number of patches",
            stage.patch_count() as u64,
            Entry::MAX_PATCHES as u64 - 1,
            "use a coarser mesh",
        );
    }
    if plan.target_error.is_none() && plan.rays_per_randomisation() > Entry::MAX_COUNT {
        return too_large(
            "the number of rays per patch and randomisation",
            plan.rays_per_randomisation(),
            Entry::MAX_COUNT,
            "ask for fewer --rays or more --randomisations",
        );
    }
    Ok(())
}

fn begin_casting(progress: &dyn Progress, what: &str, plan: &Plan, emitters: usize) {
    let rays = plan.rays_per_randomisation() * u64::from(plan.randomisations) * emitters as u64;
    progress.begin(what, plan.target_error.is_none().then_some(rays));
}

/// Radiosities that belong to one state of the counts.
struct Solved {
    /// Solution of the mean matrix: N x bands.
    mean: Vec<f64>,
    /// Pseudo-values: R independent radiosities free of the bias that solving with noisy factors brings.
    replicates: Replicates,
    /// Worst relative residual.
    residual: f64,
}

/// Solves with the mean matrix and with every matrix that leaves one randomisation out.
///
/// The solution depends on F in a curved way, so noise in F shifts its mean by a term of order 1/R. The
/// jackknife pseudo-values `R B - (R - 1) B_without_r` cancel that term and are the replicates.
///
/// Settled pairs are the same in every matrix; what their numerical errors do is added as noise of that size.
fn solve(
    stage: &Stage,
    inputs: &Inputs,
    blend: &Blend,
    direct: Option<&DirectLight>,
    stream: Stream,
) -> Result<Solved, ReferenceError> {
    let (areas, counts) = (stage.areas(), blend.counts());
    let r = counts.randomisations;
    let params = krylov::Params {
        tolerance: RESIDUAL,
        norm: crate::solver::Norm { weights: Some(&areas) },
        ..krylov::Params::default()
    };
    let source = inputs.source(direct.map(|d| &d.mean));
    let system = System { emission: &source, reflectance: &inputs.reflectance, bands: inputs.bands };
    let (mean, info) = krylov::solve(&system, &blend.form_factors(), None, &params, |_, _| {})?;
    let emission = inputs.sources_left_out(counts, direct);
    let reflectance = counts.repeated(&inputs.reflectance, inputs.bands);
    let system = System { emission: &emission, reflectance: &reflectance, bands: inputs.bands * usize::from(r) };
    let guess = counts.repeated(&mean, inputs.bands);
    let (left_out, more) = krylov::solve(&system, &LeaveOneOut { blend }, Some(&guess), &params, |_, _| {})?;
    let residual = info.residual.iter().chain(&more.residual).copied().fold(0.0, f64::max);
    let mut replicates = pseudo_values(&mean, &left_out, inputs.bands, r);
    add_numerical_noise(&mut replicates, &mean, inputs, blend, stream.child(NUMERICAL_NOISE));
    Ok(Solved { mean, replicates, residual })
}

/// Spreads the replicates by what the numerical errors of settled pairs may do: independent noise of the size
/// `rho sqrt(sum se^2 B^2)`, grown by the reflections that follow, as if each bound were a standard error.
fn add_numerical_noise(replicates: &mut Replicates, mean: &[f64], inputs: &Inputs, blend: &Blend, stream: Stream) {
    let noise = blend.settled_noise(mean, inputs.bands);
    let brightest = inputs.reflectance.iter().copied().fold(0.0, f64::max);
    let count = (replicates.count() as f64).sqrt();
    for (r, values) in replicates.replicates.iter_mut().enumerate() {
        let own = stream.child(r as u64);
        for (k, v) in values.iter_mut().enumerate() {
            let size = inputs.reflectance[k] * noise[k] / (1.0 - brightest);
            if size > 0.0 {
                *v += size * count * normal_quantile(own.unit(k as u64).max(f64::MIN_POSITIVE));
            }
        }
    }
}

fn pseudo_values(mean: &[f64], left_out: &[f64], bands: usize, r: u16) -> Replicates {
    let (count, width) = (f64::from(r), usize::from(r) * bands);
    let replicate = |r: usize| -> Vec<f64> {
        let pick = |(k, b): (usize, &f64)| {
            let without = left_out[k / bands * width + r * bands + k % bands];
            count * b - (count - 1.0) * without
        };
        mean.iter().enumerate().map(pick).collect()
    };
    Replicates { bands, replicates: (0..usize::from(r)).map(replicate).collect() }
}

/// sqrt(sum A se^2) / sqrt(sum A Y^2), luminances.
pub(super) fn relative_noise(stage: &Stage, replicates: &Replicates) -> f64 {
    let r = replicates.count() as f64;
    let (mut noise, mut signal) = (0.0, 0.0);
    for (i, patch) in stage.patches.iter().enumerate() {
        let span = i * replicates.bands..(i + 1) * replicates.bands;
        let y: Vec<f64> = replicates.replicates.iter().map(|v| stage.photometry.luminance(&v[span.clone()])).collect();
        let mean = y.iter().sum::<f64>() / r;
        noise += patch.area * y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / (r * (r - 1.0));
        signal += patch.area * mean * mean;
    }
    if signal == 0.0 { 0.0 } else { (noise / signal).sqrt() }
}

/// Element values: one gather per element and randomisation from the patch replicate of the same number.
fn gather_elements(
    tracer: &Tracer,
    inputs: &Inputs,
    patches: &Replicates,
    casting: &Casting,
    stream: Stream,
    progress: &dyn Progress,
    kept: &dyn Checkpoint,
) -> Replicates {
    let stage = tracer.stage();
    let emitters = element_emitters(stage);
    let plan = Plan {
        rays: casting.reached.rays_per_patch,
        randomisations: casting.counts.randomisations,
        target_error: None,
        max_time: None,
        estimator: Estimator::Rays,
    };
    begin_casting(progress, "casting rays of elements", &plan, emitters.iter().flatten().count());
    let elements = cast_on(tracer, &emitters, stream, &plan, &|_| 0.0, &|rays| progress.advance(rays), kept);
    let bands = inputs.bands;
    let width = patches.count() * bands;
    let mut sources = vec![0.0; stage.patch_count() * width];
    for (r, values) in patches.replicates.iter().enumerate() {
        for (k, b) in values.iter().enumerate() {
            sources[k / bands * width + r * bands + k % bands] = *b;
        }
    }
    let gathered = elements.counts.apply_each(&sources, bands);
    let (rays, r) = (elements.counts.rays, elements.counts.randomisations);
    let direct = direct_light(tracer, &lit_elements(stage, &emitters), stream.child(LIGHT[1]), rays, r);
    let direct = direct.map(|d| d.replicates());
    let straight = |r: usize, k: usize| direct.as_ref().map_or(0.0, |d| d[r][k]);
    let value = |r: usize, e: usize, c: usize| {
        let i = stage.elements[e].patch as usize * bands + c;
        let present = emitters[e].is_some();
        let arriving = gathered[e * width + r * bands + c] + straight(r, e * bands + c);
        if present { inputs.emission[i] + inputs.reflectance[i] * arriving } else { 0.0 }
    };
    let replicate = |r: usize| {
        (0..emitters.len()).flat_map(|e| (0..bands).map(move |c| (e, c))).map(|(e, c)| value(r, e, c)).collect()
    };
    Replicates { bands, replicates: (0..patches.count()).map(replicate).collect() }
}

fn provenance(tracer: &Tracer, options: &Options, casting: &Casting) -> Provenance {
    let (kernel, tally) = (tracer.kernel(), casting.counts.tally);
    Provenance {
        version: env!("CARGO_PKG_VERSION").into(),
        truth: TruthLevel::PatchSystem,
        seed: options.seed,
        rays_per_patch: casting.reached.rays_per_patch,
        randomisations: options.plan.randomisations,
        rays: tally.rays,
        escapes: tally.escapes,
        back_hits: tally.back_hits,
        kernel: kernel.name.clone(),
        kernel_version: kernel.version.clone(),
        instruction_set: kernel.instruction_set.clone(),
        enclosure: tracer.is_enclosure(),
        relative_error: casting.reached.relative_error,
        estimator: options.plan.estimator.name().into(),
    }
}
