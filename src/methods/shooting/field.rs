//! Power that has arrived, per element and per patch.

use super::fan::sinks;
use super::row::Row;
use crate::scene::Stage;

/// Power per place, channel and band, W: channel 0 is the mean, the others leave out one randomisation each.
#[derive(Debug, Clone)]
pub(super) struct Field {
    pub channels: usize,
    pub bands: usize,
    /// Per element, then per place where power is lost.
    pub elements: Vec<f64>,
    /// Per patch: the sums over its elements.
    pub patches: Vec<f64>,
    /// Patch of each element.
    owner: Vec<u32>,
}

impl Field {
    /// No power.
    pub fn dark(stage: &Stage, channels: usize) -> Self {
        let bands = stage.band_count();
        let width = channels * bands;
        Self {
            channels,
            bands,
            elements: vec![0.0; sinks(stage) * width],
            patches: vec![0.0; stage.patch_count() * width],
            owner: stage.elements.iter().map(|e| e.patch).collect(),
        }
    }

    /// Values per place.
    pub fn width(&self) -> usize {
        self.channels * self.bands
    }

    /// Adds what a shot brings: `power` has one value per channel and band.
    pub fn add(&mut self, row: &Row, power: &[f64]) {
        let (width, bands) = (self.width(), self.bands);
        for (sink, factors) in row.iter() {
            let place = &mut self.elements[sink * width..(sink + 1) * width];
            let patch = self.owner.get(sink).map(|p| *p as usize * width);
            for (k, factor) in factors.iter().enumerate() {
                for c in k * bands..(k + 1) * bands {
                    let arrives = factor * power[c];
                    place[c] += arrives;
                    if let Some(at) = patch {
                        self.patches[at + c] += arrives;
                    }
                }
            }
        }
    }

    /// Adds another field.
    pub fn join(&mut self, other: &Self) {
        self.elements.iter_mut().zip(&other.elements).for_each(|(a, b)| *a += b);
        self.patches.iter_mut().zip(&other.patches).for_each(|(a, b)| *a += b);
    }

    /// Mean power of a band at a place behind the elements.
    pub fn at(&self, sink: usize, band: usize) -> f64 {
        self.elements[sink * self.width() + band]
    }
}
