//! Quantiles and tails. Upper tails are asked for by their own probability, so that tiny ones keep their digits.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// The value that Student's t with `dof` degrees of freedom exceeds with probability `upper_tail`.
/// Infinite for a tail of 0 or without degrees of freedom.
pub fn t_quantile(upper_tail: f64, dof: f64) -> f64 {
    match (StudentsT::new(0.0, 1.0, dof), upper_tail) {
        (Ok(_), p) if p == 0.5 => 0.0,
        // The lower tail keeps its digits, 1 - p does not.
        (Ok(t), p) if p > 0.0 && p < 0.5 => -t.inverse_cdf(p),
        (Ok(t), p) if p > 0.5 && p < 1.0 => t.inverse_cdf(1.0 - p),
        (_, p) if p >= 1.0 => f64::NEG_INFINITY,
        _ => f64::INFINITY,
    }
}

/// Half-width in standard errors of a two-sided interval: `t_quantile((1 - confidence) / 2, dof)`.
pub fn two_sided_t(confidence: f64, dof: f64) -> f64 {
    t_quantile(0.5 * (1.0 - confidence), dof)
}

/// Probability that Student's t with `dof` degrees of freedom exceeds `x`; NaN without degrees of freedom.
pub fn t_upper_tail(x: f64, dof: f64) -> f64 {
    StudentsT::new(0.0, 1.0, dof).map_or(f64::NAN, |t| t.cdf(-x))
}

/// Probability that a standard normal value exceeds `x`.
pub fn normal_upper_tail(x: f64) -> f64 {
    Normal::standard().sf(x)
}

/// The value that a standard normal exceeds with probability `upper_tail`.
pub fn normal_quantile(upper_tail: f64) -> f64 {
    if upper_tail <= 0.0 {
        f64::INFINITY
    } else if upper_tail >= 1.0 {
        f64::NEG_INFINITY
    } else {
        -Normal::standard().inverse_cdf(upper_tail)
    }
}

/// Probability that chi-square with `dof` degrees of freedom exceeds `x`; NaN without degrees of freedom.
pub fn chi_square_upper_tail(x: f64, dof: f64) -> f64 {
    ChiSquared::new(dof).map_or(f64::NAN, |c| c.sf(x.max(0.0)))
}
