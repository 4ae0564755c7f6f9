//! A material with another reflectance, which is fitted.

use super::case::Case;
use super::jury::{Hypothesis, Jury};
use super::quick::Quick;
use super::words::per_band;

/// Materials looked at: those with most of the squared error.
const MOST: usize = 16;
/// Corrections of a fit, each with the system solved again.
const CORRECTIONS: usize = 3;
/// A change of first order is followed up if so much of the squared error may go away.
const PROMISING: f64 = 0.5;
/// Reflectances end below this.
const BRIGHTEST: f64 = 0.999;

pub(super) fn hear(jury: &mut Jury, quick: &Quick) {
    let case = jury.case;
    let irradiance = quick.irradiance();
    for number in case.worst(|i| case.stage.patches[i].material, MOST) {
        let Some((reflectance, change)) = fit(case, quick, &irradiance, number) else { continue };
        let material = &case.stage.materials[number as usize];
        let (now, was) = (per_band(&reflectance), per_band(&material.reflectance));
        let name = material.name.clone();
        let sentence = format!("material \"{name}\" behaves like reflectance {now} instead of {was}");
        let parameters = if reflectance.iter().all(|r| *r == 0.0) { 0 } else { 1 };
        jury.hear(
            Hypothesis { family: "material", kind: "material", place: Some(name), parameters, sentence, partly: false },
            change,
        );
    }
}

/// The reflectance of a material, per band, that explains most, and what it changes. Bands do not mix, so each is a fit
/// of one number: from the derivative first, then by the change that is solved for.
fn fit(case: &Case, quick: &Quick, irradiance: &[f64], number: u32) -> Option<(Vec<f64>, Vec<f64>)> {
    let bands = case.bands;
    let own = |k: usize| case.stage.patches[k / bands].material == number;
    let was = &case.stage.materials[number as usize].reflectance;
    let source = case.everywhere(|k| if own(k) { irradiance[k] } else { 0.0 });
    let slope = quick.spread(&source)?;
    let mut step: Vec<f64> = (0..bands).map(|c| amount(case, &slope, c)).collect();
    let first: Vec<f64> = slope.iter().enumerate().map(|(k, d)| step[k % bands] * d).collect();
    if case.left(&first).bands > 1.0 - PROMISING {
        return None;
    }
    let mut change = first;
    for _ in 0..CORRECTIONS {
        step.iter_mut().zip(was).for_each(|(s, rho)| *s = (rho + *s).clamp(0.0, BRIGHTEST) - rho);
        let reflectance: Vec<f64> =
            case.reflectance.iter().enumerate().map(|(k, r)| if own(k) { r + step[k % bands] } else { *r }).collect();
        let source = case.everywhere(|k| if own(k) { step[k % bands] * irradiance[k] } else { 0.0 });
        change = quick.spread_with(&source, &reflectance)?;
        // Secant through "no change": the answer grows with the step nearly in proportion.
        for (c, s) in step.iter_mut().enumerate() {
            *s *= amount(case, &change, c);
        }
    }
    // The last correction is within rounding of the one before: the change belongs to the reflectance before it.
    let reflectance = was.iter().zip(&step).map(|(rho, s)| (rho + s).clamp(0.0, BRIGHTEST)).collect();
    Some((reflectance, change))
}

/// The least-squares amount of a change in one band; 1 where it changes nothing.
fn amount(case: &Case, change: &[f64], band: usize) -> f64 {
    let d = case.inner_band(change, change, band);
    if d > 0.0 { case.inner_band(&case.error, change, band) / d } else { 0.0 }
}
