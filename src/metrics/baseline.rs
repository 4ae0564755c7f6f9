//! A solution against an earlier one, both against the same reference: by how much it became worse.

use super::bias::relative_bias;
use super::error::MetricsError;
use super::quantity::{Quantity, mean_of};
use super::rms::relative_rms;
use super::types::{Judged, Truth};
use super::worst::worst_patch;
use crate::math::compensated_sum;
use crate::solution::Radiosity;
use crate::stats::{Estimate, jackknife_interval};
use serde::{Deserialize, Serialize};

/// Eq. 7 of `solution` less eq. 7 of `before`, judged on the same replicates. `None` where the reference is dark.
///
/// The squares differ by `<y - y_before, y + y_before - 2 y_ref>`, which is linear in the reference: its noise squared,
/// the same in both, is gone, and two solutions that are alike are told apart far below the noise of either. The step from
/// squares to roots takes the error of `before`, known within its own interval; each of the two intervals gets half of the
/// risk.
pub fn growth(
    areas: &[f64],
    solution: &[f64],
    before: &[f64],
    reference: &[Vec<f64>],
    confidence: f64,
) -> Option<Estimate> {
    let half_risk = 0.5 + 0.5 * confidence;
    let old = relative_rms(areas, before, reference, half_risk).estimate()?;
    let squares = growth_of_squares(areas, solution, before, reference, half_risk)?;
    // From q_before to q_before + g: the root moves the more the smaller q_before is.
    let step = |g: f64, r: f64| (r * r + g).max(0.0).sqrt() - r;
    let value = step(squares.value, old.value);
    let low = if squares.low > 0.0 {
        step(squares.low, old.high)
    } else {
        step(squares.low, old.low.max(least(squares.low)))
    };
    let high = if squares.high > 0.0 { step(squares.high, old.low) } else { step(squares.high, old.high) };
    let slope = old.value + (old.value * old.value + squares.value).max(0.0).sqrt();
    let std_err = squares.std_err.map(|se| if slope > 0.0 { se / slope } else { se.sqrt() });
    Some(Estimate { value, std_err, low: low.min(value), high: high.max(value) })
}

/// Below this error of the baseline, a fall of squares by `g` would bring the new error below 0.
fn least(g: f64) -> f64 {
    (-g).max(0.0).sqrt()
}

/// The difference of the squares of eq. 7; exact for one row. Interval by jackknife over replicates.
pub fn growth_of_squares(
    areas: &[f64],
    solution: &[f64],
    before: &[f64],
    reference: &[Vec<f64>],
    confidence: f64,
) -> Option<Estimate> {
    let present = || (0..areas.len()).filter(|i| areas[*i] > 0.0);
    let linear = |y: &[f64]| {
        compensated_sum(
            present().map(|i| areas[i] * (solution[i] - before[i]) * (solution[i] + before[i] - 2.0 * y[i])),
        )
    };
    let inner = |a: &[f64], b: &[f64]| compensated_sum(present().map(|i| areas[i] * a[i] * b[i]));
    let mean = mean_of(reference);
    let r = reference.len() as f64;
    if reference.len() == 1 {
        let norm = inner(&mean, &mean);
        return (norm > 0.0).then(|| Estimate::exact(linear(&mean) / norm));
    }
    let numerators: Vec<f64> = reference.iter().map(|y| linear(y)).collect();
    let (own, with_mean): (Vec<f64>, Vec<f64>) = reference.iter().map(|y| (inner(y, y), inner(y, &mean))).unzip();
    let squares = compensated_sum(own.iter().copied());
    let all = r * r * inner(&mean, &mean);
    // Means over pairs of different replicates, all of them and with one left out.
    let norm = (all - squares) / (r * (r - 1.0));
    let total = compensated_sum(numerators.iter().copied());
    let full = (norm > 0.0).then(|| total / r / norm)?;
    let left_out: Option<Vec<f64>> = (0..reference.len())
        .map(|k| {
            let pairs = all - squares - 2.0 * (r * with_mean[k] - own[k]);
            let norm = pairs / ((r - 1.0) * (r - 2.0));
            (norm > 0.0).then(|| (total - numerators[k]) / (r - 1.0) / norm)
        })
        .collect();
    Some(jackknife_interval(full, &left_out?, confidence))
}

/// One metric of a solution, before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// `rms`, `energy`, `worst`, or `rms@band:NAME`.
    pub metric: String,
    /// Of the earlier solution.
    pub before: Estimate,
    /// Of the later one.
    pub after: Estimate,
    /// After - before, both judged by the same replicates; `None` where the difference has no error of its own.
    pub change: Option<Estimate>,
    /// The change in standard errors of itself: how sure it is that there is one. `None` where none is stated.
    pub sigmas: Option<f64>,
}

/// What changed between two solutions of one scene, metric by metric. Intervals two-sided at `confidence`, one by one.
///
/// # Errors
/// As [`compare`](super::compare).
pub fn changes(
    after: &Radiosity,
    before: &Radiosity,
    reference: &Truth,
    judged: &Judged,
    confidence: f64,
    reflected: bool,
) -> Result<Vec<Change>, MetricsError> {
    super::check::inputs(after, reference, None, judged, confidence)?;
    super::check::alone(before, judged, confidence)?;
    let areas = judged.areas;
    let scalar = |q: &Quantity| (q.of(&after.values), q.of(&before.values), q.of_truth(reference));
    let rms = |name: String, q: Quantity| {
        let (new, old, rows) = scalar(&q);
        let error = |y: &[f64]| relative_rms(areas, y, &rows, confidence).estimate();
        let change = growth(areas, &new, &old, &rows, confidence);
        let squares = growth_of_squares(areas, &new, &old, &rows, confidence);
        let sigmas = squares.and_then(|s| Some(s.value / s.std_err.filter(|e| *e > 0.0)?));
        Some(Change { metric: name, before: error(&old)?, after: error(&new)?, change, sigmas })
    };
    let luminance = || Quantity::luminance(judged, reflected);
    let (new, old, rows) = scalar(&luminance());
    let bias = |y: &[f64]| relative_bias(areas, y, &rows, confidence);
    let energy = || {
        // The difference of two solutions over the light there is.
        let rows: Vec<Vec<f64>> = rows.clone();
        let sum: Vec<f64> = new.iter().zip(&old).map(|(a, b)| a - b).collect();
        let change = relative_share(areas, &sum, &rows, confidence);
        let sigmas = change.and_then(|c| Some(c.value / c.std_err.filter(|e| *e > 0.0)?));
        Some(Change { metric: "energy".into(), before: bias(&old)?, after: bias(&new)?, change, sigmas })
    };
    let worst = || {
        let of = |y: &[f64]| worst_patch(areas, y, &rows, confidence).filter(|e| e.value < f64::MAX);
        Some(Change { metric: "worst".into(), before: of(&old)?, after: of(&new)?, change: None, sigmas: None })
    };
    let mut all: Vec<Change> = rms("rms".into(), luminance()).into_iter().chain(energy()).chain(worst()).collect();
    if judged.bands.len() > 1 {
        let band = |(c, name): (usize, &String)| rms(format!("rms@band:{name}"), Quantity::band(judged, c, reflected));
        all.extend(judged.bands.iter().enumerate().filter_map(band));
    }
    Ok(all)
}

/// `sum A x / sum A Y_ref`, the interval from the spread of the denominator; exact for one row.
fn relative_share(areas: &[f64], x: &[f64], rows: &[Vec<f64>], confidence: f64) -> Option<Estimate> {
    let total = |y: &[f64]| compensated_sum(areas.iter().zip(y).map(|(a, y)| a * y));
    let (own, sums) = (total(x), rows.iter().map(|r| total(r)).collect::<Vec<_>>());
    let (sum, r) = (compensated_sum(sums.iter().copied()), rows.len() as f64);
    if sum <= 0.0 {
        return None;
    }
    if rows.len() == 1 {
        return Some(Estimate::exact(own / sum));
    }
    let left_out: Vec<f64> = sums.iter().map(|s| own / ((sum - s) / (r - 1.0))).collect();
    Some(jackknife_interval(own * r / sum, &left_out, confidence))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    #[test]
    fn alike_is_exactly_no_worse_whatever_the_noise() {
        let mut random = Random(3);
        let rows: Vec<Vec<f64>> = (0..16).map(|_| (0..50).map(|_| 1.0 + 0.3 * random.normal()).collect()).collect();
        let e = growth(&[1.0; 50], &[1.2; 50], &[1.2; 50], &rows, 0.95).unwrap();
        assert_eq!((e.value, e.low, e.high), (0.0, 0.0, 0.0));
    }

    #[test]
    fn exact_against_a_solution() {
        let e = growth(&[1.0, 3.0], &[1.2, 2.0], &[1.0, 2.2], &[vec![1.0, 2.0]], 0.95).unwrap();
        let known = (0.04f64 / 13.0).sqrt() - (0.12f64 / 13.0).sqrt();
        assert!((e.value - known).abs() < 1e-15 && e.low == e.value && e.high == e.value, "{e:?}");
    }

    /// Two solutions 2 % and 2.1 % off in different patches, a reference with noise of 1 % of its own: the interval holds
    /// the true difference, and the difference is seen although it is far below the noise of each error.
    #[test]
    fn paired_intervals_cover_and_see_far_below_the_noise() {
        let n = 200;
        let mut random = Random(12);
        let truth: Vec<f64> = (0..n).map(|i| 1.0 + 0.5 * (i as f64).sin()).collect();
        let old: Vec<f64> = truth.iter().enumerate().map(|(i, y)| y * if i % 2 == 0 { 1.02 } else { 0.98 }).collect();
        let new: Vec<f64> = truth.iter().enumerate().map(|(i, y)| y * if i % 2 == 0 { 1.021 } else { 0.979 }).collect();
        let areas = vec![1.0; n];
        let known = growth(&areas, &new, &old, std::slice::from_ref(&truth), 0.95).unwrap().value;
        let (mut missed, mut seen) = (0, 0);
        for _ in 0..300 {
            let rows: Vec<Vec<f64>> = (0..16)
                .map(|_| {
                    let common = 0.01 * random.normal();
                    truth.iter().map(|y| y * (1.0 + common + 0.02 * random.normal())).collect()
                })
                .collect();
            let e = growth(&areas, &new, &old, &rows, 0.95).unwrap();
            missed += usize::from(e.low > known || e.high < known);
            seen += usize::from(e.low > 0.0);
        }
        // 15 expected at most of 300, sd 3.8; above 31 with probability 1e-4.
        assert!(missed <= 31, "{missed}");
        assert!(seen > 270, "{seen}");
    }

    /// A baseline without error: anything added to it is worse.
    #[test]
    fn against_a_perfect_baseline() {
        let mut random = Random(5);
        let (mut alarms, mut caught) = (0, 0);
        for _ in 0..300 {
            let rows: Vec<Vec<f64>> =
                (0..16).map(|_| (0..100).map(|_| 1.0 + 0.01 * random.normal()).collect()).collect();
            let other: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { 1.0 + 1e-7 } else { 1.0 - 1e-7 }).collect();
            alarms += usize::from(growth(&[1.0; 100], &other, &[1.0; 100], &rows, 0.95).unwrap().low > 1e-7);
            let bad: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { 1.02 } else { 0.98 }).collect();
            caught += usize::from(growth(&[1.0; 100], &bad, &[1.0; 100], &rows, 0.95).unwrap().low > 0.0);
        }
        assert!(alarms <= 31, "{alarms}");
        assert_eq!(caught, 300);
    }
}
