//! Every metric of one comparison.

use super::bias::relative_bias;
use super::error::MetricsError;
use super::quantity::{Quantity, mean_of};
use super::rms::{Rms, relative_rms};
use super::scale::{Scale, fit_scale};
use super::top1::top1_rms;
use super::types::{Comparison, Judged, Truth, WorstPatch};
use crate::math::compensated_sum;
use crate::solution::Radiosity;
use crate::stats::{Estimate, Moments};

/// A reference needs so many replicates: the top 1 % halves them, and half a spread takes two.
pub(super) const MIN_REPLICATES: usize = 4;

/// How many of the worst patches are named.
const WORST: usize = 10;

/// Compares a solution with the truth; all intervals two-sided at `confidence`.
///
/// `before` is the state before the change, for the top 1 %: a reference, or the old solver's solution.
/// With `reflected` the metrics are of B - E instead of B, except `rms_reflected` (B - E in either case) and
/// `emitter_share` (eq. 7 of B in either case); the patches of the top 1 % are chosen by the change of B, for
/// the emission before the change is not known.
///
/// # Errors
/// Shapes that do not fit, values that are not finite, fewer than four replicates, nothing present, a reference
/// that is dark.
pub fn compare(
    solution: &Radiosity,
    reference: &Truth,
    before: Option<&Truth>,
    judged: &Judged,
    confidence: f64,
    reflected: bool,
) -> Result<Comparison, MetricsError> {
    super::check::inputs(solution, reference, before, judged, confidence)?;
    let whole = View::of(solution, reference, judged, Quantity::luminance(judged, false), confidence);
    let beyond_emission = View::of(solution, reference, judged, Quantity::luminance(judged, true), confidence);
    let main = if reflected { &beyond_emission } else { &whole };
    let what = if reflected { "the reflected luminance" } else { "the luminance" };
    let dark = MetricsError::DarkReference { what };
    let rms_reflected = beyond_emission.rms().estimate();
    let rms = if reflected { rms_reflected } else { whole.rms().estimate() }.ok_or(dark.clone())?;
    let top1 = before.and_then(|before| {
        let before = Quantity::luminance(judged, false).of_truth(before);
        main.top1(&whole.reference, &before).estimate()
    });
    Ok(Comparison {
        confidence,
        rms,
        top1,
        rms_reflected,
        bias: relative_bias(judged.areas, &main.solution, &main.reference, confidence).ok_or(dark)?,
        per_band: per_band(solution, reference, judged, confidence, reflected),
        reference_noise_floor: main.reference_noise_floor(),
        solution_noise: solution.std_err.as_ref().map(|e| main.solution_noise(e)),
        emitter_share: whole.emitter_share(),
        scale: beyond_emission.scale(),
        scale_of_total: whole.scale(),
        patches: judged.areas.iter().filter(|a| **a > 0.0).count(),
        worst: main.worst(),
    })
}

fn per_band(
    solution: &Radiosity,
    reference: &Truth,
    judged: &Judged,
    confidence: f64,
    reflected: bool,
) -> Vec<(String, Option<Estimate>)> {
    let band = |c: usize| {
        View::of(solution, reference, judged, Quantity::band(judged, c, reflected), confidence).rms().estimate()
    };
    judged.bands.iter().enumerate().map(|(c, name)| (name.clone(), band(c))).collect()
}

/// Solution and reference seen as one scalar per patch.
struct View<'a> {
    quantity: Quantity<'a>,
    judged: Judged<'a>,
    confidence: f64,
    solution: Vec<f64>,
    /// One row per replicate.
    reference: Vec<Vec<f64>>,
    /// Mean of the rows.
    mean: Vec<f64>,
}

impl<'a> View<'a> {
    fn of(
        solution: &Radiosity,
        reference: &Truth,
        judged: &Judged<'a>,
        quantity: Quantity<'a>,
        confidence: f64,
    ) -> Self {
        let rows = quantity.of_truth(reference);
        let (solution, mean) = (quantity.of(&solution.values), mean_of(&rows));
        Self { quantity, judged: *judged, confidence, solution, reference: rows, mean }
    }

    fn rms(&self) -> Rms {
        relative_rms(self.judged.areas, &self.solution, &self.reference, self.confidence)
    }

    fn scale(&self) -> Option<Scale> {
        fit_scale(self.judged.areas, &self.solution, &self.reference, self.confidence)
    }

    fn top1(&self, after: &[Vec<f64>], before: &[Vec<f64>]) -> Rms {
        top1_rms(self.judged.areas, &self.solution, &self.reference, after, before, self.confidence)
    }

    /// `sum A x^2` over the patches.
    fn norm_squared(&self, x: impl Fn(usize) -> f64) -> f64 {
        compensated_sum(self.judged.areas.iter().enumerate().map(|(i, a)| a * x(i).powi(2)))
    }

    fn mean_norm_squared(&self) -> f64 {
        self.norm_squared(|i| self.mean[i])
    }

    /// Standard error of the reference at a patch.
    fn std_err(&self, i: usize) -> Option<f64> {
        self.reference.iter().map(|row| row[i]).collect::<Moments>().std_err()
    }

    fn reference_noise_floor(&self) -> Option<f64> {
        if self.reference.len() < 2 {
            return None;
        }
        Some((self.norm_squared(|i| self.std_err(i).unwrap_or(0.0)) / self.mean_norm_squared()).sqrt())
    }

    fn solution_noise(&self, std_err: &[f64]) -> f64 {
        let e = self.quantity.std_err_bound(std_err);
        (self.norm_squared(|i| e[i]) / self.mean_norm_squared()).sqrt()
    }

    /// Share of patches with emission in sum A Y^2.
    fn emitter_share(&self) -> f64 {
        let bands = self.judged.bands.len();
        let emits = |i: usize| self.judged.emission[i * bands..(i + 1) * bands].iter().any(|e| *e > 0.0);
        self.norm_squared(|i| if emits(i) { self.mean[i] } else { 0.0 }) / self.mean_norm_squared()
    }

    fn worst(&self) -> Vec<WorstPatch> {
        let difference = |i: usize| self.solution[i] - self.mean[i];
        let mut order: Vec<usize> = (0..self.mean.len()).filter(|i| self.judged.areas[*i] > 0.0).collect();
        order.sort_by(|a, b| difference(*b).abs().total_cmp(&difference(*a).abs()));
        order.truncate(WORST);
        let named = |i: usize| WorstPatch {
            patch: i,
            surface: self.judged.surfaces[i].to_string(),
            reference: self.mean[i],
            solution: self.solution[i],
            difference: difference(i),
            std_err: self.std_err(i),
        };
        order.into_iter().map(named).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{Beside, Limits, Verdict, decide, measure};
    use crate::solution::Replicates;
    use crate::stats::test_random::Random;

    const RGB: [f64; 3] = [0.2, 0.7, 0.1];

    fn bands(names: &[&str]) -> Vec<String> {
        names.iter().map(|n| n.to_string()).collect()
    }

    fn mono(values: &[f64]) -> Radiosity {
        Radiosity { bands: 1, values: values.to_vec(), std_err: None }
    }

    #[test]
    fn by_hand_against_another_solution() {
        let names = bands(&["y"]);
        let judged = Judged {
            areas: &[1.0, 2.0, 0.0, 1.0],
            emission: &[0.0, 0.0, 0.0, 3.0],
            surfaces: &["floor", "wall", "gone", "lamp"],
            bands: &names,
            weights: &[1.0],
        };
        let reference = Truth::Given(mono(&[1.0, 2.0, 0.0, 4.0]));
        let before = Truth::Given(mono(&[1.0, 2.0, 0.0, 3.0]));
        let solution = mono(&[1.5, 1.5, 9.0, 5.0]);
        let c = compare(&solution, &reference, Some(&before), &judged, 0.95, false).unwrap();
        // Squares: 0.25 + 2 * 0.25 + 1 = 1.75 over 1 + 8 + 16 = 25.
        let exact = |x: f64| Estimate::exact(x.sqrt());
        assert_eq!(c.rms, exact(1.75 / 25.0));
        // Reflected: 1 + 8 + 1 = 10.
        assert_eq!(c.rms_reflected, Some(exact(1.75 / 10.0)));
        assert_eq!(c.top1, Some(exact(1.0 / 16.0)));
        // 0.5 - 1 + 1 over 1 + 4 + 4.
        assert_eq!(c.bias, Estimate::exact(0.5 / 9.0));
        assert_eq!((c.patches, c.reference_noise_floor, c.solution_noise), (3, None, None));
        assert_eq!(c.emitter_share, 16.0 / 25.0);
        let order: Vec<usize> = c.worst.iter().map(|w| w.patch).collect();
        assert_eq!(order, [3, 0, 1]);
        assert_eq!((c.worst[2].surface.as_str(), c.worst[2].difference), ("wall", -0.5));
        let reflected = compare(&solution, &reference, None, &judged, 0.95, true).unwrap();
        assert_eq!((reflected.rms, reflected.rms_reflected), (exact(0.175), Some(exact(0.175))));
        assert_eq!((reflected.worst[0].reference, reflected.worst[0].solution), (1.0, 2.0));
        assert_eq!(reflected.emitter_share, 0.64);
    }

    #[test]
    fn a_bright_solution_reads_one_per_cent_and_an_exact_one_nothing() {
        let n = 200;
        let truth: Vec<f64> = (0..3 * n).map(|k| 1.0 + (k as f64).sin()).collect();
        let mut random = Random(7);
        let noisy = |random: &mut Random| truth.iter().map(|b| b * (1.0 + 0.004 * random.normal())).collect();
        let replicates = (0..16).map(|_| noisy(&mut random)).collect();
        let reference = Truth::Sampled(Replicates { bands: 3, replicates });
        let names = bands(&["r", "g", "b"]);
        let judged = Judged {
            areas: &vec![0.5; n],
            emission: &vec![0.0; 3 * n],
            surfaces: &vec!["s"; n],
            bands: &names,
            weights: &RGB,
        };
        let at = |scale: f64| {
            let solution = Radiosity { bands: 3, values: truth.iter().map(|b| b * scale).collect(), std_err: None };
            compare(&solution, &reference, None, &judged, 0.95, false).unwrap()
        };
        let (exact, bright) = (at(1.0), at(1.01));
        assert_eq!(exact.rms.low, 0.0);
        assert!(exact.rms.high < 7e-4, "{:?}", exact.rms);
        assert!((bright.rms.value - 0.01).abs() < 2e-4, "{:?}", bright.rms);
        assert!(bright.rms.low > 0.0095 && bright.rms.high < 0.0105, "{:?}", bright.rms);
        assert!(bright.bias.low < 0.01 && bright.bias.high > 0.01 && (bright.bias.value - 0.01).abs() < 2e-4);
        assert_eq!(bright.per_band.len(), 3);
        let solution = Radiosity { bands: 3, values: truth.iter().map(|b| b * 1.01).collect(), std_err: None };
        let beside = Beside { before: None, baseline: None, objects: &vec!["o"; n], viewing: None };
        let limit = |max: f64| {
            let m = measure(&solution, &reference, &judged, beside, &Limits::rms(max), 0.95, false).unwrap();
            assert_eq!(m[0].estimate, Some(bright.rms));
            // The noise is a tenth of a per cent: what would have been caught is not far above the limit.
            let caught = m[0].smallest_caught.unwrap();
            assert!(caught > max && caught < max + 2e-3, "{max} {caught}");
            decide(&m).verdict
        };
        assert_eq!([0.009, 0.010, 0.011].map(limit), [Verdict::Fail, Verdict::Inconclusive, Verdict::Pass]);
    }

    /// Two lit patches and an absent one; four replicates that scatter by 10 % about 1 and 2.
    fn four_replicates() -> Truth {
        let replicates = [0.9, 1.1, 0.95, 1.05].map(|f| vec![f, 2.0 * f, 0.0]).to_vec();
        Truth::Sampled(Replicates { bands: 1, replicates })
    }

    fn of_three<'a>(bands: &'a [String], emission: &'a [f64]) -> Judged<'a> {
        Judged { areas: &[1.0, 2.0, 0.0], emission, surfaces: &["a", "b", "gone"], bands, weights: &[2.0] }
    }

    #[test]
    fn noise_is_reported_but_the_solutions_own_never_judges() {
        let names = bands(&["y"]);
        let judged = of_three(&names, &[0.0; 3]);
        let mut solution = mono(&[1.0, 2.1, 0.0]);
        let quiet = compare(&solution, &four_replicates(), None, &judged, 0.95, false).unwrap();
        // Squared deviations of a factor: 0.025; se^2 = 0.025 / 12, the same share of every patch.
        let floor = quiet.reference_noise_floor.unwrap();
        assert!((floor - (0.025f64 / 12.0).sqrt()).abs() < 1e-12, "{floor}");
        assert!((quiet.worst[0].std_err.unwrap() - 4.0 * floor).abs() < 1e-12);
        assert_eq!(quiet.worst.len(), 2);
        solution.std_err = Some(vec![0.3, 0.0, 0.0]);
        let noisy = compare(&solution, &four_replicates(), None, &judged, 0.95, false).unwrap();
        assert!((noisy.solution_noise.unwrap() - 0.3 / 3.0).abs() < 1e-12);
        assert_eq!(Comparison { solution_noise: None, ..noisy }, quiet);
    }

    #[test]
    fn errors_of_bands_may_add_up() {
        let names = bands(&["r", "g"]);
        let judged =
            Judged { areas: &[1.0], emission: &[0.0; 2], surfaces: &["a"], bands: &names, weights: &[0.25, 0.75] };
        let solution = Radiosity { bands: 2, values: vec![1.0, 1.0], std_err: Some(vec![0.4, 0.4]) };
        let reference = Truth::Given(Radiosity { bands: 2, values: vec![2.0, 2.0], std_err: None });
        let c = compare(&solution, &reference, None, &judged, 0.95, false).unwrap();
        assert_eq!(c.solution_noise, Some(0.2));
        let halves = c.per_band.iter().map(|(n, e)| (n.as_str(), e.unwrap().value)).collect::<Vec<_>>();
        assert_eq!(halves, [("r", 0.5), ("g", 0.5)]);
    }

    #[test]
    fn where_nothing_is_reflected_there_is_no_reflected_error() {
        let names = bands(&["y"]);
        let emission = [1.0, 2.0, 0.0];
        // B differs from E by the rounding of a solver.
        let reference = Truth::Given(mono(&[1.0 + 1e-14, 2.0, 0.0]));
        let judged = of_three(&names, &emission);
        let c = compare(&mono(&[1.1, 2.0, 0.0]), &reference, None, &judged, 0.95, false).unwrap();
        assert_eq!((c.rms_reflected, c.emitter_share), (None, 1.0));
        let refused = compare(&mono(&[1.1, 2.0, 0.0]), &reference, None, &judged, 0.95, true);
        assert_eq!(refused, Err(MetricsError::DarkReference { what: "the reflected luminance" }));
    }

    #[test]
    fn a_dark_band_has_no_error_and_a_dark_scene_is_refused() {
        let names = bands(&["r", "g"]);
        let judged =
            Judged { areas: &[1.0], emission: &[0.0; 2], surfaces: &["a"], bands: &names, weights: &[0.5, 0.5] };
        let of = |values: [f64; 2]| Radiosity { bands: 2, values: values.to_vec(), std_err: None };
        let compared = |r| compare(&of([1.0, 1.0]), &Truth::Given(of(r)), None, &judged, 0.95, false);
        let c = compared([1.0, 0.0]).unwrap();
        assert_eq!(c.per_band, [("r".to_string(), Some(Estimate::exact(0.0))), ("g".to_string(), None)]);
        assert_eq!(compared([0.0, 0.0]), Err(MetricsError::DarkReference { what: "the luminance" }));
    }

    #[test]
    fn what_does_not_fit_is_refused_with_its_place() {
        let names = bands(&["y"]);
        let judged = of_three(&names, &[0.0; 3]);
        let good = mono(&[1.0, 2.0, 0.0]);
        let given = |values: &[f64]| Truth::Given(mono(values));
        let run = |s: &Radiosity, r: &Truth, before: Option<&Truth>, confidence| {
            compare(s, r, before, &judged, confidence, false).unwrap_err().to_string()
        };
        let reference = four_replicates();
        assert!(run(&mono(&[1.0]), &reference, None, 0.95).contains("the solution has 1 values"));
        assert!(run(&mono(&[1.0, f64::NAN, 0.0]), &reference, None, 0.95).contains("patch 1"));
        assert!(run(&good, &given(&[1.0, 2.0]), None, 0.95).contains("the reference has 2 values"));
        assert!(run(&good, &reference, Some(&given(&[1.0])), 0.95).contains("before the change has 1 values"));
        assert!(run(&good, &reference, None, 1.0).contains("confidence of 1"));
        let few = Truth::Sampled(Replicates { bands: 1, replicates: vec![vec![1.0, 2.0, 0.0]; 3] });
        assert!(run(&good, &few, None, 0.95).contains("3 replicates"));
        let bands_differ = Radiosity { bands: 3, values: vec![1.0; 9], std_err: None };
        assert!(run(&bands_differ, &reference, None, 0.95).contains("3 bands"));
        let nobody = Judged { areas: &[0.0; 3], ..judged };
        assert_eq!(compare(&good, &reference, None, &nobody, 0.95, false), Err(MetricsError::NothingPresent));
    }

    #[test]
    fn the_json_has_the_contracts_fields() {
        let names = bands(&["y"]);
        let c = compare(&mono(&[1.0, 2.1, 0.0]), &four_replicates(), None, &of_three(&names, &[0.0; 3]), 0.9, false);
        let json = serde_json::to_value(c.unwrap()).unwrap();
        let keys: Vec<&str> = json.as_object().unwrap().keys().map(String::as_str).collect();
        let contract = [
            "confidence",
            "rms",
            "top1",
            "rms_reflected",
            "bias",
            "per_band",
            "reference_noise_floor",
            "solution_noise",
            "emitter_share",
            "scale",
            "scale_of_total",
            "patches",
            "worst",
        ];
        assert_eq!(keys, contract);
        assert!(json["top1"].is_null() && json["per_band"]["y"]["value"].is_number());
        assert_eq!((json["worst"][0]["patch"].as_u64(), json["worst"][0]["surface"].as_str()), (Some(1), Some("b")));
    }
}
