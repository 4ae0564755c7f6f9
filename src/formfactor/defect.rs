//! Reciprocity `A_i F_ij = A_j F_ji`, judged by the spread of the randomisations.

use crate::scene::Stage;
use crate::stats::{sidak, t_p_value};
use serde::{Deserialize, Serialize};

/// Most groups of patches whose exchanges are tested: pairs grow with the square.
const MAX_GROUPS: usize = 48;

/// Patches gathered into groups: sums over many hits show a defect that single pairs hide in their noise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Groups {
    /// Group of each patch.
    pub of_patch: Vec<usize>,
    /// Number of groups.
    pub count: usize,
}

impl Groups {
    /// One group per surface; where there are too many, runs of consecutive patches.
    pub fn of(stage: &Stage) -> Self {
        let n = stage.patch_count();
        if stage.surfaces.len() <= MAX_GROUPS && stage.surfaces.len() > 1 {
            let of_patch = stage.patches.iter().map(|p| p.surface as usize).collect();
            return Self { of_patch, count: stage.surfaces.len() };
        }
        let count = MAX_GROUPS.min(n);
        Self { of_patch: (0..n).map(|i| i * count / n).collect(), count }
    }
}

/// Outcome of the reciprocity test.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reciprocity {
    /// Chance of a defect this large if reciprocity holds, corrected for the number of pairs looked at.
    /// `None` where no pair of groups exchanges enough hits to be tested.
    pub p_value: Option<f64>,
    /// Pairs of groups tested.
    pub pairs: usize,
    /// The worst pair of groups.
    pub worst: Option<(usize, usize)>,
}

/// Tests, for each pair of groups, that the flows in both directions agree.
///
/// `flows[r][g * groups + h]` is `sum A_i F_ij` (m^2) of randomisation r. A Student t test over the randomisations
/// holds whatever the correlations within one. `resolution` is the smallest step of a flow, m^2 (one hit on the
/// largest patch): pairs below 200 steps are too grainy for t and left out.
pub fn reciprocity(flows: &[Vec<f64>], groups: usize, resolution: f64) -> Reciprocity {
    let r = flows.len() as f64;
    let (mut p_min, mut pairs, mut worst) = (1.0, 0, None);
    for g in 0..groups {
        for h in 0..g {
            let (there, back) = (g * groups + h, h * groups + g);
            let total: f64 = flows.iter().map(|f| f[there] + f[back]).sum();
            if total < 200.0 * resolution {
                continue;
            }
            let defects: Vec<f64> = flows.iter().map(|f| f[there] - f[back]).collect();
            let mean = defects.iter().sum::<f64>() / r;
            let squares: f64 = defects.iter().map(|d| (d - mean).powi(2)).sum();
            let std_err = (squares / (r * (r - 1.0))).sqrt();
            // Below rounding there is nothing to test: exchanges that are exact in every randomisation.
            if mean.abs() <= 1e-12 * total && std_err <= 1e-12 * total {
                continue;
            }
            pairs += 1;
            let p = t_p_value(mean, std_err, r - 1.0);
            if p < p_min {
                (p_min, worst) = (p, Some((g, h)));
            }
        }
    }
    Reciprocity { p_value: (pairs > 0).then(|| sidak(p_min, pairs)), pairs, worst }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_one_sided_exchange_is_found_and_an_even_one_is_not() {
        // 16 randomisations with a fixed, balanced scatter of 1 %.
        let scatter = |r: usize| 0.01 * ((r * 7 % 16) as f64 - 7.5) / 7.5;
        let flows = |bias: f64| -> Vec<Vec<f64>> {
            (0..16).map(|r| vec![0.0, 1.0 + scatter(r), 1.0 + bias - scatter(r + 3), 0.0]).collect()
        };
        assert!(reciprocity(&flows(0.0), 2, 1e-4).p_value.unwrap() > 0.5);
        assert!(reciprocity(&flows(0.05), 2, 1e-4).p_value.unwrap() < 1e-6);
        assert_eq!(reciprocity(&flows(0.05), 2, 1.0).p_value, None);
    }
}
