//! How far a solution is from the reference, and what that means: eq. 7 of GSG90, top 1 %, bias, energy.
//! Areas, weights and names come in as data; [`decide`] is the only place that decides.

mod baseline;
mod bias;
mod breakdown;
mod check;
mod compare;
mod error;
mod floor;
mod groups;
mod histogram;
mod limits;
mod matrix;
mod measure;
mod noise;
mod power;
mod quantity;
mod rates;
mod residual;
mod residual_bounds;
mod residual_causes;
#[cfg(test)]
mod residual_testing;
mod residual_verdict;
mod rms;
mod scale;
mod split;
mod sums;
mod top1;
mod types;
mod verdict;
mod visible;
mod worst;

pub use baseline::{Change, changes, growth, growth_of_squares};
pub use bias::relative_bias;
pub use breakdown::{Breakdown, break_down};
pub use compare::compare;
pub use error::MetricsError;
pub use floor::top1_noise_floor;
pub use groups::GroupError;
pub use histogram::Histogram;
pub use limits::{Limit, Limits, Metric, Place};
pub use matrix::{
    EntryDifference, MATRIX_FALSE_ALARM, MatrixComparison, MatrixLimits, MatrixRequest, Rounding, RowDifference,
    compare_matrices, decide_matrix,
};
pub use measure::{Beside, Measured, look, measure};
pub use noise::{Beyond, NoiseTest};
pub use rates::{FLOOR_FACTOR, Point, Rate, Reached, fit_rate, reached};
pub use residual::{BandBounds, Rebounded, ResidualMetrics, bound_error};
pub use residual_bounds::ErrorBounds;
pub use residual_causes::{SurfaceResidual, WorstResidual};
pub use residual_verdict::{MOST_BOUNCES, Remedy, ResidualDecision, decide_residual};
pub use rms::{Rms, relative_rms};
pub use scale::{Scale, fit_scale};
pub use split::{Part, Split, Steps, split};
pub use top1::{top1_count, top1_rms, top1_set};
pub use types::{Comparison, Decision, Judged, LimitOutcome, Truth, Verdict, WorstPatch};
pub use verdict::{decide, shared_confidence};
pub use visible::{AsSeen, Needed, Viewing, WorstSeen};
pub use worst::worst_patch;
