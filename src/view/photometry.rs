//! From bands to luminance.

use serde::{Deserialize, Serialize};

/// Names of the bands and what each weighs in luminance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Photometry {
    /// Band names.
    pub bands: Vec<String>,
    /// Luminance weight of each band.
    pub weights: Vec<f64>,
}

/// The sets of primaries whose luminance weights are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Primaries {
    /// ITU-R BT.709 / sRGB.
    Rec709,
    /// ITU-R BT.2020.
    Rec2020,
    /// CIE XYZ: luminance is Y alone.
    Xyz,
    /// One band of weight 1.
    Mono,
}

impl Primaries {
    /// Luminance weights, one per band: the Y row of the primaries' matrix to XYZ (white D65).
    pub fn weights(self) -> &'static [f64] {
        match self {
            Primaries::Rec709 => &[0.212_639_005_871_510, 0.715_168_678_767_756, 0.072_192_315_360_733_5],
            Primaries::Rec2020 => &[0.262_700_212_011_267, 0.677_998_071_518_871, 0.059_301_716_469_862_1],
            Primaries::Xyz => &[0.0, 1.0, 0.0],
            Primaries::Mono => &[1.0],
        }
    }
}

impl Photometry {
    /// Red, green and blue of ITU-R BT.709.
    pub fn rec709() -> Self {
        Self { bands: ["r", "g", "b"].map(String::from).to_vec(), weights: Primaries::Rec709.weights().to_vec() }
    }

    /// Luminance of one set of band values.
    pub fn luminance(&self, values: &[f64]) -> f64 {
        self.weights.iter().zip(values).map(|(w, v)| w * v).sum()
    }
}
