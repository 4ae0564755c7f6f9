//! Running the judge and the candidates.

use super::Session;
use crate::estimate::{cast, element_emitters, patch_emitters};
use crate::io::StoredReference;
use crate::methods::shooting::{self, Shooting};
use crate::methods::{Method, MethodError, MethodInfo, PatchVectors, gather, hemicube};
use crate::raycast::agree;
use crate::reference::{self, Evidence, Kept, Options, Progress, Reference, ReferenceError};
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::solution::{FormFactors, Radiosity};
use crate::solver::{System, gather_once};

/// Rays traced again by the second kernel.
const WITNESS_RAYS: usize = 32_768;

/// Computes a reference with its self-check, ready to be stored.
pub fn reference(
    session: &Session,
    options: &Options,
    progress: &dyn Progress,
) -> Result<(StoredReference, Reference), ReferenceError> {
    reference_on(session, options, progress, Kept::NONE)
}

/// The same, going on from what an interrupted run has kept.
///
/// # Errors
/// As [`reference()`].
pub fn reference_on(
    session: &Session,
    options: &Options,
    progress: &dyn Progress,
    kept: Kept,
) -> Result<(StoredReference, Reference), ReferenceError> {
    let stage = session.stage();
    let evidence = evidence(session, options.seed);
    let reference = reference::compute_on(&session.tracer(), options, &evidence, progress, kept)?;
    let stored = StoredReference {
        stage: stage.clone(),
        scene_hash: stage.hash(),
        patches: reference.patches.clone(),
        elements: reference.elements.clone(),
        provenance: reference.provenance.clone(),
        self_check: reference.self_check.clone(),
        waves: reference.waves.clone(),
        findings: Vec::new(),
    };
    Ok((stored, reference))
}

/// Computes a reference of the continuous problem with its self-check, ready to be stored. True beside it if a target
/// error was asked for and not reached.
///
/// # Errors
/// As [`reference()`].
pub fn continuous_reference(
    session: &Session,
    options: &Options,
    progress: &dyn Progress,
) -> Result<(StoredReference, bool), ReferenceError> {
    let stage = session.stage();
    let evidence = evidence(session, options.seed);
    let reference = reference::compute_continuous(&session.tracer(), options, &evidence, progress)?;
    let stored = StoredReference {
        stage: stage.clone(),
        scene_hash: stage.hash(),
        patches: reference.patches,
        elements: reference.elements,
        provenance: reference.provenance,
        self_check: reference.self_check,
        waves: reference.waves,
        findings: Vec::new(),
    };
    Ok((stored, reference.missed_target))
}

/// Traces a sample of rays on both kernels.
fn evidence(session: &Session, seed: u64) -> Evidence {
    let declared_enclosure = session.stage().enclosure == Some(true);
    let Some((first, second)) = session.witness() else {
        return Evidence { declared_enclosure, ..Evidence::default() };
    };
    let emitters = patch_emitters(session.stage());
    let batches = crate::estimate::sample_batches(&emitters, Stream::new(Role::Judge, seed), WITNESS_RAYS);
    let agreement = agree(first, second, session.stage(), &batches);
    Evidence {
        witness: Some(second.info().name.clone()),
        retraced: agreement.rays,
        near_edge: (agreement.near_edge * agreement.rays as f64).round() as u64,
        disagreements: agreement.disagreements,
        declared_enclosure,
    }
}

/// What a candidate has to do.
pub struct SolveRequest<'a> {
    /// Method with parameters.
    pub method: Method,
    /// Form factors to be used instead of computing them.
    pub form_factors: Option<&'a FormFactors>,
    /// Seed of ray-cast methods.
    pub seed: u64,
    /// Values per element instead of per patch.
    pub per_element: bool,
}

/// What came of it.
pub struct SolveOutcome {
    /// Radiosities per patch, or per element where asked for.
    pub radiosity: Radiosity,
    /// How the method got there.
    pub info: MethodInfo,
    /// Form factors computed or used; `None` for methods that forget them shot by shot.
    pub form_factors: Option<FormFactors>,
}

/// Runs a candidate.
pub fn solve(session: &Session, request: &SolveRequest, progress: &dyn Progress) -> Result<SolveOutcome, MethodError> {
    let stage = session.stage();
    if !stage.lights.is_empty() {
        return Err(MethodError::PointLights(stage.lights.len()));
    }
    let rows = stage.patches.iter().filter(|p| p.is_present()).count() as u64;
    let (radiosity, info, form_factors) = match (request.method, request.form_factors) {
        (Method::Gather(_), Some(f)) => with_matrix(f, gather::solve_with(stage, f)?),
        (Method::Hemicube(p), Some(f)) => with_matrix(f, hemicube::solve_with(stage, f, &p)?),
        (Method::Gather(p), None) => {
            progress.begin("casting rays", Some(rows * p.rays));
            gather::solve(&session.tracer(), &p, request.seed, &|rays| progress.advance(rays))?
        }
        (Method::Hemicube(p), None) => {
            progress.begin("hemi-cubes", Some(stage.patch_count() as u64));
            let done = std::cell::Cell::new(0);
            let f = hemicube::form_factors(stage, &p, &|rows| progress.advance((rows - done.replace(rows)) as u64))?;
            let solved = hemicube::solve_with(stage, &f, &p)?;
            (solved.0, solved.1, f)
        }
        (Method::Progressive(p), _) => return progressive(session, p, request),
        (Method::Redistribution(_), _) => return Err(MethodError::NoEdits),
    };
    let radiosity = if request.per_element { per_element(session, request, &radiosity)? } else { radiosity };
    Ok(SolveOutcome { radiosity, info, form_factors: Some(form_factors) })
}

fn progressive(
    session: &Session,
    params: shooting::Params,
    request: &SolveRequest,
) -> Result<SolveOutcome, MethodError> {
    let mut solver = Shooting::on(session.stage().clone(), params, session.kind(), request.seed)?;
    solver.converge();
    let radiosity = if request.per_element { solver.element_radiosity() } else { solver.radiosity() };
    Ok(SolveOutcome { radiosity, info: solver.info(), form_factors: None })
}

fn with_matrix(f: &FormFactors, solved: (Radiosity, MethodInfo)) -> (Radiosity, MethodInfo, FormFactors) {
    (solved.0, solved.1, f.clone())
}

/// One gather from the patch solution, with element rows of the method's own kind.
fn per_element(session: &Session, request: &SolveRequest, patches: &Radiosity) -> Result<Radiosity, MethodError> {
    let stage = session.stage();
    let rows = match request.method {
        Method::Hemicube(p) => hemicube::element_form_factors(stage, &p)?,
        Method::Progressive(_) | Method::Redistribution(_) => return Err(MethodError::NoEdits),
        Method::Gather(p) => {
            let plan = p.plan();
            let stream = Stream::new(Role::Candidate, request.seed);
            cast(&session.tracer(), &element_emitters(stage), stream, &plan, &|_| 0.0, &|_| ()).counts.form_factors()
        }
    };
    let values = element_values(stage, &rows, patches)?;
    Ok(Radiosity { bands: patches.bands, values, std_err: None })
}

fn element_values(stage: &Stage, rows: &FormFactors, patches: &Radiosity) -> Result<Vec<f64>, MethodError> {
    let vectors = PatchVectors::of(stage);
    let bands = vectors.bands;
    let spread = |v: &[f64]| -> Vec<f64> {
        let of = |e: &crate::scene::Element| {
            let (i, part) = (e.patch as usize, if e.area > 0.0 { 1.0 } else { 0.0 });
            v[i * bands..(i + 1) * bands].iter().map(move |x| x * part).collect::<Vec<_>>()
        };
        stage.elements.iter().flat_map(of).collect()
    };
    let (emission, reflectance) = (spread(&vectors.emission), spread(&vectors.reflectance));
    let system = System { emission: &emission, reflectance: &reflectance, bands };
    Ok(gather_once(&system, rows, &patches.values)?)
}
