//! What a perfect solution would read over the patches that change most.

use super::quantity::{Quantity, mean_of};
use super::top1::top1_set;
use super::types::{Judged, Truth};
use crate::math::compensated_sum;
use crate::stats::Moments;

/// The noise floor of the top 1 %: `sqrt(sum A se^2 / sum A Y^2)` over the patches whose luminance changes most from
/// `before`, chosen by the means. `None` where the reference states no noise, or where those patches are dark.
pub fn top1_noise_floor(reference: &Truth, before: &Truth, judged: &Judged, reflected: bool) -> Option<f64> {
    let luminance = Quantity::luminance(judged, false);
    let after = luminance.of_truth(reference);
    let set = top1_set(judged.areas, &mean_of(&after), &mean_of(&luminance.of_truth(before)));
    let rows = if reflected { Quantity::luminance(judged, true).of_truth(reference) } else { after };
    if rows.len() < 2 {
        return None;
    }
    let moments = |i: usize| rows.iter().map(|row| row[i]).collect::<Moments>();
    let over = |f: &dyn Fn(Moments) -> f64| compensated_sum(set.iter().map(|i| judged.areas[*i] * f(moments(*i))));
    let light = over(&|m| m.mean.powi(2));
    (light > 0.0).then(|| (over(&|m| m.std_err().unwrap_or(0.0).powi(2)) / light).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solution::{Radiosity, Replicates};

    #[test]
    fn only_the_patches_that_change_count() {
        let bands = ["y".to_string()];
        let emission = vec![0.0; 120];
        let surfaces = vec!["wall"; 120];
        let areas: Vec<f64> = (0..120).map(|i| if i == 5 { 2.0 } else { 1.0 }).collect();
        let judged = Judged { areas: &areas, emission: &emission, surfaces: &surfaces, bands: &bands, weights: &[1.0] };
        // Patches 5 and 7 change; the spread of two values a +- d has the standard error d.
        let row = |d: f64| {
            let value = |i: usize| {
                if i == 5 {
                    3.0 + 0.3 * d
                } else if i == 7 {
                    4.0 - 0.4 * d
                } else {
                    1.0 + 0.5 * d
                }
            };
            (0..120).map(value).collect::<Vec<f64>>()
        };
        let truth = Truth::Sampled(Replicates { bands: 1, replicates: vec![row(1.0), row(-1.0)] });
        let before = Truth::Given(Radiosity { bands: 1, values: vec![1.0; 120], std_err: None });
        let known = ((2.0 * 0.09 + 0.16) / (2.0 * 9.0 + 16.0f64)).sqrt();
        let floor = top1_noise_floor(&truth, &before, &judged, false).expect("noise");
        assert!((floor - known).abs() < 1e-12, "{floor} {known}");
        assert_eq!(top1_noise_floor(&before, &before, &judged, false), None);
    }
}
