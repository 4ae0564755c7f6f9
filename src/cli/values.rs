//! Values of options: fractions and percentages, spans of time, states.

use crate::math::DVec3;
use clap::ValueEnum;
use std::path::PathBuf;
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

/// Width and height of a picture, written 640x480.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pixels(pub [u32; 2]);

/// Largest width and height of a picture, pixels.
const MOST_PIXELS: u32 = 16_384;

impl FromStr for Pixels {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |s: &str| s.parse().ok().filter(|n| (1..=MOST_PIXELS).contains(n));
        let size = text.split_once(['x', 'X']).and_then(|(w, h)| Some(Self([side(w)?, side(h)?])));
        size.ok_or_else(|| {
            format!("\"{text}\" is not a size: write WIDTHxHEIGHT in pixels (640x480), at most {MOST_PIXELS} each")
        })
    }
}

/// Three numbers, written X,Y,Z: a place in metres, or a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triple(pub DVec3);

impl FromStr for Triple {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> =
            text.split(',').map(|s| s.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match numbers.as_deref() {
            Some([x, y, z]) => Ok(Self(DVec3::new(*x, *y, *z))),
            _ => Err(format!("\"{text}\" is not three numbers: write X,Y,Z (1.5,0,2)")),
        }
    }
}

/// A folder with the name it goes by, written NAME=DIR.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedFolder {
    /// What it is called.
    pub name: String,
    /// Where it is.
    pub folder: PathBuf,
}

impl FromStr for NamedFolder {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').filter(|(name, folder)| !name.trim().is_empty() && !folder.is_empty());
        let (name, folder) = parts.ok_or_else(|| format!("\"{text}\" is not NAME=DIR: write mine=runs/mine"))?;
        Ok(Self { name: name.trim().into(), folder: folder.into() })
    }
}

/// What a picture in false colours shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Quantity {
    /// Luminance.
    Luminance,
    /// Standard error of the luminance.
    StdErr,
    /// The same as a share of the luminance.
    RelativeStdErr,
    /// Radiosity in one band.
    Band(String),
}

impl FromStr for Quantity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.strip_prefix("band:")) {
            ("luminance", _) => Ok(Self::Luminance),
            ("std-err", _) => Ok(Self::StdErr),
            ("relative-std-err", _) => Ok(Self::RelativeStdErr),
            (_, Some(name)) if !name.is_empty() => Ok(Self::Band(name.into())),
            _ => Err(format!("\"{text}\" is not a quantity: write luminance, std-err, relative-std-err or band:NAME")),
        }
    }
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Luminance => f.write_str("luminance"),
            Self::StdErr => f.write_str("std-err"),
            Self::RelativeStdErr => f.write_str("relative-std-err"),
            Self::Band(name) => write!(f, "band:{name}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_quantities() {
        assert_eq!("640x480".parse(), Ok(Pixels([640, 480])));
        for bad in ["640", "0x10", "-1x5", "10x20x30", "99999x1", "x", "640 x 480"] {
            assert!(bad.parse::<Pixels>().is_err(), "{bad}");
        }
        for good in ["luminance", "std-err", "relative-std-err", "band:450 nm"] {
            assert_eq!(good.parse::<Quantity>().unwrap().to_string(), good);
        }
        assert!("band:".parse::<Quantity>().is_err() && "r".parse::<Quantity>().is_err());
    }

    #[test]
    fn named_folders() {
        let named: NamedFolder = "mine=runs/a=b".parse().unwrap();
        assert_eq!((named.name.as_str(), named.folder), ("mine", PathBuf::from("runs/a=b")));
        assert!(["mine", "=runs", "mine=", ""].iter().all(|bad| bad.parse::<NamedFolder>().is_err()));
    }

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
