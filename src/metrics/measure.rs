//! The value each limit is held against.

use super::baseline::growth;
use super::bias::relative_bias;
use super::error::MetricsError;
use super::limits::{Limit, Limits, Metric, Place};
use super::power::smallest_caught;
use super::quantity::Quantity;
use super::rms::relative_rms;
use super::top1::top1_rms;
use super::types::{Comparison, Judged, Truth};
use super::visible::{AsSeen, Viewing, as_seen, visible_share};
use super::worst::worst_patch;
use crate::solution::Radiosity;
use crate::stats::Estimate;

/// A limit with what it is held against.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The limit.
    pub limit: Limit,
    /// The metric there; `None` where it cannot be had: no state before, or a dark one.
    pub estimate: Option<Estimate>,
    /// The smallest value of the metric that this run would have failed for sure in 19 of 20 cases; `None` where that
    /// is not known.
    pub smallest_caught: Option<f64>,
    /// Times the rays that would decide an open limit, where that does not follow from the interval alone.
    pub rays_factor: Option<f64>,
}

/// What a solution is measured with, beside the judged receivers.
#[derive(Debug, Clone, Copy)]
pub struct Beside<'a> {
    /// State before the change, for the top 1 %.
    pub before: Option<&'a Truth>,
    /// Solution of the baseline, for "no worse than".
    pub baseline: Option<&'a Radiosity>,
    /// Object of each receiver.
    pub objects: &'a [&'a str],
    /// Who looks, for what can be seen.
    pub viewing: Option<&'a Viewing>,
}

/// Measures a solution for each limit, all intervals two-sided at `confidence`.
///
/// # Errors
/// As [`compare`](super::compare); a limit on a place that the scene does not have.
pub fn measure(
    solution: &Radiosity,
    reference: &Truth,
    judged: &Judged,
    beside: Beside,
    limits: &Limits,
    confidence: f64,
    reflected: bool,
) -> Result<Vec<Measured>, MetricsError> {
    super::check::inputs(solution, reference, beside.before, judged, confidence)?;
    let (got, expected) = (beside.objects.len(), judged.areas.len());
    if got != expected {
        return Err(MetricsError::Shape { what: "the list of objects", unit: "patches", got, expected });
    }
    let gauge = Gauge { solution, reference, judged, beside, confidence, reflected };
    limits.list().iter().map(|l| gauge.measured(l)).collect()
}

impl Comparison {
    /// What a comparison alone knows of limits: eq. 7 and the top 1 % of the whole scene. Nothing is said of what would
    /// have been caught; [`measure`] does.
    pub fn measured(&self, limits: &Limits) -> Vec<Measured> {
        let estimate = |l: &Limit| match (l.metric, &l.place) {
            (Metric::Rms, Place::Everywhere) => Some(self.rms),
            (Metric::Top1, Place::Everywhere) => self.top1,
            _ => None,
        };
        let of =
            |l: &Limit| Measured { limit: l.clone(), estimate: estimate(l), smallest_caught: None, rays_factor: None };
        limits.list().iter().map(of).collect()
    }
}

/// What can be seen of the error of a solution; `None` where nothing of it is in the picture.
///
/// # Errors
/// As [`compare`](super::compare).
pub fn look(
    solution: &Radiosity,
    reference: &Truth,
    judged: &Judged,
    viewing: &Viewing,
    confidence: f64,
) -> Result<Option<AsSeen>, MetricsError> {
    super::check::inputs(solution, reference, None, judged, confidence)?;
    let (got, expected) = (viewing.shares.len(), judged.areas.len());
    if got != expected {
        return Err(MetricsError::Shape { what: "the picture", unit: "patches", got, expected });
    }
    let quantity = Quantity::luminance(judged, false);
    let (ours, rows) = (quantity.of(&solution.values), quantity.of_truth(reference));
    Ok(as_seen(viewing, judged.areas, &ours, &rows, confidence))
}

struct Gauge<'a> {
    solution: &'a Radiosity,
    reference: &'a Truth,
    judged: &'a Judged<'a>,
    beside: Beside<'a>,
    confidence: f64,
    reflected: bool,
}

impl Gauge<'_> {
    fn measured(&self, limit: &Limit) -> Result<Measured, MetricsError> {
        if limit.metric == Metric::Visible {
            return Ok(self.visible(limit));
        }
        let (areas, quantity) = (self.areas(&limit.place)?, self.quantity(&limit.place)?);
        let (ours, rows) = (quantity.of(&self.solution.values), quantity.of_truth(self.reference));
        let metric = |y: &[f64]| match limit.metric {
            Metric::Rms => relative_rms(&areas, y, &rows, self.confidence).estimate(),
            Metric::Worst => worst_patch(&areas, y, &rows, self.confidence),
            Metric::Energy => relative_bias(&areas, y, &rows, self.confidence).map(size),
            Metric::Top1 => self.top1(&areas, y, &rows),
            Metric::Visible => None,
            Metric::Worse => {
                let before = quantity.of(&self.beside.baseline?.values);
                growth(&areas, y, &before, &rows, self.confidence)
            }
        };
        let estimate = metric(&ours);
        let caught = estimate.and_then(|_| smallest_caught(limit, &areas, &ours, &rows, &metric));
        Ok(Measured { limit: limit.clone(), estimate, smallest_caught: caught, rays_factor: None })
    }

    /// What is seen is all light, emission too, by an eye that was settled beforehand. What would have been caught is not
    /// known: a share grows in jumps.
    fn visible(&self, limit: &Limit) -> Measured {
        let quantity = Quantity::luminance(self.judged, false);
        let (ours, rows) = (quantity.of(&self.solution.values), quantity.of_truth(self.reference));
        let seen = self.beside.viewing.and_then(|v| visible_share(v, self.judged.areas, &ours, &rows, self.confidence));
        let rays_factor = seen.as_ref().and_then(|s| s.rays_factor(limit.max));
        let estimate = seen.map(|s| s.estimate);
        Measured { limit: limit.clone(), estimate, smallest_caught: None, rays_factor }
    }

    fn top1(&self, areas: &[f64], ours: &[f64], rows: &[Vec<f64>]) -> Option<Estimate> {
        let whole = Quantity::luminance(self.judged, false);
        let (after, before) = (whole.of_truth(self.reference), whole.of_truth(self.beside.before?));
        top1_rms(areas, ours, rows, &after, &before, self.confidence).estimate()
    }

    /// Areas of a place; 0 elsewhere.
    fn areas(&self, place: &Place) -> Result<Vec<f64>, MetricsError> {
        let names = match place {
            Place::Everywhere | Place::Band(_) => return Ok(self.judged.areas.to_vec()),
            Place::Surface(_) => self.judged.surfaces,
            Place::Object(_) => self.beside.objects,
        };
        let (kind, name) = place.parts().unwrap_or_default();
        let areas: Vec<f64> =
            self.judged.areas.iter().zip(names).map(|(a, n)| if *n == name { *a } else { 0.0 }).collect();
        if areas.iter().any(|a| *a > 0.0) {
            return Ok(areas);
        }
        let mut known: Vec<&str> =
            names.iter().zip(self.judged.areas).filter(|(_, a)| **a > 0.0).map(|(n, _)| *n).collect();
        known.sort_unstable();
        known.dedup();
        Err(MetricsError::NoSuchPlace { kind, name: name.into(), known: listed(&known) })
    }

    fn quantity(&self, place: &Place) -> Result<Quantity<'_>, MetricsError> {
        let Place::Band(name) = place else { return Ok(Quantity::luminance(self.judged, self.reflected)) };
        match self.judged.bands.iter().position(|b| b == name) {
            Some(c) => Ok(Quantity::band(self.judged, c, self.reflected)),
            None => {
                let known: Vec<&str> = self.judged.bands.iter().map(String::as_str).collect();
                Err(MetricsError::NoSuchPlace { kind: "band", name: name.clone(), known: listed(&known) })
            }
        }
    }
}

/// The size of a signed error.
fn size(e: Estimate) -> Estimate {
    let (low, high) = match (e.low, e.high) {
        (low, high) if low > 0.0 => (low, high),
        (low, high) if high < 0.0 => (-high, -low),
        (low, high) => (0.0, high.max(-low)),
    };
    Estimate { value: e.value.abs(), std_err: e.std_err, low, high }
}

/// Names for a message, not more than a line of them.
fn listed(names: &[&str]) -> String {
    const MOST: usize = 12;
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    format!("{}{more}", names[..names.len().min(MOST)].join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged<'a>(bands: &'a [String]) -> Judged<'a> {
        Judged {
            areas: &[1.0, 2.0, 1.0, 0.0],
            emission: &[0.0; 8],
            surfaces: &["floor", "floor", "wall", "gone"],
            bands,
            weights: &[0.5, 0.5],
        }
    }

    fn two(values: [[f64; 2]; 4]) -> Radiosity {
        Radiosity { bands: 2, values: values.concat(), std_err: None }
    }

    #[test]
    fn places_metrics_and_bands_by_hand() {
        let bands = ["r".to_string(), "g".to_string()];
        let truth = two([[1.0, 3.0], [2.0, 2.0], [4.0, 4.0], [9.0, 9.0]]);
        let ours = two([[2.0, 3.0], [2.0, 2.0], [5.0, 4.0], [0.0, 0.0]]);
        let worse = two([[3.0, 3.0], [2.0, 2.0], [5.0, 4.0], [0.0, 0.0]]);
        let beside =
            Beside { before: None, baseline: Some(&worse), objects: &["room", "room", "box", "box"], viewing: None };
        let value = |text: &str| {
            let limits: Limits = [text.parse::<Limit>().unwrap()].into_iter().collect();
            let m = measure(&ours, &Truth::Given(truth.clone()), &judged(&bands), beside, &limits, 0.95, false);
            m.unwrap()[0].estimate.map(|e| e.value)
        };
        // Differences of luminance: 0.5, 0, 0.5; luminances 2, 2, 4; areas 1, 2, 1.
        assert_eq!(value("rms=1"), Some((0.5f64 / 28.0).sqrt()));
        assert_eq!(value("rms@surface:floor=1"), Some((0.25f64 / 12.0).sqrt()));
        assert_eq!(value("rms@object:box=1"), Some(0.125));
        assert_eq!(value("worst=1"), Some(0.25));
        assert_eq!(value("worst@surface:wall=1"), Some(0.125));
        assert_eq!(value("worst@band:r=1"), Some(1.0));
        assert_eq!(value("energy=1"), Some(0.1));
        assert_eq!(value("energy@band:g=1"), Some(0.0));
        // The baseline is off by 1, 0, 0.5.
        let limits: Limits = [Limit::new(Metric::Worse, 0.0)].into_iter().collect();
        let m = measure(&ours, &Truth::Given(truth.clone()), &judged(&bands), beside, &limits, 0.95, false).unwrap();
        let known = (0.5f64 / 28.0).sqrt() - (1.25f64 / 28.0).sqrt();
        assert!((m[0].estimate.unwrap().value - known).abs() < 1e-15);
    }

    #[test]
    fn a_place_that_is_not_there_is_named_with_those_that_are() {
        let bands = ["r".to_string(), "g".to_string()];
        let b = two([[1.0; 2]; 4]);
        let beside = Beside { before: None, baseline: None, objects: &["room"; 4], viewing: None };
        let refused = |text: &str| {
            let limits: Limits = [text.parse::<Limit>().unwrap()].into_iter().collect();
            let m = measure(&b, &Truth::Given(b.clone()), &judged(&bands), beside, &limits, 0.95, false);
            m.unwrap_err().to_string()
        };
        assert!(refused("rms@surface:gone=1").contains("floor, wall"));
        assert!(refused("rms@object:box=1").contains("there are: room"));
        assert!(refused("rms@band:b=1").contains("r, g"));
    }

    #[test]
    fn the_size_of_a_signed_error() {
        let of = |low: f64, high: f64| {
            let e = size(Estimate { value: 0.5 * (low + high), std_err: None, low, high });
            (e.low, e.high)
        };
        assert_eq!((of(0.1, 0.3), of(-0.3, -0.1), of(-0.2, 0.1)), ((0.1, 0.3), (0.1, 0.3), (0.0, 0.2)));
    }
}
