//! From what a row sums to, to the resolution.

use super::model::Model;
use super::tables::Table;

/// The highest resolution looked for.
const LAST: u32 = 2048;
/// From here on what is left to the limit falls as 1 / N or 1 / N^2 as good as exactly.
const SETTLED: u32 = 128;

/// Resolutions whose table sums to a value, within `slack`: the lowest and the highest, even, or odd where the
/// model's are.
pub(super) fn resolutions(model: Model, value: f64, slack: f64) -> Option<(u32, u32)> {
    let total = |n: u32| Table::total_of(n, model);
    if model.is_constant() {
        return ((total(4) - value).abs() <= slack).then_some((4, LAST));
    }
    let odd = u32::from(model.mistake.is_odd());
    let mut at = (4 + odd, total(4 + odd));
    let mut before = at.1;
    while at.0 < LAST {
        let n = 2 * at.0 - odd;
        let next = (n, total(n));
        let (low, high) = (at.1.min(next.1) - slack, at.1.max(next.1) + slack);
        if (low..=high).contains(&value) {
            return inside(&total, at, next, value, slack);
        }
        // What is still to come is at most as much again as the last step: beyond that, no large table need be made.
        let step = next.1 - at.1;
        if n >= SETTLED && (value - next.1 - step).abs() > step.abs() + slack {
            return None;
        }
        // Steps of a fourth: only a third of the last one is still to come.
        let fourth = (at.1 - before - 4.0 * step).abs() < 0.05 * step.abs();
        if n >= SETTLED && fourth && (value - next.1).abs() > 0.4 * step.abs() + slack {
            return None;
        }
        (before, at) = (at.1, next);
    }
    None
}

/// The same between two resolutions, total falling or rising all the way.
fn inside(
    total: &dyn Fn(u32) -> f64,
    (mut low, first): (u32, f64),
    (mut high, last): (u32, f64),
    value: f64,
    slack: f64,
) -> Option<(u32, u32)> {
    let end = high;
    while high - low > 2 {
        let middle = low + (high - low) / 4 * 2;
        let before = if last < first { total(middle) > value } else { total(middle) < value };
        if before { low = middle } else { high = middle }
    }
    let fits = |n: u32| (total(n) - value).abs() <= slack;
    let first = [low, high].into_iter().find(|n| fits(*n))?;
    let (mut lowest, mut highest) = (first, first);
    while lowest > 5 && first - lowest < 64 && fits(lowest - 2) {
        lowest -= 2;
    }
    while highest < 2 * end && highest - first < 64 && fits(highest + 2) {
        highest += 2;
    }
    Some((lowest, highest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_total_leads_back_to_its_resolution() {
        for model in Model::all().filter(|m| !m.is_constant()) {
            for n in [6, 50, 128, 250, 600] {
                let n = n + u32::from(model.mistake.is_odd());
                let found = resolutions(model, Table::total_of(n, model), 1e-13);
                assert_eq!(found, Some((n, n)), "{model:?} at {n}");
            }
        }
    }
}
