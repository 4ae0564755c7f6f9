//! The JSON object of `compare` and `check`.

use super::{Artifact, Exporter, Extras, ReportError};
use crate::study::Record;
use serde_json::{Map, Value, json};

/// The contract's JSON object as a file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Json;

impl Exporter for Json {
    fn export(&self, record: &Record, _: &Extras) -> Result<Vec<Artifact>, ReportError> {
        let mut text = serde_json::to_string_pretty(&json_object(record)?)?;
        text.push('\n');
        Ok(vec![Artifact::new("comparison.json", text)])
    }
}

/// `verdict` and `limits` (only where limits were given), then `scene`, `solution`, `truth` and every metric.
///
/// # Errors
/// [`ReportError::Json`], which no finite number provokes.
pub fn json_object(record: &Record) -> Result<Value, ReportError> {
    let mut object = Map::new();
    if let Some(decision) = &record.decision {
        object.insert("verdict".into(), json!(decision.verdict));
        object.insert("limits".into(), serde_json::to_value(&decision.limits)?);
    }
    object.insert("scene".into(), json!(record.stage.name));
    object.insert("solution".into(), json!(record.solution_name));
    object.insert("truth".into(), json!(record.truth));
    if let Value::Object(metrics) = serde_json::to_value(&record.comparison)? {
        object.extend(metrics);
    }
    object.insert("notices".into(), json!(record.notices));
    Ok(Value::Object(object))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{Comparison, Verdict};
    use crate::report::testing::{record, with_verdict};

    #[test]
    fn the_contracts_keys_are_there() {
        let v = json_object(&with_verdict(Verdict::Inconclusive)).expect("json");
        assert_eq!(v["verdict"], "inconclusive");
        assert_eq!(v["limits"][0]["rays_factor"], 123.0);
        for key in ["truth", "confidence", "bias", "per_band", "reference_noise_floor", "patches", "worst"] {
            assert!(!v[key].is_null(), "{key}");
        }
        for key in ["value", "std_err", "low", "high"] {
            assert!(v["rms"][key].is_number() && v["rms_reflected"][key].is_number(), "{key}");
        }
        assert!(v["top1"].is_null() && v.get("top1").is_some());
        for key in ["patch", "surface", "reference", "solution", "difference", "std_err"] {
            assert!(v["worst"][0].get(key).is_some(), "{key}");
        }
        assert!(v["emitter_share"].is_number());
    }

    #[test]
    fn without_limits_there_is_no_verdict() {
        let mut r = record();
        r.decision = None;
        let v = json_object(&r).expect("json");
        assert!(v.get("verdict").is_none() && v.get("limits").is_none());
    }

    #[test]
    fn the_numbers_come_back_as_they_were() {
        let r = record();
        let files = Json.export(&r, &Extras::default()).expect("json");
        let back: Comparison = serde_json::from_slice(&files[0].bytes).expect("reads");
        assert_eq!(back, r.comparison);
    }
}
