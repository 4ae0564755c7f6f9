//! The judge, as an object.

use super::scene::Silent;
use super::{Check, Error, ReferenceOptions};
use crate::io::{StoredReference, read_solution, write_folder};
use crate::metrics::{Comparison, Limits};
use crate::raycast::open_kernels;
use crate::scene::Stage;
use crate::solution::{Provenance, Radiosity, SelfCheck, TruthLevel};
use crate::study::{self, Against, Question, Receivers, Session, falls_short, judge};
use std::path::Path;
use std::time::Instant;

/// The file that marks a folder as a reference.
const MARKER: &str = "reference.json";
/// Two-sided confidence of intervals and verdicts.
const CONFIDENCE: f64 = 0.95;

/// A reference radiosity with its errors, its scene and its self-check: all that judging needs.
#[derive(Debug, Clone)]
pub struct Reference {
    stored: StoredReference,
    seconds: f64,
}

impl Reference {
    /// Casts the judge's rays in a stage and solves its patch system.
    ///
    /// # Errors
    /// [`Error::Kernel`] or [`Error::Reference`]. A reference that fails its self-check is returned: it can be
    /// looked at, but does not judge.
    pub fn compute(stage: &Stage, options: &ReferenceOptions) -> Result<Self, Error> {
        let begin = Instant::now();
        let session = Session::open(stage, options.kernel)?;
        let (stored, _) = study::reference(&session, &options.options, &Silent)?;
        Ok(Self { stored, seconds: begin.elapsed().as_secs_f64() })
    }

    /// Follows the judge's paths in a stage: the true mean radiosity of each patch, no patch taken for evenly bright.
    /// The rays of `options` are paths per patch.
    ///
    /// # Errors
    /// As [`Reference::compute`].
    pub fn compute_continuous(stage: &Stage, options: &ReferenceOptions) -> Result<Self, Error> {
        let begin = Instant::now();
        let session = Session::open(stage, options.kernel)?;
        let (stored, _) = study::continuous_reference(&session, &options.options, &Silent)?;
        Ok(Self { stored, seconds: begin.elapsed().as_secs_f64() })
    }

    /// Opens a reference directory and verifies every byte of it.
    ///
    /// # Errors
    /// [`Error::File`] with file and mend.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(Self { stored: StoredReference::read(folder.as_ref())?, seconds: 0.0 })
    }

    /// Opens the reference in a directory if it answers what is asked (scene, seed, kernel, rays or target error, a
    /// self-check passed); else computes it and stores it there.
    ///
    /// # Errors
    /// As [`Reference::compute`] and [`Reference::save`].
    pub fn open_or_compute(folder: impl AsRef<Path>, stage: &Stage, options: &ReferenceOptions) -> Result<Self, Error> {
        if let Ok(known) = Self::open(folder.as_ref()) {
            let kernels = open_kernels(options.kernel, stage)?;
            let kernel = kernels.kernel.info();
            if falls_short(&known.stored, stage, &options.options, kernel, TruthLevel::PatchSystem).is_none() {
                return Ok(known);
            }
        }
        let fresh = Self::compute(stage, options)?;
        fresh.save(folder)?;
        Ok(fresh)
    }

    /// Stores the reference as a directory, whole or not at all.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written, or holds something else than a reference.
    pub fn save(&self, folder: impl AsRef<Path>) -> Result<(), Error> {
        Ok(write_folder(folder.as_ref(), &self.stored.files(self.seconds), MARKER)?)
    }

    /// The scene at its state: patches, areas, names, materials.
    pub fn stage(&self) -> &Stage {
        &self.stored.stage
    }

    /// Mean radiosities per patch with standard errors, W/m^2 per band.
    pub fn radiosity(&self) -> Radiosity {
        self.stored.patches.mean()
    }

    /// How it was computed.
    pub fn provenance(&self) -> &Provenance {
        &self.stored.provenance
    }

    /// What the judge found about itself.
    pub fn self_check(&self) -> &SelfCheck {
        &self.stored.self_check
    }

    /// Reads a solution file (CSV, JSON, NPY, NPZ) for the reference's scene.
    ///
    /// # Errors
    /// [`Error::File`] with file, row and mend.
    pub fn read_solution(&self, path: impl AsRef<Path>) -> Result<Radiosity, Error> {
        let present = Receivers::patches(self.stage()).present();
        Ok(read_solution(path.as_ref())?.fit(&self.stage().photometry.bands, &present)?)
    }

    /// All metrics of a solution, with 95 % intervals.
    ///
    /// # Errors
    /// [`Error::Judge`] if the solution does not fit the scene, [`Error::Untrusted`].
    pub fn compare(&self, solution: &Radiosity) -> Result<Comparison, Error> {
        Ok(self.judge(solution, None, None)?.comparison)
    }

    /// Holds a solution against limits: pass, fail or inconclusive, with 95 % confidence over all limits.
    ///
    /// # Errors
    /// As [`Reference::compare`]; [`Error::NoLimit`].
    pub fn check(&self, solution: &Radiosity, limits: &Limits) -> Result<Check, Error> {
        self.checked(solution, None, limits)
    }

    /// The same for a change of the scene: `before` is the reference of the scene before it, which a limit on the
    /// top 1 % needs.
    ///
    /// # Errors
    /// As [`Reference::check`].
    pub fn check_change(&self, solution: &Radiosity, before: &Self, limits: &Limits) -> Result<Check, Error> {
        self.checked(solution, Some(before), limits)
    }

    fn checked(&self, solution: &Radiosity, before: Option<&Self>, limits: &Limits) -> Result<Check, Error> {
        if limits.is_empty() || !limits.are_sound() {
            return Err(Error::NoLimit);
        }
        let judgement = self.judge(solution, before, Some(limits.clone()))?;
        Ok(Check::new(judgement.comparison, judgement.decision.ok_or(Error::NoLimit)?))
    }

    fn judge(
        &self,
        solution: &Radiosity,
        before: Option<&Self>,
        limits: Option<Limits>,
    ) -> Result<study::Judgement, Error> {
        for r in std::iter::once(self).chain(before) {
            if let Some(c) = r.self_check().failures().next() {
                return Err(Error::Untrusted { check: c.name.clone(), finding: c.finding.clone() });
            }
        }
        let against = |r: &Self| Against::Reference(Box::new(r.stored.clone()));
        let before = before.map(against);
        let question = Question { limits, confidence: CONFIDENCE, ..Question::default() };
        Ok(judge(solution, &against(self), before.as_ref(), &Receivers::patches(self.stage()), &question)?)
    }
}
