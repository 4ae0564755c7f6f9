//! Conducts whole runs: check, compare, demo. Emits a finished record that reports only format.

mod record;

pub use record::{Record, Setting};
