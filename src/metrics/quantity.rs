//! The scalar that is compared: luminance or one band, with or without emission.

use super::types::{Judged, Truth};

/// A weighted sum of bands, of B or of B - E.
#[derive(Debug, Clone)]
pub(super) struct Quantity<'a> {
    weights: Vec<f64>,
    /// Taken off before weighting; receiver-major.
    emission: Option<&'a [f64]>,
}

impl<'a> Quantity<'a> {
    /// Luminance of B, or of B - E.
    pub fn luminance(judged: &Judged<'a>, reflected: bool) -> Self {
        Self { weights: judged.weights.to_vec(), emission: reflected.then_some(judged.emission) }
    }

    /// One band of B, or of B - E.
    pub fn band(judged: &Judged<'a>, band: usize, reflected: bool) -> Self {
        let weights = (0..judged.bands.len()).map(|c| f64::from(u8::from(c == band))).collect();
        Self { weights, emission: reflected.then_some(judged.emission) }
    }

    /// Its value at every receiver.
    pub fn of(&self, radiosities: &[f64]) -> Vec<f64> {
        let bands = self.weights.len();
        let weigh = |values: &[f64]| self.weights.iter().zip(values).map(|(w, v)| w * v).sum::<f64>();
        let whole = radiosities.chunks_exact(bands).map(weigh);
        match self.emission {
            None => whole.collect(),
            Some(e) => whole.zip(e.chunks_exact(bands)).map(|(b, e)| beyond(b, weigh(e))).collect(),
        }
    }

    /// Its value at every receiver, per replicate of a reference; one row for a solution.
    pub fn of_truth(&self, truth: &Truth) -> Vec<Vec<f64>> {
        match truth {
            Truth::Sampled(r) => r.replicates.iter().map(|b| self.of(b)).collect(),
            Truth::Given(r) => vec![self.of(&r.values)],
        }
    }

    /// Upper bound of the standard error at every receiver: bands share rays, so their errors may be fully correlated.
    pub fn std_err_bound(&self, std_err: &[f64]) -> Vec<f64> {
        let add = |values: &[f64]| self.weights.iter().zip(values).map(|(w, v)| w.abs() * v).sum::<f64>();
        std_err.chunks_exact(self.weights.len()).map(add).collect()
    }
}

/// B - E, and nothing where B is E up to the rounding of a solver: a relative error against that would be noise.
fn beyond(b: f64, e: f64) -> f64 {
    const ROUNDING: f64 = 1e-12;
    if (b - e).abs() <= ROUNDING * e.abs() { 0.0 } else { b - e }
}

/// Mean over the rows at every receiver.
pub(super) fn mean_of(rows: &[Vec<f64>]) -> Vec<f64> {
    mean_of_some(rows, |_| true)
}

/// Mean over the rows whose number is chosen.
pub(super) fn mean_of_some(rows: &[Vec<f64>], chosen: impl Fn(usize) -> bool) -> Vec<f64> {
    let rows: Vec<&Vec<f64>> = rows.iter().enumerate().filter(|(r, _)| chosen(*r)).map(|(_, v)| v).collect();
    let mut sum = rows.first().map_or(Vec::new(), |v| vec![0.0; v.len()]);
    for row in &rows {
        sum.iter_mut().zip(*row).for_each(|(s, v)| *s += v);
    }
    sum.iter().map(|s| s / rows.len() as f64).collect()
}
