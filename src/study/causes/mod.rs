//! The cause of a failure, by name: worlds with one mistake each, and which of them predicts the solution.
//!
//! Each hypothesis predicts radiosities, from the reference's own: `B_h = B_ref + (what the mistake changes)`. What can be
//! had from the reference (irradiance `(B - E) / rho`, for one) is taken from it; only how a change spreads is computed
//! with one quick matrix. A hypothesis is named if it is much nearer to the solution than the truth is, and if no other of
//! another kind does as well.

mod bounces;
mod brightness;
mod case;
mod encoding;
mod jury;
mod lamps;
mod materials;
mod objects;
mod order;
mod patches;
mod quick;
mod rounds;
mod swaps;
mod words;

use super::Session;
use crate::io::StoredReference;
use crate::solution::Radiosity;
use case::Case;
use jury::Jury;
use quick::Quick;
use serde::{Deserialize, Serialize};

/// What explains an error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cause {
    /// Name for machines: `scale`, `srgb`, `materials-swapped`, `missing-object` ...
    pub kind: String,
    /// Plain words, with names and numbers.
    pub sentence: String,
    /// The surface, material, object, band or patch concerned; `None` where it is everything.
    pub place: Option<String>,
    /// Share of the squared error of eq. 7 that goes away if this is it, the reference's noise taken off.
    pub explains: f64,
    /// Eq. 7 of the solution against what this predicts, the reference's noise taken off.
    pub left: f64,
}

/// What the search may spend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CauseOptions {
    /// Rays of all quick matrices together.
    pub rays: u64,
    /// Seed of those rays.
    pub seed: u64,
    /// Objects that are taken out one at a time: those that cover most.
    pub most_objects: usize,
    /// Patches up to which a quick matrix is made; beyond, only causes are looked for that need none.
    pub most_patches: usize,
}

impl Default for CauseOptions {
    fn default() -> Self {
        Self { rays: 6_000_000, seed: 0x6361_7573, most_objects: 20, most_patches: 20_000 }
    }
}

/// A cause that leaves less than this share ends the search before the quick matrix is made, and before objects are taken
/// out.
const SETTLED: f64 = 0.02;

/// Looks for the mistake that explains the error of a solution, the best first. Empty where no single known mistake
/// explains most of it, where two of different kinds explain it alike, and where the error is within twice the
/// reference's noise.
///
/// `solution` holds one value per patch of the session's stage and band, which is the stage of `reference`; anything else
/// (values per element, values that are not finite) gets no name.
pub fn causes(
    session: &Session,
    reference: &StoredReference,
    solution: &Radiosity,
    options: &CauseOptions,
) -> Vec<Cause> {
    let Some(case) = Case::new(session.stage(), &reference.patches, solution) else { return Vec::new() };
    let mut jury = Jury::new(&case);
    brightness::hear(&mut jury, &reference.patches);
    bounces::hear_emission_alone(&mut jury);
    encoding::hear(&mut jury);
    order::hear(&mut jury);
    patches::hear(&mut jury);
    if jury.least_left() > SETTLED
        && let Some(quick) = Quick::new(&case, session, options)
    {
        bounces::hear(&mut jury, &quick);
        rounds::hear(&mut jury, &quick);
        lamps::hear(&mut jury, &quick);
        materials::hear(&mut jury, &quick);
        swaps::hear(&mut jury, &quick);
        // Each object takes rays of its own.
        if jury.least_left() > SETTLED {
            objects::hear(&mut jury, &quick);
        }
    }
    jury.verdict()
}
