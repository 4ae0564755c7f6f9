//! Where an error comes from: the solver, the form factors, or the division into patches.
//!
//! With the candidate's own form factors F, `solve(F)` the exact solution with them, (a) the patch system and (b) the
//! continuous problem: `B - (b) = [B - solve(F)] + [solve(F) - (a)] + [(a) - (b)]`, patch by patch and with sign; norms do
//! not add (Arvo, Torrance and Smits 1994).

use super::error::MetricsError;
use super::quantity::{Quantity, mean_of};
use super::rms::interval;
use super::sums::Sums;
use super::types::{Judged, Truth, WorstPatch};
use crate::math::compensated_sum;
use crate::solution::Radiosity;
use crate::stats::{Estimate, Moments};
use serde::{Deserialize, Serialize};

/// One part of an error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// `sqrt(sum A d^2 / sum A Y_ref^2)` of the signed differences d: eq. 7 of this part alone.
    pub rms: Estimate,
    /// `sum A d / sum A Y_ref`, signed.
    pub bias: f64,
    /// The patch with the largest |difference|: `reference` and `solution` are the two sides of this part.
    pub worst: Option<WorstPatch>,
}

/// The parts that can be told apart with what is at hand; `None` where something is missing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Split {
    /// B - solve(F): iterations left off, clamping, bugs of the solver.
    pub solver: Option<Part>,
    /// solve(F) - patch system: errors of the form factors.
    pub form_factor: Option<Part>,
    /// Patch system - continuous: patches taken for evenly bright.
    pub discretisation: Option<Part>,
    /// B - patch system, where no form factors were given.
    pub solver_and_form_factor: Option<Part>,
    /// solve(F) - continuous, where no patch-system reference was given.
    pub form_factor_and_discretisation: Option<Part>,
}

/// What there is to tell parts apart by.
#[derive(Debug, Clone, Copy)]
pub struct Steps<'a> {
    /// The candidate's radiosities.
    pub solution: &'a Radiosity,
    /// The exact solution with the candidate's own form factors.
    pub solved: Option<&'a Radiosity>,
    /// Level (a).
    pub patch_system: Option<&'a Truth>,
    /// Level (b).
    pub continuous: Option<&'a Truth>,
}

/// Splits the error of a solution into its parts, luminances; everything is relative to the deepest level given.
///
/// # Errors
/// Shapes that do not fit, values that are not finite, a reference that is dark.
pub fn split(steps: &Steps, judged: &Judged, confidence: f64) -> Result<Split, MetricsError> {
    let deepest = steps.continuous.or(steps.patch_system);
    let Some(deepest) = deepest else { return Ok(Split::default()) };
    for (given, truth) in [(steps.solved, steps.patch_system), (None, steps.continuous)] {
        let solution = given.unwrap_or(steps.solution);
        super::check::inputs(solution, truth.unwrap_or(deepest), None, judged, confidence)?;
    }
    let quantity = Quantity::luminance(judged, false);
    let rows = |r: &Radiosity| vec![quantity.of(&r.values)];
    let [solution, solved] = [Some(steps.solution), steps.solved].map(|r| r.map(rows));
    let [a, b] = [steps.patch_system, steps.continuous].map(|t| t.map(|t| quantity.of_truth(t)));
    let scale = Norms::of(judged, &quantity.of_truth(deepest))?;
    let part = |ours: &Option<Vec<Vec<f64>>>, theirs: &Option<Vec<Vec<f64>>>| {
        Some(scale.part(judged, ours.as_ref()?, theirs.as_ref()?, confidence))
    };
    let (with_factors, with_system) = (solved.is_some(), a.is_some());
    Ok(Split {
        solver: part(&solution, &solved),
        form_factor: part(&solved, &a),
        discretisation: part(&a, &b),
        solver_and_form_factor: if with_factors { None } else { part(&solution, &a) },
        form_factor_and_discretisation: if with_system { None } else { part(&solved, &b) },
    })
}

/// What parts are relative to.
struct Norms {
    /// `sum A Y^2`, free of noise.
    squares: f64,
    /// `sum A Y`.
    total: f64,
}

impl Norms {
    fn of(judged: &Judged, reference: &[Vec<f64>]) -> Result<Self, MetricsError> {
        let rows: Vec<&[f64]> = reference.iter().map(Vec::as_slice).collect();
        let zeros = vec![0.0; judged.areas.len()];
        let squares = Sums::over(present(judged), judged.areas, &zeros, &rows).debiased_reference();
        let mean = mean_of(reference);
        let total = compensated_sum(judged.areas.iter().zip(&mean).map(|(a, y)| a * y));
        let lit = squares > 0.0 && total > 0.0;
        if lit { Ok(Self { squares, total }) } else { Err(MetricsError::DarkReference { what: "the luminance" }) }
    }

    /// `ours - theirs`; replicates of both sides are independent, so they are paired as they come.
    fn part(&self, judged: &Judged, ours: &[Vec<f64>], theirs: &[Vec<f64>], confidence: f64) -> Part {
        let rows =
            if ours.len().min(theirs.len()) == 1 { ours.len().max(theirs.len()) } else { ours.len().min(theirs.len()) };
        let (ours, theirs) = (used(ours, rows), used(theirs, rows));
        let of = |side: &[&Vec<f64>], r: usize, i: usize| side[if side.len() == 1 { 0 } else { r }][i];
        let differences: Vec<Vec<f64>> =
            (0..rows).map(|r| (0..judged.areas.len()).map(|i| of(&theirs, r, i) - of(&ours, r, i)).collect()).collect();
        let (mean_ours, mean) = (mean_of(&cloned(&ours)), mean_of(&differences));
        let total = compensated_sum(judged.areas.iter().zip(&mean).map(|(a, d)| -a * d));
        Part {
            rms: self.rms(judged, &differences, confidence),
            bias: total / self.total,
            worst: worst(judged, &mean_ours, &mean, &differences),
        }
    }

    /// Eq. 7 of differences alone, against a norm that is taken as known: its noise is of second order here.
    fn rms(&self, judged: &Judged, differences: &[Vec<f64>], confidence: f64) -> Estimate {
        let rows: Vec<&[f64]> = differences.iter().map(Vec::as_slice).collect();
        let zeros = vec![0.0; judged.areas.len()];
        let mut sums = Sums::over(present(judged), judged.areas, &zeros, &rows);
        sums.reference = self.squares + sums.noise;
        sums.along_reference.iter_mut().for_each(|z| *z = 0.0);
        let unknown = Estimate { value: 0.0, std_err: None, low: 0.0, high: f64::MAX };
        interval(&[sums], confidence).estimate().unwrap_or(unknown)
    }
}

fn present<'a>(judged: &'a Judged) -> impl Iterator<Item = usize> + 'a {
    (0..judged.areas.len()).filter(|i| judged.areas[*i] > 0.0)
}

/// The first `rows` replicates; all of a side that has but one row.
fn used(side: &[Vec<f64>], rows: usize) -> Vec<&Vec<f64>> {
    side.iter().take(if side.len() == 1 { 1 } else { rows }).collect()
}

fn cloned(side: &[&Vec<f64>]) -> Vec<Vec<f64>> {
    side.iter().map(|v| v.to_vec()).collect()
}

/// `differences` are theirs - ours.
fn worst(judged: &Judged, ours: &[f64], mean: &[f64], differences: &[Vec<f64>]) -> Option<WorstPatch> {
    let i = present(judged).max_by(|i, j| mean[*i].abs().total_cmp(&mean[*j].abs()).then(j.cmp(i)))?;
    Some(WorstPatch {
        patch: i,
        surface: judged.surfaces[i].to_string(),
        reference: ours[i] + mean[i],
        solution: ours[i],
        difference: -mean[i],
        std_err: differences.iter().map(|d| d[i]).collect::<Moments>().std_err(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solution::Replicates;
    use crate::stats::test_random::Random;

    const AREAS: [f64; 4] = [1.0, 2.0, 0.0, 1.0];

    fn of(values: [f64; 4]) -> Radiosity {
        Radiosity { bands: 1, values: values.to_vec(), std_err: None }
    }

    fn sampled(random: &mut Random, values: [f64; 4], sigma: f64) -> Truth {
        let row = |random: &mut Random| values.iter().map(|v| v + sigma * random.normal()).collect();
        Truth::Sampled(Replicates { bands: 1, replicates: (0..16).map(|_| row(random)).collect() })
    }

    fn run(steps: &Steps) -> Split {
        let bands = ["y".to_string()];
        let judged = Judged {
            areas: &AREAS,
            emission: &[0.0; 4],
            surfaces: &["floor", "wall", "gone", "roof"],
            bands: &bands,
            weights: &[1.0],
        };
        split(steps, &judged, 0.95).expect("a split")
    }

    #[test]
    fn known_parts_are_found_by_hand() {
        let (b, solved) = (of([1.5, 2.0, 7.0, 3.0]), of([1.0, 2.0, 5.0, 3.0]));
        let system = Truth::Given(of([1.0, 2.5, 0.0, 3.0]));
        let continuous = Truth::Given(of([1.0, 2.5, 0.0, 4.0]));
        let steps =
            Steps { solution: &b, solved: Some(&solved), patch_system: Some(&system), continuous: Some(&continuous) };
        let s = run(&steps);
        // The norm: 1 + 12.5 + 16 = 29.5; the total: 1 + 5 + 4 = 10.
        let [solver, factor, division] = [&s.solver, &s.form_factor, &s.discretisation].map(|p| p.clone().unwrap());
        let rms = |squares: f64| (squares / 29.5f64).sqrt();
        assert!((solver.rms.value - rms(0.25)).abs() < 1e-15 && (solver.bias - 0.05).abs() < 1e-15);
        assert!((factor.rms.value - rms(0.5)).abs() < 1e-15 && (factor.bias + 0.1).abs() < 1e-15);
        assert!((division.rms.value - rms(1.0)).abs() < 1e-15 && (division.bias + 0.1).abs() < 1e-15);
        let worst = factor.worst.unwrap();
        assert_eq!((worst.patch, worst.surface.as_str(), worst.difference), (1, "wall", -0.5));
        assert_eq!((worst.solution, worst.reference), (2.0, 2.5));
        assert!(s.solver_and_form_factor.is_none() && s.form_factor_and_discretisation.is_none());
    }

    #[test]
    fn what_cannot_be_told_apart_stays_one() {
        let b = of([1.5, 2.0, 7.0, 3.0]);
        let mut random = Random(1);
        let system = sampled(&mut random, [1.0, 2.5, 0.0, 3.0], 0.01);
        let continuous = sampled(&mut random, [1.0, 2.5, 0.0, 4.0], 0.01);
        let all = Steps { solution: &b, solved: None, patch_system: Some(&system), continuous: Some(&continuous) };
        let s = run(&all);
        assert!(s.solver.is_none() && s.form_factor.is_none() && s.form_factor_and_discretisation.is_none());
        let (ours, division) = (s.solver_and_form_factor.unwrap(), s.discretisation.unwrap());
        assert!((ours.rms.value - (0.75f64 / 29.5).sqrt()).abs() < 0.005, "{ours:?}");
        assert!(division.rms.low < (1.0f64 / 29.5).sqrt() && division.rms.high > (1.0f64 / 29.5).sqrt());
        let factors = Steps { solved: Some(&b), patch_system: None, ..all };
        let s = run(&factors);
        assert_eq!(s.solver.unwrap().rms, Estimate::exact(0.0));
        assert!(s.form_factor_and_discretisation.is_some() && s.discretisation.is_none());
    }

    /// A part that is nothing but noise reads 0 within its interval: low is 0 in 97.5 % of cases. 400 trials, 10
    /// expected above, 6 sd is 29.
    #[test]
    fn noise_is_no_part() {
        let mut random = Random(4);
        let b = of([1.0, 2.0, 0.0, 3.0]);
        let above = (0..400).filter(|_| {
            let system = sampled(&mut random, [1.0, 2.0, 0.0, 3.0], 0.1);
            let continuous = sampled(&mut random, [1.0, 2.0, 0.0, 3.0], 0.1);
            let steps =
                Steps { solution: &b, solved: None, patch_system: Some(&system), continuous: Some(&continuous) };
            run(&steps).discretisation.unwrap().rms.low > 0.0
        });
        let above = above.count();
        assert!(above < 29, "{above}");
    }
}
