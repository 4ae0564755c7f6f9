//! The audit of a hemi-cube: the truth, the hemi-cube, its errors by cause and by source, and the cures, each run and
//! judged.

mod auditor;
mod cures;
mod curves;
mod findings;
mod judging;
mod record;
mod request;
mod run;
mod sources;
mod sums;

pub use findings::Finding;
pub use record::{At, AuditRecord, CureRun, Form, MatrixError, Receiver, SourceAudit, Wrong};
pub use request::{AuditError, AuditRequest};
pub use run::{Audited, audit};
