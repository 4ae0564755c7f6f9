//! The part of a patch that radiates: convex pieces, and the map that spreads points evenly over them.

use crate::math::{DVec3, area, centroid};
use serde::{Deserialize, Serialize};

/// Disjoint convex pieces of one plane. One piece for a patch that nothing covers, none for an absent one.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// Convex loops, wound like the patch.
    pub pieces: Vec<Vec<DVec3>>,
}

impl Region {
    /// A region of one piece.
    pub fn whole(polygon: Vec<DVec3>) -> Self {
        Self { pieces: vec![polygon] }
    }

    /// Total area, m^2.
    pub fn area(&self) -> f64 {
        crate::math::compensated_sum(self.pieces.iter().map(|p| area(p)))
    }

    /// Centre of area; `None` for an empty region.
    pub fn centroid(&self) -> Option<DVec3> {
        let total = self.area();
        (total > 0.0).then(|| self.pieces.iter().map(|p| centroid(p) * (area(p) / total)).sum())
    }
}
