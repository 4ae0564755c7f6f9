//! All leave-one-out matrices at once as one linear operator.

use crate::estimate::Blend;
use crate::solver::Transport;

/// The R matrices that leave out one randomisation each, side by side: R times the bands.
pub(super) struct LeaveOneOut<'a> {
    pub blend: &'a Blend<'a>,
}

impl Transport for LeaveOneOut<'_> {
    fn len(&self) -> usize {
        self.blend.counts().rows.len()
    }

    fn sources(&self) -> usize {
        self.blend.counts().patches
    }

    fn apply(&self, x: &[f64], width: usize, y: &mut [f64]) {
        self.blend.apply_leave_one_out(x, width, y);
    }
}
