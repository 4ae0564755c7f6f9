//! The Gauss-Seidel iteration of the hemi-cube paper.
//!
//! It starts from B = E and solves each receiver's equation in turn with the newest radiosities of the others,
//! until no radiosity changes by more than a small percentage. It works row by row and so needs the matrix.

use super::system::{check_finite, gather_row};
use super::{Norm, SolverError, System, relative_residual};
use crate::solution::FormFactors;

/// Name in messages.
const NAME: &str = "the Gauss-Seidel iteration";

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Largest change of any radiosity in the last iteration, as a fraction of its new value; 0.001 is 0.1 %.
    pub tolerance: f64,
    /// Iterations allowed.
    pub max_iterations: usize,
}

impl Default for Params {
    fn default() -> Self {
        Self { tolerance: 1e-3, max_iterations: 10_000 }
    }
}

/// What an iteration has done.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Number of the iteration, from 1.
    pub iteration: usize,
    /// Largest relative change of a radiosity, per band; the last one of a band that has come to rest.
    pub change: &'a [f64],
    /// Radiosities after it, n x bands.
    pub radiosity: &'a [f64],
}

/// How the iteration ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// Iterations, per band.
    pub iterations: Vec<usize>,
    /// `|E - (I - rho F) B| / |E|`, per band: how much of the system is left unsolved.
    pub residual: Vec<f64>,
}

/// Solves `(I - diag(rho) F) B = E`; every band stops on its own, as if it had been solved alone [CG85 eq. 2].
pub fn solve(
    system: &System,
    form_factors: &FormFactors,
    params: &Params,
    mut on_iteration: impl FnMut(Step),
) -> Result<(Vec<f64>, Info), SolverError> {
    system.check(form_factors.n)?;
    let diagonal = diagonal(system, form_factors)?;
    let mut b = system.emission.to_vec();
    let mut iterations = vec![0; system.bands];
    let mut change = vec![f64::INFINITY; system.bands];
    for iteration in 1..=params.max_iterations {
        let active: Vec<bool> = change.iter().map(|c| *c > params.tolerance).collect();
        if !active.contains(&true) {
            break;
        }
        sweep(system, form_factors, &diagonal, &active, &mut b, &mut change);
        iterations.iter_mut().zip(&active).filter(|(_, a)| **a).for_each(|(n, _)| *n = iteration);
        check_range(&b, system.bands, iteration)?;
        on_iteration(Step { iteration, change: &change, radiosity: &b });
    }
    let residual = relative_residual(system, form_factors, &b, Norm::default())?;
    match change.iter().position(|c| *c > params.tolerance) {
        None => Ok((b, Info { iterations, residual })),
        Some(band) => Err(SolverError::NotConverged {
            solver: NAME,
            iterations: params.max_iterations,
            band,
            residual: residual[band],
        }),
    }
}

/// The diagonal `1 - rho_i F_ii`, n x bands; one for planar patches, which do not see themselves.
fn diagonal(system: &System, f: &FormFactors) -> Result<Vec<f64>, SolverError> {
    let mut diagonal = Vec::with_capacity(system.emission.len());
    for (k, rho) in system.reflectance.iter().enumerate() {
        let receiver = k / system.bands;
        let product = rho * f.get(receiver, receiver);
        if product >= 1.0 {
            return Err(SolverError::Singular { receiver, product });
        }
        diagonal.push(1.0 - product);
    }
    Ok(diagonal)
}

/// One iteration over all receivers in their order; leaves the largest relative change of each active band.
fn sweep(system: &System, f: &FormFactors, diagonal: &[f64], active: &[bool], b: &mut [f64], change: &mut [f64]) {
    let bands = system.bands;
    let mut gathered = vec![0.0; bands];
    change.iter_mut().zip(active).filter(|(_, a)| **a).for_each(|(c, _)| *c = 0.0);
    for i in 0..f.n {
        gather_row(f, i, b, &mut gathered);
        for c in (0..bands).filter(|c| active[*c]) {
            let k = i * bands + c;
            // What the receiver sees of itself is on the left-hand side, in the diagonal.
            let own = (1.0 - diagonal[k]) * b[k];
            let new = (system.emission[k] + system.reflectance[k] * gathered[c] - own) / diagonal[k];
            change[c] = change[c].max(relative_change(b[k], new));
            b[k] = new;
        }
    }
}

fn relative_change(old: f64, new: f64) -> f64 {
    if old == new { 0.0 } else { ((new - old) / new).abs() }
}

fn check_range(b: &[f64], bands: usize, iterations: usize) -> Result<(), SolverError> {
    check_finite("the radiosity", b, bands).map_err(|e| match e {
        SolverError::NotFinite { band, .. } => SolverError::Diverged { solver: NAME, iterations, band },
        other => other,
    })
}

#[cfg(test)]
mod tests {
    use super::super::system::tests::dense;
    use super::*;

    fn solve_quietly(s: &System, f: &FormFactors, p: &Params) -> Result<(Vec<f64>, Info), SolverError> {
        solve(s, f, p, |_| ())
    }

    #[test]
    fn bands_stop_on_their_own() {
        let f = dense(12, 1.0);
        let mixed: Vec<f64> = (0..24).map(|k| if k % 2 == 0 { 0.2 } else { 0.8 }).collect();
        let e: Vec<f64> = (0..24).map(|k| if k < 2 { 1.0 } else { 0.0 }).collect();
        let system = System { emission: &e, reflectance: &mixed, bands: 2 };
        let (b, info) = solve_quietly(&system, &f, &Params::default()).unwrap();
        for (c, rho) in [(0, 0.2), (1, 0.8)] {
            let (e, rho) = (e.iter().step_by(2).copied().collect::<Vec<_>>(), vec![rho; 12]);
            let alone = System { emission: &e, reflectance: &rho, bands: 1 };
            let (single, single_info) = solve_quietly(&alone, &f, &Params::default()).unwrap();
            assert!((0..12).all(|i| b[2 * i + c] == single[i]));
            assert_eq!(info.iterations[c], single_info.iterations[0]);
        }
        assert!(info.iterations[0] < info.iterations[1]);
    }

    #[test]
    fn a_receiver_that_sees_itself_is_solved_for() {
        // One sphere: F = 1, B = E / (1 - rho) in a single step.
        let f = FormFactors::from_exact_rows(vec![vec![(0, 1.0)]]);
        let system = System { emission: &[2.0], reflectance: &[0.75], bands: 1 };
        let (b, info) = solve_quietly(&system, &f, &Params::default()).unwrap();
        assert_eq!((b[0], info.iterations[0]), (8.0, 2));
        let mirror = System { emission: &[2.0], reflectance: &[1.0], bands: 1 };
        assert!(matches!(solve_quietly(&mirror, &f, &Params::default()), Err(SolverError::Singular { .. })));
    }

    #[test]
    fn too_few_iterations_say_what_is_left() {
        let f = dense(12, 1.0);
        let system = System { emission: &[1.0; 12], reflectance: &[0.9; 12], bands: 1 };
        let params = Params { tolerance: 1e-9, max_iterations: 3 };
        let Err(SolverError::NotConverged { iterations: 3, residual, .. }) = solve_quietly(&system, &f, &params) else {
            panic!("three iterations cannot be enough");
        };
        assert!(residual > 0.1 && residual < 1.0);
    }

    #[test]
    fn rows_that_make_light_are_found_out() {
        let f = dense(6, 1.5);
        let system = System { emission: &[1.0; 6], reflectance: &[0.9; 6], bands: 1 };
        let failed = solve_quietly(&system, &f, &Params::default()).unwrap_err();
        assert!(matches!(failed, SolverError::Diverged { band: 0, .. }), "{failed}");
    }

    #[test]
    fn darkness_stays_dark() {
        let f = dense(6, 1.0);
        let system = System { emission: &[0.0; 6], reflectance: &[0.9; 6], bands: 1 };
        let (b, info) = solve_quietly(&system, &f, &Params::default()).unwrap();
        assert_eq!((b, info.residual), (vec![0.0; 6], vec![0.0]));
    }
}
