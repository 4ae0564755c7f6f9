//! Which value gets which colour, and the marks beside it.

use super::{ColourMap, Field, LinearRgb};

/// Share of the area whose values lie within a fitted range; the rest is shown in the end colours.
const ROBUST_SHARE: f64 = 0.98;

/// A colour map over a range of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    map: ColourMap,
    /// Value at the upper end.
    pub high: f64,
    /// Share of the area whose values lie beyond the range.
    pub beyond: f64,
}

/// A mark on a colour bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tick {
    /// Place along the bar, 0 to 1.
    pub at: f64,
    /// Value there.
    pub value: f64,
}

/// The value below which `share` of the weight lies, of (value, weight) pairs; `None` without any weight.
/// Values that are not finite are left out.
pub fn area_percentile(pairs: impl IntoIterator<Item = (f64, f64)>, share: f64) -> Option<f64> {
    let mut kept: Vec<(f64, f64)> = pairs.into_iter().filter(|(v, w)| v.is_finite() && *w > 0.0).collect();
    kept.sort_by(|a, b| a.0.total_cmp(&b.0));
    let goal = share * crate::math::compensated_sum(kept.iter().map(|(_, w)| *w));
    let mut below = 0.0;
    // The last one stands in where rounding keeps the running sum under the goal.
    let found = kept.iter().find(|(_, w)| {
        below += w;
        below >= goal
    });
    found.or(kept.last()).map(|(v, _)| *v)
}

impl Scale {
    /// From 0 to a round number that 98 % of the area stays under.
    pub fn from_zero(field: &Field, areas: &[f64]) -> Self {
        Self::fitted(ColourMap::Sequential, field, areas, 0.0)
    }

    /// The same number of units either side of 0, at least `least`; 98 % of the area stays within.
    pub fn symmetric(field: &Field, areas: &[f64], least: f64) -> Self {
        Self::fitted(ColourMap::Diverging, field, areas, least)
    }

    fn fitted(map: ColourMap, field: &Field, areas: &[f64], least: f64) -> Self {
        let magnitudes = || field.values.iter().zip(areas).filter_map(|(v, a)| Some((v.as_ref()?.abs(), *a)));
        let reach = |share| area_percentile(magnitudes(), share).filter(|r| *r > 0.0);
        // Where nearly all of the area is exactly right, the rest still has to show.
        let high = round_up(reach(ROBUST_SHARE).or_else(|| reach(1.0)).unwrap_or(1.0).max(least));
        let total: f64 = magnitudes().map(|(_, a)| a).sum();
        let outside: f64 = magnitudes().filter(|(v, _)| *v > high).map(|(_, a)| a).sum();
        Self { map, high, beyond: if total > 0.0 { outside / total } else { 0.0 } }
    }

    /// Value at the lower end.
    pub fn low(&self) -> f64 {
        match self.map {
            ColourMap::Sequential => 0.0,
            ColourMap::Diverging => -self.high,
        }
    }

    /// Colour of a value.
    pub fn colour(&self, value: f64) -> LinearRgb {
        self.map.colour(value / self.high)
    }

    /// Colours at `n` equal steps from the lower to the upper end; `n` of at least 2.
    pub fn stops(&self, n: usize) -> Vec<LinearRgb> {
        let at = |k: usize| self.low() + (self.high - self.low()) * k as f64 / (n - 1) as f64;
        (0..n).map(|k| self.colour(at(k))).collect()
    }

    /// Round marks from end to end.
    pub fn ticks(&self) -> Vec<Tick> {
        let step = match self.map {
            ColourMap::Diverging => 0.5 * self.high,
            ColourMap::Sequential => tick_step(self.high),
        };
        let parts = ((self.high - self.low()) / step).round();
        let tick = |k: u32| {
            let at = f64::from(k) / parts;
            Tick { at, value: self.low() * (1.0 - at) + self.high * at }
        };
        (0..=parts as u32).map(tick).collect()
    }
}

/// The next number of the series 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten.
fn round_up(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let series = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    // The slack keeps a round number that carries a rounding error from moving up.
    power * series.into_iter().find(|m| x <= m * power * (1.0 + 1e-9)).unwrap_or(10.0)
}

/// The smallest round step that divides `high` into four parts or fewer.
fn tick_step(high: f64) -> f64 {
    let power = 10f64.powf((high / 4.0).log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0, 20.0, 50.0].map(|m| m * power);
    let divides = |s: &f64| *s >= high / 4.0 * (1.0 - 1e-9) && ((high / s) - (high / s).round()).abs() < 1e-6;
    steps.into_iter().find(divides).unwrap_or(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(values: &[f64]) -> Field {
        Field { values: values.iter().map(|v| Some(*v)).collect() }
    }

    #[test]
    fn ranges_end_on_round_numbers() {
        let pairs = [(0.013, 0.015), (0.0101, 0.015), (1.0, 1.0), (0.6, 0.6), (734.0, 800.0), (0.3 * 1.0, 0.3)];
        for (x, expected) in pairs {
            assert!((round_up(x) / expected - 1.0).abs() < 1e-12, "{x}: {}", round_up(x));
        }
        for high in [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 0.1, 0.015, 300.0] {
            let s = Scale { map: ColourMap::Sequential, high, beyond: 0.0 };
            let ticks = s.ticks();
            assert!((3..=5).contains(&ticks.len()), "{high}: {ticks:?}");
            assert!((ticks[ticks.len() - 1].value / high - 1.0).abs() < 1e-12 && ticks[0].value == 0.0);
        }
    }

    #[test]
    fn one_wild_patch_does_not_stretch_the_range() {
        let mut values = vec![0.01; 200];
        values[7] = -5.0;
        let s = Scale::symmetric(&field(&values), &[1.0; 200], 0.0);
        assert_eq!((s.high, s.low()), (0.01, -0.01));
        assert!((s.beyond - 0.005).abs() < 1e-12);
        assert_eq!(s.colour(-5.0), s.colour(-0.01));
        let values: Vec<f64> = s.ticks().iter().map(|t| t.value).collect();
        assert!(values.iter().zip([-0.01, -0.005, 0.0, 0.005, 0.01]).all(|(a, b)| (a - b).abs() < 1e-15), "{values:?}");
        assert_eq!(values[2], 0.0);
    }

    #[test]
    fn a_single_wrong_patch_shows_all_the_same_and_none_at_all_gives_a_range() {
        let mut values = vec![0.0; 200];
        values[7] = -5.0;
        assert_eq!(Scale::symmetric(&field(&values), &[1.0; 200], 0.0).high, 5.0);
        assert_eq!(Scale::from_zero(&field(&[0.0; 4]), &[1.0; 4]).high, 1.0);
        assert_eq!(Scale::from_zero(&Field { values: vec![None; 3] }, &[1.0; 3]).high, 1.0);
    }

    #[test]
    fn percentiles_weigh_by_area() {
        let pairs = [(1.0, 9.0), (2.0, 1.0)];
        assert_eq!(area_percentile(pairs, 0.9), Some(1.0));
        assert_eq!(area_percentile(pairs, 0.91), Some(2.0));
        assert_eq!(area_percentile([(f64::NAN, 1.0), (3.0, 0.0)], 0.5), None);
    }
}
