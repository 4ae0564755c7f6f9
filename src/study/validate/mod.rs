//! Published test suites, run against the engine: what it is validated against, never certified by.

mod cie171;
mod cie171_exact;
mod closed_forms;
mod display;
mod obstructed;
mod truth_file;

pub use cie171::{CIE_LIMIT, CieError, Measured, Outcome, cie171};
pub use closed_forms::{ABSOLUTE, RELATIVE, Route, Row, closed_forms};
pub use display::{BrightnessCurve, DISPLAY_TOLERANCE, DisplayRow, DisplaySuite, display};

/// Chance that a sound engine fails a whole suite by bad luck; shared out among its values.
pub const FALSE_ALARM: f64 = 1e-6;
