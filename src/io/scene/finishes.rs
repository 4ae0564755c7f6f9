//! What materials show beyond their reflectance: textures, bumps, mirrored and transmitted shares.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::pictures::Pictures;
use super::raw;
use super::raw_look::{self, Share};
use crate::math::DVec3;
use crate::scene::{Finish, Texture};
use std::ops::Range;
use toml::Spanned;

/// Refractive indices of solids and liquids lie well within these.
const REFRACTION: std::ops::RangeInclusive<f64> = 0.1..=10.0;

/// The keys of one table, of a `[[material]]` or of a `[[finish]]`.
pub(super) struct Keys<'a> {
    pub texture: Option<&'a raw_look::Texture>,
    pub bump: Option<&'a raw_look::Bump>,
    pub reflection: Option<&'a Spanned<Share>>,
    pub transparency: Option<&'a Spanned<Share>>,
    pub refraction: Option<&'a Spanned<f64>>,
}

impl<'a> Keys<'a> {
    pub(super) fn of_material(m: &'a raw::Material) -> Self {
        Self {
            texture: m.texture.as_ref(),
            bump: m.bump.as_ref(),
            reflection: m.reflection.as_ref(),
            transparency: m.transparency.as_ref(),
            refraction: m.refraction.as_ref(),
        }
    }

    pub(super) fn of_finish(f: &'a raw_look::Finish) -> Self {
        Self {
            texture: f.texture.as_ref(),
            bump: f.bump.as_ref(),
            reflection: f.reflection.as_ref(),
            transparency: f.transparency.as_ref(),
            refraction: f.refraction.as_ref(),
        }
    }

    /// True where the table speaks of nothing that a finish has.
    pub(super) fn are_none(&self) -> bool {
        self.texture.is_none()
            && self.bump.is_none()
            && self.reflection.is_none()
            && self.transparency.is_none()
            && self.refraction.is_none()
    }

    /// The finish of a material.
    pub(super) fn finish(&self, check: Check, material: &str, pictures: &mut Pictures) -> Checked<Finish> {
        let (reflection, reflection_map) = share(check, "reflection", self.reflection, pictures)?;
        let (transparency, transparency_map) = share(check, "transparency", self.transparency, pictures)?;
        if reflection + transparency > 1.0 {
            let span = self.transparency.map_or(0..0, Spanned::span);
            let message = format!("reflection {reflection} and transparency {transparency} are more than all light");
            return check.refuse(Refusal::Number, span, message, "make their sum 1 at most");
        }
        let mut texture = |t: Parts| t.texture(check, pictures);
        let bump = self.bump.map(|b| texture(Parts(&b.picture, &b.tile, b.origin.as_ref()))).transpose()?;
        Ok(Finish {
            material: material.to_string(),
            colour: self.texture.map(|t| texture(Parts(&t.picture, &t.tile, t.origin.as_ref()))).transpose()?,
            bump,
            bump_height: self.bump.map_or(Ok(0.0), |b| check.finite("height", *b.height.get_ref(), b.height.span()))?,
            reflection,
            reflection_map,
            transparency,
            transparency_map,
            refraction: self.refraction.map_or(Ok(1.0), |r| refraction(check, r))?,
        })
    }
}

/// Picture, tile and origin.
struct Parts<'a>(&'a Spanned<String>, &'a Spanned<Vec<f64>>, Option<&'a Spanned<Vec<f64>>>);

impl Parts<'_> {
    fn texture(&self, check: Check, pictures: &mut Pictures) -> Checked<Texture> {
        Ok(Texture {
            tile: lengths(check, "tile", self.1)?,
            origin: self.2.map_or(Ok(DVec3::ZERO), |o| check.point("origin", o))?,
            picture: pictures.named(check, self.0)?,
        })
    }
}

/// Two lengths greater than zero.
pub(super) fn lengths(check: Check, what: &str, value: &Spanned<Vec<f64>>) -> Checked<[f64; 2]> {
    match value.get_ref()[..] {
        [w, h] if w > 0.0 && h > 0.0 && w.is_finite() && h.is_finite() => Ok([w, h]),
        _ => check.refuse(
            Refusal::Number,
            value.span(),
            format!("{what} is {:?}", value.get_ref()),
            "give [breadth, height] in metres, both greater than zero",
        ),
    }
}

/// A share, and the picture it is to be multiplied with.
fn share(
    check: Check,
    what: &str,
    value: Option<&Spanned<Share>>,
    pictures: &mut Pictures,
) -> Checked<(f64, Option<Texture>)> {
    let within = |v: f64, span: Range<usize>| match (0.0..=1.0).contains(&v) {
        true => Ok(v),
        false => {
            check.refuse(Refusal::Number, span, format!("{what} {v} is outside [0, 1]"), "give a share of the light")
        }
    };
    match value.map(|v| (v.get_ref(), v.span())) {
        None => Ok((0.0, None)),
        Some((Share::One(v), span)) => Ok((within(*v, span)?, None)),
        Some((Share::Map(m), _)) => {
            let share = m.share.as_ref().map_or(Ok(1.0), |s| within(*s.get_ref(), s.span()))?;
            Ok((share, Some(Parts(&m.picture, &m.tile, m.origin.as_ref()).texture(check, pictures)?)))
        }
    }
}

fn refraction(check: Check, value: &Spanned<f64>) -> Checked<f64> {
    let v = *value.get_ref();
    match REFRACTION.contains(&v) {
        true => Ok(v),
        false => check.refuse(
            Refusal::Number,
            value.span(),
            format!("refraction {v} is no refractive index"),
            "glass is about 1.5, water 1.33; 1 goes straight on",
        ),
    }
}
