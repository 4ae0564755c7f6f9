//! What a matrix of form factors has to fit: areas, planes, and whether light can escape.

use crate::scene::{Patch, Stage};
use serde::{Deserialize, Serialize};

/// Heights below this share of a pair's extent count as lying in the plane.
const IN_PLANE: f64 = 1e-9;

/// The patches a matrix speaks of.
#[derive(Debug, Clone)]
pub struct Surroundings<'a> {
    /// Area of each patch that takes part, m^2; 0 for absent patches.
    pub areas: Vec<f64>,
    /// True where no light escapes: every row adds up to 1. Otherwise to 1 at most.
    pub closed: bool,
    /// The planar patches; empty where only their areas are known.
    pub patches: &'a [Patch],
}

/// Why two patches cannot exchange light, whatever stands between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoExchange {
    /// One of them takes no part in this state.
    Absent,
    /// A planar patch does not see itself.
    Itself,
    /// One lies behind the plane of the other, or in it.
    FacingAway,
}

impl<'a> Surroundings<'a> {
    /// Those of a stage; `closed` as the author or the rays say.
    pub fn of(stage: &'a Stage, closed: bool) -> Self {
        Self { areas: stage.areas(), closed, patches: &stage.patches }
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    /// True if there is no patch.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Why the pair exchanges no light; `None` if nothing in its geometry forbids it.
    pub fn forbids(&self, i: usize, j: usize) -> Option<NoExchange> {
        if self.areas[i] <= 0.0 || self.areas[j] <= 0.0 {
            return Some(NoExchange::Absent);
        }
        if i == j {
            return Some(NoExchange::Itself);
        }
        let (Some(a), Some(b)) = (self.patches.get(i), self.patches.get(j)) else { return None };
        (!(rises_above(b, a) && rises_above(a, b))).then_some(NoExchange::FacingAway)
    }
}

/// True if some corner of `one` lies in front of the plane of `other`.
fn rises_above(one: &Patch, other: &Patch) -> bool {
    let Some(origin) = other.corners.first() else { return true };
    let extent = one.corners.iter().chain(&other.corners).map(|p| p.distance(*origin)).fold(0.0, f64::max);
    one.corners.iter().any(|p| (*p - *origin).dot(other.normal) > IN_PLANE * extent)
}
