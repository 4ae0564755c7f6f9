//! Many tests at once: what the smallest p-value means, and how p-values combine.

use super::distributions::chi_square_upper_tail;
use crate::math::compensated_sum;

/// P-value of the smallest of `m` independent p-values (Sidak): `1 - (1 - p)^m`, without losing tiny ones.
pub fn sidak(p_min: f64, m: usize) -> f64 {
    -(m as f64 * (-p_min.clamp(0.0, 1.0)).ln_1p()).exp_m1()
}

/// Level for each of `m` independent tests that together raise a false alarm with probability `level`.
pub fn sidak_level(level: f64, m: usize) -> f64 {
    -((-level.clamp(0.0, 1.0)).ln_1p() / m.max(1) as f64).exp_m1()
}

/// P-value of the smallest of `m` p-values however they depend on each other (Bonferroni): `min(1, m p)`.
pub fn bonferroni(p_min: f64, m: usize) -> f64 {
    (p_min * m as f64).min(1.0)
}

/// Level for each of `m` tests that together, however they depend, raise a false alarm with at most `level`.
pub fn bonferroni_level(level: f64, m: usize) -> f64 {
    level / m.max(1) as f64
}

/// Combined p-value of independent tests (Fisher): -2 sum ln p against chi-square with 2 m degrees of freedom.
/// 1 for no tests.
pub fn fisher(p_values: &[f64]) -> f64 {
    if p_values.is_empty() {
        return 1.0;
    }
    let statistic = -2.0 * compensated_sum(p_values.iter().map(|p| p.ln()));
    if statistic.is_infinite() { 0.0 } else { chi_square_upper_tail(statistic, 2.0 * p_values.len() as f64) }
}

/// Combined p-value of independent tests by the smallest of them (Sidak). 1 for no tests.
pub fn min_p(p_values: &[f64]) -> f64 {
    sidak(p_values.iter().copied().fold(1.0, f64::min), p_values.len().max(1))
}
