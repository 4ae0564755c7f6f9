//! What errors of form factors do to radiosities, carried through the solve.
//!
//! With `F~ = F + sum_c E_c` and both systems solved, the difference is linear in the causes, exactly:
//! `(I - rho F)(B~ - B) = rho sum_c E_c B~`. So the error of the solution is split as its form factors are.

use super::causes::{Cause, Pair};
use super::split::Split;
use crate::methods::PatchVectors;
use crate::scene::Stage;
use crate::solution::FormFactors;
use crate::solver::{SolverError, System, krylov};
use rayon::prelude::*;

/// Residual to which systems are solved here: far below any error that is looked at.
const RESIDUAL: f64 = 1e-12;

/// Radiosities, n x bands each, W/m^2.
#[derive(Debug, Clone)]
pub struct Effect {
    /// With the true form factors (the mean matrix of the judge).
    pub truth: Vec<f64>,
    /// With the hemi-cube's.
    pub cube: Vec<f64>,
    /// What each cause does, in the order of [`Cause::ALL`]: they add up to `cube - truth`.
    pub parts: [Vec<f64>; 3],
    /// With the hemi-cube's form factors but for one cause.
    pub without: [Vec<f64>; 3],
    /// With the exact values at the centres: a hemi-cube of infinite resolution.
    pub point: Vec<f64>,
}

impl Effect {
    /// Solves with all these matrices.
    ///
    /// # Errors
    /// Systems that have no solution: form factors of shooters may sum to more than the inverse reflectance.
    pub fn of(stage: &Stage, split: &Split) -> Result<Self, SolverError> {
        let vectors = PatchVectors::of(stage);
        let mean = split.matrix(|p| p.mean);
        let truth = solved(&vectors.emission, &vectors, &mean, None)?;
        let with = |of: &dyn Fn(&Pair) -> f64| solved(&vectors.emission, &vectors, &split.matrix(of), Some(&truth));
        let cube = with(&|p| p.cube)?;
        let point = with(&|p| p.point)?;
        let mut parts: [Vec<f64>; 3] = Default::default();
        let mut without: [Vec<f64>; 3] = Default::default();
        for (k, cause) in Cause::ALL.into_iter().enumerate() {
            let source = first_bounce(&vectors, &split.matrix(|p| p.part(cause)), &cube);
            parts[k] = solved(&source, &vectors, &mean, None)?;
            without[k] = with(&|p| p.cube - p.part(cause))?;
        }
        Ok(Self { truth, cube, parts, without, point })
    }
}

/// Radiosities with a matrix, n x bands, W/m^2.
///
/// # Errors
/// A system that has no solution.
pub fn radiosity(stage: &Stage, f: &FormFactors) -> Result<Vec<f64>, SolverError> {
    let vectors = PatchVectors::of(stage);
    solved(&vectors.emission, &vectors, f, None)
}

fn solved(
    source: &[f64],
    vectors: &PatchVectors,
    f: &FormFactors,
    guess: Option<&[f64]>,
) -> Result<Vec<f64>, SolverError> {
    let system = System { emission: source, reflectance: &vectors.reflectance, bands: vectors.bands };
    let params = krylov::Params { tolerance: RESIDUAL, ..krylov::Params::default() };
    Ok(krylov::solve(&system, f, guess, &params, |_, _| ())?.0)
}

/// `rho F B`, all bands.
pub(super) fn first_bounce(vectors: &PatchVectors, f: &FormFactors, b: &[f64]) -> Vec<f64> {
    let bands = vectors.bands;
    let mut out = vec![0.0; b.len()];
    out.par_chunks_mut(bands.max(1)).enumerate().for_each(|(i, out)| {
        for (j, value) in f.row(i) {
            out.iter_mut().zip(&b[j * bands..]).for_each(|(o, x)| *o += value * x);
        }
        out.iter_mut().zip(&vectors.reflectance[i * bands..]).for_each(|(o, rho)| *o *= rho);
    });
    out
}
