//! Conducts whole runs: reference, solve, check, demo. Hands finished records to reports, which only format.

mod contributions;
mod judge;
mod record;
mod run;
mod session;

pub use contributions::{Contributions, Rows, Source, contributions};
pub use judge::{Against, JudgeError, Judgement, Question, Receivers, anonymous_stage, break_down, judge};
pub use record::{Part, Record, Setting};
pub use run::{SolveOutcome, SolveRequest, reference, solve};
pub use session::Session;
