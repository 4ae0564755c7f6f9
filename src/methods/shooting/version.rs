//! A version of the geometry with the power that was shot in it: an entry of the log.

use super::change::Change;
use super::geometry::Geometry;
use crate::scene::{Edit, Material};
use std::sync::Arc;

/// Power shot in one version of the geometry.
pub(super) struct Version {
    pub geometry: Arc<Geometry>,
    /// Number of edits applied when it stood.
    pub state: usize,
    /// The edits that have ended it and followed.
    pub edits: Vec<String>,
    /// Power per patch, channel and band, W.
    pub shot: Vec<f64>,
    /// What differs from the newest version; `None` for the newest itself.
    pub change: Option<Change>,
    /// Estimated share of a patch's power that has to be redistributed.
    pub weight: Vec<f64>,
    /// Patches with power in it and the estimated luminous power to be redistributed, least first. Power is never added
    /// to an old version, so the order holds until the next edit.
    pub queue: Vec<(f64, u32)>,
}

impl Version {
    pub fn new(geometry: Arc<Geometry>, state: usize, values: usize) -> Self {
        let weight = vec![0.0; geometry.stage.patch_count()];
        Self { geometry, state, edits: Vec::new(), shot: vec![0.0; values], change: None, weight, queue: Vec::new() }
    }

    /// Orders the patches with power by `luminous(power of the mean) * weight`; of equals the lower number goes first.
    pub fn enqueue(&mut self, width: usize, bands: usize, luminous: impl Fn(&[f64]) -> f64) {
        let holding = (0..self.weight.len()).filter(|i| self.holds(*i, width));
        let key = |i: usize| self.weight[i] * luminous(&self.shot[i * width..][..bands]);
        let mut queue: Vec<(f64, u32)> = holding.map(|i| (key(i), i as u32)).collect();
        queue.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        self.queue = queue;
    }

    /// True if patch i has power in it.
    pub fn holds(&self, i: usize, width: usize) -> bool {
        self.shot[i * width..(i + 1) * width].iter().any(|q| *q != 0.0)
    }
}

/// Power that has not been redistributed since an edit: what the solution still lacks, exactly. With F the form
/// factors now, F_v those of the version and Q the power given here, the elements lack `(F - F_v)^T Q`.
#[derive(Debug, Clone, PartialEq)]
pub struct LogEntry {
    /// State of the scene in which the power was shot.
    pub state: usize,
    /// The edits since.
    pub edits: Vec<String>,
    /// Patches whose power is still distributed as if the edits had not been made, with that power in W per band.
    pub patches: Vec<(usize, Vec<f64>)>,
    /// The patch with most to redistribute and an estimate of how much, W of luminance.
    pub largest: Option<(usize, f64)>,
}

/// An edit in words.
pub(super) fn describe(edit: &Edit, materials: &[Material]) -> String {
    match edit {
        Edit::Add { object } => format!("add {object}"),
        Edit::Remove { object } => format!("remove {object}"),
        Edit::Move { object, .. } => format!("move {object}"),
        Edit::Reshape { object, .. } => format!("reshape {object}"),
        Edit::Replace { object, .. } => format!("replace {object}"),
        Edit::Material { material, .. } => {
            let name = materials.get(*material as usize).map_or("", |m| &m.name);
            format!("change material {name}")
        }
    }
}
