//! Quantiles and tails. Upper tails are asked for by their own probability, so that tiny ones keep their digits.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// The value that Student's t with `dof` degrees of freedom exceeds with probability `upper_tail`.
/// Infinite for a tail of 0 or without degrees of freedom.
pub fn t_quantile(upper_tail: f64, dof: f64) -> f64 {
    match (StudentsT::new(0.0, 1.0, dof), upper_tail) {
        (Ok(_), 0.5) => 0.0,
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
#[cfg(test)]
mod tests {
    use super::*;

    /// Digits from 40-digit arithmetic (mpmath: incomplete beta, incomplete gamma, erfc).
    fn close(got: f64, known: f64) {
        assert!((got / known - 1.0).abs() < 1e-9, "{got:e} is not {known:e}");
    }

    #[test]
    fn t_quantiles() {
        close(t_quantile(0.025, 1.0), 12.7062047361747);
        close(t_quantile(0.025, 7.0), 2.36462425159279);
        close(t_quantile(0.025, 15.0), 2.13144954555978);
        close(t_quantile(0.0125, 15.0), 2.48987970347989);
        close(t_quantile(0.3, 4.0), 0.568649063049705);
        close(t_quantile(0.7, 4.0), -0.568649063049705);
        close(two_sided_t(0.95, 31.0), 2.03951344639641);
        assert_eq!(t_quantile(0.5, 3.0), 0.0);
        assert_eq!((t_quantile(0.0, 3.0), t_quantile(1.0, 3.0)), (f64::INFINITY, f64::NEG_INFINITY));
        assert_eq!(t_quantile(0.025, 0.0), f64::INFINITY);
    }

    #[test]
    fn t_quantiles_of_family_wise_tails() {
        close(t_quantile(1e-6, 15.0), 7.46438494009637);
        close(t_quantile(1e-12, 7.0), 104.021829262647);
        close(t_quantile(1e-12, 15.0), 20.6386073102161);
        close(t_quantile(1e-12, 31.0), 11.2002071928848);
    }

    #[test]
    fn tails() {
        close(t_upper_tail(2.0, 10.0), 0.0366940173853702);
        close(t_upper_tail(7.5, 15.0), 9.44426930235403e-07);
        close(t_upper_tail(30.0, 15.0), 4.15740359716247e-15);
        close(normal_upper_tail(1.0), 0.158655253931457);
        close(normal_upper_tail(10.0), 7.61985302416053e-24);
        close(normal_upper_tail(30.0), 4.90671392714819e-198);
        close(chi_square_upper_tail(3.84, 1.0), 0.0500435212487051);
        close(chi_square_upper_tail(18.307, 10.0), 0.0500005890913981);
        close(chi_square_upper_tail(200.0, 100.0), 1.17845007209794e-08);
        close(chi_square_upper_tail(500.0, 100.0), 1.72012100536954e-54);
        close(chi_square_upper_tail(80.0, 100.0), 0.929664933340605);
        assert!(t_upper_tail(1.0, 0.0).is_nan() && chi_square_upper_tail(1.0, 0.0).is_nan());
        assert_eq!(chi_square_upper_tail(-1.0, 2.0), 1.0);
    }

    #[test]
    fn normal_quantiles() {
        close(normal_quantile(0.025), 1.95996398454005);
        close(normal_quantile(0.4), 0.2533471031358);
        close(normal_quantile(1e-6), 4.7534243088229);
        close(normal_quantile(1e-15), 7.941345326171);
        assert_eq!((normal_quantile(0.0), normal_quantile(1.0)), (f64::INFINITY, f64::NEG_INFINITY));
    }
}
