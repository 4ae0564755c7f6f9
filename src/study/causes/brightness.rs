//! Everything too bright by one factor, and quantities that are taken for each other.

use super::jury::{Hypothesis, Jury};
use super::words::{digits, too_bright};
use crate::metrics::fit_scale;
use crate::solution::Replicates;
use std::f64::consts::PI;

const FAMILY: &str = "brightness";

/// Share of the area that may be black where irradiance is told from `(B - E) / rho`.
const MOST_BLACK: f64 = 0.2;

pub(super) fn hear(jury: &mut Jury, reference: &Replicates) {
    scales(jury, reference);
    quantities(jury);
    irradiance(jury);
    one_band(jury);
}

/// `B` or `B - E` times one factor.
fn scales(jury: &mut Jury, reference: &Replicates) {
    let case = jury.case;
    for (kind, what, of_emission) in [("scale", "everything", 0.0), ("scale-reflected", "all reflected light", 1.0)] {
        let light = case.everywhere(|k| case.truth[k] - of_emission * case.emission[k]);
        let factor = 1.0 + case.amount(&light);
        // Named by what is known of factors: the same words as beside the metrics.
        let less = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(&case.emission).map(|(b, e)| b - of_emission * e).collect()
        };
        let rows: Vec<Vec<f64>> = reference.replicates.iter().map(|r| case.luminances(&less(r))).collect();
        let fitted = fit_scale(&case.areas, &case.luminances(&less(&case.solution)), &rows, 0.95);
        let name = fitted.and_then(|s| s.named).map_or(String::new(), |n| format!("; {n}"));
        let sentence = format!("{what} is {} (factor {}){name}", too_bright(factor), digits(factor));
        let change = light.iter().map(|b| (factor - 1.0) * b).collect();
        jury.hear(hypothesis(kind, 1, sentence, false), change);
    }
}

/// The value of patch and band k in another world.
type Value<'a> = &'a dyn Fn(usize) -> f64;

/// Radiance for radiosity, its inverse, and emission left out or counted twice.
fn quantities(jury: &mut Jury) {
    let case = jury.case;
    let known: [(&str, &str, Value); 4] = [
        ("radiance", "the values are radiances, not radiosities: pi times too small", &|k| case.truth[k] / PI),
        ("times-pi", "the values are pi times too large: radiosities taken for radiances", &|k| case.truth[k] * PI),
        ("emission-missing", "the values are reflected light only: the emission of the lamps is missing", &|k| {
            case.truth[k] - case.emission[k]
        }),
        ("emission-twice", "the emission of the lamps is counted twice", &|k| case.truth[k] + case.emission[k]),
    ];
    for (kind, sentence, value) in known {
        let change = case.everywhere(|k| value(k) - case.truth[k]);
        // A factor that is only partly pi is another factor.
        let partly = kind.starts_with("emission");
        jury.hear(hypothesis(kind, 0, sentence.to_string(), partly), change);
    }
}

/// What arrives instead of what leaves: `(B - E) / rho`. Black patches, of which the reference does not tell what
/// arrives, are taken as they come, where they are few.
fn irradiance(jury: &mut Jury) {
    let case = jury.case;
    let black = |i: usize| case.reflectance[i * case.bands..(i + 1) * case.bands].iter().all(|r| *r <= 0.0);
    let area = |choose: &dyn Fn(usize) -> bool| {
        (0..case.areas.len()).filter(|i| choose(*i)).map(|i| case.areas[i]).sum::<f64>()
    };
    if area(&black) > MOST_BLACK * area(&|_| true) {
        return;
    }
    let arriving = |k: usize| {
        let rho = case.reflectance[k];
        if rho > 0.0 { (case.truth[k] - case.emission[k]) / rho } else { case.solution[k] }
    };
    let change = case.everywhere(|k| arriving(k) - case.truth[k]);
    let sentence = "the values are irradiances (what arrives), not radiosities (what leaves)".to_string();
    jury.hear(hypothesis("irradiance", 0, sentence, true), change);
}

/// One band off by a factor.
fn one_band(jury: &mut Jury) {
    let case = jury.case;
    if case.bands < 2 {
        return;
    }
    for (c, name) in case.stage.photometry.bands.iter().enumerate() {
        let light = case.everywhere(|k| if k % case.bands == c { case.truth[k] } else { 0.0 });
        let factor = 1.0 + case.amount(&light);
        let sentence = format!("band \"{name}\" alone is {} (factor {})", too_bright(factor), digits(factor));
        let change = light.iter().map(|b| (factor - 1.0) * b).collect();
        let place = Some(name.clone());
        jury.hear(Hypothesis { place, ..hypothesis("one-band", 1, sentence, false) }, change);
    }
}

fn hypothesis(kind: &'static str, parameters: usize, sentence: String, partly: bool) -> Hypothesis {
    Hypothesis { family: FAMILY, kind, place: None, parameters, sentence, partly }
}
