//! The fingerprint of a form-factor matrix made elsewhere: a hemi-cube, of which resolution, table and mistake?
//!
//! What does not depend on how the hemi-cubes are turned leads: the sum that the rows of a closed scene share,
//! and small entries that are one delta of a table or two. What they suggest is then drawn with our own hemi-cube,
//! turned in the ways people turn theirs, and held against rows entry by entry.

mod axes;
mod borders;
mod candidates;
mod clues;
mod judge;
mod lattice;
mod model;
mod pictures;
mod search;
mod sheets;
mod tables;
mod totals;
mod words;

use crate::scene::Stage;
use crate::solution::FormFactors;
pub use axes::{Axes, Axis};
pub use candidates::Candidate;
pub use clues::{Digits, RowSums};
pub use lattice::Lattice;
pub use model::{Mistake, Model, Rule};
pub use pictures::Confirmed;
use search::{Found, Search};
use serde::Serialize;

/// What a matrix looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Likeness {
    /// A hemi-cube, beyond accident.
    Hemicube,
    /// Counts of rays: every entry is a multiple of 1 / `rays`.
    RayCounts {
        /// The smallest number of rays that fits.
        rays: u64,
    },
    /// Nothing in it says hemi-cube; a hemi-cube turned in an unknown way, of a table that sums to 1, may say nothing
    /// either.
    NoSignOfHemicube,
    /// Too few rows or digits to say.
    CannotBeTold,
}

/// What can be told of a matrix.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fingerprint {
    /// What it looks like.
    pub likeness: Likeness,
    /// Pixels along an edge of the top face; `None` where it cannot be told.
    pub resolution: Option<u32>,
    /// How deltas are found; `None` where it cannot be told.
    pub rule: Option<Rule>,
    /// What is wrong, [`Mistake::None`] for nothing; `None` where it cannot be told.
    pub mistake: Option<Mistake>,
    /// How the hemi-cubes are turned; `None` where no turn reproduces the entries.
    pub axes: Option<Axes>,
    /// Entries reproduced; `None` where nothing was drawn.
    pub confirmed: Option<Confirmed>,
    /// Where neither row sums nor small entries name a resolution: all those up to this one were drawn.
    pub drawn_to: Option<u32>,
    /// What rows sum to.
    pub row_sums: RowSums,
    /// The smallest entry above zero; `None` for an empty matrix.
    pub smallest_entry: Option<f64>,
    /// Digits of the entries.
    pub digits: Digits,
    /// All that fits, best first.
    pub candidates: Vec<Candidate>,
    /// The reasons in words, most telling first.
    pub reasons: Vec<String>,
}

/// Tells what can be told of a matrix of this scene.
///
/// Draws up to 24 hemi-cubes per candidate; where neither row sums nor small entries say a resolution, those up to
/// 256 are drawn for one row, fewer in a scene of very many patches: drawing ends after about 1.5e9 pixels.
pub fn fingerprint(stage: &Stage, matrix: &FormFactors) -> Fingerprint {
    let search = Search::new(stage, matrix);
    let nothing = || Found { candidates: Vec::new(), drawn_to: None };
    let rays = clues::rays(&search.entries, search.digits);
    // Decimal places and counts of a power of ten are the same numbers.
    let decimal = matches!(search.digits, Digits::Places(_));
    if let Some(rays) = rays.filter(|_| !decimal) {
        return search.conclude(Likeness::RayCounts { rays }, nothing());
    }
    // Where rounding hides pixels, any good matrix is "reproduced".
    if search.row_sums.rows < 3 || search.entries.len() < 8 || search.is_coarse() {
        return search.conclude(Likeness::CannotBeTold, nothing());
    }
    let found = search.run();
    let likeness = match found.candidates.first() {
        Some(best) if best.is_sure(&search.row_sums) => Likeness::Hemicube,
        None if decimal => Likeness::CannotBeTold,
        _ => Likeness::NoSignOfHemicube,
    };
    search.conclude(likeness, found)
}
