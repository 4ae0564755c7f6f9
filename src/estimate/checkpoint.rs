//! Where finished rows are kept while the others are still cast, so that an interrupted run can go on.

use super::Entry;
use crate::raycast::Tally;

/// A block of samples that every row takes: the unit between two looks at the whole matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    /// Samples of each row and randomisation before it.
    pub start: u64,
    /// Samples of each row and randomisation in it.
    pub rays: u64,
    /// Patches that can be hit.
    pub patches: usize,
    /// Number of randomisations R.
    pub randomisations: u16,
}

/// What the rays of one block found for one row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FinishedRow {
    /// Row.
    pub row: usize,
    /// Hits, ascending by (patch, randomisation).
    pub entries: Vec<Entry>,
    /// What became of the rays.
    pub tally: Tally,
}

/// Keeps finished rows, and gives back those of an earlier run with the same rays.
///
/// A checkpoint may forget rows: they are cast again, and integers do not care who counted them.
pub trait Checkpoint: Sync {
    /// Hands the rows of a block that an earlier run finished to `take`, each once.
    fn restore(&self, block: Block, take: &mut dyn FnMut(FinishedRow));

    /// Keeps a finished row.
    fn keep(&self, block: Block, row: &FinishedRow);
}

/// Keeps nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoCheckpoint;

impl Checkpoint for NoCheckpoint {
    fn restore(&self, _: Block, _: &mut dyn FnMut(FinishedRow)) {}

    fn keep(&self, _: Block, _: &FinishedRow) {}
}
