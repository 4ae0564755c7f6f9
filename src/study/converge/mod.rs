//! Convergence curves: the error of a method against what it has cost so far, judged snapshot by snapshot.
//!
//! Methods are run ([`run_method`]) or their snapshots read from a folder; the judge holds each snapshot against the
//! reference of its state ([`judge_series`]); rates and levels are what is read off the curves ([`digest`]).

mod curve;
mod diff;
mod digest;
mod entry;
mod judge;
mod refine;
mod run;

pub use curve::{Axis, Curve, CurvePoint, Metric, join};
pub use diff::{At, Difference, Noise, Side, diff};
pub use digest::{Digest, LEVELS, RateRow, ReachedRow, digest};
pub use entry::{Entry, EntryError, parse_methods};
pub use judge::{JudgedState, judge_mesh, judge_series};
pub use refine::{MeshCurve, MeshPoint, MeshSize, RefineError, mesh_rate, refined};
pub use run::{Run, RunError, run_method};
