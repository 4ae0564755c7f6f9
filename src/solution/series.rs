//! A solution as it grows: what a method had after so many shots.

use super::Radiosity;

/// A solution on its way, with what it has cost so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Number of edits applied: the state of the scene that these radiosities are for.
    pub edit: usize,
    /// Shots since the beginning of the series; 0 for methods that do not shoot.
    pub shots: u64,
    /// Rays since the beginning of the series; 0 for methods that cast none.
    pub rays: u64,
    /// Seconds of computing since the beginning of the series, without the taking of snapshots.
    pub seconds: f64,
    /// Radiosities per patch.
    pub radiosity: Radiosity,
}

/// The snapshots of one run, in the order in which they were taken: edits, shots, rays and seconds never fall.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What the method is called.
    pub name: String,
    /// At least one.
    pub snapshots: Vec<Snapshot>,
}
