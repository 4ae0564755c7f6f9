//! What is shown in false colour: one number per patch, with its words, its unit and its scale.

use crate::render::{Field, Scale, difference, in_standard_errors, luminance, luminance_std_err, relative_difference};
use crate::report::asked::Level;
use crate::report::format::{count, significant};
use crate::study::Record;

/// A difference picture in standard errors reaches at least this far: what lies within is no news.
const LEAST_Z: f64 = 3.0;

/// One number per patch that is shown in false colour, with its words and its scale.
pub(in crate::report) struct ShownField {
    /// `difference`, `relative`, `std_err`, `z`, `steps` or `brils`.
    pub kind: &'static str,
    /// Title.
    pub title: &'static str,
    /// What is shown, without what the scale leaves out.
    pub what: String,
    /// The numbers.
    pub field: Field,
    /// Their colours.
    pub scale: Scale,
    /// Their unit.
    pub unit: Unit,
}

/// What is shown in false colour: the errors of the reference only where there are any, what is seen only where somebody
/// looks.
pub(in crate::report) fn shown_fields(record: &Record) -> Vec<ShownField> {
    let (stage, photometry) = (&record.stage, &record.stage.photometry);
    let areas = stage.areas();
    let reference = luminance(photometry, &record.reference);
    let solution = luminance(photometry, &record.solution);
    let wrong = difference(&reference, &solution);
    let relative = relative_difference(&reference, &solution);
    let noise = luminance_std_err(photometry, &record.reference);
    let z = tested(record)
        .unwrap_or_else(|| in_standard_errors(&wrong, &noise, &luminance_std_err(photometry, &record.solution)));
    let shown = |kind, title, what: String, field, scale, unit| ShownField { kind, title, what, field, scale, unit };
    let scale = Scale::symmetric(&wrong, &areas, 0.0);
    let mut all = vec![shown("difference", "Signed difference", WRONG.into(), wrong, scale, WATTS)];
    let scale = Scale::symmetric(&relative, &areas, 0.0);
    all.push(shown("relative", "Relative difference", RELATIVE.into(), relative, scale, PERCENT));
    if !noise.is_blank() {
        let scale = Scale::from_zero(&noise, &areas);
        all.push(shown("std_err", "Standard error of the reference", NOISE.into(), noise, scale, WATTS));
        let scale = Scale::symmetric(&z, &areas, LEAST_Z);
        let what = format!("{IN_ERRORS}{}", beyond(record));
        all.push(shown("z", "Difference in standard errors", what, z, scale, ERRORS));
    }
    if let Some(seen) = &record.as_seen {
        let viewer = &seen.viewer;
        let off = |of: &dyn Fn(f64) -> f64| Field {
            values: reference.iter().zip(&solution).map(|(r, s)| Some(of(*s) - of(*r))).collect(),
        };
        let (steps, brils) = (off(&|y| viewer.steps(y)), off(&|y| viewer.brightness(y)));
        let scale = Scale::symmetric(&steps, &areas, 1.0);
        all.push(shown("steps", "Difference in display steps", IN_STEPS.into(), steps, scale, STEPS));
        let scale = Scale::symmetric(&brils, &areas, 0.0);
        all.push(shown("brils", "Difference in brightness", IN_BRILS.into(), brils, scale, BRILS));
    }
    all
}

/// The scores that were tested, where they are of patches: then picture, histogram and counts agree.
fn tested(record: &Record) -> Option<Field> {
    let scores = &record.breakdown.as_ref()?.noise.as_ref()?.scores;
    let of_patches = Level::of(record) == Level::Patch && scores.len() == record.stage.patch_count();
    of_patches.then(|| Field { values: scores.clone() })
}

/// How many lie beyond what chance allows to all of them together.
fn beyond(record: &Record) -> String {
    let Some(noise) = record.breakdown.as_ref().and_then(|b| b.noise.as_ref()) else { return String::new() };
    let (family, nouns) = (&noise.family, Level::of(record).nouns());
    format!(
        " {} of {} {nouns} lie beyond {} standard errors, where chance alone would put {}.",
        count(family.count),
        count(noise.tested),
        significant(family.threshold, 3),
        significant(family.expected, 2)
    )
}

/// (unit, what a value is multiplied by for its label).
pub(in crate::report) type Unit = (&'static str, f64);
pub(in crate::report) const WATTS: Unit = ("W/m\u{b2}, luminance", 1.0);
const PERCENT: Unit = ("% of the reference", 100.0);
const STEPS: Unit = ("steps of the display, of 255", 1.0);
const BRILS: Unit = ("brils", 1.0);
const ERRORS: Unit = ("standard errors", 1.0);

const WRONG: &str = "Solution minus reference: red where the solution is too bright, blue where it is too dark.";
const RELATIVE: &str = "The same as a share of what the reference has there: errors in dark corners show as clearly as \
                        those in the light.";
const IN_STEPS: &str = "By how many steps of the frame buffer the screen shows it wrong: what stays within one cannot \
                        be seen there.";
const IN_BRILS: &str = "By how much brighter (red) or darker (blue) it looks to an eye in the scene.";
const NOISE: &str = "How well the reference itself is known.";
const IN_ERRORS: &str =
    "Differences against the noise: what stays within two or three is no evidence of an error in the solution.";
