//! Inputs of a comparison, looked at before anything is computed.

use super::compare::MIN_REPLICATES;
use super::error::MetricsError;
use super::types::{Judged, Truth};
use crate::solution::{Radiosity, Replicates};

pub(super) fn inputs(
    solution: &Radiosity,
    reference: &Truth,
    before: Option<&Truth>,
    judged: &Judged,
    confidence: f64,
) -> Result<(), MetricsError> {
    alone(solution, judged, confidence)?;
    truth("the reference", reference, judged)?;
    before.map_or(Ok(()), |b| truth("the state before the change", b, judged))
}

/// A solution and its scene, whatever it is held against.
pub(super) fn alone(solution: &Radiosity, judged: &Judged, confidence: f64) -> Result<(), MetricsError> {
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(MetricsError::Confidence { confidence });
    }
    if judged.bands.is_empty() {
        return Err(MetricsError::Shape { what: "the judged scene", unit: "bands", got: 0, expected: 1 });
    }
    same("the list of luminance weights", "bands", judged.weights.len(), judged.bands.len())?;
    same("the list of surfaces", "patches", judged.surfaces.len(), judged.areas.len())?;
    values("the emission", judged.bands.len(), judged.emission, judged)?;
    one("the solution", solution, judged)?;
    if judged.areas.iter().any(|a| *a > 0.0) { Ok(()) } else { Err(MetricsError::NothingPresent) }
}

fn truth(what: &'static str, truth: &Truth, judged: &Judged) -> Result<(), MetricsError> {
    match truth {
        Truth::Given(radiosity) => one(what, radiosity, judged),
        Truth::Sampled(r) => sampled(what, r, judged),
    }
}

/// Replicates that a spread can be had of.
pub(super) fn sampled(what: &'static str, r: &Replicates, judged: &Judged) -> Result<(), MetricsError> {
    if r.count() < MIN_REPLICATES {
        return Err(MetricsError::TooFewReplicates { what, got: r.count(), needed: MIN_REPLICATES });
    }
    r.replicates.iter().try_for_each(|b| values(what, r.bands, b, judged))
}

fn one(what: &'static str, radiosity: &Radiosity, judged: &Judged) -> Result<(), MetricsError> {
    values(what, radiosity.bands, &radiosity.values, judged)?;
    radiosity.std_err.as_ref().map_or(Ok(()), |e| values(what, radiosity.bands, e, judged))
}

fn values(what: &'static str, bands: usize, values: &[f64], judged: &Judged) -> Result<(), MetricsError> {
    same(what, "bands", bands, judged.bands.len())?;
    same(what, "values", values.len(), judged.areas.len() * bands)?;
    match values.iter().position(|v| !v.is_finite()) {
        Some(k) => Err(MetricsError::NotFinite { what, patch: k / bands }),
        None => Ok(()),
    }
}

fn same(what: &'static str, unit: &'static str, got: usize, expected: usize) -> Result<(), MetricsError> {
    if got == expected { Ok(()) } else { Err(MetricsError::Shape { what, unit, got, expected }) }
}
