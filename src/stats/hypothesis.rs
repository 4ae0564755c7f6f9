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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_p_values() {
        assert!((t_p_value(1.0, 0.5, 10.0) - 0.0733880347707404).abs() < 1e-12);
        assert_eq!(t_p_value(1.0, 0.5, 10.0), t_p_value(-1.0, 0.5, 10.0));
        assert!((z_p_value(-1.0, 1.0) - 0.317310507862914).abs() < 1e-9);
        assert!((chi_square_p_value(10.0, 5.0) - 0.0752352461465122).abs() < 1e-12);
    }

    #[test]
    fn no_error_leaves_no_doubt() {
        assert_eq!((t_p_value(0.0, 0.0, 3.0), z_p_value(0.0, 0.0), z_p_value(1e-9, 0.0)), (1.0, 1.0, 0.0));
    }

    #[test]
    fn independent_errors_add_in_squares() {
        assert_eq!(z_difference(10.0, 3.0, 0.0, 4.0), 2.0);
        assert_eq!(z_difference(1.0, 0.0, 1.0, 0.0), 0.0);
        assert_eq!(z_difference(0.0, 0.0, 1.0, 0.0), f64::NEG_INFINITY);
    }
}
