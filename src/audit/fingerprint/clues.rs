//! What the numbers of a matrix say by themselves: row sums, digits, multiples.

use crate::scene::Stage;
use crate::solution::FormFactors;
use serde::Serialize;

/// Digits the values of a file carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Digits {
    /// So many decimal places.
    Places(u32),
    /// So many significant decimal digits.
    Significant(u32),
    /// Single precision.
    Single,
    /// Double precision.
    Double,
}

impl Digits {
    /// The digits that hold all values.
    pub(super) fn of(values: &[f64]) -> Self {
        let whole = |x: f64| (x - x.round()).abs() <= 1e-6_f64.min(1e-12 * x.abs() + 1e-9);
        if let Some(k) = (0..=9).find(|k| values.iter().all(|v| whole(v * 10_f64.powi(*k)))) {
            return Self::Places(k as u32);
        }
        let written = |v: f64, d: usize| format!("{v:.d$e}").parse() == Ok(v);
        if let Some(d) = (1..=12).find(|d| values.iter().all(|v| written(*v, d - 1))) {
            return Self::Significant(d as u32);
        }
        if values.iter().all(|v| f64::from(*v as f32) == *v) { Self::Single } else { Self::Double }
    }

    /// Greatest rounding error of a value.
    pub(super) fn error(self, value: f64) -> f64 {
        match self {
            Self::Places(k) => 0.5 * 10_f64.powi(-(k as i32)),
            Self::Significant(d) => 0.5 * 10_f64.powi(value.abs().log10().floor() as i32 + 1 - d as i32),
            Self::Single => f64::from(f32::EPSILON) * value.abs(),
            Self::Double => f64::EPSILON * value.abs(),
        }
    }
}

/// What rows sum to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowSums {
    /// Rows of patches that take part and have entries.
    pub rows: usize,
    /// Smallest and largest sum.
    pub range: [f64; 2],
    /// The sum that most rows share; `None` where fewer than three in five do.
    pub common: Option<f64>,
    /// Half of the spread of the rows that share it.
    pub slack: f64,
    /// Rows that share it.
    pub sharing: usize,
}

impl RowSums {
    pub(super) fn of(stage: &Stage, f: &FormFactors) -> Self {
        let rows = (0..f.n).filter(|i| stage.patches[*i].is_present()).map(|i| f.row_sum(i));
        let mut sums: Vec<f64> = rows.filter(|s| *s > 0.0).collect();
        sums.sort_unstable_by(f64::total_cmp);
        let range = [sums.first().copied().unwrap_or(0.0), sums.last().copied().unwrap_or(0.0)];
        let mut out = Self { rows: sums.len(), range, common: None, slack: 0.0, sharing: 0 };
        // Single-precision tables and sums spread more than double ones: the closest cluster that holds most rows.
        for width in [1e-11, 1e-9, 1e-7, 1e-6, 1e-5] {
            let (from, to) = widest(&sums, width);
            if to - from >= 3 && 5 * (to - from) >= 3 * sums.len() {
                out.common = Some(sums[(from + to) / 2]);
                out.slack = (0.5 * (sums[to - 1] - sums[from])).max(2e-12);
                out.sharing = to - from;
                return out;
            }
        }
        out
    }
}

/// The most sums within a relative width: from, to.
fn widest(sums: &[f64], width: f64) -> (usize, usize) {
    let (mut best, mut from) = ((0, 0), 0);
    for to in 0..sums.len() {
        while sums[to] - sums[from] > width * sums[to] {
            from += 1;
        }
        if to + 1 - from > best.1 - best.0 {
            best = (from, to + 1);
        }
    }
    best
}

/// The smallest number of rays whose counts all values are; `None` if they are none, or their digits do not say.
pub(super) fn rays(values: &[f64], digits: Digits) -> Option<u64> {
    const MOST: u32 = 8192;
    let mut different: Vec<f64> = values.to_vec();
    different.dedup_by(|b, a| (*b - *a).abs() <= 1e-12 * *a);
    let smallest = *different.first()?;
    let step = (different.len() / 300).max(1);
    let sample: Vec<f64> = different.iter().copied().step_by(step).collect();
    if different.len() < 8 {
        return None;
    }
    let count = |k: u32| {
        let rays = (f64::from(k) / smallest).round();
        let fits = |v: &f64| {
            let (hits, slack) = (v * rays, 1e-7 + 2.0 * rays * digits.error(*v));
            slack < 0.02 && (hits - hits.round()).abs() <= slack
        };
        (rays >= 16.0 && sample.iter().all(fits)).then_some(rays as u64)
    };
    (1..=MOST).find_map(count)
}
