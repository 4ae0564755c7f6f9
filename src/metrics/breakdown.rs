//! How the error is spread: over values, over the noise, over surfaces and objects.

use super::error::MetricsError;
use super::groups::{GroupError, group_errors};
use super::histogram::{Histogram, reach};
use super::noise::{Against, NoiseTest, noise_test};
use super::quantity::{Quantity, mean_of};
use super::types::{Judged, Truth};
use crate::math::compensated_sum;
use crate::solution::Radiosity;
use crate::stats::Moments;
use serde::{Deserialize, Serialize};

/// Share of the area that the histogram of errors reaches around.
const BULK: f64 = 0.98;

/// What a report shows beside the metrics: where the error lies and whether it can be noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Breakdown {
    /// Two-sided confidence of each interval here, taken by itself.
    pub confidence: f64,
    /// Root-mean-square luminance of the reference over the area, W/m^2.
    pub reference_rms: f64,
    /// Area by difference of luminance, as a fraction of `reference_rms`; `None` without any difference.
    pub errors: Option<Histogram>,
    /// Differences against the noise of the reference; `None` if it states none.
    pub noise: Option<NoiseTest>,
    /// By surface, the largest part of the squared error first.
    pub surfaces: Vec<GroupError>,
    /// By object likewise.
    pub objects: Vec<GroupError>,
}

/// Breaks the error of a solution down. `objects` names the object of each receiver; all else as in
/// [`compare`](super::compare).
///
/// # Errors
/// As [`compare`](super::compare).
pub fn break_down(
    solution: &Radiosity,
    reference: &Truth,
    judged: &Judged,
    objects: &[&str],
    confidence: f64,
    reflected: bool,
) -> Result<Breakdown, MetricsError> {
    super::check::inputs(solution, reference, None, judged, confidence)?;
    let (got, expected) = (objects.len(), judged.areas.len());
    if got != expected {
        return Err(MetricsError::Shape { what: "the list of objects", unit: "patches", got, expected });
    }
    let quantity = Quantity::luminance(judged, reflected);
    let (rows, ours) = (quantity.of_truth(reference), quantity.of(&solution.values));
    let mean = mean_of(&rows);
    let areas = judged.areas;
    let area = compensated_sum(areas.iter().copied());
    let reference_rms = (compensated_sum(areas.iter().zip(&mean).map(|(a, y)| a * y * y)) / area).sqrt();
    let groups = |key: &dyn Fn(usize) -> _| group_errors(areas, &ours, &rows, key, confidence);
    let own = solution.std_err.as_ref().map(|e| quantity.std_err_bound(e));
    let noise = (rows.len() > 1).then(|| {
        let all = against(areas, &ours, &rows, &mean, own.as_deref());
        noise_test(&all, rows.len() as f64 - 1.0, 1.0 - confidence)
    });
    Ok(Breakdown {
        confidence,
        reference_rms,
        errors: errors(areas, &ours, &mean, reference_rms),
        noise,
        surfaces: groups(&|i| (Some(objects[i]), judged.surfaces[i])),
        objects: groups(&|i| (None, objects[i])),
    })
}

fn errors(areas: &[f64], solution: &[f64], reference: &[f64], unit: f64) -> Option<Histogram> {
    let present = (0..areas.len()).filter(|i| areas[*i] > 0.0);
    let pairs: Vec<(f64, f64)> = present.map(|i| ((solution[i] - reference[i]) / unit, areas[i])).collect();
    // A dark reference has no scale.
    let reach = reach(&pairs, BULK).filter(|r| r.is_finite())?;
    Some(Histogram::empty(reach).fill(&pairs))
}

fn against(
    areas: &[f64],
    solution: &[f64],
    rows: &[Vec<f64>],
    mean: &[f64],
    own: Option<&[f64]>,
) -> Vec<Option<Against>> {
    let one = |i: usize| {
        let std_err = rows.iter().map(|row| row[i]).collect::<Moments>().std_err()?;
        let own_std_err = own.map_or(0.0, |e| e[i]);
        let difference = solution[i] - mean[i];
        (areas[i] > 0.0).then_some(Against { area: areas[i], reference: mean[i], difference, std_err, own_std_err })
    };
    (0..areas.len()).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::compare;
    use crate::solution::Replicates;
    use crate::stats::test_random::Random;

    fn mono(values: Vec<f64>) -> Radiosity {
        Radiosity { bands: 1, values, std_err: None }
    }

    #[test]
    fn the_parts_make_up_eq_7() {
        let n = 60;
        let mut random = Random(2);
        let truth: Vec<f64> = (0..n).map(|i| 1.0 + (i % 7) as f64).collect();
        let replicates: Vec<Vec<f64>> =
            (0..12).map(|_| truth.iter().map(|y| y * (1.0 + 0.01 * random.normal())).collect()).collect();
        let solution = mono(truth.iter().enumerate().map(|(i, y)| y * (1.0 + 0.002 * (i % 5) as f64)).collect());
        let areas: Vec<f64> = (0..n).map(|i| 0.5 + (i % 3) as f64).collect();
        let surfaces: Vec<&str> = (0..n).map(|i| ["a", "b", "c"][i % 3]).collect();
        let objects: Vec<&str> = (0..n).map(|i| if i % 3 == 0 { "o" } else { "p" }).collect();
        let names = vec!["y".to_string()];
        let judged =
            Judged { areas: &areas, emission: &vec![0.0; n], surfaces: &surfaces, bands: &names, weights: &[1.0] };
        let reference = Truth::Sampled(Replicates { bands: 1, replicates });
        let b = break_down(&solution, &reference, &judged, &objects, 0.95, false).expect("a breakdown");
        let c = compare(&solution, &reference, None, &judged, 0.95, false).expect("a comparison");
        let sum = |groups: &[GroupError]| groups.iter().map(|g| g.share.expect("a share").value).sum::<f64>();
        assert!((sum(&b.surfaces) - 1.0).abs() < 1e-12 && (sum(&b.objects) - 1.0).abs() < 1e-12);
        // Biases of surfaces, by area over the light of the reference, are the bias of the whole.
        let missing: f64 = b.surfaces.iter().map(|g| g.area * g.bias.value).sum();
        let light: f64 = b.surfaces.iter().map(|g| g.area * g.reference.value).sum();
        assert!((missing / light - c.bias.value).abs() < 1e-12);
        let worst = &b.surfaces.iter().max_by(|a, b| a.worst_difference.abs().total_cmp(&b.worst_difference.abs()));
        assert_eq!(worst.map(|g| g.worst), Some(c.worst[0].patch));
        let noise = b.noise.expect("a test");
        assert_eq!((noise.tested, noise.freedom), (n, 11.0));
        let scored = noise.scores[c.worst[0].patch].expect("a score");
        assert!((scored - c.worst[0].difference / c.worst[0].std_err.expect("an error")).abs() < 1e-12);
        let h = b.errors.expect("a histogram");
        assert!((h.bins.iter().sum::<f64>() + h.below + h.above - 1.0).abs() < 1e-12);
        assert!(h.below + h.above <= 0.02 + 1e-12);
    }

    #[test]
    fn a_solution_that_is_the_other_has_no_histogram_and_another_solution_no_noise() {
        let names = vec!["y".to_string()];
        let judged =
            Judged { areas: &[1.0, 2.0], emission: &[0.0, 0.5], surfaces: &["a", "b"], bands: &names, weights: &[1.0] };
        let same = mono(vec![1.0, 2.0]);
        let b = break_down(&same, &Truth::Given(same.clone()), &judged, &["o", "o"], 0.95, false).expect("ok");
        assert!(b.errors.is_none() && b.noise.is_none() && b.objects.len() == 1);
        assert!((b.reference_rms - 3f64.sqrt()).abs() < 1e-15);
        let bright = break_down(&mono(vec![1.0, 2.5]), &Truth::Given(same), &judged, &["o", "o"], 0.95, true);
        let b = bright.expect("ok");
        // Reflected: 1 and 1.5 over three square metres; a third of the area in the middle, two thirds at the right end.
        assert!((b.reference_rms - (5.5f64 / 3.0).sqrt()).abs() < 1e-15);
        let h = b.errors.expect("a histogram");
        let last = h.bins.iter().rposition(|s| *s > 0.0).expect("a bin");
        assert!((h.bins[last] - 2.0 / 3.0).abs() < 1e-12 && (h.bins[h.bins.len() / 2] - 1.0 / 3.0).abs() < 1e-12);
        let (low, high) = (h.edges()[last], h.edges()[last + 1]);
        let at = 0.5 / b.reference_rms;
        assert!(low <= at && at < high, "{low} {at} {high}");
    }
}
