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
    if p_values.iter().any(|p| *p <= 0.0) {
        return 0.0;
    }
    let statistic = -2.0 * compensated_sum(p_values.iter().map(|p| p.ln()));
    chi_square_upper_tail(statistic, 2.0 * p_values.len() as f64)
}

/// Combined p-value of independent tests by the smallest of them (Sidak). 1 for no tests.
pub fn min_p(p_values: &[f64]) -> f64 {
    sidak(p_values.iter().copied().fold(1.0, f64::min), p_values.len().max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    fn close(got: f64, known: f64) {
        assert!((got / known - 1.0).abs() < 1e-12, "{got:e} is not {known:e}");
    }

    #[test]
    fn known_combinations() {
        close(sidak(0.01, 10), 0.0956179249911955);
        close(sidak(1e-12, 500_000), 4.99999875000271e-07);
        close(sidak_level(0.05, 72), 0.000712153164971856);
        close(bonferroni(0.01, 10), 0.1);
        close(bonferroni_level(0.05, 2), 0.025);
        close(fisher(&[0.1, 0.2, 0.03]), 0.0215617513248346);
        close(min_p(&[0.4, 0.01, 0.3]), 1.0 - 0.99f64.powi(3));
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!((sidak(0.0, 5), sidak(1.0, 5), bonferroni(0.5, 3)), (0.0, 1.0, 1.0));
        assert_eq!((fisher(&[]), min_p(&[]), fisher(&[0.0, 0.5])), (1.0, 1.0, 0.0));
    }

    #[test]
    fn level_and_p_value_undo_each_other() {
        for m in [1, 7, 500_000] {
            close(sidak(sidak_level(1e-6, m), m), 1e-6);
        }
    }

    /// Combined p-values of true hypotheses are uniform: below 0.05 in 5 % of cases.
    #[test]
    fn combined_p_values_keep_their_false_alarm_rate() {
        let mut random = Random(3);
        let (mut by_fisher, mut by_min) = (0, 0);
        for _ in 0..20_000 {
            let p: Vec<f64> = (0..8).map(|_| random.uniform()).collect();
            by_fisher += usize::from(fisher(&p) < 0.05);
            by_min += usize::from(min_p(&p) < 0.05);
        }
        // 1000 expected, sd 31.
        for alarms in [by_fisher, by_min] {
            assert!((880..1120).contains(&alarms), "{alarms}");
        }
    }
}
