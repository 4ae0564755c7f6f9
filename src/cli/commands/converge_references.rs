//! The references that curves are held against: computed, or found where an earlier run has left them.

use super::reference::{MARKER, arm, open_work};
use crate::cli::args::Truth;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::doctor;
use crate::io::{Claim, StoredReference};
use crate::raycast::KernelKind;
use crate::reference::Options;
use crate::report::Phase;
use crate::scene::{Scene, Stage};
use crate::solution::TruthLevel;
use crate::study::{self, Session};
use std::path::Path;
use std::time::Instant;

/// How references are made.
pub struct Judge<'a> {
    pub options: Options,
    pub truth: Truth,
    pub kernel: KernelKind,
    pub console: &'a Console,
}

impl Judge<'_> {
    /// The reference of a stage in `folder`: the one that is there if it will do, else a new one. Says how long that
    /// took.
    ///
    /// # Errors
    /// What kernels and reference refuse; a reference that fails its self-check ends the command with its own code.
    pub fn obtain(&self, scene: &Scene, stage: &Stage, folder: &Path) -> Result<(StoredReference, Phase), Failure> {
        let begin = Instant::now();
        let session = Session::open(stage, self.kernel)?;
        let name = folder.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned());
        let stored = match self.stored(&session, folder) {
            Some(stored) => stored,
            None => self.compute(scene, &session, folder)?,
        };
        if let Some(c) = stored.self_check.failures().next() {
            let message = format!(
                "{}: this reference failed its own self-check of {} ({}); ask for more --rays, or see `etalon scene check`",
                folder.display(),
                c.name,
                c.finding
            );
            return Err(Failure { code: exit::SELF_CHECK, ..Failure::input(message) }.at(folder.display().to_string()));
        }
        Ok((stored, Phase { name, seconds: begin.elapsed().as_secs_f64() }))
    }

    fn level(&self) -> TruthLevel {
        match self.truth {
            Truth::PatchSystem => TruthLevel::PatchSystem,
            Truth::Continuous => TruthLevel::Continuous,
        }
    }

    /// What stands in the folder, if it answers what is asked.
    fn stored(&self, session: &Session, folder: &Path) -> Option<StoredReference> {
        if !folder.join(MARKER).is_file() {
            return None;
        }
        let again = |why: &str| self.console.notice(&format!("{}: {why}; it is computed again", folder.display()));
        let stored = match StoredReference::read(folder) {
            Ok(stored) => stored,
            Err(e) => {
                again(&format!("the reference there cannot be used ({})", e.problem));
                return None;
            }
        };
        match study::falls_short(&stored, session.stage(), &self.options, session.kernel(), self.level()) {
            None => Some(stored),
            Some(lack) => {
                again(&format!("the reference there has {lack}"));
                None
            }
        }
    }

    fn compute(&self, scene: &Scene, session: &Session, folder: &Path) -> Result<StoredReference, Failure> {
        let (begin, stage) = (Instant::now(), session.stage());
        let claim = Claim::take(folder, MARKER)?;
        let mut armed = None;
        let mut stored = match self.truth {
            Truth::Continuous => study::continuous_reference(session, &self.options, self.console)?.0,
            Truth::PatchSystem => {
                let work = open_work(&claim, session, &self.options, self.console)?;
                armed = Some(arm(&work));
                let stored = study::reference_on(session, &self.options, self.console, work.kept())?.0;
                work.flush();
                stored
            }
        };
        self.console.end();
        stored.findings = doctor::examine(scene, stage)?;
        claim.publish(&stored.files(begin.elapsed().as_secs_f64()))?;
        drop(armed);
        Ok(stored)
    }
}
