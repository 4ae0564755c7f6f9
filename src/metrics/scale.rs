//! The factor by which a solution is too bright everywhere, and its name where it has one.

use super::rms::relative_rms;
use crate::math::{Compensated, compensated_sum};
use crate::stats::{Estimate, jackknife_interval};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A factor is named only if dividing by it leaves less than this share of the error.
const EXPLAINED: f64 = 0.25;
/// The solution may be off by this much beside the factor: beyond, a name would be a guess.
const MOST_LEFT: f64 = 0.1;
/// A name has to be so much nearer than no factor at all.
const NEARER: f64 = 0.2;

/// The least-squares factor s that makes `sum A (Y_sol - s Y_ref)^2` least.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// The factor: 1 for a solution that is right, 4 for one that is four times too bright.
    #[serde(flatten)]
    pub factor: Estimate,
    /// Eq. 7 of the solution divided by the factor: what no factor explains. `None` where that cannot be told.
    pub rms_after: Option<f64>,
    /// What factors like this one come from; `None` for a factor without a name.
    pub named: Option<String>,
}

impl Scale {
    /// True if the factor explains most of an error that was `rms` before.
    pub fn explains(&self, rms: f64) -> bool {
        let surely = self.factor.low > 1.0 || self.factor.high < 1.0;
        surely && self.rms_after.is_some_and(|after| after <= EXPLAINED * rms)
    }

    /// Names a factor that has no name yet by the reflectance that all reflecting patches share; `rms` is the error
    /// before the factor is taken out.
    pub fn name_by_reflectance(&mut self, rho: f64, rms: f64) {
        if self.named.is_none() && rho > 0.0 && self.explains(rms) {
            let known = [
                (1.0 / rho, format!("1/rho ({:.4}): irradiance given as reflected radiosity", 1.0 / rho)),
                (rho, format!("rho ({rho:.4}): reflected once too often")),
            ];
            self.named = self.rms_after.and_then(|after| name(&self.factor, after, known));
        }
    }
}

/// Fits the factor; interval by jackknife over replicates, exact for one row. `None` where the reference is
/// dark.
///
/// `areas`, `solution` and each row of `reference` have one entry per patch; patches of area 0 take no part.
pub fn fit_scale(areas: &[f64], solution: &[f64], reference: &[Vec<f64>], confidence: f64) -> Option<Scale> {
    let factor = factor(&Products::of(areas, solution, reference), confidence)?;
    if factor.value <= 0.0 {
        return Some(Scale { factor, rms_after: None, named: None });
    }
    let divided: Vec<f64> = solution.iter().map(|y| y / factor.value).collect();
    let value = |s: &[f64]| relative_rms(areas, s, reference, confidence).estimate().map(|e| e.value);
    let (before, rms_after) = (value(solution)?, value(&divided));
    let mut scale = Scale { factor, rms_after, named: None };
    if scale.explains(before) {
        scale.named = rms_after.and_then(|after| name(&factor, after, KNOWN));
    }
    Some(scale)
}

/// Inner products over patches, weighted by area.
struct Products {
    /// `<Y_sol, Y_r>` per replicate.
    with_solution: Vec<f64>,
    /// `<Y_r, Y>` per replicate, Y the sum over replicates.
    with_sum: Vec<f64>,
    /// `<Y_r, Y_r>` per replicate.
    squares: Vec<f64>,
}

impl Products {
    fn of(areas: &[f64], solution: &[f64], rows: &[Vec<f64>]) -> Self {
        let mut sum = vec![0.0; areas.len()];
        for row in rows {
            sum.iter_mut().zip(row).for_each(|(s, y)| *s += y);
        }
        let inner = |a: &[f64], b: &[f64]| {
            let mut total = Compensated::default();
            areas.iter().zip(a.iter().zip(b)).filter(|(w, _)| **w > 0.0).for_each(|(w, (x, y))| total.add(w * x * y));
            total.value()
        };
        Self {
            with_solution: rows.iter().map(|row| inner(solution, row)).collect(),
            with_sum: rows.iter().map(|row| inner(row, &sum)).collect(),
            squares: rows.iter().map(|row| inner(row, row)).collect(),
        }
    }
}

/// `<Y_sol, Y> / <Y, Y>`, the denominator over pairs of different replicates so that it holds no noise squared.
fn factor(p: &Products, confidence: f64) -> Option<Estimate> {
    let r = p.squares.len() as f64;
    let (a, b) = (compensated_sum(p.with_solution.iter().copied()), compensated_sum(p.with_sum.iter().copied()));
    let c = compensated_sum(p.squares.iter().copied());
    if p.squares.len() == 1 {
        return (c > 0.0).then(|| Estimate::exact(a / c));
    }
    let ratio = |a: f64, pairs: f64, n: f64| (a / n) / (pairs / (n * (n - 1.0)));
    let full = ratio(a, b - c, r);
    // Without replicate k the pairs that hold it go.
    let without = |k: usize| ratio(a - p.with_solution[k], b - c - 2.0 * (p.with_sum[k] - p.squares[k]), r - 1.0);
    let left_out: Vec<f64> = (0..p.squares.len()).map(without).collect();
    let known = b > c && left_out.iter().all(|s| s.is_finite());
    known.then(|| jackknife_interval(full, &left_out, confidence))
}

/// The name of a factor that is, within its interval and what it leaves unexplained, a well-known one.
fn name<T: Into<String>, const N: usize>(factor: &Estimate, rms_after: f64, known: [(f64, T); N]) -> Option<String> {
    if rms_after > MOST_LEFT {
        return None;
    }
    let s = factor.value;
    let slack = |ratio: f64| (0.5 * (factor.high - factor.low)).max(rms_after * ratio).max(1e-9 * ratio);
    let off = |ratio: f64| (s - ratio).abs();
    let near = |ratio: f64| off(ratio) <= slack(ratio) && off(ratio) <= NEARER * (s - 1.0).abs();
    let best = known.into_iter().filter(|(ratio, _)| near(*ratio)).min_by(|a, b| off(a.0).total_cmp(&off(b.0)));
    best.map(|(_, what)| what.into())
}

/// Factors that mistakes are known by.
const KNOWN: [(f64, &str); 8] = [
    (PI, "pi: a division by pi is missing (radiosity is pi times radiance)"),
    (1.0 / PI, "1/pi: radiance given as radiosity, or a division by pi too many"),
    (2.0, "2: counted twice, or both sides of a lamp"),
    (0.5, "1/2: half is missing, or a mean of two sides"),
    (4.0, "4: an edge of 2 taken for 1 (areas four times too large), or 4 samples added instead of averaged"),
    (0.25, "1/4: areas four times too small, or 4 samples averaged twice"),
    (4.0 * PI, "4 pi: a division by the full sphere is missing"),
    (1.0 / (4.0 * PI), "1/(4 pi): divided by the full sphere"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    const AREAS: [f64; 5] = [1.0, 2.0, 0.0, 0.5, 3.0];
    const TRUTH: [f64; 5] = [1.0, 3.0, 9.0, 0.2, 2.0];

    fn noisy(random: &mut Random, sigma: f64) -> Vec<Vec<f64>> {
        (0..16).map(|_| TRUTH.iter().map(|y| y * (1.0 + sigma * random.normal())).collect()).collect()
    }

    fn times(s: f64) -> Vec<f64> {
        // The absent patch is of another brightness: it must not count.
        TRUTH.iter().enumerate().map(|(i, y)| if i == 2 { 77.0 } else { s * y }).collect()
    }

    #[test]
    fn a_known_factor_is_found_and_named() {
        let rows = noisy(&mut Random(3), 0.01);
        for (s, start) in [(PI, "pi:"), (1.0 / PI, "1/pi:"), (4.0, "4:"), (0.5, "1/2:"), (0.25, "1/4:"), (2.0, "2:")] {
            let scale = fit_scale(&AREAS, &times(s), &rows, 0.95).unwrap();
            assert!(scale.factor.low < s && scale.factor.high > s, "{scale:?}");
            assert!(scale.named.as_ref().is_some_and(|n| n.starts_with(start)), "{s}: {scale:?}");
        }
        let mut scale = fit_scale(&AREAS, &times(1.25), &rows, 0.95).unwrap();
        scale.name_by_reflectance(0.8, 0.25);
        assert!(scale.named.is_some_and(|n| n.starts_with("1/rho")));
        assert_eq!(fit_scale(&AREAS, &times(2.6), &rows, 0.95).unwrap().named, None);
    }

    #[test]
    fn a_right_solution_has_factor_one_and_no_name() {
        let rows = noisy(&mut Random(5), 0.02);
        let scale = fit_scale(&AREAS, &times(1.0), &rows, 0.95).unwrap();
        assert!(scale.factor.low < 1.0 && scale.factor.high > 1.0 && scale.named.is_none(), "{scale:?}");
        assert!(!scale.explains(0.01));
    }

    #[test]
    fn an_error_that_is_no_factor_is_not_explained_by_one() {
        let solution = [4.0, 3.0, 0.0, 0.2, 2.0];
        let scale = fit_scale(&AREAS, &solution, &[TRUTH.to_vec()], 0.95).unwrap();
        // <Y_sol, Y> = 4 + 18 + 0.02 + 12 over 1 + 18 + 0.02 + 12.
        assert_eq!(scale.factor, Estimate::exact(34.02 / 31.02));
        assert!(scale.named.is_none() && scale.rms_after.is_some_and(|r| r > 0.4));
    }

    #[test]
    fn nothing_is_a_multiple_of_darkness() {
        assert_eq!(fit_scale(&AREAS, &TRUTH, &[vec![0.0; 5]], 0.95), None);
        assert_eq!(fit_scale(&AREAS, &TRUTH, &vec![vec![0.0; 5]; 8], 0.95), None);
    }

    /// Intervals of 95 % miss in 5 % of cases: 2,000 trials, 100 expected, sd 10; the jackknife at R = 16 has a little
    /// more. 160 is 6 sd.
    #[test]
    fn the_interval_covers_as_it_says() {
        let mut random = Random(8);
        let missed = (0..2000).filter(|_| {
            let rows = noisy(&mut random, 0.2);
            let e = fit_scale(&AREAS, &times(1.5), &rows, 0.95).unwrap().factor;
            e.low > 1.5 || e.high < 1.5
        });
        let missed = missed.count();
        assert!((50..160).contains(&missed), "{missed}");
    }
}
