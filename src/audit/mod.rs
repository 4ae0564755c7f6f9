//! Audit of hemi-cube form factors: which pairs are wrong, by how much and why, what it does to radiosities, what would
//! mend it; and what can be told of a matrix that somebody else's hemi-cube made.

mod unfolded;

pub use unfolded::{Unfolded, unfold};
