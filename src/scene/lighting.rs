//! What is not a surface: lamps without extent, and points at which light is asked for.

use crate::math::DVec3;
use serde::{Deserialize, Serialize};

/// A lamp without extent. It shines through nothing and blocks nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointLight {
    /// Name given in the file.
    pub name: String,
    /// Where it is, metres.
    pub position: DVec3,
    /// Radiant intensity, W/sr per band (cd where the band is photometric): in every direction, or along the axis.
    pub intensity: Vec<f64>,
    /// How the intensity depends on the direction.
    pub distribution: Distribution,
}

/// How the intensity of a point light depends on the direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Distribution {
    /// Alike in all directions.
    Isotropic,
    /// The cosine of the angle to an axis (unit vector); nothing behind.
    Lambert(DVec3),
}

impl PointLight {
    /// The intensity towards `point` as a share of [`PointLight::intensity`], 0 to 1.
    pub fn share_towards(&self, point: DVec3) -> f64 {
        match self.distribution {
            Distribution::Isotropic => 1.0,
            Distribution::Lambert(axis) => (point - self.position).normalize_or_zero().dot(axis).max(0.0),
        }
    }

    /// Solid angle that the light fills, weighted with the share of its intensity, sr: its power per intensity.
    pub fn solid_angle(&self) -> f64 {
        match self.distribution {
            Distribution::Isotropic => 4.0 * std::f64::consts::PI,
            Distribution::Lambert(_) => std::f64::consts::PI,
        }
    }
}

/// A point with a direction at which the irradiance is asked for. It blocks nothing and reflects nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Receiver {
    /// Name given in the file.
    pub name: String,
    /// Where it is, metres.
    pub position: DVec3,
    /// Unit normal of the side that receives.
    pub normal: DVec3,
}
