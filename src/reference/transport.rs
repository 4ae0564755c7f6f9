//! All leave-one-out matrices at once as one linear operator.

use crate::estimate::HitCounts;
use crate::solver::Transport;

/// The R matrices that leave out one randomisation each, side by side: R times the bands.
pub(super) struct LeaveOneOut<'a> {
    pub counts: &'a HitCounts,
}

impl Transport for LeaveOneOut<'_> {
    fn len(&self) -> usize {
        self.counts.rows.len()
    }

    fn sources(&self) -> usize {
        self.counts.patches
    }

    fn apply(&self, x: &[f64], width: usize, y: &mut [f64]) {
        self.counts.apply_leave_one_out(x, width, y);
    }
}
