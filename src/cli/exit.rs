//! Exit codes, and the one error that ends a command.

use crate::compositing::{CompositeError, ScanError, ShadeError};
use crate::io::FileError;
use crate::io::SpanWriteError;
use crate::io::atomic::WriteError;
use crate::io::scene::SceneFileError;
use crate::methods::MethodError;
use crate::metrics::MetricsError;
use crate::raycast::KernelError;
use crate::reference::ReferenceError;
use crate::report::ReportError;
use crate::scene::SceneError;
use crate::solver::SolverError;
use crate::study::JudgeError;
use crate::study::compositing::CompositingError;
use crate::study::validate::CieError;
use serde_json::{Value, json};

/// Done; every limit met.
pub const DONE: u8 = 0;
/// A limit is exceeded, with confidence.
pub const FAIL: u8 = 1;
/// Bad usage or bad input.
pub const BAD_INPUT: u8 = 2;
/// No sure failure, some limit open.
pub const INCONCLUSIVE: u8 = 3;
/// The reference failed its own self-check.
pub const SELF_CHECK: u8 = 4;
/// A bug.
pub const BUG: u8 = 70;
/// Interrupted by Ctrl-C (128 + SIGINT).
pub const INTERRUPTED: u8 = 130;
/// Ended by SIGTERM (128 + SIGTERM).
pub const TERMINATED: u8 = 143;

/// Why a command ends early: exit code, one message, the place.
#[derive(Debug)]
pub struct Failure {
    /// Exit code.
    pub code: u8,
    /// One message that names the place and the mend.
    pub message: String,
    /// The place alone: file, line, surface or row; empty where there is none.
    pub place: String,
    /// The message with the source text drawn around it, for a terminal.
    pub drawn: Option<String>,
}

impl Failure {
    /// Bad usage or input.
    pub fn input(message: impl Into<String>) -> Self {
        Self { code: BAD_INPUT, message: message.into(), place: String::new(), drawn: None }
    }

    /// The same with its place.
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.place = place.into();
        self
    }

    /// Name of the exit code.
    fn kind(&self) -> &'static str {
        match self.code {
            SELF_CHECK => "self-check",
            BUG => "bug",
            INTERRUPTED | TERMINATED => "interrupted",
            _ => "bad-input",
        }
    }

    /// The object that `--json` prints.
    pub fn json(&self) -> Value {
        json!({ "error": { "code": self.kind(), "message": self.message, "place": self.place } })
    }
}

impl From<FileError> for Failure {
    fn from(e: FileError) -> Self {
        Self::input(e.to_string()).at(e.whereabouts())
    }
}

/// Errors that are bad input as they are.
macro_rules! bad_input {
    ($($error:ty),*) => { $(
        impl From<$error> for Failure {
            fn from(e: $error) -> Self {
                Self::input(e.to_string())
            }
        }
    )* };
}

bad_input!(KernelError, SolverError, ReferenceError, MetricsError, MethodError, SceneError, JudgeError, ReportError);
bad_input!(ScanError, CompositeError, ShadeError, CompositingError);

impl From<SpanWriteError> for Failure {
    fn from(e: SpanWriteError) -> Self {
        match e {
            SpanWriteError::Image(e) => e.into(),
            SpanWriteError::Write(e) => e.into(),
        }
    }
}

impl From<CieError> for Failure {
    fn from(e: CieError) -> Self {
        match e {
            CieError::File(e) => e.into(),
            CieError::Scene(e) => e.into(),
            CieError::Kernel(e) => e.into(),
            CieError::Reference(e) => e.into(),
        }
    }
}

impl From<SceneFileError> for Failure {
    fn from(e: SceneFileError) -> Self {
        let place = e.place();
        let message = e.to_string();
        let drawn = Some(format!("{:?}", miette::Report::new(e)));
        Self { drawn, ..Self::input(message).at(place) }
    }
}

impl From<WriteError> for Failure {
    fn from(e: WriteError) -> Self {
        Self::input(e.to_string()).at(e.target().display().to_string())
    }
}
