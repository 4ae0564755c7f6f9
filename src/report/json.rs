//! The JSON object of `compare` and `check`.

use super::{Artifact, Exporter, Extras, Phase, ReportError};
use crate::study::Record;
use serde::Deserialize;
use serde_json::{Map, Value, json};

/// Name of the finished record in a report folder.
pub const RECORD_NAME: &str = "record.json";
/// Name of the clock's own file.
pub const TIMING_NAME: &str = "timing.json";
/// Format of the record; fields added later stay in this version.
const RECORD: &str = "etalon-record/1";
/// Format of the clock's file.
const TIMING: &str = "etalon-timing/1";

/// The finished record with everything a page is made of, one field a line.
pub(super) fn record_file(record: &Record) -> Result<Artifact, ReportError> {
    let Value::Object(fields) = serde_json::to_value(record)? else { unreachable!("a record has fields") };
    let mut text = format!("{{\n\"format\": {}", json!(RECORD));
    for (name, value) in &fields {
        text += &format!(",\n{}: {value}", json!(name));
    }
    text += "\n}\n";
    Ok(Artifact::new(RECORD_NAME, text))
}

/// Reads a record as a report folder keeps it.
///
/// # Errors
/// [`ReportError::Format`] for another format, [`ReportError::NotARecord`] for what does not read.
pub fn read_record(bytes: &[u8]) -> Result<Record, ReportError> {
    check_format(bytes, RECORD)?;
    serde_json::from_slice(bytes).map_err(ReportError::NotARecord)
}

pub(super) fn timing_file(phases: &[Phase]) -> Result<Artifact, ReportError> {
    let phases: Vec<_> = phases.iter().map(|p| json!({ "phase": p.name, "seconds": p.seconds })).collect();
    let mut text = serde_json::to_string_pretty(&json!({ "format": TIMING, "phases": phases }))?;
    text.push('\n');
    Ok(Artifact::new(TIMING_NAME, text))
}

/// Reads the times of a report folder.
///
/// # Errors
/// As [`read_record`].
pub fn read_timing(bytes: &[u8]) -> Result<Vec<Phase>, ReportError> {
    #[derive(Deserialize)]
    struct Row {
        phase: String,
        seconds: f64,
    }
    #[derive(Deserialize)]
    struct Timing {
        phases: Vec<Row>,
    }
    check_format(bytes, TIMING)?;
    let timing: Timing = serde_json::from_slice(bytes).map_err(ReportError::NotARecord)?;
    Ok(timing.phases.into_iter().map(|r| Phase { name: r.phase, seconds: r.seconds }).collect())
}

fn check_format(bytes: &[u8], wanted: &'static str) -> Result<(), ReportError> {
    #[derive(Deserialize)]
    struct Head {
        format: Option<String>,
    }
    let head: Head = serde_json::from_slice(bytes).map_err(ReportError::NotARecord)?;
    let found = head.format.unwrap_or_else(|| "(none)".into());
    if found == wanted { Ok(()) } else { Err(ReportError::Format { found, wanted }) }
}

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
    if !record.looks.is_empty() {
        object.insert("looks".into(), json!(record.looks));
    }
    object.insert("scene".into(), json!(record.stage.name));
    object.insert("solution".into(), json!(record.solution_name));
    object.insert("truth".into(), json!(record.truth));
    if let Value::Object(metrics) = serde_json::to_value(&record.comparison)? {
        object.extend(metrics);
    }
    object.insert("as_seen".into(), json!(record.as_seen));
    object.insert("causes".into(), json!(record.causes));
    object.insert("split".into(), json!(record.split));
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
    fn a_record_comes_back_to_the_byte() {
        let file = record_file(&with_verdict(Verdict::Fail)).expect("json");
        let again = record_file(&read_record(&file.bytes).expect("reads")).expect("json");
        assert!(file == again);
        let other = String::from_utf8(file.bytes).expect("text").replace("etalon-record/1", "etalon-record/2");
        let refused = read_record(other.as_bytes()).expect_err("another format").to_string();
        assert_eq!(refused, "has format etalon-record/2; this version reads etalon-record/1");
        assert!(read_record(b"{\"format\": \"etalon-record/1\"}").is_err() && read_record(b"[").is_err());
        let phases = [Phase { name: "rays".into(), seconds: 0.1 + 0.2 }];
        assert_eq!(read_timing(&timing_file(&phases).expect("json").bytes).expect("reads"), phases);
    }

    #[test]
    fn the_numbers_come_back_as_they_were() {
        let r = record();
        let files = Json.export(&r, &Extras::default()).expect("json");
        let back: Comparison = serde_json::from_slice(&files[0].bytes).expect("reads");
        assert_eq!(back, r.comparison);
    }
}
