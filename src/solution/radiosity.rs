//! Radiosities per patch (or element) and band, single or replicated.

use serde::{Deserialize, Serialize};

/// One radiosity per receiver and band, W/m^2. Row-major: receiver i, band c at `i * bands + c`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Radiosity {
    /// Number of bands.
    pub bands: usize,
    /// Values; absent receivers hold 0.
    pub values: Vec<f64>,
    /// Standard errors in the same order; `None` for a method that states none.
    pub std_err: Option<Vec<f64>>,
}

impl Radiosity {
    /// Number of receivers.
    pub fn len(&self) -> usize {
        self.values.len() / self.bands
    }

    /// True if there are no receivers.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Values of a receiver, one per band.
    pub fn of(&self, i: usize) -> &[f64] {
        &self.values[i * self.bands..(i + 1) * self.bands]
    }

    /// Standard errors of a receiver, one per band.
    pub fn std_err_of(&self, i: usize) -> Option<&[f64]> {
        self.std_err.as_ref().map(|e| &e[i * self.bands..(i + 1) * self.bands])
    }
}

/// R independent estimates of the same radiosities, one per randomisation of the whole scene. Each is unbiased
/// on its own; their spread is the error, correlations between patches included.
#[derive(Debug, Clone, PartialEq)]
pub struct Replicates {
    /// Number of bands.
    pub bands: usize,
    /// One vector per replicate, laid out as [`Radiosity::values`].
    pub replicates: Vec<Vec<f64>>,
}

impl Replicates {
    /// Number of replicates R.
    pub fn count(&self) -> usize {
        self.replicates.len()
    }

    /// Number of receivers.
    pub fn len(&self) -> usize {
        self.replicates.first().map_or(0, |r| r.len() / self.bands)
    }

    /// True if there are no receivers.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Mean over the replicates, with the standard error of that mean.
    pub fn mean(&self) -> Radiosity {
        let r = self.count() as f64;
        let width = self.replicates[0].len();
        let mut values = Vec::with_capacity(width);
        let mut errors = Vec::with_capacity(width);
        for k in 0..width {
            let mean = self.replicates.iter().map(|v| v[k]).sum::<f64>() / r;
            let squares = self.replicates.iter().map(|v| (v[k] - mean).powi(2)).sum::<f64>();
            values.push(mean);
            errors.push((squares / (r * (r - 1.0))).sqrt());
        }
        Radiosity { bands: self.bands, values, std_err: Some(errors) }
    }
}
