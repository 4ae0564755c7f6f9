//! One integral over a stretch at whose ends the integrand may have a corner or a root.

use crate::formfactor::gauss::rule;

/// Points per panel.
const POINTS: usize = 24;
/// Panels of a stretch.
const PANELS: usize = 8;

/// Integral of `f` from `lo` to `hi`, 0 where the stretch is empty. `f` is smooth inside; at the ends it may behave
/// like a square root: a step of fifth degree (`10 t^3 - 15 t^4 + 6 t^5`) flattens it there.
pub(super) fn integral(lo: f64, hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    let width = hi - lo;
    if width.is_nan() || width <= 0.0 {
        return 0.0;
    }
    let panel = |k: usize| {
        let term = |(x, w): &(f64, f64)| {
            let t = (k as f64 + 0.5 * (x + 1.0)) / PANELS as f64;
            let step = t * t * t * (10.0 + t * (6.0 * t - 15.0));
            let slope = 30.0 * t * t * (1.0 - t) * (1.0 - t);
            0.5 * w / PANELS as f64 * slope * f(lo + width * step)
        };
        rule(POINTS).iter().map(term).sum::<f64>()
    };
    width * (0..PANELS).map(panel).sum::<f64>()
}

/// The same over `[lo, hi]` cut at every `corner` that lies inside.
pub(super) fn integral_in_pieces(lo: f64, hi: f64, corners: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    let mut cuts: Vec<f64> = corners.iter().copied().filter(|c| *c > lo && *c < hi).collect();
    cuts.extend([lo, hi]);
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2).map(|w| integral(w[0], w[1], &f)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_at_the_ends_do_not_matter() {
        assert!((integral(0.0, 1.0, f64::sqrt) - 2.0 / 3.0).abs() < 2e-14);
        let half_disk = integral(-1.0, 1.0, |x| (1.0 - x * x).max(0.0).sqrt());
        assert!((half_disk - std::f64::consts::FRAC_PI_2).abs() < 2e-14);
        let kink = integral_in_pieces(-1.0, 2.0, &[0.0, 5.0], f64::abs);
        assert!((kink - 2.5).abs() < 2e-14);
        assert_eq!(integral(1.0, 1.0, |_| 1.0), 0.0);
    }
}
