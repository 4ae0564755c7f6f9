//! What only pictures show, as TOML: keys of scene files and of lighting files.

use super::raw::Numbers;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, IgnoredAny, MapAccess, Visitor};
use std::fmt;
use toml::Spanned;

type Point = Spanned<Vec<f64>>;
pub(super) type Outline = Spanned<Vec<Spanned<Vec<f64>>>>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightingFile {
    #[serde(rename = "format")]
    pub _format: IgnoredAny,
    pub light: Option<Vec<Light>>,
    pub fog: Option<Fog>,
    pub background: Option<Background>,
    #[serde(default)]
    pub finish: Vec<Finish>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Light {
    pub name: Option<Spanned<String>>,
    #[serde(rename = "type")]
    pub kind: Spanned<String>,
    pub position: Option<Point>,
    pub intensity: Option<Spanned<Numbers>>,
    pub distribution: Option<Spanned<String>>,
    pub direction: Option<Point>,
    pub curve: Option<Spanned<Vec<Spanned<Vec<f64>>>>>,
    pub irradiance: Option<Spanned<Numbers>>,
    pub from: Option<Point>,
    pub to: Option<Point>,
    pub polygon: Option<Outline>,
    pub faces: Option<Spanned<Vec<Outline>>>,
    pub surface: Option<Spanned<String>>,
    pub object: Option<Spanned<String>>,
    pub radiosity: Option<Spanned<Numbers>>,
    pub model: Option<Spanned<String>>,
    pub radiance: Option<Spanned<Numbers>>,
    pub sun: Option<Point>,
    pub up: Option<Point>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [fog] with extinction and radiance")]
pub(super) struct Fog {
    pub extinction: Spanned<f64>,
    pub radiance: Spanned<Numbers>,
    pub background_at: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [background]")]
pub(super) struct Background {
    pub radiance: Option<Spanned<Numbers>>,
    pub picture: Option<Spanned<String>>,
    pub sky: Option<bool>,
    pub clouds: Option<Clouds>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { picture, height, tile, radiance }")]
pub(super) struct Clouds {
    pub picture: Spanned<String>,
    pub height: Spanned<f64>,
    pub tile: Point,
    pub radiance: Spanned<Numbers>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tree {
    pub name: Spanned<String>,
    pub object: Option<Spanned<String>>,
    pub foot: Point,
    pub size: Point,
    pub picture: Spanned<String>,
    pub up: Option<Point>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Finish {
    pub material: Spanned<String>,
    pub texture: Option<Texture>,
    pub bump: Option<Bump>,
    pub reflection: Option<Spanned<Share>>,
    pub transparency: Option<Spanned<Share>>,
    pub refraction: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { picture, tile, origin }")]
pub(super) struct Texture {
    pub picture: Spanned<String>,
    pub tile: Point,
    pub origin: Option<Point>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { picture, tile, origin, height }")]
pub(super) struct Bump {
    pub picture: Spanned<String>,
    pub tile: Point,
    pub origin: Option<Point>,
    pub height: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { share, picture, tile, origin }")]
pub(super) struct ShareMap {
    pub share: Option<Spanned<f64>>,
    pub picture: Spanned<String>,
    pub tile: Point,
    pub origin: Option<Point>,
}

/// A share of light: a number, or a picture of shares.
pub(super) enum Share {
    One(f64),
    Map(Box<ShareMap>),
}

struct OneOrMap;

impl<'de> Visitor<'de> for OneOrMap {
    type Value = Share;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a table { share, picture, tile, origin }")
    }

    fn visit_i64<E>(self, v: i64) -> Result<Share, E> {
        Ok(Share::One(v as f64))
    }

    fn visit_f64<E>(self, v: f64) -> Result<Share, E> {
        Ok(Share::One(v))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Share, A::Error> {
        ShareMap::deserialize(MapAccessDeserializer::new(map)).map(|m| Share::Map(Box::new(m)))
    }
}

impl<'de> Deserialize<'de> for Share {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        d.deserialize_any(OneOrMap)
    }
}
