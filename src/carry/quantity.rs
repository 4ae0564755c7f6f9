//! What the numbers of a file mean, and the radiosities they stand for.

use crate::math::centroid;
use crate::scene::Stage;
use crate::solution::{MeshValues, Radiosity};
use std::f64::consts::PI;

/// What the numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quantity {
    /// Radiosity B, W/m^2, what a surface emits itself included.
    #[default]
    Radiosity,
    /// Reflected part of it, B - E.
    Reflected,
    /// Irradiance H, W/m^2: B = E + rho H.
    Irradiance,
    /// Radiance L, W/(m^2 sr), of a diffuse surface: B = pi L.
    Radiance,
}

/// How numbers were encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Transfer {
    /// As they are.
    #[default]
    Linear,
    /// By the curve of sRGB (IEC 61966-2-1), 0 to 1.
    Srgb,
}

/// A number that cannot be what it is said to be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {value} is no value of the sRGB curve, which are 0 to 1")]
pub struct UnitsError {
    /// Patch or face.
    pub place: String,
    /// The number.
    pub value: f64,
}

/// Files in single precision write 1 as a little more.
const ABOVE_ONE: f64 = 1e-6;

/// Linear value of an sRGB-encoded one.
fn from_srgb(x: f64) -> f64 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Its derivative.
fn from_srgb_slope(x: f64) -> f64 {
    if x <= 0.04045 { 1.0 / 12.92 } else { 2.4 / 1.055 * ((x + 0.055) / 1.055).powf(1.4) }
}

impl Transfer {
    /// Values of a mesh, decoded. Before they are carried: a mean of encoded values is not the encoded mean.
    ///
    /// # Errors
    /// If a value is outside of 0 to 1 and encoded by the curve of sRGB.
    pub fn decode_mesh(self, values: MeshValues) -> Result<MeshValues, UnitsError> {
        if self == Self::Linear {
            return Ok(values);
        }
        let mut decoded = MeshValues::new(values.bands.clone(), values.per());
        decoded.notices = values.notices.clone();
        for face in 0..values.len() {
            let place = || format!("face {face}, around {:.3?}", centroid(values.corners(face)).to_array());
            let linear: Result<Vec<f64>, UnitsError> = values.values(face).iter().map(|v| decode(*v, place)).collect();
            decoded.push(values.corners(face), &linear?);
        }
        Ok(decoded)
    }

    /// Values per patch, decoded; standard errors by the slope of the curve.
    ///
    /// # Errors
    /// As [`Transfer::decode_mesh`].
    pub fn decode(self, mut b: Radiosity) -> Result<Radiosity, UnitsError> {
        if self == Self::Linear {
            return Ok(b);
        }
        let bands = b.bands;
        if let Some(errors) = &mut b.std_err {
            errors.iter_mut().zip(&b.values).for_each(|(e, v)| *e *= from_srgb_slope(*v));
        }
        for (k, v) in b.values.iter_mut().enumerate() {
            *v = decode(*v, || format!("patch {}", k / bands))?;
        }
        Ok(b)
    }
}

fn decode(value: f64, place: impl Fn() -> String) -> Result<f64, UnitsError> {
    let valid = (0.0..=1.0 + ABOVE_ONE).contains(&value);
    if valid { Ok(from_srgb(value)) } else { Err(UnitsError { place: place(), value }) }
}

impl Quantity {
    /// Radiosities of the patches from `factor` times values of this quantity, standard errors along with them. Absent
    /// patches have 0.
    ///
    /// # Panics
    /// If patches or bands are not those of the stage, which is a mistake of the program.
    pub fn to_radiosity(self, values: &Radiosity, factor: f64, stage: &Stage) -> Radiosity {
        let (emission, reflectance) = (stage.emissions(), stage.reflectances());
        assert_eq!(values.values.len(), emission.len(), "values per patch and band");
        let slope = |k: usize| match self {
            Self::Radiosity | Self::Reflected => factor,
            Self::Irradiance => factor * reflectance[k],
            Self::Radiance => factor * PI,
        };
        let start = |k: usize| match self {
            Self::Radiosity | Self::Radiance => 0.0,
            Self::Reflected | Self::Irradiance => emission[k],
        };
        let scaled = |k: usize, v: &f64| if slope(k) == 1.0 { *v } else { slope(k) * v };
        let numbered = values.values.iter().enumerate();
        let errors = |e: &Vec<f64>| e.iter().enumerate().map(|(k, e)| scaled(k, e).abs()).collect();
        Radiosity {
            bands: values.bands,
            values: numbered.map(|(k, v)| start(k) + scaled(k, v)).collect(),
            std_err: values.std_err.as_ref().map(errors),
        }
    }
}

/// For each band of a scene the place of a file's band that holds it: by name; a single band, and bands that were
/// chosen one by one (`by_place`), by their order. `None` if they do not fit.
pub fn band_order(file: &[String], scene: &[String], by_place: bool) -> Option<Vec<usize>> {
    if file.len() != scene.len() {
        return None;
    }
    if by_place || scene.len() == 1 {
        return Some((0..scene.len()).collect());
    }
    scene.iter().map(|s| file.iter().position(|f| f == s)).collect()
}

/// The values of some bands, in this order.
pub fn select_bands(values: &MeshValues, order: &[usize]) -> MeshValues {
    let bands = values.bands.len();
    let names = order.iter().map(|k| values.bands[*k].clone()).collect();
    let mut selected = MeshValues::new(names, values.per());
    selected.notices = values.notices.clone();
    for face in 0..values.len() {
        let places = values.values(face).chunks(bands);
        let chosen: Vec<f64> = places.flat_map(|v| order.iter().map(|k| v[*k])).collect();
        selected.push(values.corners(face), &chosen);
    }
    selected
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;
    use crate::solution::ValuesPer;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|s| s.to_string()).collect()
    }

    #[test]
    fn the_curve_of_srgb_has_its_published_points() {
        // Grey 0.5 is 0.21404 (IEC 61966-2-1); the two branches meet; the slope is the slope.
        assert!((from_srgb(0.5) - 0.214_041_14).abs() < 1e-8);
        assert_eq!((from_srgb(0.0), from_srgb(1.0)), (0.0, 1.0));
        assert!((from_srgb(0.04045) - from_srgb(0.040_450_001)).abs() < 1e-7);
        for x in [0.01, 0.3, 0.9] {
            let slope = (from_srgb(x + 1e-6) - from_srgb(x - 1e-6)) / 2e-6;
            assert!((slope - from_srgb_slope(x)).abs() < 1e-6);
        }
    }

    #[test]
    fn encoded_values_outside_of_the_curve_are_refused_with_their_place() {
        let b = Radiosity { bands: 2, values: vec![0.1, 0.2, 0.3, 1.5], std_err: None };
        let e = Transfer::Srgb.decode(b.clone()).unwrap_err();
        assert_eq!((e.place.as_str(), e.value), ("patch 1", 1.5));
        assert_eq!(Transfer::Linear.decode(b.clone()).unwrap(), b);
        let mut m = MeshValues::new(names(&["y"]), ValuesPer::Face);
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        m.push(&triangle, &[0.5]);
        m.push(&triangle, &[-0.5]);
        assert!(Transfer::Srgb.decode_mesh(m).unwrap_err().place.starts_with("face 1, around [0.333"));
    }

    #[test]
    fn bands_by_name_by_choice_and_alone() {
        let rgb = names(&["r", "g", "b"]);
        assert_eq!(band_order(&names(&["b", "r", "g"]), &rgb, false), Some(vec![1, 2, 0]));
        assert_eq!(band_order(&names(&["x", "y", "z"]), &rgb, false), None);
        assert_eq!(band_order(&names(&["x", "y", "z"]), &rgb, true), Some(vec![0, 1, 2]));
        assert_eq!(band_order(&names(&["flux"]), &names(&["y"]), false), Some(vec![0]));
        assert_eq!(band_order(&names(&["y"]), &rgb, true), None);
    }
}
