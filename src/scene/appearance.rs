//! What only the display stage knows: lamps of every kind, fog, backgrounds, textures, trees.
//!
//! Form factors and radiosities take no part in it; the materials of a scene stay what they are.

use super::Distribution;
use crate::math::DVec3;
use serde::{Deserialize, Serialize};

/// Everything that a picture shows beyond surfaces and their radiosity. Data only.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Appearance {
    /// Lights in file order.
    pub lights: Vec<Light>,
    /// Fog over everything that stands there.
    pub fog: Option<Fog>,
    /// What is seen where nothing stands.
    pub background: Background,
    /// Finishes by the name of the material that has them.
    pub finishes: Vec<Finish>,
    /// Pictures on transparent polygons that turn to whoever looks.
    pub trees: Vec<Tree>,
    /// Pictures that finishes, trees and backgrounds refer to by number.
    pub pictures: Vec<Picture>,
}

/// A light of the display stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Name given in the file.
    pub name: String,
    /// Its strength per band, in the unit of its kind.
    pub strength: Vec<f64>,
    /// Its shape.
    pub shape: LightShape,
}

/// The shape of a light, and what its strength is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "type")]
pub enum LightShape {
    /// Light from one direction, as of the sun. Strength: irradiance on a surface that faces it, W/m^2.
    Parallel {
        /// Unit vector along which the light travels.
        direction: DVec3,
    },
    /// A point. Strength: radiant intensity, W/sr, in every direction, along the axis, or where the curve is 1.
    Point {
        /// Where it is, metres.
        position: DVec3,
        /// How the intensity depends on the direction.
        distribution: Distribution,
        /// A luminous intensity curve about an axis, times the distribution.
        curve: Option<IntensityCurve>,
    },
    /// A thin straight tube that shines by Lambert's law about its axis. Strength: intensity per length, at right angles
    /// to the tube, W/(m sr); towards a direction at angle t to the tube it is that times sin t.
    Linear {
        /// One end, metres.
        from: DVec3,
        /// The other end.
        to: DVec3,
    },
    /// A planar convex polygon that shines to its front. Strength: radiosity, W/m^2.
    Area {
        /// Corners, counter-clockwise seen from where it shines.
        polygon: Vec<DVec3>,
    },
    /// Planar convex polygons, each of which shines to its front: a lamp with a body. Strength: radiosity, W/m^2.
    Polyhedron {
        /// Faces, counter-clockwise seen from outside.
        faces: Vec<Vec<DVec3>>,
    },
    /// The sky, infinitely far, above the horizontal plane of `up`. Strength: radiance at the zenith, W/(m^2 sr).
    Sky {
        /// How the radiance depends on the direction.
        model: SkyModel,
        /// Unit vector to the zenith.
        up: DVec3,
    },
}

/// Radiance of the sky relative to the zenith.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SkyModel {
    /// The same everywhere.
    Uniform,
    /// CIE overcast sky: (1 + 2 sin(elevation)) / 3.
    Overcast,
    /// CIE clear sky (Kittler): a function of elevation and of the angle to the sun; no sun disc in it.
    Clear {
        /// Unit vector to the sun.
        sun: DVec3,
    },
}

/// Relative intensity against the angle to an axis, linear between samples, nothing beyond the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IntensityCurve {
    /// Unit vector of the axis.
    pub axis: DVec3,
    /// Angles to the axis, degrees, ascending from 0 to at most 180, each with a factor of at least 0.
    pub samples: Vec<(f64, f64)>,
}

/// Fog: what is seen through a length d of it is weighted with exp(-extinction d), the fog with the rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fog {
    /// Extinction, 1/m.
    pub extinction: f64,
    /// Radiance of endless fog, W/(m^2 sr) per band.
    pub radiance: Vec<f64>,
    /// Distance of the background, m; `None` leaves it out of the fog.
    pub background_at: Option<f64>,
}

/// What is seen where nothing stands.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Background {
    /// Radiance, W/(m^2 sr) per band; empty is none.
    pub radiance: Vec<f64>,
    /// A picture stretched over the view; its white has `radiance`.
    pub picture: Option<usize>,
    /// Adds the radiance of the lights that are skies.
    pub sky: bool,
    /// Clouds before it.
    pub clouds: Option<Clouds>,
}

/// A picture with transparency on an endless horizontal plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Clouds {
    /// Index into [`Appearance::pictures`].
    pub picture: usize,
    /// Height of the plane over the eye, metres; along the zenith of the sky among the lights, else z.
    pub height: f64,
    /// Breadth and depth of one repeat, metres.
    pub tile: [f64; 2],
    /// Radiance of the picture's white, W/(m^2 sr) per band.
    pub radiance: Vec<f64>,
}

/// What a material shows beyond its reflectance.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Finish {
    /// Name of the material.
    pub material: String,
    /// Reflectance is the material's times this colour.
    pub colour: Option<Texture>,
    /// Tilts the normal: white is `bump_height` above black.
    pub bump: Option<Texture>,
    /// Height of white over black, m.
    pub bump_height: f64,
    /// Share that is mirrored, 0 to 1; that of the rest is what is left.
    pub reflection: f64,
    /// Mirrored share times this picture's luminance.
    pub reflection_map: Option<Texture>,
    /// Share that goes through, 0 to 1.
    pub transparency: f64,
    /// Share that goes through times this picture's luminance.
    pub transparency_map: Option<Texture>,
    /// Refractive index of what is behind the front; 1 goes straight on.
    pub refraction: f64,
}

/// A picture repeated over surfaces, lying along world axes: on a wall its rows run level, on a floor along x.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Texture {
    /// Index into [`Appearance::pictures`].
    pub picture: usize,
    /// Where a lower left corner of the picture lies, metres.
    pub origin: DVec3,
    /// Breadth and height of one repeat, metres.
    pub tile: [f64; 2],
}

/// A picture on a polygon that stands upright and turns to the eye, to the light, to the mirror.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tree {
    /// Name given in the file.
    pub name: String,
    /// Object it belongs to.
    pub object: String,
    /// Middle of its lower edge, metres.
    pub foot: DVec3,
    /// Unit vector along its trunk.
    pub up: DVec3,
    /// Breadth and height, metres.
    pub size: [f64; 2],
    /// Index into [`Appearance::pictures`]: its colour is the reflectance.
    pub picture: usize,
}

/// A picture in memory: sRGB colour with transparency, rows from the top.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Name of the file it came from.
    pub name: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Red, green, blue, opacity; 4 bytes a pixel.
    #[serde(skip)]
    pub rgba: Vec<u8>,
}

impl Appearance {
    /// Unit vector to the zenith: that of the first sky among the lights, else z. Clouds and horizons keep to it, whichever way
    /// a camera is held.
    pub fn zenith(&self) -> DVec3 {
        let up = self.lights.iter().find_map(|l| match l.shape {
            LightShape::Sky { up, .. } => Some(up),
            _ => None,
        });
        up.unwrap_or(DVec3::Z)
    }

    /// The finish of a material, if it has one.
    pub fn finish(&self, material: &str) -> Option<&Finish> {
        self.finishes.iter().find(|f| f.material == material)
    }
}
