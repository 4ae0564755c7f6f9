//! Power that has arrived, per element and per patch.

use super::fan::sinks;
use super::row::{Entry, Row};
use crate::scene::Stage;

/// Power per place, channel and band, W. Channel 0 is of all rays. Channel r + 1 is a solution of its own, by the rays of
/// randomisation r alone and the same shots: the spread of these is the standard error of the first, and a ray costs two
/// additions, not one for each randomisation.
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
        for entry in row.iter() {
            let place = &mut self.elements[entry.sink * width..][..width];
            let patch = self.owner.get(entry.sink).map(|p| &mut self.patches[*p as usize * width..][..width]);
            scatter(place, bands, &entry, power);
            if let Some(patch) = patch {
                scatter(patch, bands, &entry, power);
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

fn scatter(place: &mut [f64], bands: usize, entry: &Entry, power: &[f64]) {
    for c in 0..bands {
        place[c] += entry.mean * power[c];
    }
    for (channel, factor) in entry.parts {
        let first = *channel as usize * bands;
        for c in first..first + bands {
            place[c] += factor * power[c];
        }
    }
}
