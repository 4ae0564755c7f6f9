//! How wrong a solution is, from its own residual: two-sided bounds on eq. 7 without a reference. The proof stands in
//! `residual_bounds`.

use super::error::MetricsError;
use super::quantity::Quantity;
use super::residual_bounds::{ErrorBounds, Group, Norms};
use super::residual_causes::{SurfaceResidual, WorstResidual, surfaces, worst};
use super::sums::Sums;
use super::types::Judged;
use crate::math::compensated_sum;
use crate::solution::{Radiosity, Replicates};
use crate::stats::{Estimate, bonferroni_level, two_sided_t};
use serde::Serialize;

/// What rays have made of a solution B; one unbiased replicate per randomisation.
#[derive(Debug, Clone, Copy)]
pub struct Rebounded<'a> {
    /// `r = E + rho F B - B`, W/m^2: above zero where the solution is too dark for the light it receives.
    pub residual: &'a Replicates,
    /// `r + K r + ... + K^(n-1) r`; for one bounce the same as `residual`.
    pub series: &'a Replicates,
    /// Bounces n, at least 1.
    pub bounces: u32,
    /// Reflectances, receiver-major with one value per band; 0 for receivers that take no part.
    pub reflectance: &'a [f64],
}

/// What a residual says about the error of a solution. Serialises as the JSON of `check --residual`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResidualMetrics {
    /// Two-sided confidence of the error bounds.
    pub confidence: f64,
    /// Area norm of the luminance of r over that of the solution; `None` for a black solution.
    pub residual: Option<Estimate>,
    /// [GSG90 eq. 7] lies between these.
    pub error_bounds: ErrorBounds,
    /// Largest reflectance of a band that counts.
    pub rho_max: f64,
    /// Bounces n of the residual.
    pub bounces: u32,
    /// `rho_max^n`: how far the bounds are apart, `(1 + x) / (1 - x)` times for bands of equal reflectances.
    pub left_over: f64,
    /// Bounds of each band alone, in band order; `None` for a band without light.
    pub per_band: Vec<BandBounds>,
    /// Share of patches with emission in the solution's `sum A Y^2`.
    pub emitter_share: f64,
    /// Patches present.
    pub patches: usize,
    /// Up to ten patches with the largest |residual|.
    pub worst: Vec<WorstResidual>,
    /// Up to ten surfaces with the largest share of the residual.
    pub surfaces: Vec<SurfaceResidual>,
    #[serde(skip)]
    pub(super) norms: Norms,
}

/// One band.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BandBounds {
    /// Name.
    pub band: String,
    /// Bounds on eq. 7 of this band.
    pub error_bounds: Option<ErrorBounds>,
}

/// Bounds on the error of a solution from its residual; `reflected`: relative to B - E instead of B.
///
/// # Errors
/// Shapes that do not fit, values that are not finite, fewer than four replicates, nothing present, no light at all.
pub fn bound_error(
    solution: &Radiosity,
    rebounded: &Rebounded,
    judged: &Judged,
    confidence: f64,
    reflected: bool,
) -> Result<ResidualMetrics, MetricsError> {
    super::check::alone(solution, judged, confidence)?;
    super::check::sampled("the residual", rebounded.residual, judged)?;
    super::check::sampled("the series of the residual", rebounded.series, judged)?;
    let norms = norms(solution, rebounded, judged, judged.weights, confidence, reflected);
    if norms.solution == 0.0 && norms.series.high == 0.0 {
        return Err(MetricsError::DarkReference {
            what: if reflected { "the reflected luminance" } else { "the luminance" },
        });
    }
    let residual = rows(rebounded.residual, judged.weights, judged.areas.len());
    let norm = area_norm(judged.areas, &residual, confidence);
    let rho_max = norms.groups.iter().map(|g| g.rho_max).fold(0.0, f64::max);
    Ok(ResidualMetrics {
        confidence,
        residual: (norms.solution > 0.0).then(|| scaled(norm, 1.0 / norms.solution)),
        error_bounds: norms.bounds(),
        rho_max,
        bounces: rebounded.bounces,
        left_over: rho_max.powi(rebounded.bounces as i32),
        per_band: per_band(solution, rebounded, judged, confidence, reflected),
        emitter_share: emitter_share(&solution.values, judged),
        patches: judged.areas.iter().filter(|a| **a > 0.0).count(),
        worst: worst(&residual, judged),
        surfaces: surfaces(&residual, judged),
        norms,
    })
}

/// The norms of the weighted sum of bands; their intervals hold together at `confidence` (Bonferroni).
pub(super) fn norms(
    solution: &Radiosity,
    given: &Rebounded,
    judged: &Judged,
    weights: &[f64],
    confidence: f64,
    reflected: bool,
) -> Norms {
    let groups = groups(given.reflectance, judged.areas, weights);
    let intervals = if groups.len() > 1 { groups.len() + 2 } else { 2 };
    let shared = 1.0 - bonferroni_level(1.0 - confidence, intervals);
    let weighed = |weights: &[f64]| rows(given.series, weights, judged.areas.len());
    let series = weighed(weights);
    let whole = Quantity::luminance(&Judged { weights, ..*judged }, reflected).of(&solution.values);
    let corrected: Vec<Vec<f64>> =
        series.iter().map(|row| row.iter().zip(&whole).map(|(v, b)| v + b).collect()).collect();
    let group = |masked: &Vec<f64>| Group {
        norm: area_norm(judged.areas, &weighed(masked), shared),
        rho_max: largest(given.reflectance, masked, judged.areas),
        apart: groups.iter().map(|other| apart(given.reflectance, masked, other, judged.areas)).collect(),
    };
    Norms {
        series: area_norm(judged.areas, &series, shared),
        groups: groups.iter().map(group).collect(),
        corrected: area_norm(judged.areas, &corrected, shared),
        solution: norm(judged.areas, &whole),
        bounces: given.bounces,
    }
}

/// Weights of each group of bands that weigh something and have the same reflectances on every patch.
fn groups(reflectance: &[f64], areas: &[f64], weights: &[f64]) -> Vec<Vec<f64>> {
    let mut out: Vec<Vec<f64>> = Vec::new();
    for c in (0..weights.len()).filter(|c| weights[*c] != 0.0) {
        let mut alone = vec![0.0; weights.len()];
        alone[c] = weights[c];
        match out.iter_mut().find(|g| apart(reflectance, &alone, g, areas) == 0.0) {
            Some(group) => group[c] = weights[c],
            None => out.push(alone),
        }
    }
    if out.is_empty() { vec![vec![0.0; weights.len()]] } else { out }
}

/// Reflectances of a group: those of its first band, 0 for a group without any.
fn of_group<'a>(reflectance: &'a [f64], weights: &'a [f64], areas: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let first = weights.iter().position(|w| *w != 0.0);
    let present = move |i: &usize| areas[*i] > 0.0;
    (0..areas.len()).filter(present).map(move |i| first.map_or(0.0, |c| reflectance[i * weights.len() + c]))
}

fn largest(reflectance: &[f64], group: &[f64], areas: &[f64]) -> f64 {
    of_group(reflectance, group, areas).fold(0.0, f64::max)
}

fn apart(reflectance: &[f64], a: &[f64], b: &[f64], areas: &[f64]) -> f64 {
    let pairs = of_group(reflectance, a, areas).zip(of_group(reflectance, b, areas));
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

fn per_band(
    solution: &Radiosity,
    given: &Rebounded,
    judged: &Judged,
    confidence: f64,
    reflected: bool,
) -> Vec<BandBounds> {
    let of = |(c, name): (usize, &String)| {
        let weights: Vec<f64> = (0..judged.bands.len()).map(|k| f64::from(u8::from(k == c))).collect();
        let norms = norms(solution, given, judged, &weights, confidence, reflected);
        let lit = norms.solution > 0.0 || norms.series.high > 0.0;
        BandBounds { band: name.clone(), error_bounds: lit.then(|| norms.bounds()) }
    };
    judged.bands.iter().enumerate().map(of).collect()
}

/// A weighted sum of bands, per replicate.
fn rows(replicates: &Replicates, weights: &[f64], n: usize) -> Vec<Vec<f64>> {
    let weigh = |values: &[f64]| weights.iter().zip(values).map(|(w, v)| w * v).sum::<f64>();
    replicates.replicates.iter().map(|b| (0..n).map(|i| weigh(&b[i * weights.len()..])).collect()).collect()
}

/// `sqrt(sum A x^2)` of the mean x of independent replicates, without the square of their noise: numerator of
/// [`super::relative_rms`] with its interval, made the same way.
fn area_norm(areas: &[f64], rows: &[Vec<f64>], confidence: f64) -> Estimate {
    let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
    let present = (0..areas.len()).filter(|i| areas[*i] > 0.0);
    let sums = Sums::over(present, areas, &vec![0.0; areas.len()], &rows);
    let q = sums.debiased_difference().max(0.0);
    let deviation = sums.spread(0.0).residual.sqrt();
    let variance = sums.top_variance / sums.replicates as f64;
    let high = |t: f64| (q + t * deviation + (t * t + 1.0) * variance).sqrt();
    let t = two_sided_t(confidence, sums.replicates as f64 - 1.0);
    let value = q.sqrt();
    Estimate { value, std_err: Some(high(1.0) - value), low: (q - t * deviation).max(0.0).sqrt(), high: high(t) }
}

fn norm(areas: &[f64], x: &[f64]) -> f64 {
    compensated_sum(areas.iter().zip(x).map(|(a, x)| a * x * x)).sqrt()
}

fn scaled(e: Estimate, by: f64) -> Estimate {
    Estimate { value: by * e.value, std_err: e.std_err.map(|s| by * s), low: by * e.low, high: by * e.high }
}

fn emitter_share(values: &[f64], judged: &Judged) -> f64 {
    let y = Quantity::luminance(judged, false).of(values);
    let bands = judged.bands.len();
    let emits = |i: usize| judged.emission[i * bands..(i + 1) * bands].iter().any(|e| *e > 0.0);
    let lamps: Vec<f64> = (0..y.len()).map(|i| if emits(i) { y[i] } else { 0.0 }).collect();
    let whole = norm(judged.areas, &y);
    if whole > 0.0 { (norm(judged.areas, &lamps) / whole).powi(2) } else { 0.0 }
}
