//! A number that travels with its error.

use serde::{Deserialize, Serialize};

/// A value with its standard error and confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Point value.
    pub value: f64,
    /// One standard error; `None` where nothing is known of it.
    pub std_err: Option<f64>,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Estimate {
    /// A number that is not an estimate: both ends of the interval are the value, and it has no standard error.
    pub fn exact(value: f64) -> Self {
        Self { value, std_err: None, low: value, high: value }
    }
}
