//! Small entries: sums of one or two deltas of a table?

use super::clues::Digits;
use serde::Serialize;

/// Entries looked at, smallest first.
const ENTRIES: usize = 48;

/// A match that chance makes more often than this is none.
const TELLING: f64 = 1e-3;

/// How many of the smallest entries are one delta of a table, or the sum of two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Lattice {
    /// Different entries looked at: the smallest, up to twice the largest delta.
    pub entries: usize,
    /// Those that are one delta.
    pub single: usize,
    /// Those that are the sum of two.
    pub double: usize,
    /// How many such matches chance would make.
    pub by_chance: f64,
    /// True if an entry is smaller than the smallest delta.
    pub too_small: bool,
}

impl Lattice {
    /// True if chance does not explain the matches.
    pub(super) fn holds(&self) -> bool {
        let found = self.single + self.double;
        found >= 2 && self.by_chance < TELLING * found as f64
    }

    /// Holds the different entries (ascending) against the deltas (ascending) of a table.
    pub(super) fn of(entries: &[f64], deltas: &[f64], digits: Digits) -> Self {
        let (Some(first), Some(last)) = (deltas.first(), deltas.last()) else { return Self::none() };
        let mut out = Self::none();
        if entries.first().is_some_and(|e| *e < 0.999 * first) {
            // A pixel smaller than the smallest cannot be: another table, or edges that are no pixels.
            out.too_small = true;
            return out;
        }
        for e in entries.iter().take_while(|e| **e <= 2.001 * last).take(ENTRIES) {
            let slack = 3.0 * digits.error(*e) + 4e-16;
            let (one, two) = (2.0 * slack * density(deltas, *e), 2.0 * slack * pairs(deltas, *e));
            if one > TELLING {
                break;
            }
            out.entries += 1;
            out.by_chance += one;
            if near(deltas, *e, slack) {
                out.single += 1;
            }
            // Sums of two of a large table are everywhere: they tell nothing, and take long.
            if two <= TELLING {
                out.by_chance += two;
                let is_sum =
                    || deltas.iter().take_while(|d| 2.0 * **d <= e + slack).any(|d| near(deltas, e - d, slack));
                out.double += usize::from(!near(deltas, *e, slack) && is_sum());
            }
        }
        out
    }

    fn none() -> Self {
        Self { entries: 0, single: 0, double: 0, by_chance: 0.0, too_small: false }
    }
}

/// True if a delta lies within `slack` of a value.
fn near(deltas: &[f64], value: f64, slack: f64) -> bool {
    deltas.get(deltas.partition_point(|d| *d < value - slack)).is_some_and(|d| *d <= value + slack)
}

/// Deltas per unit around a value.
fn density(deltas: &[f64], value: f64) -> f64 {
    let below = |x: f64| deltas.partition_point(|d| *d < x);
    (below(1.1 * value) - below(0.9 * value)) as f64 / (0.2 * value)
}

/// Sums of two deltas per unit around a value, from a few of the first.
fn pairs(deltas: &[f64], value: f64) -> f64 {
    let first = deltas.partition_point(|d| 2.0 * *d <= value);
    let step = (first / 32).max(1);
    let sampled: f64 = deltas[..first].iter().step_by(step).map(|d| density(deltas, value - d)).sum();
    sampled * step as f64
}
