//! One number per patch, ready to be painted.

use crate::math::compensated_sum;
use crate::solution::Radiosity;
use crate::view::Photometry;

/// One number per patch; `None` where there is none to show.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Values by patch number.
    pub values: Vec<Option<f64>>,
}

impl Field {
    fn each(n: usize, value: impl Fn(usize) -> Option<f64>) -> Self {
        Self { values: (0..n).map(|i| value(i).filter(|v| v.is_finite())).collect() }
    }

    /// True if there is nothing to show.
    pub fn is_blank(&self) -> bool {
        self.values.iter().all(Option::is_none)
    }
}

/// Luminance of every patch, W/m^2 weighted by band.
pub fn luminance(photometry: &Photometry, radiosity: &Radiosity) -> Vec<f64> {
    (0..radiosity.len()).map(|i| photometry.luminance(radiosity.of(i))).collect()
}

/// Standard error of every patch's luminance: the bands' own, weighted and added. An upper bound, since no
/// correlation makes it larger, and nearly exact, since the bands share their rays.
pub fn luminance_std_err(photometry: &Photometry, radiosity: &Radiosity) -> Field {
    let bound = |e: &[f64]| compensated_sum(photometry.weights.iter().zip(e).map(|(w, e)| w.abs() * e));
    Field::each(radiosity.len(), |i| radiosity.std_err_of(i).map(bound))
}

/// Solution - reference.
pub fn difference(reference: &[f64], solution: &[f64]) -> Field {
    Field::each(reference.len(), |i| Some(solution.get(i)? - reference[i]))
}

/// (Solution - reference) / reference; nothing where the reference is black.
pub fn relative_difference(reference: &[f64], solution: &[f64]) -> Field {
    Field::each(reference.len(), |i| Some((solution.get(i)? - reference[i]) / reference[i]))
}

/// Differences in standard errors, those of both sides together; 0 where there is neither difference nor error,
/// nothing where a difference stands against no error at all.
pub fn in_standard_errors(difference: &Field, reference: &Field, solution: &Field) -> Field {
    let of = |f: &Field, i: usize| f.values.get(i).copied().flatten();
    Field::each(difference.values.len(), |i| {
        let (d, e) = (of(difference, i)?, of(reference, i)?.hypot(of(solution, i).unwrap_or(0.0)));
        Some(if d == 0.0 { 0.0 } else { d / e })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(values: &[f64]) -> Field {
        Field { values: values.iter().map(|v| Some(*v)).collect() }
    }

    #[test]
    fn errors_of_both_sides_count() {
        let d = some(&[5.0, 0.0, 1.0, 0.0]);
        let z = in_standard_errors(&d, &some(&[3.0, 2.0, 0.0, 0.0]), &Field { values: vec![Some(4.0)] });
        assert_eq!(z.values, [Some(1.0), Some(0.0), None, Some(0.0)]);
        assert!(in_standard_errors(&d, &Field { values: vec![None; 4] }, &d).is_blank());
    }

    #[test]
    fn black_has_no_relative_difference() {
        assert_eq!(relative_difference(&[2.0, 0.0, 0.0], &[1.5, 1.0, 0.0]).values, [Some(-0.25), None, None]);
    }

    #[test]
    fn luminance_weighs_the_bands() {
        let p = Photometry { bands: vec!["a".into(), "b".into()], weights: vec![0.25, 0.75] };
        let r = Radiosity { bands: 2, values: vec![4.0, 8.0], std_err: Some(vec![0.4, 0.8]) };
        assert_eq!(luminance(&p, &r), [7.0]);
        assert!((luminance_std_err(&p, &r).values[0].unwrap_or(0.0) - 0.7).abs() < 1e-15);
        let silent = Radiosity { std_err: None, ..r };
        assert!(luminance_std_err(&p, &silent).is_blank());
    }
}
