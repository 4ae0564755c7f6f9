//! What the rows of a matrix stand for, and matrices by surface.

use crate::math::Compensated;
use crate::scene::{OBSTRUCTIONS, Stage};
use crate::solution::FormFactors;
use std::collections::BTreeMap;

/// Names, areas and emittances of the rows.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub names: Vec<String>,
    /// m^2; 0 for absent patches.
    pub areas: Vec<f64>,
    /// 1 - reflectance, weighted by luminance, and by area where patches are put together.
    pub emittances: Vec<f64>,
    /// Per patch: its row, if it has one.
    row_of: Vec<Option<u32>>,
}

impl Rows {
    /// One row per patch; `radiating` leaves out what only blocks.
    pub(super) fn patches(stage: &Stage, radiating: bool) -> Self {
        let mut count = vec![0u32; stage.surfaces.len()];
        stage.patches.iter().for_each(|p| count[p.surface as usize] += 1);
        let mut seen = vec![0u32; stage.surfaces.len()];
        let mut rows = Self::default();
        for (i, patch) in stage.patches.iter().enumerate() {
            let surface = patch.surface as usize;
            let name = printable(&stage.surfaces[surface].name);
            let k = seen[surface];
            seen[surface] += 1;
            if radiating && blocks(stage, surface) {
                rows.row_of.push(None);
                continue;
            }
            rows.row_of.push(Some(rows.names.len() as u32));
            rows.names.push(if count[surface] == 1 { name } else { format!("{name}[{k}]") });
            rows.areas.push(patch.area);
            rows.emittances.push(emittance(stage, i));
        }
        rows
    }

    /// One row per surface that takes part, in order of their numbers; what only blocks is left out.
    pub(super) fn surfaces(stage: &Stage) -> Self {
        let mut area = vec![0.0; stage.surfaces.len()];
        let mut absorbing = vec![0.0; stage.surfaces.len()];
        for (i, patch) in stage.patches.iter().enumerate() {
            area[patch.surface as usize] += patch.area;
            absorbing[patch.surface as usize] += patch.area * emittance(stage, i);
        }
        let mut rows = Self::default();
        let mut row_of = vec![None; stage.surfaces.len()];
        for (surface, own) in stage.surfaces.iter().enumerate() {
            if area[surface] > 0.0 && !blocks(stage, surface) {
                row_of[surface] = Some(rows.names.len() as u32);
                rows.names.push(printable(&own.name));
                rows.areas.push(area[surface]);
                rows.emittances.push(absorbing[surface] / area[surface]);
            }
        }
        rows.row_of = stage.patches.iter().map(|p| row_of[p.surface as usize]).collect();
        rows
    }

    pub(super) fn len(&self) -> usize {
        self.names.len()
    }
}

fn blocks(stage: &Stage, surface: usize) -> bool {
    stage.surfaces[surface].object == OBSTRUCTIONS
}

fn emittance(stage: &Stage, patch: usize) -> f64 {
    // What the luminance weights do not add up to 1 for is no part of a mean.
    let total: f64 = stage.photometry.weights.iter().sum();
    1.0 - stage.photometry.luminance(stage.reflectance(patch)) / total
}

fn printable(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}

/// The matrix by rows: `A_g F_gh` is the sum of `A_i F_ij`. The standard error of a sum is at most the sum of the
/// standard errors, whatever their correlation; that is what it is given as.
pub(super) fn merged(stage: &Stage, f: &FormFactors, rows: &Rows) -> FormFactors {
    let mut sums: Vec<BTreeMap<u32, (Compensated, Compensated)>> = vec![BTreeMap::new(); rows.len()];
    for (i, g) in rows.row_of.iter().enumerate() {
        let Some(g) = g else { continue };
        let area = rows.areas[*g as usize];
        let weight = if area > 0.0 { stage.patches[i].area / area } else { 0.0 };
        for k in f.row_starts[i]..f.row_starts[i + 1] {
            let Some(h) = rows.row_of[f.columns[k] as usize] else { continue };
            let (value, error) = sums[*g as usize].entry(h).or_default();
            value.add(weight * f.values[k]);
            error.add(weight * f.std_err.as_ref().map_or(0.0, |e| e[k]));
        }
    }
    let row = |sums: BTreeMap<u32, (Compensated, Compensated)>| {
        sums.into_iter().map(|(h, (value, error))| (h, value.value(), error.value())).collect()
    };
    let mut merged = FormFactors::from_rows(sums.into_iter().map(row).collect());
    if f.std_err.is_none() {
        merged.std_err = None;
    }
    merged
}
