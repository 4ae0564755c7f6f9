//! The audit of a hemi-cube: the truth, the hemi-cube, its errors by cause and by source, and the cures, each run and
//! judged.

mod findings;
mod judging;
mod record;
mod run;

pub use findings::Finding;
pub use record::{At, AuditRecord, CureRun, Form, MatrixError, Receiver, SourceAudit, Wrong};
pub use run::{AuditError, AuditRequest, Audited, audit};
