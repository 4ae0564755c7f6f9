//! Power that has arrived, per element and per patch.

use super::fan::sinks;
use super::row::Row;
use crate::scene::Stage;
use rayon::prelude::*;

/// Rays of a row from which on its randomisations are booked in parallel.
const MANY_RAYS: usize = 4096;

/// Power that has arrived, W. Plane 0 is of all rays. Plane r + 1 is a solution of its own, by the rays of randomisation
/// r alone and the same shots: the spread of these is the standard error of the first, and a ray costs two additions,
/// not one for each randomisation.
#[derive(Debug, Clone)]
pub(super) struct Field {
    pub bands: usize,
    pub planes: Vec<Plane>,
    /// Patch of each element.
    owner: Vec<u32>,
}

/// One solution.
#[derive(Debug, Clone)]
pub(super) struct Plane {
    /// Per element, then per place where power is lost; x bands.
    pub elements: Vec<f64>,
    /// Per patch, the sums over its elements; x bands.
    pub patches: Vec<f64>,
}

impl Plane {
    fn add(&mut self, owner: &[u32], bands: usize, sink: u32, factor: f64, power: &[f64]) {
        let at = sink as usize * bands;
        for (place, p) in self.elements[at..at + bands].iter_mut().zip(power) {
            *place += factor * p;
        }
        if let Some(patch) = owner.get(sink as usize) {
            let at = *patch as usize * bands;
            for (place, p) in self.patches[at..at + bands].iter_mut().zip(power) {
                *place += factor * p;
            }
        }
    }
}

impl Field {
    /// No power.
    pub fn dark(stage: &Stage, channels: usize) -> Self {
        let bands = stage.band_count();
        let plane =
            Plane { elements: vec![0.0; sinks(stage) * bands], patches: vec![0.0; stage.patch_count() * bands] };
        Self { bands, planes: vec![plane; channels], owner: stage.elements.iter().map(|e| e.patch).collect() }
    }

    /// Number of solutions.
    pub fn channels(&self) -> usize {
        self.planes.len()
    }

    /// Values per place over all planes.
    pub fn width(&self) -> usize {
        self.channels() * self.bands
    }

    /// Adds what a shot brings: `power` has one value per channel and band.
    pub fn add(&mut self, row: &Row, power: &[f64]) {
        let (bands, owner) = (self.bands, &self.owner);
        let Some((mean, replicates)) = self.planes.split_first_mut() else { return };
        row.iter().for_each(|(sink, factor)| mean.add(owner, bands, sink, factor, &power[..bands]));
        let book = |(r, plane): (usize, &mut Plane)| {
            let power = &power[(r + 1) * bands..(r + 2) * bands];
            for (sink, by) in row.rays.get(r).into_iter().flatten() {
                plane.add(owner, bands, *sink, f64::from(*by) * row.share, power);
            }
        };
        if row.rays.iter().map(Vec::len).sum::<usize>() < MANY_RAYS {
            replicates.iter_mut().enumerate().for_each(book);
        } else {
            replicates.par_iter_mut().enumerate().for_each(book);
        }
    }

    /// Adds another field.
    pub fn join(&mut self, other: &Self) {
        for (mine, theirs) in self.planes.iter_mut().zip(&other.planes) {
            mine.elements.iter_mut().zip(&theirs.elements).for_each(|(a, b)| *a += b);
            mine.patches.iter_mut().zip(&theirs.patches).for_each(|(a, b)| *a += b);
        }
    }

    /// Power that patch i has received; `channel` counts planes and bands, bands running faster.
    #[inline]
    pub fn of_patch(&self, i: usize, channel: usize) -> f64 {
        self.planes[channel / self.bands].patches[i * self.bands + channel % self.bands]
    }

    /// Mean power of a band at a place behind the elements.
    pub fn at(&self, sink: usize, band: usize) -> f64 {
        self.planes[0].elements[sink * self.bands + band]
    }
}
