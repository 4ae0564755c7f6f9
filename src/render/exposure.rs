//! From radiosities to the screen: one linear scale, then the sRGB curve.
//!
//! Plain on purpose: equal radiosities look equal in every picture of a run, and nothing depends on the eye.

use super::LinearRgb;
use super::area_percentile;
use crate::view::{Photometry, Primaries};

/// Share of the reflecting area that stays below the display's white.
const SHARE: f64 = 0.99;

/// How bands become display colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DisplayColour {
    /// Three bands through a matrix to linear BT.709.
    Matrix([[f64; 3]; 3]),
    /// Luminance, shown grey.
    Grey,
}

/// The scale that all pictures of a run share.
#[derive(Debug, Clone, PartialEq)]
pub struct Exposure {
    /// Display value per unit of radiosity, m^2/W.
    pub scale: f64,
    /// Luminance that is shown as the display's white, W/m^2.
    pub white_luminance: f64,
    colour: DisplayColour,
    weights: Vec<f64>,
}

impl DisplayColour {
    /// By luminance weights, the only thing known of the bands; three bands called r, g, b are taken for BT.709.
    pub fn of(photometry: &Photometry) -> Self {
        let is = |p: Primaries| photometry.weights == p.weights();
        let named_rgb = photometry.bands.iter().map(|b| b.to_lowercase()).eq(["r", "g", "b"].map(String::from));
        if is(Primaries::Xyz) {
            Self::Matrix(XYZ_TO_BT709)
        } else if is(Primaries::Rec2020) {
            Self::Matrix(BT2020_TO_BT709)
        } else if is(Primaries::Rec709) || named_rgb {
            Self::Matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        } else {
            Self::Grey
        }
    }

    /// Linear BT.709 of one set of bands, in their unit; grey is their luminance.
    pub(super) fn rgb(self, weights: &[f64], bands: &[f64]) -> LinearRgb {
        match (self, bands) {
            (Self::Matrix(m), &[r, g, b]) => m.map(|row| row[0] * r + row[1] * g + row[2] * b),
            _ => [weights.iter().zip(bands).map(|(w, v)| w * v).sum(); 3],
        }
    }
}

const XYZ_TO_BT709: [[f64; 3]; 3] = [
    [3.240_969_941_9, -1.537_383_177_6, -0.498_610_760_3],
    [-0.969_243_636_3, 1.875_967_501_5, 0.041_555_057_4],
    [0.055_630_079_7, -0.203_976_958_9, 1.056_971_514_2],
];
const BT2020_TO_BT709: [[f64; 3]; 3] = [
    [1.660_491_002_1, -0.587_641_138_8, -0.072_849_863_3],
    [-0.124_550_474_5, 1.132_899_897_1, -0.008_349_422_6],
    [-0.018_150_763_4, -0.100_578_898_0, 1.118_729_661_4],
];

impl Exposure {
    /// Fits the scale: of the reflecting area, 99 % comes out at or below the display's white. Lamps may burn out. Where every patch is a lamp, or all that reflects is dark, the lamps count too.
    ///
    /// `luminances`, `areas` and `is_emitter` have one entry per patch, the luminances those of the reference.
    pub fn fit(photometry: &Photometry, luminances: &[f64], areas: &[f64], is_emitter: &[bool]) -> Self {
        let among = |lamps_too: bool| {
            let kept = |i: &usize| lamps_too || !is_emitter[*i];
            let pairs = (0..luminances.len()).filter(kept).map(|i| (luminances[i], areas[i]));
            area_percentile(pairs, SHARE).filter(|y| *y > 0.0)
        };
        let white_luminance = among(false).or_else(|| among(true)).unwrap_or(1.0);
        Self {
            scale: 1.0 / white_luminance,
            white_luminance,
            colour: DisplayColour::of(photometry),
            weights: photometry.weights.clone(),
        }
    }

    /// The same scale with another white: `stops` of 1 shows everything twice as bright, -1 half as bright.
    pub fn brighter(self, stops: f64) -> Self {
        let white = self.white_luminance / stops.exp2();
        self.with_white(white)
    }

    /// The same with this luminance, W/m^2 and above 0, shown white.
    pub fn with_white(self, white_luminance: f64) -> Self {
        Self { scale: 1.0 / white_luminance, white_luminance, ..self }
    }

    /// Display colour, linear, of one patch's radiosities (one per band); clamped to 0 to 1.
    pub fn display(&self, radiosity: &[f64]) -> LinearRgb {
        self.linear(radiosity).map(|c| c.clamp(0.0, 1.0))
    }

    /// The same before clamping: colours that are mixed or interpolated are clamped afterwards.
    pub fn linear(&self, radiosity: &[f64]) -> LinearRgb {
        self.colour.rgb(&self.weights, radiosity).map(|c| c * self.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lamp_does_not_set_the_exposure() {
        let p = Photometry::rec709();
        let e = Exposure::fit(&p, &[100.0, 0.5, 0.25], &[1.0, 1.0, 1.0], &[true, false, false]);
        assert_eq!(e.white_luminance, 0.5);
        let shown = e.display(&[0.5, 0.5, 0.5]);
        assert!((shown[1] - 1.0).abs() < 1e-12);
        assert!((e.display(&[0.25; 3])[1] - 0.5).abs() < 1e-12);
        assert_eq!(e.display(&[100.0; 3]), [1.0; 3]);
    }

    #[test]
    fn a_scene_of_lamps_and_a_dark_scene_still_have_an_exposure() {
        let p = Photometry::rec709();
        assert_eq!(Exposure::fit(&p, &[2.0, 2.0], &[1.0, 1.0], &[true, true]).white_luminance, 2.0);
        assert_eq!(Exposure::fit(&p, &[0.0, 0.0], &[1.0, 1.0], &[false, false]).scale, 1.0);
    }

    #[test]
    fn white_stays_white_in_every_set_of_primaries() {
        for (primaries, white) in [(Primaries::Rec2020, [1.0, 1.0, 1.0]), (Primaries::Xyz, [0.950_456, 1.0, 1.089_058])]
        {
            let p = Photometry { bands: vec!["a".into(); 3], weights: primaries.weights().to_vec() };
            let e = Exposure::fit(&p, &[1.0], &[1.0], &[false]);
            let shown = e.display(&white);
            assert!(shown.iter().all(|c| (c - 1.0).abs() < 1e-4), "{primaries:?} {shown:?}");
        }
        let mono = Photometry { bands: vec!["y".into()], weights: vec![1.0] };
        assert_eq!(Exposure::fit(&mono, &[1.0], &[1.0], &[false]).display(&[0.5]), [0.5; 3]);
    }
}
