//! Random closed and open rooms with random errors, dense: what the bounds of a residual are tried on.

use super::residual::{Rebounded, norms};
use super::residual_bounds::Norms;
use super::types::Judged;
use crate::solution::{Radiosity, Replicates};
use crate::stats::test_random::Random;

/// A random patch system with its exact solution and a wrong one.
pub(super) struct Room {
    pub areas: Vec<f64>,
    pub form_factors: Vec<Vec<f64>>,
    pub reflectance: Vec<f64>,
    pub emission: Vec<f64>,
    pub truth: Vec<f64>,
    pub solution: Vec<f64>,
    pub weights: Vec<f64>,
    pub bands: usize,
}

impl Room {
    /// Every third has equal reflectances in all bands, every fifth is open; errors are patchwise or a common factor.
    pub fn new(seed: u64, n: usize, bands: usize) -> Self {
        let mut random = Random(seed);
        let (areas, form_factors) = reciprocal(&mut random, n, if seed.is_multiple_of(5) { 0.6 } else { 1.0 });
        let highest = 0.95 * random.uniform();
        let mut reflectance: Vec<f64> = (0..n * bands).map(|_| highest * random.uniform()).collect();
        if seed.is_multiple_of(3) {
            (0..n * bands).for_each(|k| reflectance[k] = reflectance[k / bands * bands]);
        }
        let emission = (0..n * bands).map(|k| if k < bands { 1.0 + random.uniform() } else { 0.0 }).collect();
        let weights = (0..bands).map(|_| 0.1 + random.uniform()).collect();
        let mut room =
            Self { areas, form_factors, reflectance, emission, truth: vec![], solution: vec![], weights, bands };
        let mut b = room.emission.clone();
        (0..2000).for_each(|_| b = room.bounced(&b, true));
        let size = 0.2 * random.uniform();
        let wrong = |b: &f64| b * (1.0 + size * if seed.is_multiple_of(2) { 1.0 } else { random.normal() });
        room.solution = b.iter().map(wrong).collect();
        room.truth = b;
        room
    }

    /// `K x`, with E added where asked for.
    fn bounced(&self, x: &[f64], add_emission: bool) -> Vec<f64> {
        let value = |k: usize| {
            let (i, c) = (k / self.bands, k % self.bands);
            let gathered: f64 = self.form_factors[i].iter().enumerate().map(|(j, f)| f * x[j * self.bands + c]).sum();
            self.reflectance[k] * gathered + if add_emission { self.emission[k] } else { 0.0 }
        };
        (0..x.len()).map(value).collect()
    }

    fn luminance_norm(&self, x: impl Fn(usize) -> f64) -> f64 {
        let y = |i: usize| (0..self.bands).map(|c| self.weights[c] * x(i * self.bands + c)).sum::<f64>();
        self.areas.iter().enumerate().map(|(i, a)| a * y(i).powi(2)).sum::<f64>().sqrt()
    }

    /// `|e_Y| / |B*_Y|`.
    pub fn true_error(&self) -> f64 {
        self.luminance_norm(|k| self.solution[k] - self.truth[k]) / self.luminance_norm(|k| self.truth[k])
    }

    /// Residual and series without noise.
    pub fn series(&self, bounces: u32) -> (Vec<f64>, Vec<f64>) {
        let mut term: Vec<f64> =
            self.bounced(&self.solution, true).iter().zip(&self.solution).map(|(a, b)| a - b).collect();
        let (first, mut sum) = (term.clone(), term.clone());
        for _ in 1..bounces {
            term = self.bounced(&term, false);
            sum.iter_mut().zip(&term).for_each(|(s, t)| *s += t);
        }
        (first, sum)
    }

    pub fn norms(&self, bounces: u32) -> Norms {
        let (residual, series) = self.series(bounces);
        let replicates = |v: &Vec<f64>| Replicates { bands: self.bands, replicates: vec![v.clone(); 4] };
        let (residual, series) = (replicates(&residual), replicates(&series));
        let given = Rebounded { residual: &residual, series: &series, bounces, reflectance: &self.reflectance };
        let solution = Radiosity { bands: self.bands, values: self.solution.clone(), std_err: None };
        let names: Vec<String> = (0..self.bands).map(|c| format!("b{c}")).collect();
        let judged = Judged {
            areas: &self.areas,
            emission: &self.emission,
            surfaces: &vec!["s"; self.areas.len()],
            bands: &names,
            weights: &self.weights,
        };
        norms(&solution, &given, &judged, &self.weights, 0.95, false)
    }
}

/// Areas and form factors of a random room: a symmetric matrix of exchange areas `A_i F_ij`, balanced until every row
/// sums to `sum`.
fn reciprocal(random: &mut Random, n: usize, sum: f64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut exchange = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..i {
            let x = random.uniform().powi(2) + 1e-3;
            (exchange[i][j], exchange[j][i]) = (x, x);
        }
    }
    // Areas as the rows have it: a room whose walls are as large as what they exchange.
    let areas: Vec<f64> = exchange.iter().map(|row| row.iter().sum::<f64>() / sum).collect();
    let form_factors = exchange.iter().zip(&areas).map(|(row, a)| row.iter().map(|x| x / a).collect()).collect();
    (areas, form_factors)
}
