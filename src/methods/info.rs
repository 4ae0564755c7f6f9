//! What every method says about its own run, and the vectors every method starts from.

use crate::math::compensated_sum;
use crate::scene::Stage;
use crate::solution::FormFactors;
use crate::solver::System;

/// How a method came to its solution. No clocks in it: the same input gives the same info.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodInfo {
    /// Iterations of the solver, per band; shots for methods that shoot.
    pub iterations: Vec<usize>,
    /// Relative residual of the patch system that is left, per band.
    pub residual: Vec<f64>,
    /// Row sums of the form factors used; `None` for methods that forget their form factors shot by shot.
    pub row_sums: Option<RowSums>,
}

/// Sums of the form-factor rows of the patches present; 1 each in an exact closed scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowSums {
    /// Smallest.
    pub min: f64,
    /// Largest; reflectances above its inverse make the system lose its diagonal dominance.
    pub max: f64,
    /// Mean.
    pub mean: f64,
}

impl RowSums {
    /// Row sums over the patches present; all 0 where there are none.
    pub fn of(stage: &Stage, form_factors: &FormFactors) -> Self {
        let present = (0..form_factors.n).filter(|i| stage.patches[*i].is_present());
        let sums: Vec<f64> = present.map(|i| form_factors.row_sum(i)).collect();
        if sums.is_empty() {
            return Self { min: 0.0, max: 0.0, mean: 0.0 };
        }
        let min = sums.iter().copied().fold(f64::INFINITY, f64::min);
        let max = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self { min, max, mean: compensated_sum(sums.iter().copied()) / sums.len() as f64 }
    }
}

/// Emission and reflectance of every patch, n x bands; both 0 for patches that take no part, so that their
/// radiosities are 0.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchVectors {
    /// Number of bands.
    pub bands: usize,
    /// Self-emitted radiosity E, W/m^2.
    pub emission: Vec<f64>,
    /// Reflectance rho.
    pub reflectance: Vec<f64>,
}

impl PatchVectors {
    /// The vectors of a stage.
    pub fn of(stage: &Stage) -> Self {
        Self { bands: stage.band_count(), emission: stage.emissions(), reflectance: stage.reflectances() }
    }

    /// As a system to be solved.
    pub fn system(&self) -> System<'_> {
        System { emission: &self.emission, reflectance: &self.reflectance, bands: self.bands }
    }
}
