//! Who brings the errors: sources by what they contribute to the error of the light, not by how bright they are.

use super::causes::Cause;
use super::split::Split;
use crate::math::compensated_sum;
use crate::methods::PatchVectors;
use crate::scene::Stage;
use crate::solution::FormFactors;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A surface as a source of error.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Source {
    /// Name of the surface.
    pub name: String,
    /// Its patches, ascending.
    pub patches: Vec<u32>,
    /// Mean luminance that leaves it.
    pub luminance: f64,
    /// `sqrt(sum A dY^2 / sum A Y^2)` over the receivers: the error that the form factors to this source bring to
    /// reflected light at the first bounce, as a share of all reflected light.
    pub error: f64,
    /// The same of each cause alone, in the order of [`Cause::ALL`].
    pub by_cause: [f64; 3],
}

impl Source {
    /// The cause with the largest share.
    pub fn main_cause(&self) -> Cause {
        Cause::largest(&self.by_cause)
    }
}

/// First-bounce errors of receivers, in luminance.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstBounce {
    /// By receiver and cause.
    pub receivers: Vec<[f64; 3]>,
    /// Standard errors of those.
    pub std_err: Vec<[f64; 3]>,
    /// Surfaces, the largest error first.
    pub sources: Vec<Source>,
}

/// What the pairs do at the first bounce from radiosities `b` (n x bands), by receiver and by source. `reflected`:
/// reflected luminance of the receivers, what errors are related to.
pub fn first_bounce(stage: &Stage, split: &Split, b: &[f64], reflected: &[f64]) -> FirstBounce {
    let vectors = PatchVectors::of(stage);
    let (bands, weights) = (vectors.bands, &stage.photometry.weights);
    let row = |i: usize| {
        let rho = &vectors.reflectance[i * bands..(i + 1) * bands];
        let (mut all, mut variance) = ([0.0; 3], [0.0; 3]);
        let mut by_surface: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
        for (j, pair) in split.row(i) {
            // Luminance that one unit of form factor brings.
            let light = &b[j * bands..(j + 1) * bands];
            let unit: f64 = weights.iter().zip(rho).zip(light).map(|((w, r), l)| w * r * l).sum();
            let own = by_surface.entry(stage.patches[j].surface).or_default();
            for (k, cause) in Cause::ALL.into_iter().enumerate() {
                let part = unit * pair.part(cause);
                own[k] += part;
                all[k] += part;
                variance[k] += (unit * pair.std_err(cause)).powi(2);
            }
        }
        (all, variance.map(f64::sqrt), by_surface)
    };
    let rows: Vec<_> = (0..split.len()).into_par_iter().map(row).collect();
    let mut sources: BTreeMap<u32, [Vec<(usize, f64)>; 4]> = BTreeMap::new();
    let (mut receivers, mut std_err) = (Vec::with_capacity(rows.len()), Vec::with_capacity(rows.len()));
    for (i, (all, errors, by_surface)) in rows.into_iter().enumerate() {
        receivers.push(all);
        std_err.push(errors);
        for (surface, parts) in by_surface {
            let own = sources.entry(surface).or_default();
            (0..3).for_each(|k| own[k].push((i, parts[k])));
            own[3].push((i, parts.iter().sum()));
        }
    }
    let norm = |list: &[(usize, f64)]| compensated_sum(list.iter().map(|(i, y)| stage.patches[*i].area * y * y)).sqrt();
    let all = norm(&reflected.iter().copied().enumerate().collect::<Vec<_>>());
    let source = |(surface, own): (&u32, &[Vec<(usize, f64)>; 4])| {
        let patches = patches_of(stage, *surface);
        let share = |k: usize| if all > 0.0 { norm(&own[k]) / all } else { 0.0 };
        Source {
            name: stage.surfaces[*surface as usize].name.clone(),
            luminance: mean_luminance(stage, &patches, b),
            patches,
            error: share(3),
            by_cause: [share(0), share(1), share(2)],
        }
    };
    let mut sources: Vec<Source> = sources.iter().map(source).collect();
    sources.sort_by(|a, b| b.error.total_cmp(&a.error));
    FirstBounce { receivers, std_err, sources }
}

fn patches_of(stage: &Stage, surface: u32) -> Vec<u32> {
    (0..stage.patch_count() as u32)
        .filter(|i| stage.patches[*i as usize].surface == surface && stage.patches[*i as usize].is_present())
        .collect()
}

fn mean_luminance(stage: &Stage, patches: &[u32], b: &[f64]) -> f64 {
    let bands = stage.band_count();
    let light = |j: &u32| {
        let j = *j as usize;
        stage.patches[j].area * stage.photometry.luminance(&b[j * bands..(j + 1) * bands])
    };
    let area: f64 = patches.iter().map(|j| stage.patches[*j as usize].area).sum();
    if area > 0.0 { patches.iter().map(light).sum::<f64>() / area } else { 0.0 }
}

/// First-bounce error that the columns of some patches bring, as [`Source::error`]: of a matrix against the truth of
/// `split`, or of one that is a difference already. `unit(i, j)`: luminance that a unit of form factor brings.
pub fn source_error(
    stage: &Stage,
    f: &FormFactors,
    split: Option<&Split>,
    source: &[u32],
    unit: &(dyn Fn(usize, usize) -> f64 + Sync),
    reflected: &[f64],
) -> f64 {
    let error = |i: usize| -> f64 {
        let of = |j: usize| f.get(i, j) - split.and_then(|s| s.get(i, j)).map_or(0.0, |p| p.mean);
        source.iter().map(|j| unit(i, *j as usize) * of(*j as usize)).sum()
    };
    let errors: Vec<f64> = (0..f.n).into_par_iter().map(error).collect();
    let norm = |y: &[f64]| compensated_sum(y.iter().zip(&stage.patches).map(|(y, p)| p.area * y * y)).sqrt();
    let all = norm(reflected);
    if all > 0.0 { norm(&errors) / all } else { 0.0 }
}
