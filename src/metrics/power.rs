//! What a run would have caught.

use super::limits::{Limit, Metric};
use super::quantity::mean_of;
use crate::stats::Estimate;

/// Steps of the search: the answer is found to a part in a thousand.
const STEPS: usize = 24;

/// A difference is scaled by at most this: what is not caught then is not said to be.
const LARGEST: f64 = 1e6;

/// The smallest value of a limit's metric that this run would have failed: the solution's own pattern of errors is made
/// larger or smaller (a solution without any is made brighter everywhere) until the lower end of the interval, moved down by
/// what the value itself scatters from run to run, is at the limit. Caught in 19 of 20 runs, as far as the scatter is
/// normal. `None` where no error of this pattern is ever sure.
pub(super) fn smallest_caught(
    limit: &Limit,
    areas: &[f64],
    solution: &[f64],
    rows: &[Vec<f64>],
    metric: &dyn Fn(&[f64]) -> Option<Estimate>,
) -> Option<f64> {
    if limit.metric == Metric::Worse && rows.len() < 2 {
        return Some(limit.max);
    }
    let mean = mean_of(rows);
    let differs = (0..areas.len()).any(|i| areas[i] > 0.0 && solution[i] != mean[i]);
    let at = |c: f64| -> Option<(f64, bool)> {
        let scaled: Vec<f64> =
            (0..mean.len()).map(|i| mean[i] + c * if differs { solution[i] - mean[i] } else { mean[i] }).collect();
        let e = metric(&scaled)?;
        // Normal quantile of 19 in 20.
        let scatter = 1.645 * e.std_err.unwrap_or(0.0);
        Some((e.value, e.low - scatter > limit.max))
    };
    let (mut low, mut high) = (0.0, 1.0);
    while !at(high)?.1 {
        low = high;
        high *= 4.0;
        if high > LARGEST {
            return None;
        }
    }
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if at(middle)?.1 {
            high = middle
        } else {
            low = middle
        }
        if high - low < 1e-3 * high {
            break;
        }
    }
    Some(at(high)?.0)
}
