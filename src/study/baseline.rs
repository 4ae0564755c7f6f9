//! A baseline: a solution that later ones are held against, with what was measured of it.

use super::judge::{Against, JudgeError, Question, Receivers};
use crate::io::{FileError, StoredReference, atomic};
use crate::metrics::{Change, Comparison, changes};
use crate::solution::Radiosity;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Format of the file.
const FORMAT: &str = "etalon-baseline/1";

/// A stored baseline. One file, made to be kept under version control.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    format: String,
    /// Name of the scene.
    pub scene: String,
    /// Hash of the scene at its state.
    pub scene_hash: String,
    /// Which truth it was judged by.
    pub truth: String,
    /// `patch` or `element`.
    pub per: String,
    /// Metrics on B - E.
    pub reflected: bool,
    /// What the solution was called.
    pub solution: String,
    /// Version of this program.
    pub version: String,
    /// The reference it was judged by: rays per patch, randomisations, seed, one-sigma relative error.
    pub reference: JudgedBy,
    /// Every metric at that time.
    pub metrics: Comparison,
    /// Band names.
    pub bands: Vec<String>,
    /// Radiosities, W/m^2: one list of bands for each receiver.
    pub radiosity: Vec<Vec<f64>>,
    /// SHA-256 of this file with this string empty.
    checksum: String,
}

/// The reference of a baseline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JudgedBy {
    /// Rays per patch.
    pub rays_per_patch: u64,
    /// Randomisations.
    pub randomisations: u16,
    /// Seed.
    pub seed: u64,
    /// One-sigma relative error.
    pub relative_error: f64,
}

/// What a baseline is taken of.
#[derive(Debug, Clone, Copy)]
pub struct Taken<'a> {
    /// The reference that judged.
    pub reference: &'a StoredReference,
    /// The solution.
    pub solution: &'a Radiosity,
    /// What it is called.
    pub name: &'a str,
    /// Its metrics.
    pub comparison: &'a Comparison,
    /// Elements instead of patches.
    pub per_element: bool,
    /// Metrics on B - E.
    pub reflected: bool,
}

impl Baseline {
    /// A baseline of a judged solution.
    pub fn of(taken: &Taken) -> Self {
        let (r, b) = (taken.reference, taken.solution);
        let mut baseline = Self {
            format: FORMAT.into(),
            scene: r.stage.name.clone(),
            scene_hash: r.scene_hash.clone(),
            truth: r.provenance.truth.name().into(),
            per: level(taken.per_element).into(),
            reflected: taken.reflected,
            solution: taken.name.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            reference: JudgedBy {
                rays_per_patch: r.provenance.rays_per_patch,
                randomisations: r.provenance.randomisations,
                seed: r.provenance.seed,
                relative_error: r.provenance.relative_error,
            },
            metrics: taken.comparison.clone(),
            bands: r.stage.photometry.bands.clone(),
            radiosity: (0..b.len()).map(|i| b.of(i).to_vec()).collect(),
            checksum: String::new(),
        };
        baseline.checksum = sum(&baseline.text());
        baseline
    }

    /// The bytes of its file: one receiver a line, so that changes read well.
    pub fn bytes(&self) -> Vec<u8> {
        self.text().into_bytes()
    }

    fn text(&self) -> String {
        let value = serde_json::to_value(self).expect("finite data serialise");
        let fields = value.as_object().expect("a baseline has fields");
        let mut out = String::from("{");
        for (k, (name, field)) in fields.iter().enumerate() {
            let comma = if k == 0 { "" } else { "," };
            let field = match field.as_array().filter(|_| name == "radiosity") {
                Some(rows) => {
                    let rows: Vec<String> = rows.iter().map(|r| format!("  {r}")).collect();
                    format!("[\n{}\n]", rows.join(",\n"))
                }
                None => field.to_string(),
            };
            out += &format!("{comma}\n\"{name}\": {field}");
        }
        out + "\n}\n"
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// A file that is missing (it is never made in silence), damaged, or of another format.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let bytes = std::fs::read(path).map_err(|e| {
            FileError::system(path, "read", &e)
                .mend("a baseline is made by `etalon baseline save`, and never by a check")
        })?;
        let wrong = |problem: String| {
            FileError::new(path, problem).mend("make it again with `etalon baseline save`, or take it from its history")
        };
        let value: serde_json::Value = serde_json::from_slice(&bytes)
            .map_err(|e| wrong(format!("is not a baseline: {e}")).at(format!("line {}", e.line())))?;
        match value.get("format").and_then(|f| f.as_str()) {
            Some(FORMAT) => {}
            other => {
                let other = other.unwrap_or("(none)");
                return Err(wrong(format!("has format {other}; this version reads {FORMAT}")));
            }
        }
        let baseline: Self =
            serde_json::from_value(value).map_err(|e| wrong(format!("is not a whole baseline: {e}")))?;
        let unsigned = Self { checksum: String::new(), ..baseline.clone() };
        if baseline.checksum != sum(&unsigned.text()) {
            return Err(wrong("does not have the checksum it was written with: it was changed by hand or cut".into()));
        }
        Ok(baseline)
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), atomic::WriteError> {
        atomic::write(path, &self.bytes())
    }

    /// Its radiosities.
    pub fn radiosity(&self) -> Radiosity {
        Radiosity { bands: self.bands.len(), values: self.radiosity.concat(), std_err: None }
    }

    /// Why it cannot be held against something judged like this; `None` if it can.
    pub fn misfit(&self, reference: &StoredReference, per_element: bool, reflected: bool) -> Option<String> {
        let truth = reference.provenance.truth.name();
        if self.scene_hash != reference.scene_hash {
            return Some(format!(
                "it is of scene \"{}\" with other geometry, materials, discretisation or state than the reference",
                self.scene
            ));
        }
        if self.truth != truth {
            return Some(format!("it was judged by the {} truth, the reference holds the {truth} one", self.truth));
        }
        if self.per != level(per_element) {
            return Some(format!("it is of --per {}", self.per));
        }
        if self.reflected != reflected {
            return Some(format!("it is of {} light", if self.reflected { "reflected" } else { "all" }));
        }
        None
    }

    /// What a solution changed, judged by one reference.
    ///
    /// # Errors
    /// As [`judge`](super::judge()).
    pub fn changes(
        &self,
        solution: &Radiosity,
        reference: &Against,
        receivers: &Receivers,
        question: &Question,
    ) -> Result<Vec<Change>, JudgeError> {
        let truth = reference.truth(question.per_element)?;
        let surfaces: Vec<&str> = receivers.surfaces.iter().map(String::as_str).collect();
        let judged = receivers.judged(&surfaces);
        Ok(changes(solution, &self.radiosity(), &truth, &judged, question.confidence, question.reflected)?)
    }
}

fn level(per_element: bool) -> &'static str {
    if per_element { "element" } else { "patch" }
}

fn sum(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect()
}
