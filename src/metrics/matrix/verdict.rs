//! Limits on a matrix.

use super::MatrixComparison;
use crate::metrics::types::Decision;
use crate::metrics::verdict::{outcome, overall};
use serde::{Deserialize, Serialize};

/// Limits that a matrix has to keep.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MatrixLimits {
    /// Limit on the relative norm of the difference.
    pub max_rms: Option<f64>,
    /// Limit on the difference of any entry.
    pub max_entry: Option<f64>,
}

impl MatrixLimits {
    /// How many are given.
    pub fn given(&self) -> usize {
        [self.max_rms, self.max_entry].iter().flatten().count()
    }
}

/// Holds a comparison against limits, as [`crate::metrics::decide`] does: failed if the interval lies above a limit,
/// passed if it does not reach beyond, else open.
pub fn decide_matrix(comparison: &MatrixComparison, limits: &MatrixLimits) -> Decision {
    let asked = [("relative", limits.max_rms, comparison.relative), ("largest", limits.max_entry, comparison.largest)];
    let limits: Vec<_> =
        asked.into_iter().filter_map(|(metric, limit, e)| limit.map(|l| outcome(metric, l, Some(e)))).collect();
    Decision { verdict: overall(&limits), limits }
}
