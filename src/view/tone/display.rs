//! The display: which value has to be in the frame buffer for a luminance to be on the screen.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Where the straight part of the curve of sRGB ends, as light.
const SRGB_TOE: f64 = 0.003_130_8;

/// How a display turns frame-buffer values into light.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Response {
    /// `n^gamma`.
    Gamma(f64),
    /// The curve of IEC 61966-2-1.
    Srgb,
}

/// A display in its room [TR93 eq. 12].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Display {
    /// What it is called.
    pub name: String,
    /// Greatest luminance of the screen, cd/m^2.
    pub peak: f64,
    /// Greatest contrast: the peak over what the screen shows of the room's own light.
    pub contrast: f64,
    /// Frame buffer to light.
    pub response: Response,
}

/// What a display is to be driven with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Frame-buffer value before clipping; 0 where the screen cannot be as dark.
    pub value: f64,
    /// Light of the screen itself over its peak, before clipping; below 0 where even black is too bright.
    pub light: f64,
}

impl Drive {
    /// Frame-buffer value, 0 to 1.
    pub fn shown(&self) -> f64 {
        self.value.clamp(0.0, 1.0)
    }

    /// True where the screen cannot be as dark.
    pub fn is_black(&self) -> bool {
        self.light <= 0.0
    }

    /// True where it cannot be as bright.
    pub fn is_white(&self) -> bool {
        self.value > 1.0
    }
}

impl Response {
    /// Frame-buffer value for light of the screen itself, over its peak; 0 below 0, above 1 beyond the peak.
    pub fn value_of(self, light: f64) -> f64 {
        match self {
            // Not a number counts as no light.
            _ if light.is_nan() || light <= 0.0 => 0.0,
            Self::Gamma(gamma) => light.powf(1.0 / gamma),
            Self::Srgb if light <= SRGB_TOE => 12.92 * light,
            Self::Srgb => 1.055 * light.powf(1.0 / 2.4) - 0.055,
        }
    }

    /// Light of the screen itself, over its peak, for a frame-buffer value of 0 or more.
    pub fn light(self, value: f64) -> f64 {
        match self {
            Self::Gamma(gamma) => value.powf(gamma),
            Self::Srgb if value <= 12.92 * SRGB_TOE => value / 12.92,
            Self::Srgb => ((value + 0.055) / 1.055).powf(2.4),
        }
    }
}

impl Display {
    /// The paper's, with television's gamma: 86 cd/m^2, contrast 35, gamma 1.2.
    pub fn crt() -> Self {
        Self { name: "crt".into(), peak: 86.0, contrast: 35.0, response: Response::Gamma(1.2) }
    }

    /// The paper's without correction: gamma 2.9.
    pub fn crt_uncorrected() -> Self {
        Self { name: "crt-uncorrected".into(), response: Response::Gamma(2.9), ..Self::crt() }
    }

    /// The reference display of sRGB in its reference room: 80 cd/m^2, 1 % of flare.
    pub fn srgb() -> Self {
        Self { name: "srgb".into(), peak: 80.0, contrast: 100.0, response: Response::Srgb }
    }

    /// The frame-buffer value that shows a luminance (cd/m^2) [TR93 eq. 12].
    pub fn drive(&self, luminance: f64) -> Drive {
        let light = luminance / self.peak - 1.0 / self.contrast;
        Drive { value: self.response.value_of(light), light }
    }

    /// Luminance of the screen for a frame-buffer value of 0 or more, cd/m^2.
    pub fn luminance(&self, value: f64) -> f64 {
        self.peak * (self.response.light(value) + 1.0 / self.contrast)
    }

    /// The middle of what it can show, on a logarithmic scale, cd/m^2: what its viewer is adapted to [TR93 eq. 14].
    pub fn adapts_to(&self) -> f64 {
        self.peak / self.contrast.sqrt()
    }
}

impl fmt::Display for Display {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let curve = match self.response {
            Response::Gamma(gamma) => format!("gamma {gamma}"),
            Response::Srgb => "the curve of sRGB".into(),
        };
        write!(f, "{} ({} cd/m\u{b2}, contrast {}, {curve})", self.name, self.peak, self.contrast)
    }
}

impl FromStr for Display {
    type Err = String;

    /// `srgb`, `crt`, `crt-uncorrected`, or `PEAK:CONTRAST:GAMMA` (`300:1000:2.2`; GAMMA may be `srgb`).
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "\"{text}\" is no display: write srgb, crt, crt-uncorrected, or PEAK:CONTRAST:GAMMA with the peak in \
                 cd/m^2, a contrast above 1 and a gamma above 0 or srgb (300:1000:2.2)"
            )
        };
        match text {
            "srgb" => return Ok(Self::srgb()),
            "crt" => return Ok(Self::crt()),
            "crt-uncorrected" => return Ok(Self::crt_uncorrected()),
            _ => {}
        }
        let parts: Vec<&str> = text.split(':').collect();
        let &[peak, contrast, gamma] = parts.as_slice() else { return Err(wrong()) };
        let number = |t: &str, least: f64| t.parse().ok().filter(|x: &f64| x.is_finite() && *x > least);
        let response = match gamma {
            "srgb" => Some(Response::Srgb),
            _ => number(gamma, 0.0).map(Response::Gamma),
        };
        match (number(peak, 0.0), number(contrast, 1.0), response) {
            (Some(peak), Some(contrast), Some(response)) => Ok(Self { name: text.into(), peak, contrast, response }),
            _ => Err(wrong()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_screen() {
        let crt = Display::crt();
        // n = 1 takes the screen's own peak and the room's light on it.
        assert!((crt.drive(88.457_142_857_142_86).value - 1.0).abs() < 1e-12);
        assert!((crt.drive(86.0).value - 0.976_133).abs() < 1e-6);
        let below = crt.drive(2.0);
        assert!(below.is_black() && below.value == 0.0 && below.light < 0.0);
        assert!(crt.drive(100.0).is_white() && crt.drive(100.0).shown() == 1.0);
        assert!((crt.adapts_to() - 14.536_653_18).abs() < 1e-8);
    }

    #[test]
    fn light_and_value_are_each_others_inverse() {
        for display in [Display::crt(), Display::crt_uncorrected(), Display::srgb()] {
            for n in [0.0, 1e-3, 0.03, 0.2, 0.7, 1.0, 1.3] {
                let back = display.drive(display.luminance(n)).value;
                assert!((back - n).abs() < 1e-7, "{display} {n} {back}");
            }
        }
    }

    #[test]
    fn displays_are_read_by_name_and_by_number() {
        assert_eq!("crt".parse(), Ok(Display::crt()));
        let own: Display = "300:1000:2.2".parse().unwrap();
        assert_eq!((own.peak, own.contrast, own.response), (300.0, 1000.0, Response::Gamma(2.2)));
        assert_eq!("300:1000:srgb".parse::<Display>().unwrap().response, Response::Srgb);
        for bad in ["", "lcd", "300", "300:1:2.2", "0:10:2", "300:10:0", "300:10:x", "nan:10:2", "inf:10:2", "1:2:3:4"]
        {
            assert!(bad.parse::<Display>().is_err(), "{bad}");
        }
    }
}
