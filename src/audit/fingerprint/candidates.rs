//! Hemi-cubes that fit a clue, and which of them to believe.

use super::axes::Axes;
use super::clues::RowSums;
use super::lattice::Lattice;
use super::model::{Mistake, Model};
use super::pictures::Confirmed;
use serde::Serialize;

/// A hemi-cube that fits a clue.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// How its table is made.
    pub model: Model,
    /// Resolutions that fit: the lowest and the highest.
    pub resolutions: [u32; 2],
    /// True if its total is the sum that the rows share.
    pub by_row_sum: bool,
    /// Small entries against its table, where it has one resolution.
    pub lattice: Option<Lattice>,
    /// Entries reproduced by our pixels, best turn.
    pub confirmed: Option<Confirmed>,
    /// That turn.
    pub axes: Option<Axes>,
}

impl Candidate {
    pub(super) fn new(model: Model, resolutions: [u32; 2], by_row_sum: bool) -> Self {
        Self { model, resolutions, by_row_sum, lattice: None, confirmed: None, axes: None }
    }

    /// The one resolution that fits, if it is one.
    pub(super) fn resolution(&self) -> Option<u32> {
        (self.resolutions[0] == self.resolutions[1]).then_some(self.resolutions[0])
    }

    pub(super) fn is_drawn(&self) -> bool {
        self.confirmed.is_some_and(|c| c.holds())
    }

    fn is_on_lattice(&self) -> bool {
        self.lattice.is_some_and(|l| l.holds())
    }

    /// True if a row sum alone speaks for a mistake, and an entry is smaller than any pixel it could be.
    pub(super) fn is_refuted(&self) -> bool {
        let too_small = self.lattice.is_some_and(|l| l.too_small);
        too_small && !self.is_drawn() && self.model.mistake != Mistake::None
    }

    /// True if more than accident speaks for it: entries reproduced, small entries on its table, or a row sum that
    /// only one resolution has and that is not 1, which every closed matrix may have.
    pub(super) fn is_sure(&self, sums: &RowSums) -> bool {
        let distinct =
            if self.model.is_constant() { self.model.mistake.leaves_out() } else { self.resolution().is_some() };
        let told = self.by_row_sum && distinct && sums.slack < 1e-7;
        self.is_drawn() || self.is_on_lattice() || told
    }

    /// Order of belief, best first.
    pub(super) fn rank(&self) -> (bool, bool, bool, f64) {
        let share = self.confirmed.map_or(0.0, |c| c.explained());
        (self.is_drawn(), self.is_on_lattice(), self.by_row_sum, share)
    }

    pub(super) fn is_as_good_as(&self, best: &Self) -> bool {
        let share = |c: &Self| c.confirmed.map_or(0.0, |c| c.explained());
        let same = self.is_drawn() == best.is_drawn()
            && self.by_row_sum == best.by_row_sum
            && (best.is_drawn() || self.is_on_lattice() == best.is_on_lattice());
        same && (!best.is_drawn() || share(self) >= share(best) - 0.02)
    }
}
