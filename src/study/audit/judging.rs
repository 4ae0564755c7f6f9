//! Solutions of audited matrices before the judge.

use super::record::Wrong;
use crate::io::StoredReference;
use crate::metrics::{Limits, Verdict};
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::{Against, JudgeError, Question, Receivers, judge};

/// The judge of an audit: reflected light, the top 1 % of the patches that receive most of it.
pub(super) struct Bench {
    truth: Against,
    lamps: Against,
    receivers: Receivers,
    question: Question,
    bands: usize,
}

impl Bench {
    pub(super) fn new(stage: &Stage, reference: StoredReference, limit: Option<f64>, confidence: f64) -> Self {
        let bands = stage.band_count();
        // Before any light is reflected there are the lamps alone: the patches that "change most" are lit most.
        let lamps = Radiosity { bands, values: stage.emissions(), std_err: None };
        let limits = limit.map(Limits::rms);
        Self {
            truth: Against::Reference(Box::new(reference)),
            lamps: Against::Solution(lamps),
            receivers: Receivers::patches(stage),
            question: Question { limits, confidence, reflected: true, ..Question::default() },
            bands,
        }
    }

    /// How wrong a solution is, and the verdict where there is a limit.
    pub(super) fn judge(&self, values: &[f64]) -> Result<(Wrong, Option<Verdict>), JudgeError> {
        let solution = Radiosity { bands: self.bands, values: values.to_vec(), std_err: None };
        let judged = judge(&solution, &self.truth, Some(&self.lamps), &self.receivers, &self.question)?;
        let wrong = Wrong { rms: judged.comparison.rms_reflected, top1: judged.comparison.top1 };
        Ok((wrong, judged.decision.map(|d| d.verdict)))
    }
}
