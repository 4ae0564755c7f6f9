//! Values of options: fractions and percentages, spans of time, states.

use clap::ValueEnum;
use std::str::FromStr;
use std::time::Duration;

/// A fraction >= 0, written 0.05 or 5%.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fraction(pub f64);

impl FromStr for Fraction {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is not a fraction >= 0: write 0.05 or 5%");
        let (number, scale) = match text.strip_suffix('%') {
            Some(percent) => (percent.trim(), 0.01),
            None => (text, 1.0),
        };
        let value: f64 = number.parse().map_err(|_| wrong())?;
        if value.is_finite() && value >= 0.0 { Ok(Self(value * scale)) } else { Err(wrong()) }
    }
}

/// A span of time: 90s, 5m, 1h, 500ms; a bare number is seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span(pub Duration);

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is not a span of time: write 90s, 5m or 1h");
        let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
        let value: f64 = text[..split].trim().parse().map_err(|_| wrong())?;
        let unit = match &text[split..] {
            "ms" => 1e-3,
            "" | "s" => 1.0,
            "m" | "min" => 60.0,
            "h" => 3600.0,
            _ => return Err(wrong()),
        };
        Duration::try_from_secs_f64(value * unit).ok().filter(|d| !d.is_zero()).map(Self).ok_or_else(wrong)
    }
}

/// A state of a scene with edits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateChoice {
    /// Before the first edit.
    Initial,
    /// After so many edits.
    After(usize),
    /// After the last edit.
    Final,
}

impl FromStr for StateChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "initial" => Ok(Self::Initial),
            "final" => Ok(Self::Final),
            k => k
                .parse()
                .map(Self::After)
                .map_err(|_| format!("\"{k}\" is not a state: write initial, final, or the number of edits applied")),
        }
    }
}

/// Level of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PerLevel {
    /// One value per patch.
    Patch,
    /// One value per element.
    Element,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_and_spans() {
        assert_eq!("5%".parse::<Fraction>().unwrap().0, 0.05);
        assert_eq!("0.05".parse::<Fraction>().unwrap().0, 0.05);
        for bad in ["-1", "x", "nan", "%", "inf"] {
            assert!(bad.parse::<Fraction>().is_err(), "{bad}");
        }
        assert_eq!("90s".parse::<Span>().unwrap().0, Duration::from_secs(90));
        assert_eq!("5m".parse::<Span>().unwrap().0, Duration::from_secs(300));
        for bad in ["", "s", "5 parsecs", "-1s", "0s", "1e300h"] {
            assert!(bad.parse::<Span>().is_err(), "{bad}");
        }
    }
}
