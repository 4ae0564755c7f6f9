//! Conducts whole runs: reference, solve, check, demo. Hands finished records to reports, which only format.

pub mod audit;
mod baseline;
mod causes;
mod contributions;
pub mod converge;
pub mod envmap;
mod judge;
mod kept;
mod looks;
mod matrix_compare;
mod receivers;
mod record;
mod residual;
mod reuse;
mod run;
mod session;
mod shoot;
mod split;
pub mod validate;
mod viewing;

pub use baseline::{Baseline, JudgedBy, Taken};
pub use causes::{Cause, CauseOptions, causes};
pub use contributions::{Contributions, Rows, Source, contributions};
pub use judge::{Against, JudgeError, Judgement, Question, Receivers, anonymous_stage, break_down, judge};
pub use kept::KeptWork;
pub use looks::{Decided, Look, Seen, confidence_of_look, until_decided};
pub use matrix_compare::{Explanation, MatrixRun, Witness, compare_matrix};
pub use receivers::at_receivers;
pub use record::{Before, Part, Record, Setting};
pub use residual::{ResidualRequest, ResidualRun, residual};
pub use reuse::{falls_short, reference_key};
pub use run::{SolveOutcome, SolveRequest, continuous_reference, reference, reference_on, solve};
pub use session::Session;
pub use shoot::{Course, Moments, ShootRequest, begin, shoot, shoot_on};
pub use split::{Beside, SplitError, split_error};
pub use viewing::{Onlooker, viewing};
