//! Gauss-Legendre rules, and where they may be used: panels on which a function is analytic far enough around.

use std::sync::LazyLock;

/// Largest rule kept.
const MOST_POINTS: usize = 24;

/// Panels are halved until no singularity lies within the Bernstein ellipse of this parameter.
const NARROWEST_ELLIPSE: f64 = 2.7;

/// `ln(1e17) / 2`: an n-point rule errs by about `rho^(-2n)`.
const HALF_LOG_ERROR: f64 = 19.6;

static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (0..=MOST_POINTS).map(legendre).collect());

/// Nodes on [-1, 1] and weights of the n-point Gauss-Legendre rule, exact for degree 2n - 1. `n` is at most 24.
pub(super) fn rule(n: usize) -> &'static [(f64, f64)] {
    &RULES[n]
}

/// Newton's iteration on the Legendre polynomial from the classical asymptotic guess.
fn legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..8 {
            let (value, slope) = polynomial(n, x);
            x -= value / slope;
        }
        let (_, slope) = polynomial(n, x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// The Legendre polynomial of degree n and its derivative, for |x| < 1.
fn polynomial(n: usize, x: f64) -> (f64, f64) {
    let (mut last, mut value) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
    }
    (value, n as f64 * (x * value - last) / (x * x - 1.0))
}

/// A place where a function on a line stops being analytic: the complex abscissae `at ± i off`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Singularity {
    /// Real part.
    pub at: f64,
    /// Distance from the real line.
    pub off: f64,
}

/// Parameter of the largest Bernstein ellipse around `[lo, hi]` that holds no singularity.
pub(super) fn ellipse(lo: f64, hi: f64, singular: &[Singularity]) -> f64 {
    let (mid, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    let parameter = |s: &Singularity| {
        let (x, y) = ((s.at - mid) / half, s.off / half);
        let major = (0.5 * ((x - 1.0).hypot(y) + (x + 1.0).hypot(y))).max(1.0);
        major + (major * major - 1.0).sqrt()
    };
    singular.iter().map(parameter).fold(f64::INFINITY, f64::min)
}

/// Integral over `[lo, hi]` of a function that is analytic but for the given singularities, to rounding.
///
/// Panels are cut at the singularities and halved towards them. Panels shorter than `floor` are taken as they are:
/// the caller knows how little the function can do there.
pub(super) fn integrate(lo: f64, hi: f64, singular: &[Singularity], floor: f64, f: &impl Fn(f64) -> f64) -> f64 {
    let width = hi - lo;
    let rho = ellipse(lo, hi, singular);
    if rho >= NARROWEST_ELLIPSE || width <= floor || width.is_nan() {
        let points = (HALF_LOG_ERROR / rho.max(NARROWEST_ELLIPSE).ln()).ceil() as usize;
        return panel(lo, hi, points.clamp(3, MOST_POINTS), f);
    }
    let inside = |s: &&Singularity| s.at > lo + 0.1 * width && s.at < hi - 0.1 * width && s.off < 0.5 * width;
    let cut = singular.iter().filter(inside).map(|s| s.at).next().unwrap_or(0.5 * (lo + hi));
    integrate(lo, cut, singular, floor, f) + integrate(cut, hi, singular, floor, f)
}

/// The n-point rule on one panel.
pub(super) fn panel(lo: f64, hi: f64, n: usize, f: &impl Fn(f64) -> f64) -> f64 {
    let (mid, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    rule(n).iter().map(|(x, w)| w * f(mid + half * x)).sum::<f64>() * half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_degree_2n_minus_1_and_no_further() {
        for n in 1..=MOST_POINTS {
            let moment = |k: i32| rule(n).iter().map(|(x, w)| w * x.powi(k)).sum::<f64>();
            for k in (0..2 * n as i32).step_by(2) {
                assert!((moment(k) - 2.0 / f64::from(k + 1)).abs() < 2e-15, "n {n}, degree {k}");
            }
            let missed = (moment(2 * n as i32) - 2.0 / (2.0 * n as f64 + 1.0)).abs();
            assert!(n > 20 || missed > 1e-13, "n {n} is exact beyond its degree: {missed:e}");
        }
    }

    #[test]
    fn singular_integrands_come_out_to_rounding() {
        let end = [Singularity { at: 0.0, off: 0.0 }];
        let got = integrate(0.0, 1.0, &end, 1e-9, &|x: f64| x * x.ln());
        assert!((got + 0.25).abs() < 1e-15, "{got}");
        let pole = [Singularity { at: 0.0, off: 1e-5 }];
        let got = integrate(-0.3, 0.7, &pole, 1e-9, &|x: f64| 1e-5 / (x * x + 1e-10));
        let truth = (0.7f64 / 1e-5).atan() + (0.3f64 / 1e-5).atan();
        assert!((got - truth).abs() < 1e-13, "{got} {truth}");
    }
}
