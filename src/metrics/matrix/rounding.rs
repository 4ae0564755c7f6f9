//! How the numbers of a file were rounded, read off the numbers.

use serde::{Deserialize, Serialize};

/// Files with more decimals hide nothing that matters.
const MOST_DECIMALS: i32 = 9;
/// Share of the last decimal by which products of doubles miss whole numbers.
const WHOLE: f64 = 1e-6;

/// What all values of a matrix have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rounding {
    /// Whole multiples of `10^-n`: n decimals, or counts of so many rays.
    Decimals(u8),
    /// Numbers of single precision.
    Single,
}

impl Rounding {
    /// The coarsest rounding that all values show; `None` where they show none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let finite = values.iter().copied().filter(|v| v.is_finite() && *v != 0.0);
        finite.clone().next()?;
        let whole = |v: f64, scale: f64| (v * scale - (v * scale).round()).abs() <= WHOLE;
        let decimals = (1..=MOST_DECIMALS).find(|d| finite.clone().all(|v| whole(v, 10f64.powi(*d))));
        let single = || finite.clone().all(|v| f64::from(v as f32) == v);
        decimals.map(|d| Self::Decimals(d as u8)).or_else(|| single().then_some(Self::Single))
    }

    /// Distance of the numbers that can be written next to `value`: rounding is off by half of it at most.
    pub fn step(self, value: f64) -> f64 {
        match self {
            Self::Decimals(d) => 10f64.powi(-i32::from(d)),
            Self::Single => value.abs() * f64::from(f32::EPSILON),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_shows() {
        assert_eq!(Rounding::of(&[0.199825, 0.200044, 0.0]), Some(Rounding::Decimals(6)));
        assert_eq!(Rounding::of(&[0.25, 0.5]), Some(Rounding::Decimals(2)));
        assert_eq!(Rounding::of(&[f64::from(0.199_824_9_f32), f64::from(1.0f32 / 3.0)]), Some(Rounding::Single));
        assert_eq!(Rounding::of(&[0.19982489569838738, 1.0 / 3.0]), None);
        assert_eq!(Rounding::of(&[0.0]), None);
        assert!((Rounding::Decimals(6).step(0.2) - 1e-6).abs() < 1e-18);
    }
}
