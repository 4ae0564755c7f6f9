//! Colour maps that are even to the eye by construction: straight lines through OKLab, lightness linear in the value.
//!
//! OKLab is Ottosson's perceptual colour space (2020); its two published matrices are all that is used of it.

use crate::view::Response;

/// Red, green, blue of BT.709, linear light, 0 to 1.
pub type LinearRgb = [f64; 3];

/// The maps from values to colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark violet over red and orange to pale yellow, for amounts from 0 to 1.
    Sequential,
    /// Blue over near-white to red, for signed values from -1 to 1. Told apart by the colour-blind.
    Diverging,
}

/// (lightness, chroma, hue in degrees) at equal steps of the value.
const SEQUENTIAL: [[f64; 3]; 5] =
    [[0.16, 0.05, 285.0], [0.36, 0.145, 303.0], [0.56, 0.185, 10.0], [0.76, 0.145, 62.0], [0.96, 0.085, 103.0]];
/// The arms of the diverging map end here; both start at its middle. Equal lightness, equal chroma.
const MIDDLE: [f64; 3] = [0.975, 0.0, 0.0];
const BLUE: [f64; 3] = [0.43, 0.145, 256.0];
const RED: [f64; 3] = [0.43, 0.145, 26.0];

impl ColourMap {
    /// Colour of a value: 0 to 1 for the sequential map, -1 to 1 for the diverging one. Beyond, the end colour;
    /// NaN gets the colour of 0.
    pub fn colour(self, value: f64) -> LinearRgb {
        let lab = match self {
            Self::Sequential => {
                let last = SEQUENTIAL.len() - 1;
                let x = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) } * last as f64;
                let k = (x as usize).min(last - 1);
                mix(lab(SEQUENTIAL[k]), lab(SEQUENTIAL[k + 1]), x - k as f64)
            }
            Self::Diverging => {
                let end = if value < 0.0 { BLUE } else { RED };
                mix(lab(MIDDLE), lab(end), value.abs().min(1.0))
            }
        };
        oklab_to_linear(lab).map(|c| c.clamp(0.0, 1.0))
    }
}

/// OKLab of lightness, chroma and hue (degrees).
fn lab([lightness, chroma, hue]: [f64; 3]) -> [f64; 3] {
    let (sine, cosine) = hue.to_radians().sin_cos();
    [lightness, chroma * cosine, chroma * sine]
}

fn mix(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    let t = if t.is_nan() { 0.0 } else { t };
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * t)
}

fn oklab_to_linear([l, a, b]: [f64; 3]) -> LinearRgb {
    let cones = [
        l + 0.396_337_777_4 * a + 0.215_803_757_3 * b,
        l - 0.105_561_345_8 * a - 0.063_854_172_8 * b,
        l - 0.089_484_177_5 * a - 1.291_485_548_0 * b,
    ]
    .map(|c| c * c * c);
    [
        [4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2],
        [-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5],
        [-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0],
    ]
    .map(|row| row[0] * cones[0] + row[1] * cones[1] + row[2] * cones[2])
}

/// Eight-bit sRGB code (IEC 61966-2-1) of a linear value; what lies outside 0 to 1 is clamped.
pub fn to_srgb8(linear: f64) -> u8 {
    to_byte(Response::Srgb, linear)
}

/// The byte that drives a display of this response to a linear intensity (clamped to 0 to 1).
pub fn to_byte(response: Response, linear: f64) -> u8 {
    // A float-to-integer cast saturates and takes NaN to 0.
    (255.0 * response.value_of(linear).min(1.0)).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of the eight-bit colour that is stored in the end.
    fn luminance(rgb: LinearRgb) -> f64 {
        0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
    }

    fn lightness_steps(map: ColourMap, from: f64, to: f64) -> Vec<f64> {
        let at = |k: u32| luminance(map.colour(from + (to - from) * f64::from(k) / 64.0)).cbrt();
        (0..64).map(|k| at(k + 1) - at(k)).collect()
    }

    #[test]
    fn the_sequential_map_only_gets_brighter_and_evenly_so() {
        let steps = lightness_steps(ColourMap::Sequential, 0.0, 1.0);
        let (least, most) = steps.iter().fold((f64::MAX, f64::MIN), |(a, b), s| (a.min(*s), b.max(*s)));
        assert!(least > 0.0 && most < 2.5 * least, "{least} {most}");
    }

    #[test]
    fn both_arms_of_the_diverging_map_darken_alike() {
        for k in 0..=32 {
            let v = f64::from(k) / 32.0;
            let (minus, plus) = (luminance(ColourMap::Diverging.colour(-v)), luminance(ColourMap::Diverging.colour(v)));
            assert!((minus.cbrt() - plus.cbrt()).abs() < 0.06, "{v}: {minus} {plus}");
        }
        assert!(lightness_steps(ColourMap::Diverging, 0.0, 1.0).iter().all(|s| *s < 0.0));
        assert!(lightness_steps(ColourMap::Diverging, -1.0, 0.0).iter().all(|s| *s > 0.0));
        let [r, g, b] = ColourMap::Diverging.colour(0.0);
        assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6);
        assert!(ColourMap::Diverging.colour(-1.0)[2] > ColourMap::Diverging.colour(-1.0)[0]);
    }

    #[test]
    fn no_colour_leaves_the_gamut() {
        for points in [SEQUENTIAL.to_vec(), vec![MIDDLE, BLUE], vec![MIDDLE, RED]] {
            for pair in points.windows(2) {
                for t in (0..=16).map(|k| f64::from(k) / 16.0) {
                    let rgb = oklab_to_linear(mix(lab(pair[0]), lab(pair[1]), t));
                    assert!(rgb.iter().all(|c| (-2e-3..=1.002).contains(c)), "{pair:?} {t}: {rgb:?}");
                }
            }
        }
    }

    #[test]
    fn codes_of_the_srgb_curve() {
        // 0.5 encodes to 0.735357, 0.0031308 lies on the straight part.
        assert_eq!([0.0, 0.0031308, 0.5, 1.0, 7.0, f64::NAN].map(to_srgb8), [0, 10, 188, 255, 255, 0]);
    }
}
