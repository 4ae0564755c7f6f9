//! A solution as another program wrote it: on its own mesh, in its own units.

use crate::carry::{Quantity, Transfer};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// What a solution brings along.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "A solution on a mesh of its own, or in other units")]
pub struct BroughtArgs {
    /// What its numbers are: radiosity B; reflected, B - E; irradiance H (B = E + rho H); radiance L (B = pi L).
    #[arg(long, value_enum, default_value_t = QuantityName::Radiosity)]
    pub quantity: QuantityName,
    /// Times this number: an exposure taken back.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_hyphen_values = true)]
    pub factor: f64,
    /// How they are encoded.
    #[arg(long, value_enum, default_value_t = TransferName::Linear)]
    pub transfer: TransferName,
    /// Table with the values of an OBJ, PLY or glTF mesh: face,<band>,... or vertex,<band>,..., counted from 0.
    #[arg(long, value_name = "FILE")]
    pub values: Option<PathBuf>,
    /// Mesh with texture coordinates that an EXR lightmap belongs to.
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Names of the properties, arrays, channels or columns that hold the values, in the order of the scene's bands.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    pub fields: Vec<String>,
    /// Unit of length of its mesh; default m.
    #[arg(long, value_name = "m|cm|mm|ft|in|METRES", allow_hyphen_values = true)]
    pub units: Option<LengthUnit>,
    /// Axis that points up in its mesh; default y for glTF, z for all others.
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    /// How far the nearest face may be where no face lies in the plane of a patch; default: a tenth of the patch's
    /// diameter, at most a hundredth of the scene's.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    pub reach: Option<f64>,
    /// Leave out patches that no face gives a value to, and say how much of the area they hold.
    #[arg(long)]
    pub skip_unmatched: bool,
}

impl BroughtArgs {
    /// True if any of these options was given.
    pub fn changes_anything(&self) -> bool {
        let units = (self.quantity, self.transfer, self.factor);
        units != (QuantityName::Radiosity, TransferName::Linear, 1.0)
            || [&self.values, &self.mesh].iter().any(|path| path.is_some())
            || !self.fields.is_empty()
            || self.units.is_some()
            || self.up.is_some()
            || self.reach.is_some()
            || self.skip_unmatched
    }
}

/// Quantities by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum QuantityName {
    /// B, W/m^2, emission included.
    Radiosity,
    /// B - E, W/m^2.
    Reflected,
    /// H, W/m^2.
    Irradiance,
    /// L, W/(m^2 sr).
    Radiance,
}

impl From<QuantityName> for Quantity {
    fn from(name: QuantityName) -> Self {
        match name {
            QuantityName::Radiosity => Self::Radiosity,
            QuantityName::Reflected => Self::Reflected,
            QuantityName::Irradiance => Self::Irradiance,
            QuantityName::Radiance => Self::Radiance,
        }
    }
}

/// Encodings by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TransferName {
    /// None.
    Linear,
    /// The curve of sRGB, 0 to 1.
    Srgb,
}

impl From<TransferName> for Transfer {
    fn from(name: TransferName) -> Self {
        match name {
            TransferName::Linear => Self::Linear,
            TransferName::Srgb => Self::Srgb,
        }
    }
}

/// The axis that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Up {
    /// y, as in glTF.
    Y,
    /// z, as in scenes.
    Z,
}

/// A unit of length, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthUnit(pub f64);

impl FromStr for LengthUnit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let metres = match text {
            "m" => 1.0,
            "cm" => 0.01,
            "mm" => 0.001,
            "ft" => 0.3048,
            "in" => 0.0254,
            number => number.parse().unwrap_or(f64::NAN),
        };
        let usable = metres.is_finite() && metres > 0.0;
        usable.then_some(Self(metres)).ok_or_else(|| {
            format!("\"{text}\" is not a unit of length: write m, cm, mm, ft, in, or its length in metres")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_by_name_and_by_length() {
        for (text, metres) in [("mm", 0.001), ("ft", 0.3048), ("0.0254", 0.0254)] {
            assert_eq!(text.parse(), Ok(LengthUnit(metres)));
        }
        assert!(["", "yard", "0", "-1", "nan", "inf"].iter().all(|bad| bad.parse::<LengthUnit>().is_err()));
    }
}
