//! Who looks at a picture, and on what: options that several commands share.

use crate::study::Onlooker;
use crate::view::{DEFAULT_EFFICACY, Display, Operator, Surround};
use clap::{Args, ValueEnum};

/// Options of natural colours.
#[derive(Debug, Clone, Args)]
pub struct ViewingArgs {
    /// The screen: srgb, crt or crt-uncorrected (those of 1993), or PEAK:CONTRAST:GAMMA (300:1000:2.2; peak in cd/m^2).
    #[arg(long, value_name = "SCREEN", default_value = "srgb")]
    pub display: Display,
    /// The light around the screen: what film and television choose their contrast by.
    #[arg(long, value_enum, default_value_t = SurroundChoice::Dim)]
    pub surround: SurroundChoice,
    /// Luminous efficacy of the light, lm/W: B W/m^2 of radiosity is a luminance of EFFICACY * B / pi cd/m^2.
    #[arg(long, value_name = "LM/W", default_value_t = Positive(DEFAULT_EFFICACY), allow_hyphen_values = true)]
    pub efficacy: Positive,
    /// Background that the eye in the scene is adapted to, cd/m^2; default: by the picture.
    #[arg(long, value_name = "CD/M2", allow_hyphen_values = true)]
    pub adapt: Option<Positive>,
}

/// The same with the operator.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Looking")]
pub struct LookingArgs {
    /// How luminances get to the screen: tr93-consistent (as the eye would see it), tr93 (the same as printed in 1993: dark),
    /// film, television or brightest.
    #[arg(long, value_name = "OPERATOR", default_value = "tr93-consistent")]
    pub tone: Operator,
    /// Screen and eye.
    #[command(flatten)]
    pub viewing: ViewingArgs,
}

impl ViewingArgs {
    /// Somebody who looks so.
    pub fn onlooker(&self, operator: Operator) -> Onlooker {
        Onlooker {
            operator,
            surround: match self.surround {
                SurroundChoice::Dark => Surround::Dark,
                SurroundChoice::Dim => Surround::Dim,
                SurroundChoice::Bright => Surround::Bright,
            },
            display: self.display.clone(),
            efficacy: self.efficacy.0,
            adapt: self.adapt.map(|a| a.0),
        }
    }
}

/// The light around a screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SurroundChoice {
    /// A dark room.
    Dark,
    /// A dim one.
    Dim,
    /// A bright one.
    Bright,
}

/// How natural colours are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToneChoice {
    /// As an eye would see it, by an operator.
    Operator(Operator),
    /// One linear scale.
    Linear,
}

impl std::str::FromStr for ToneChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "linear" {
            return Ok(Self::Linear);
        }
        text.parse().map(Self::Operator).map_err(|e| format!("{e} and linear"))
    }
}

/// A number above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Positive(pub f64);

impl std::str::FromStr for Positive {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let value = text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
        value.map(Self).ok_or_else(|| format!("\"{text}\" is not a number above 0"))
    }
}

impl std::fmt::Display for Positive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}
