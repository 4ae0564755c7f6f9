//! Conducts whole runs: reference, solve, check, demo. Hands finished records to reports, which only format.

mod judge;
mod record;
mod run;
mod session;

pub use judge::{Against, JudgeError, Judgement, Question, Receivers, anonymous_stage, judge};
pub use record::{Record, Setting};
pub use run::{SolveOutcome, SolveRequest, reference, solve};
pub use session::Session;
