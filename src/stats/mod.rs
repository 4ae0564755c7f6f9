//! Moments, estimates, intervals and tests. Knows no file, no scene, no terminal.

mod estimate;

pub use estimate::Estimate;
