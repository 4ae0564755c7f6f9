//! Work on a reference that survives the death of the program: finished rows in a journal.

use super::Session;
use crate::estimate::{Block, Checkpoint, FinishedRow, Plan, element_emitters, patch_emitters};
use crate::io::{Found, Journal};
use crate::raycast::KernelInfo;
use crate::reference::{Kept, Options};
use crate::scene::Stage;
use serde::Serialize;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All that hit counts depend on.
#[derive(Serialize)]
struct Key<'a> {
    program: &'a str,
    scene_hash: String,
    enclosure: Option<bool>,
    seed: u64,
    plan: Plan,
    kernel: &'a str,
    kernel_version: &'a str,
    instruction_set: Option<&'a str>,
}

fn key(stage: &Stage, kernel: &KernelInfo, options: &Options) -> io::Result<String> {
    let key = Key {
        program: env!("CARGO_PKG_VERSION"),
        scene_hash: stage.hash(),
        enclosure: stage.enclosure,
        seed: options.seed,
        plan: options.plan,
        kernel: &kernel.name,
        kernel_version: &kernel.version,
        instruction_set: kernel.instruction_set.as_deref(),
    };
    Ok(serde_json::to_string(&key)?)
}

/// The rows of both castings of a reference, kept as they are finished.
#[derive(Debug)]
pub struct KeptWork {
    journal: Arc<Journal>,
    patches: Rows,
    elements: Rows,
    path: PathBuf,
    found: Found,
    total: Option<u64>,
}

impl KeptWork {
    /// Opens the journal of this run; one of other settings is dropped, see [`KeptWork::found`].
    ///
    /// # Errors
    /// If a file stands at `path` that cannot be read and changed.
    pub fn open(path: &Path, session: &Session, options: &Options) -> io::Result<Self> {
        let stage = session.stage();
        let (journal, found) = Journal::open(path, &key(stage, session.kernel(), options)?)?;
        let mut rows = patch_emitters(stage).iter().flatten().count();
        if stage.has_elements() {
            rows += element_emitters(stage).iter().flatten().count();
        }
        let ends_early = options.plan.target_error.is_some() || options.plan.max_time.is_some();
        let total = (!ends_early).then(|| rows as u64 * options.plan.blocks());
        let journal = Arc::new(journal);
        let rows = |casting| Rows { journal: journal.clone(), casting };
        Ok(Self { patches: rows(0), elements: rows(1), journal, path: path.into(), found, total })
    }

    /// Removes the journal of this very run, whose reference is stored already.
    ///
    /// # Errors
    /// If a file stands at `path` that cannot be read or removed.
    pub fn forget(path: &Path, stage: &Stage, kernel: &KernelInfo, options: &Options) -> io::Result<()> {
        Journal::forget(path, &key(stage, kernel, options)?)
    }

    /// As the judge takes it.
    pub fn kept(&self) -> Kept<'_> {
        Kept { patches: &self.patches, elements: &self.elements }
    }

    /// What an earlier run has left.
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// Rows that the whole run takes, counted once per block of rays; `None` where the run decides that itself.
    pub fn total(&self) -> Option<u64> {
        self.total
    }

    /// Brings all finished rows to the disk; returns how many are there.
    pub fn flush(&self) -> u64 {
        self.journal.flush()
    }

    /// True while the journal is needed: not before its first row, nor after the reference is stored.
    pub fn is_there(&self) -> bool {
        self.path.exists()
    }

    /// Why finished rows are no longer kept, if so.
    pub fn trouble(&self) -> Option<String> {
        self.journal.trouble()
    }
}

/// The rows of one casting.
#[derive(Debug)]
struct Rows {
    journal: Arc<Journal>,
    /// 0 patches, 1 elements.
    casting: u64,
}

impl Rows {
    /// Section of the journal: no two blocks of a casting begin at the same sample.
    fn section(&self, block: Block) -> u64 {
        block.start << 1 | self.casting
    }
}

impl Checkpoint for Rows {
    fn restore(&self, block: Block, take: &mut dyn FnMut(FinishedRow)) {
        self.journal.restore(self.section(block), &mut |bytes| {
            FinishedRow::from_bytes(bytes, block).into_iter().for_each(&mut *take);
        });
    }

    fn keep(&self, block: Block, row: &FinishedRow) {
        self.journal.append(self.section(block), &row.to_bytes(block));
    }
}
