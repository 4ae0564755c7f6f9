//! The scene file as TOML: every key that exists, with the place of what must be checked.

use super::raw_look;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, SeqAccess, Visitor};
use std::fmt;
use toml::Spanned;

/// Only the format line, to be read before anything else can be unknown.
#[derive(Deserialize)]
pub(super) struct FormatLine {
    pub format: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    #[serde(rename = "format")]
    pub _format: IgnoredAny,
    pub name: Option<Spanned<String>>,
    pub enclosure: Option<bool>,
    pub photometry: Option<Spanned<Photometry>>,
    pub discretisation: Option<Discretisation>,
    #[serde(default)]
    pub material: Vec<Material>,
    #[serde(default)]
    pub surface: Vec<Spanned<Surface>>,
    pub initial: Option<Initial>,
    #[serde(default)]
    pub camera: Vec<Camera>,
    #[serde(default)]
    pub edit: Vec<Spanned<Edit>>,
    #[serde(default)]
    pub receiver: Vec<Receiver>,
    #[serde(default)]
    pub light: Vec<raw_look::Light>,
    pub fog: Option<raw_look::Fog>,
    pub background: Option<raw_look::Background>,
    #[serde(default)]
    pub tree: Vec<raw_look::Tree>,
    pub texture: Option<Spanned<IgnoredAny>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Photometry {
    pub bands: Option<Spanned<Vec<String>>>,
    pub primaries: Option<Spanned<String>>,
    pub luminance: Option<Spanned<Vec<f64>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Discretisation {
    pub max_edge: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Material {
    pub name: Spanned<String>,
    pub reflectance: Option<Spanned<Numbers>>,
    pub emission: Option<Spanned<Numbers>>,
    pub specular: Option<Spanned<IgnoredAny>>,
    pub texture: Option<raw_look::Texture>,
    pub bump: Option<raw_look::Bump>,
    pub reflection: Option<Spanned<raw_look::Share>>,
    pub transparency: Option<Spanned<raw_look::Share>>,
    pub refraction: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Surface {
    pub name: Spanned<String>,
    pub object: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
    pub polygon: Option<Spanned<Vec<Spanned<Vec<f64>>>>>,
    pub mesh: Option<Spanned<String>>,
    pub scale: Option<Spanned<f64>>,
    pub up: Option<Spanned<String>>,
    pub patches: Option<Spanned<Counts>>,
    pub elements: Option<Spanned<Counts>>,
    pub two_sided: Option<bool>,
    pub texture: Option<Spanned<IgnoredAny>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Initial {
    #[serde(default)]
    pub absent: Vec<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Camera {
    pub name: Spanned<String>,
    pub eye: Spanned<Vec<f64>>,
    pub target: Spanned<Vec<f64>>,
    pub up: Option<Spanned<Vec<f64>>>,
    pub fov: Option<Spanned<f64>>,
    pub size: Option<Spanned<Vec<i64>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Receiver {
    pub name: Spanned<String>,
    pub position: Spanned<Vec<f64>>,
    pub normal: Spanned<Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Edit {
    pub add: Option<Spanned<String>>,
    pub remove: Option<Spanned<String>>,
    #[serde(rename = "move")]
    pub moved: Option<Spanned<String>>,
    pub replace: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
    pub translate: Option<Spanned<Vec<f64>>>,
    pub rotate: Option<Spanned<Rotation>>,
    pub mesh: Option<Spanned<String>>,
    pub scale: Option<Spanned<Numbers>>,
    pub about: Option<Spanned<Vec<f64>>>,
    pub up: Option<Spanned<String>>,
    pub patches: Option<Spanned<Counts>>,
    pub elements: Option<Spanned<Counts>>,
    pub reflectance: Option<Spanned<Numbers>>,
    pub emission: Option<Spanned<Numbers>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Rotation {
    pub axis: Spanned<Vec<f64>>,
    pub degrees: Spanned<f64>,
    pub about: Option<Spanned<Vec<f64>>>,
}

/// A number, or a list of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Numbers {
    One(f64),
    List(Vec<f64>),
}

/// A count, or a list of counts; not yet checked.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Counts {
    One(i64),
    List(Vec<i64>),
}

struct OneOrList<T>(std::marker::PhantomData<T>);

impl<'de> Visitor<'de> for OneOrList<f64> {
    type Value = Numbers;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a list of numbers")
    }

    fn visit_i64<E>(self, v: i64) -> Result<Numbers, E> {
        Ok(Numbers::One(v as f64))
    }

    fn visit_f64<E>(self, v: f64) -> Result<Numbers, E> {
        Ok(Numbers::One(v))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Numbers, A::Error> {
        let mut list = Vec::new();
        while let Some(v) = seq.next_element()? {
            list.push(v);
        }
        Ok(Numbers::List(list))
    }
}

impl<'de> Visitor<'de> for OneOrList<i64> {
    type Value = Counts;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a whole number or a list of whole numbers")
    }

    fn visit_i64<E>(self, v: i64) -> Result<Counts, E> {
        Ok(Counts::One(v))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Counts, A::Error> {
        let mut list = Vec::new();
        while let Some(v) = seq.next_element()? {
            list.push(v);
        }
        Ok(Counts::List(list))
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        d.deserialize_any(OneOrList::<f64>(std::marker::PhantomData))
    }
}

impl<'de> Deserialize<'de> for Counts {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        d.deserialize_any(OneOrList::<i64>(std::marker::PhantomData))
    }
}
