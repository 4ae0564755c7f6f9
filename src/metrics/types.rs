//! What goes into a comparison and what comes out.

use super::scale::Scale;
use crate::solution::{Radiosity, Replicates};
use crate::stats::Estimate;
use serde::{Deserialize, Serialize};

/// The receivers that are judged, as data. All slices have one entry per receiver unless said otherwise.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// Areas that take part, m^2; 0 for a receiver that is absent and does not count.
    pub areas: &'a [f64],
    /// Self-emitted radiosities, receiver-major with one value per band.
    pub emission: &'a [f64],
    /// Names of the surfaces the receivers belong to.
    pub surfaces: &'a [&'a str],
    /// Band names.
    pub bands: &'a [String],
    /// Luminance weight of each band.
    pub weights: &'a [f64],
}

/// What a solution is compared with.
#[derive(Debug, Clone)]
pub enum Truth {
    /// A reference: independent replicates, whose spread is its error.
    Sampled(Replicates),
    /// Another solution, taken as it is.
    Given(Radiosity),
}

/// Every metric of one comparison. Serialises as the contract's JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Two-sided confidence of each interval here (after sharing it among the limits).
    pub confidence: f64,
    /// [GSG90 eq. 7]: relative area-weighted luminance RMS.
    pub rms: Estimate,
    /// The same over the 1 % of patches that change most; `None` without a state before, or where these are dark.
    pub top1: Option<Estimate>,
    /// Eq. 7 on B - E; `None` where nothing is reflected.
    pub rms_reflected: Option<Estimate>,
    /// Signed relative difference of area-weighted luminance: sum A (Y - Y_ref) / sum A Y_ref.
    pub bias: Estimate,
    /// Eq. 7 per band (by name, in band order); `None` for a band in which the reference is dark.
    #[serde(with = "band_map")]
    pub per_band: Vec<(String, Option<Estimate>)>,
    /// sqrt(sum A se^2 / sum A Y^2): what remains of eq. 7 for a perfect solution; `None` if the reference
    /// states no error.
    pub reference_noise_floor: Option<f64>,
    /// The same of the solution's own standard errors, errors of bands taken as fully correlated (an upper bound);
    /// `None` if it states none. Never part of a verdict.
    pub solution_noise: Option<f64>,
    /// Share of patches with emission in the denominator of eq. 7 of B, emission included, whatever is judged.
    pub emitter_share: f64,
    /// The factor by which reflected light is too bright everywhere; `None` where nothing is reflected.
    #[serde(default)]
    pub scale: Option<Scale>,
    /// The same with emission included.
    #[serde(default)]
    pub scale_of_total: Option<Scale>,
    /// Patches present in the judged state.
    pub patches: usize,
    /// Up to ten patches with the largest |difference|.
    pub worst: Vec<WorstPatch>,
}

/// One of the worst patches; luminances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstPatch {
    /// Patch number.
    pub patch: usize,
    /// Name of its surface.
    pub surface: String,
    /// Luminance of the reference.
    pub reference: f64,
    /// Luminance of the solution.
    pub solution: f64,
    /// Solution - reference.
    pub difference: f64,
    /// Standard error of the reference's luminance; `None` if it states none.
    pub std_err: Option<f64>,
}

/// Pass, fail, or not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Every limit is kept, with confidence.
    Pass,
    /// A limit is exceeded, with confidence.
    Fail,
    /// No sure failure, some limit open.
    Inconclusive,
}

/// What became of one limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitOutcome {
    /// Metric and place, as [`Limit::key`](super::Limit::key) writes them: `rms`, `top1`, `rms@surface:floor`.
    pub metric: String,
    /// The limit, a fraction.
    pub limit: f64,
    /// The metric with its interval.
    pub estimate: Estimate,
    /// Pass, fail or inconclusive.
    pub verdict: Verdict,
    /// For an open limit: about how many times the rays would decide; `None` where rays alone may never decide.
    pub rays_factor: Option<f64>,
    /// The smallest value that this run would have failed for sure in 19 of 20 cases; `None` where that is not known.
    #[serde(default)]
    pub smallest_caught: Option<f64>,
}

/// The verdict with what it rests on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Over all limits.
    pub verdict: Verdict,
    /// One by one.
    pub limits: Vec<LimitOutcome>,
}

/// (name, value) pairs as a JSON object in their own order.
mod band_map {
    use super::Estimate;
    use serde::de::{MapAccess, Visitor};
    use serde::{Deserializer, Serializer, ser::SerializeMap};

    type Bands = Vec<(String, Option<Estimate>)>;

    pub fn serialize<S: Serializer>(bands: &Bands, s: S) -> Result<S::Ok, S::Error> {
        let mut map = s.serialize_map(Some(bands.len()))?;
        for (name, value) in bands {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<Bands, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Bands;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("an object of estimates by band name")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Bands, A::Error> {
                let mut out = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    out.push(entry);
                }
                Ok(out)
            }
        }
        d.deserialize_map(InOrder)
    }
}
