//! The full-matrix method with form factors by rays (pairs settled without where asked), solved exactly, with
//! standard errors.

mod params;

pub use params::{Params, ParamsError};

use super::{MethodInfo, PatchVectors, RowSums};
use crate::estimate::{Blend, Casting, cast, patch_emitters, settle};
use crate::raycast::Tracer;
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::solution::{FormFactors, Radiosity};
use crate::solver::{SolverError, System, Transport, krylov};

/// Casts the candidate's rays: never the judge's, whatever the seed.
pub fn form_factors(tracer: &Tracer, params: &Params, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Casting {
    let plan = params.plan();
    let stream = Stream::new(Role::Candidate, seed);
    cast(tracer, &patch_emitters(tracer.stage()), stream, &plan, &|_| 0.0, progress)
}

/// Casts and solves; standard errors by leaving out one randomisation at a time. Also returns the form factors.
pub fn solve(
    tracer: &Tracer,
    params: &Params,
    seed: u64,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<(Radiosity, MethodInfo, FormFactors), SolverError> {
    let settled = settle(tracer.stage(), &params.plan(), &|_| ());
    let counts = form_factors(tracer, params, seed, progress).counts;
    let blend = settled.as_ref().map_or_else(|| Blend::of_rays(&counts), |s| Blend::new(s, &counts));
    let matrix = blend.form_factors();
    let (mut radiosity, info) = solve_with(tracer.stage(), &matrix)?;
    radiosity.std_err = Some(std_err(tracer.stage(), &blend, &radiosity)?);
    Ok((radiosity, info, matrix))
}

/// Solves the patch system of given form factors exactly.
pub fn solve_with(stage: &Stage, form_factors: &FormFactors) -> Result<(Radiosity, MethodInfo), SolverError> {
    let vectors = PatchVectors::of(stage);
    let (values, info) = krylov::solve(&vectors.system(), form_factors, None, &krylov::Params::default(), |_, _| {})?;
    let row_sums = Some(RowSums::of(stage, form_factors));
    let info = MethodInfo { iterations: info.iterations, residual: info.residual, row_sums };
    Ok((Radiosity { bands: vectors.bands, values, std_err: None }, info))
}

/// Standard errors per patch and band: of the rays and of the settled pairs, as if independent.
fn std_err(stage: &Stage, blend: &Blend, mean: &Radiosity) -> Result<Vec<f64>, SolverError> {
    let vectors = PatchVectors::of(stage);
    let brightest = vectors.reflectance.iter().copied().fold(0.0, f64::max);
    let settled = blend.settled_noise(&mean.values, vectors.bands);
    let grown = settled.iter().zip(&vectors.reflectance).map(|(noise, rho)| rho * noise / (1.0 - brightest));
    Ok(jackknife_std_err(stage, blend, mean)?.into_iter().zip(grown).map(|(a, b): (f64, f64)| a.hypot(b)).collect())
}

/// `sqrt((R - 1) / R sum (B_without_r - mean)^2)` per patch and band.
fn jackknife_std_err(stage: &Stage, blend: &Blend, mean: &Radiosity) -> Result<Vec<f64>, SolverError> {
    let vectors = PatchVectors::of(stage);
    let (bands, counts) = (vectors.bands, blend.counts());
    let wide = |v: &[f64]| counts.repeated(v, bands);
    let (emission, reflectance) = (wide(&vectors.emission), wide(&vectors.reflectance));
    let randomisations = usize::from(counts.randomisations);
    let system = System { emission: &emission, reflectance: &reflectance, bands: bands * randomisations };
    let params = krylov::Params { tolerance: 1e-9, ..krylov::Params::default() };
    let guess = wide(&mean.values);
    let (without, _) = krylov::solve(&system, &LeaveOneOut(blend), Some(&guess), &params, |_, _| {})?;
    let r = randomisations as f64;
    let spread = |(i, c): (usize, usize)| {
        let all: Vec<f64> = (0..randomisations).map(|k| without[(i * randomisations + k) * bands + c]).collect();
        let centre = all.iter().sum::<f64>() / r;
        ((r - 1.0) / r * all.iter().map(|b| (b - centre).powi(2)).sum::<f64>()).sqrt()
    };
    Ok((0..mean.len()).flat_map(|i| (0..bands).map(move |c| (i, c))).map(spread).collect())
}

/// All leave-one-out matrices at once.
struct LeaveOneOut<'a>(&'a Blend<'a>);

impl Transport for LeaveOneOut<'_> {
    fn len(&self) -> usize {
        self.0.counts().rows.len()
    }

    fn apply(&self, x: &[f64], width: usize, y: &mut [f64]) {
        self.0.apply_leave_one_out(x, width, y);
    }
}
