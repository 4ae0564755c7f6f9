//! P-values of single tests. All are two-sided unless the name says otherwise.

use super::distributions::{chi_square_upper_tail, normal_upper_tail, t_upper_tail};

/// P-value of a mean against 0 when its standard error comes from `dof` degrees of freedom.
/// A standard error of 0 leaves no doubt: 1 for a mean of exactly 0, else 0.
pub fn t_p_value(mean: f64, std_err: f64, dof: f64) -> f64 {
    doubt(mean, std_err, |t| 2.0 * t_upper_tail(t, dof))
}

/// P-value of a mean against 0 when its standard error is known.
pub fn z_p_value(mean: f64, std_err: f64) -> f64 {
    doubt(mean, std_err, |z| 2.0 * normal_upper_tail(z))
}

/// z of two independent estimates that should agree: their difference in units of its standard error.
/// 0 for two equal numbers without errors, infinite for unequal ones.
pub fn z_difference(a: f64, a_std_err: f64, b: f64, b_std_err: f64) -> f64 {
    if a == b { 0.0 } else { (a - b) / a_std_err.hypot(b_std_err) }
}

/// P-value of a chi-square statistic: the upper tail.
pub fn chi_square_p_value(statistic: f64, dof: f64) -> f64 {
    chi_square_upper_tail(statistic, dof)
}

fn doubt(mean: f64, std_err: f64, tail: impl Fn(f64) -> f64) -> f64 {
    if std_err > 0.0 {
        tail((mean / std_err).abs()).min(1.0)
    } else if mean == 0.0 {
        1.0
    } else {
        0.0
    }
}
