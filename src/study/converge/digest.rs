//! What is read off the curves: rates, and what it costs to reach a level.

use super::{Axis, Curve, Metric};
use crate::metrics::{Rate, Reached, fit_rate, reached};

/// Levels of the tables: 10 %, 3 %, 1 %.
pub const LEVELS: [f64; 3] = [0.10, 0.03, 0.01];

/// A fitted rate.
#[derive(Debug, Clone, PartialEq)]
pub struct RateRow {
    /// Of which method.
    pub method: String,
    /// Number of edits applied.
    pub edit: usize,
    /// Of which error.
    pub metric: Metric,
    /// Against which cost.
    pub axis: Axis,
    /// `None` with fewer than three points clear of the noise.
    pub rate: Option<Rate>,
}

/// What it costs to reach a level.
#[derive(Debug, Clone, PartialEq)]
pub struct ReachedRow {
    /// Which method.
    pub method: String,
    /// Number of edits applied.
    pub edit: usize,
    /// Which error.
    pub metric: Metric,
    /// The level, a fraction.
    pub level: f64,
    /// Shots, rays, seconds since the edit; in the order of [`Axis::ALL`]. `None` for a cost that the method does
    /// not have.
    pub costs: [Option<Reached>; 3],
    /// How many times the first method's cost is this one's, by value; `None` where either has none.
    pub first_over_this: [Option<f64>; 3],
}

/// All rates and levels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Digest {
    /// By curve, metric and axis.
    pub rates: Vec<RateRow>,
    /// By curve, metric and level.
    pub reached: Vec<ReachedRow>,
}

/// Rates and levels of all curves; intervals at `confidence`. The first curve of a state is what its others are
/// measured by.
pub fn digest(curves: &[Curve], confidence: f64) -> Digest {
    let mut out = Digest::default();
    for curve in curves {
        for metric in Metric::ALL.into_iter().filter(|m| has(curve, *m)) {
            for axis in Axis::ALL.into_iter().filter(|a| curve.spends(*a)) {
                let rate = fit_rate(&curve.against(metric, axis), confidence);
                out.rates.push(RateRow { method: curve.method.clone(), edit: curve.edit, metric, axis, rate });
            }
            out.reached.extend(LEVELS.map(|level| {
                let first = curves.iter().find(|c| c.edit == curve.edit && has(c, metric)).unwrap_or(curve);
                reached_row(curve, first, metric, level)
            }));
        }
    }
    out
}

/// True if a curve knows this error.
fn has(curve: &Curve, metric: Metric) -> bool {
    curve.points.iter().any(|p| p.error(metric).is_some())
}

fn reached_row(curve: &Curve, first: &Curve, metric: Metric, level: f64) -> ReachedRow {
    let costs = |c: &Curve| Axis::ALL.map(|a| c.spends(a).then(|| reached(&c.against(metric, a), level)));
    let (own, theirs) = (costs(curve), costs(first));
    let ratio = |k: usize| {
        let (this, first) = (own[k]?.by_value?, theirs[k]?.by_value?);
        (this > 0.0).then(|| first / this)
    };
    let first_over_this = [0, 1, 2].map(ratio);
    ReachedRow { method: curve.method.clone(), edit: curve.edit, metric, level, costs: own, first_over_this }
}
