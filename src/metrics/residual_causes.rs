//! Where a residual is made: the patches and surfaces whose own equation is violated most.

use super::quantity::mean_of;
use super::types::Judged;
use crate::stats::Moments;
use serde::Serialize;
use std::collections::BTreeMap;

/// How many of the worst are named.
const WORST: usize = 10;

/// A patch whose equation is violated; luminances, W/m^2.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstResidual {
    /// Patch number.
    pub patch: usize,
    /// Name of its surface.
    pub surface: String,
    /// E + rho F B - B: above zero where the solution is too dark for the light it receives.
    pub residual: f64,
    /// Its standard error.
    pub std_err: Option<f64>,
}

/// What the patches of a surface add to the residual.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurfaceResidual {
    /// Name.
    pub surface: String,
    /// Share of the squared area norm, noise taken off; the shares of all surfaces add to 1. 0 where noise is all
    /// there is.
    pub share: f64,
    /// Area-weighted mean of the residual, W/m^2.
    pub mean: f64,
    /// Its standard error.
    pub std_err: Option<f64>,
}

/// Up to ten patches with the largest |residual|; ties go to the lower number.
pub(super) fn worst(rows: &[Vec<f64>], judged: &Judged) -> Vec<WorstResidual> {
    let mean = mean_of(rows);
    let mut order: Vec<usize> = (0..mean.len()).filter(|i| judged.areas[*i] > 0.0).collect();
    order.sort_by(|a, b| mean[*b].abs().total_cmp(&mean[*a].abs()));
    let name = |&i: &usize| WorstResidual {
        patch: i,
        surface: judged.surfaces[i].to_string(),
        residual: mean[i],
        std_err: rows.iter().map(|row| row[i]).collect::<Moments>().std_err(),
    };
    order.iter().take(WORST).map(name).collect()
}

/// Sums over the patches of one surface.
#[derive(Clone)]
struct Surface {
    area: f64,
    /// `sum A <r_a, r_b>` over pairs of different replicates, averaged.
    square: f64,
    /// `sum A r` per replicate.
    flux: Vec<f64>,
}

/// Up to ten surfaces with the largest share; ties in the order of their names.
pub(super) fn surfaces(rows: &[Vec<f64>], judged: &Judged) -> Vec<SurfaceResidual> {
    let count = rows.len() as f64;
    let mut all: BTreeMap<&str, Surface> = BTreeMap::new();
    for (i, area) in judged.areas.iter().enumerate().filter(|(_, a)| **a > 0.0) {
        let none = Surface { area: 0.0, square: 0.0, flux: vec![0.0; rows.len()] };
        let sums = all.entry(judged.surfaces[i]).or_insert(none);
        let (mut sum, mut squares) = (0.0, 0.0);
        for (flux, row) in sums.flux.iter_mut().zip(rows) {
            *flux += area * row[i];
            sum += row[i];
            squares += row[i] * row[i];
        }
        sums.area += area;
        sums.square += area * (sum * sum - squares) / (count * (count - 1.0));
    }
    let whole: f64 = all.values().map(|s| s.square.max(0.0)).sum();
    let mut out: Vec<SurfaceResidual> = all
        .into_iter()
        .map(|(name, s)| {
            let mean: Moments = s.flux.iter().map(|f| f / s.area).collect();
            let share = if whole > 0.0 { s.square.max(0.0) / whole } else { 0.0 };
            SurfaceResidual { surface: name.to_string(), share, mean: mean.mean, std_err: mean.std_err() }
        })
        .collect();
    out.sort_by(|a, b| b.share.total_cmp(&a.share));
    out.truncate(WORST);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cause_is_named_and_noise_is_taken_off() {
        let rows = [vec![1.0, 0.5, 3.0, 9.0], vec![1.0, -0.5, 5.0, 9.0]];
        let bands = ["y".to_string()];
        let judged = Judged {
            areas: &[2.0, 1.0, 1.0, 0.0],
            emission: &[0.0; 4],
            surfaces: &["a", "a", "b", "gone"],
            bands: &bands,
            weights: &[1.0],
        };
        let w = worst(&rows, &judged);
        assert_eq!(w.iter().map(|w| w.patch).collect::<Vec<_>>(), [2, 0, 1]);
        assert_eq!((w[0].residual, w[0].std_err, w[0].surface.as_str()), (4.0, Some(1.0), "b"));
        let s = surfaces(&rows, &judged);
        // Pairs of different replicates: b has 3 x 5 = 15; a has 2 x 1 - 0.25 = 1.75.
        assert_eq!((s.len(), s[0].surface.as_str(), s[0].mean), (2, "b", 4.0));
        assert!((s[0].share - 15.0 / 16.75).abs() < 1e-12 && (s[1].mean - 2.0 / 3.0).abs() < 1e-12, "{s:?}");
    }
}
