//! How far a solution is from the reference, and what that means: eq. 7 of [GSG90], top 1 %, bias, energy.
//! Areas, weights and names come in as data; [`Decision`] is the only place that decides.

mod types;

pub use types::{Comparison, Decision, Judged, LimitOutcome, Limits, Truth, Verdict, WorstPatch};
