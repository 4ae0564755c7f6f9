//! Eq. 7 of GSG90 against a truth that is known through replicates only.

use super::sums::{Spread, Sums};
use crate::stats::{Estimate, two_sided_t};

/// What eq. 7 gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rms {
    /// The error with its interval.
    Known(Estimate),
    /// The reference is dark, or not distinguishable from dark (also: too few replicates to tell): no relative error
    /// is defined.
    Dark,
}

impl Rms {
    /// The estimate, if there is one.
    pub fn estimate(self) -> Option<Estimate> {
        match self {
            Rms::Known(e) => Some(e),
            Rms::Dark => None,
        }
    }
}

/// `sqrt( sum (y_ref - y)^2 A / sum y_ref^2 A )` against the *true* reference, from R independent replicates of it
/// [GSG90 eq. 7]. One row: that solution is taken as the truth and the result is exact.
///
/// `areas`, `solution` and each row of `reference` have one entry per patch; patches of area 0 take no part.
///
/// Numerator and denominator are means over pairs of different replicates, so that neither holds the square of
/// the noise. Interval: Student t, by Fieller's theorem for the ratio, and a bound on what one direction of the
/// noise can hide; the standard error is the reach of that interval above the value at t = 1. O(R N).
pub fn relative_rms(areas: &[f64], solution: &[f64], reference: &[Vec<f64>], confidence: f64) -> Rms {
    let rows: Vec<&[f64]> = reference.iter().map(Vec::as_slice).collect();
    let patches = (0..areas.len()).filter(|i| areas[*i] > 0.0);
    interval(&[Sums::over(patches, areas, solution, &rows)], confidence)
}

/// Value and interval from the sums over one or more sets of replicates that have none in common, each over its
/// own patches; numerators and denominators are averaged over the sets.
///
/// On the scale of q = value^2, with `s^2` the variance of the mean along the strongest direction of the noise:
/// - to first order q moves with the noise along the difference and along the reference, which every replicate
///   shows as two numbers: Student t for their ratio (Fieller). Where noise in many directions dominates, that
///   spread holds the second order twice over;
/// - noise in *one* direction (a brightness common to all patches) may cancel a difference along it: the difference
///   reads 0, and its spread with it. What can be hidden is bounded by the noise norm in that direction: q is at
///   most `(|D| + t s)^2 = (q + s^2) + 2 t s |D| + t^2 s^2`. Exact if there is no other noise, and small
///   against the first order away from zero;
/// - a q below zero, had by luck, never makes the interval shorter than q = 0 does.
pub(super) fn interval(sets: &[Sums], confidence: f64) -> Rms {
    if let [only] = sets
        && only.replicates == 1
    {
        return exact(only);
    }
    if sets.iter().any(|s| s.replicates < 2) {
        return Rms::Dark;
    }
    let ratio = Ratio::of(sets);
    let t = two_sided_t(confidence, ratio.freedom);
    match (ratio.reach(t), ratio.reach(1.0)) {
        (Some(reach), Some(one)) => {
            let value = ratio.value.sqrt();
            Rms::Known(Estimate {
                value,
                std_err: Some(ratio.high(one, 1.0) - value),
                low: (ratio.value + reach.0).max(0.0).sqrt(),
                high: ratio.high(reach, t),
            })
        }
        _ => Rms::Dark,
    }
}

/// Against a truth that is taken as it is.
fn exact(sums: &Sums) -> Rms {
    if sums.reference > 0.0 {
        Rms::Known(Estimate::exact((sums.difference / sums.reference).sqrt()))
    } else {
        Rms::Dark
    }
}

/// q with what its interval is made of.
struct Ratio {
    /// q, not below 0.
    value: f64,
    denominator: f64,
    spread: Spread,
    freedom: f64,
    /// Variance along the strongest noise direction relative to the denominator: of the mean over all replicates,
    /// and of the mean within a set.
    strongest: f64,
    strongest_in_set: f64,
}

impl Ratio {
    fn of(sets: &[Sums]) -> Self {
        let mean = |f: &dyn Fn(&Sums) -> f64| sets.iter().map(f).sum::<f64>() / sets.len() as f64;
        let denominator = mean(&Sums::debiased_reference);
        let value = (mean(&Sums::debiased_difference) / denominator).max(0.0);
        let replicates: usize = sets.iter().map(|s| s.replicates).sum();
        // The part of <D, D> - q <Y, Y> that is quadratic in the noise is (1 - q) times the noise norm.
        let curvature = (1.0 - value).abs() / denominator;
        Self {
            value,
            denominator,
            spread: Spread::of_mean(&sets.iter().map(|s| s.spread(value)).collect::<Vec<_>>()),
            freedom: (replicates - sets.len()) as f64,
            strongest: curvature * mean(&|s| s.top_variance / replicates as f64),
            strongest_in_set: curvature * mean(&|s| s.top_variance / s.replicates as f64),
        }
    }

    /// How far q may be below and above its value: the h for which <D, D> - (q + h) <Y, Y> is t standard errors
    /// from 0 (Fieller). `None` if the denominator is within t standard errors of 0.
    fn reach(&self, t: f64) -> Option<(f64, f64)> {
        let t2 = t * t;
        let a = self.denominator * self.denominator - t2 * self.spread.reference;
        if self.denominator <= 0.0 || a <= 0.0 {
            return None;
        }
        let b = t2 * self.spread.both;
        let root = (b * b + a * t2 * self.spread.residual).sqrt();
        Some(((-b - root) / a, (-b + root) / a))
    }

    fn high(&self, reach: (f64, f64), t: f64) -> f64 {
        (self.value + reach.1 + t * t * self.strongest + self.strongest_in_set).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;
    use proptest::prelude::*;

    /// A scene with noisy references; everything random from one seed.
    struct Case {
        areas: Vec<f64>,
        solution: Vec<f64>,
        rows: Vec<Vec<f64>>,
    }

    impl Case {
        fn new(patches: usize, replicates: usize, noise: f64, seed: u64) -> Self {
            let mut random = Random(seed);
            let areas = (0..patches).map(|_| 0.1 + random.uniform()).collect();
            let truth: Vec<f64> = (0..patches).map(|_| 1.0 + random.uniform()).collect();
            let solution = truth.iter().map(|y| y * (1.0 + 0.1 * random.normal())).collect();
            let row = |random: &mut Random| truth.iter().map(|y| y + noise * random.normal()).collect();
            let rows = (0..replicates).map(|_| row(&mut random)).collect();
            Self { areas, solution, rows }
        }

        fn rms(&self) -> Estimate {
            relative_rms(&self.areas, &self.solution, &self.rows, 0.95).estimate().unwrap()
        }
    }

    fn close(a: Estimate, b: Estimate, tolerance: f64) -> bool {
        let near = |x: f64, y: f64| (x - y).abs() <= tolerance * y.abs().max(1e-3);
        near(a.value, b.value)
            && near(a.low, b.low)
            && near(a.high, b.high)
            && near(a.std_err.unwrap(), b.std_err.unwrap())
    }

    #[test]
    fn numerator_and_denominator_are_means_over_pairs_of_different_replicates() {
        let case = Case::new(7, 5, 0.2, 1);
        let (mut above, mut below) = (0.0, 0.0);
        for r in &case.rows {
            for s in case.rows.iter().filter(|s| *s != r) {
                for i in 0..7 {
                    above += case.areas[i] * (case.solution[i] - r[i]) * (case.solution[i] - s[i]);
                    below += case.areas[i] * r[i] * s[i];
                }
            }
        }
        let known = (above / below).max(0.0).sqrt();
        assert!(known > 0.0 && (case.rms().value / known - 1.0).abs() < 1e-12, "{known}");
    }

    #[test]
    fn one_row_is_the_truth_itself() {
        let rms = relative_rms(&[1.0, 3.0], &[2.0, 1.0], &[vec![1.0, 2.0]], 0.95);
        assert_eq!(rms, Rms::Known(Estimate::exact((4.0f64 / 13.0).sqrt())));
    }

    #[test]
    fn replicates_that_agree_leave_no_doubt() {
        let rms = relative_rms(&[1.0, 3.0], &[2.0, 1.0], &vec![vec![1.0, 2.0]; 8], 0.95).estimate().unwrap();
        let known = (4.0f64 / 13.0).sqrt();
        assert_eq!((rms.value, rms.low, rms.high, rms.std_err), (known, known, known, Some(0.0)));
    }

    #[test]
    fn a_black_solution_is_off_by_all_of_it_whatever_the_noise() {
        let mut case = Case::new(20, 8, 0.5, 2);
        case.solution.fill(0.0);
        let e = case.rms();
        assert!((e.value - 1.0).abs() < 1e-12 && e.high - e.low < 1e-9, "{e:?}");
    }

    #[test]
    fn nothing_is_relative_to_the_dark() {
        assert_eq!(relative_rms(&[1.0], &[1.0], &vec![vec![0.0]; 8], 0.95), Rms::Dark);
        assert_eq!(relative_rms(&[1.0], &[1.0], &[vec![0.0]], 0.95), Rms::Dark);
        assert_eq!(relative_rms(&[0.0], &[1.0], &[vec![1.0]], 0.95), Rms::Dark);
        assert_eq!(relative_rms(&[1.0], &[1.0], &[], 0.95), Rms::Dark);
        let noise: Vec<Vec<f64>> = (0..8).map(|k| vec![(k as f64 - 3.5) * 1e-6]).collect();
        assert_eq!(relative_rms(&[1.0], &[1.0], &noise, 0.95), Rms::Dark);
    }

    /// One noise direction, along the difference, on a patch that is dark: the difference there is a scalar with a
    /// Student t interval of its own, D + t s.
    #[test]
    fn the_upper_end_is_exact_where_noise_has_one_direction() {
        for offset in [0.0, 0.02, 1.0] {
            let noise = [-0.3, -0.2, -0.1, 0.0, 0.0, 0.1, 0.2, 0.3].map(|x| 0.1 * x);
            let rows: Vec<Vec<f64>> = noise.iter().map(|e| vec![100.0, *e]).collect();
            let e = relative_rms(&[1.0, 1.0], &[100.0, offset], &rows, 0.95).estimate().unwrap();
            let s = (noise.iter().map(|e| e * e).sum::<f64>() / 56.0).sqrt();
            let t = two_sided_t(0.95, 7.0);
            // q is below 0 for the smallest offset: 0 takes its place, and s^2 more is allowed for.
            let hidden = if offset == 0.0 { s * s } else { 0.0 };
            let known = ((offset + t * s).powi(2) + hidden).sqrt() / 100.0;
            assert!((e.high / known - 1.0).abs() < 1e-3, "{offset}: {} {known}", e.high);
            assert!(e.low <= (offset - t * s).max(0.0) / 100.0);
        }
    }

    #[test]
    fn more_confidence_is_wider_and_more_replicates_are_narrower() {
        let case = Case::new(30, 32, 0.1, 3);
        let at = |confidence| relative_rms(&case.areas, &case.solution, &case.rows, confidence).estimate().unwrap();
        let (wide, narrow) = (at(0.99), at(0.9));
        assert!(wide.low < narrow.low && wide.high > narrow.high && wide.value == narrow.value);
        let few = relative_rms(&case.areas, &case.solution, &case.rows[..8], 0.95).estimate().unwrap();
        let all = case.rms();
        assert!(all.high - all.low < 0.8 * (few.high - few.low));
    }

    proptest! {
        #[test]
        fn scale_does_not_matter(seed in 0u64..1000, exponent in -20i32..20, noise in 0.0..0.5f64) {
            let case = Case::new(6, 8, noise, seed);
            let c = 1.7 * 10f64.powi(exponent);
            let scaled = |v: &Vec<f64>| v.iter().map(|x| x * c).collect::<Vec<f64>>();
            let other = Case {
                areas: scaled(&case.areas),
                solution: scaled(&case.solution),
                rows: case.rows.iter().map(scaled).collect(),
            };
            prop_assert!(close(other.rms(), case.rms(), 1e-9));
        }

        #[test]
        fn the_order_of_patches_and_of_replicates_does_not_matter(seed in 0u64..1000, turn in 0usize..6) {
            let case = Case::new(6, 8, 0.2, seed);
            let turned = |v: &Vec<f64>| {
                let mut v = v.clone();
                v.rotate_left(turn);
                v
            };
            let mut rows: Vec<Vec<f64>> = case.rows.iter().map(turned).collect();
            rows.rotate_left(turn);
            let other = Case { areas: turned(&case.areas), solution: turned(&case.solution), rows };
            prop_assert!(close(other.rms(), case.rms(), 1e-9));
        }

        #[test]
        fn a_patch_cut_in_two_halves_changes_nothing(seed in 0u64..1000, which in 0usize..6) {
            let case = Case::new(6, 8, 0.2, seed);
            let doubled = |v: &Vec<f64>| [v.as_slice(), &[v[which]]].concat();
            let mut areas = doubled(&case.areas);
            areas[which] *= 0.5;
            areas[6] *= 0.5;
            let other = Case { areas, solution: doubled(&case.solution), rows: case.rows.iter().map(doubled).collect() };
            prop_assert!(close(other.rms(), case.rms(), 1e-9));
        }

        #[test]
        fn absent_patches_take_no_part(seed in 0u64..1000, junk in -1e6..1e6f64) {
            let case = Case::new(6, 8, 0.2, seed);
            let extended = |v: &Vec<f64>, x: f64| [v.as_slice(), &[x]].concat();
            let other = Case {
                areas: extended(&case.areas, 0.0),
                solution: extended(&case.solution, junk),
                rows: case.rows.iter().map(|r| extended(r, 0.0)).collect(),
            };
            prop_assert_eq!(other.rms(), case.rms());
        }

        #[test]
        fn the_interval_holds_the_value(seed in 0u64..1000, noise in 0.0..2.0f64, replicates in 4usize..40) {
            let case = Case::new(6, replicates, noise, seed);
            if let Rms::Known(e) = relative_rms(&case.areas, &case.solution, &case.rows, 0.95) {
                prop_assert!(0.0 <= e.low && e.low <= e.value && e.value <= e.high && e.high.is_finite(), "{e:?}");
                prop_assert!(e.std_err.unwrap() >= 0.0);
            }
        }
    }
}
