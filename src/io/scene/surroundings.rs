//! `[fog]`, `[background]` and `[[tree]]`.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::finishes::lengths;
use super::lamps::strength;
use super::lighting::{second, unit};
use super::pictures::Pictures;
use super::raw_look;
use crate::math::DVec3;
use crate::scene::{Background, Clouds, Fog, Tree};

/// Object of trees that name none.
const TREES: &str = "trees";

pub(super) fn fog(check: Check, table: &raw_look::Fog, bands: &[String]) -> Checked<Fog> {
    let value = &table.extinction;
    let extinction = check.finite("extinction", *value.get_ref(), value.span())?;
    if extinction < 0.0 {
        let message = format!("extinction {extinction} is negative");
        return check.refuse(Refusal::Number, value.span(), message, "give 1/m, zero or more; 3.9 / visibility");
    }
    Ok(Fog {
        extinction,
        radiance: strength(check, "radiance", &table.radiance, bands)?,
        background_at: table.background_at.as_ref().map(|d| check.positive("background_at", d)).transpose()?,
    })
}

pub(super) fn background(
    check: Check,
    table: &raw_look::Background,
    bands: &[String],
    pictures: &mut Pictures,
) -> Checked<Background> {
    let radiance = table.radiance.as_ref().map_or(Ok(Vec::new()), |r| strength(check, "radiance", r, bands))?;
    if let Some(picture) = table.picture.as_ref().filter(|_| radiance.is_empty()) {
        let mend = "add radiance = ...: that of the picture's white";
        return check.refuse(Refusal::Key, picture.span(), "the picture has no radiance", mend);
    }
    let clouds = table.clouds.as_ref().map(|c| clouds(check, c, bands, pictures)).transpose()?;
    let picture = table.picture.as_ref().map(|p| pictures.named(check, p)).transpose()?;
    Ok(Background { radiance, picture, sky: table.sky.unwrap_or(false), clouds })
}

fn clouds(check: Check, table: &raw_look::Clouds, bands: &[String], pictures: &mut Pictures) -> Checked<Clouds> {
    Ok(Clouds {
        height: check.finite("height", *table.height.get_ref(), table.height.span())?,
        tile: lengths(check, "tile", &table.tile)?,
        radiance: strength(check, "radiance", &table.radiance, bands)?,
        picture: pictures.named(check, &table.picture)?,
    })
}

pub(super) fn trees(check: Check, tables: &[raw_look::Tree], pictures: &mut Pictures) -> Checked<Vec<Tree>> {
    let mut trees: Vec<Tree> = Vec::new();
    for table in tables {
        let name = check.name("tree name", &table.name)?;
        if trees.iter().any(|t| t.name == name) {
            return second(check, table.name.span(), "tree", &name);
        }
        trees.push(Tree {
            name,
            object: table.object.as_ref().map_or(Ok(TREES.into()), |o| check.name("object name", o))?,
            foot: check.point("foot", &table.foot)?,
            up: table.up.as_ref().map_or(Ok(DVec3::Z), |u| unit(check, "up", u))?,
            size: lengths(check, "size", &table.size)?,
            picture: pictures.named(check, &table.picture)?,
        });
    }
    Ok(trees)
}
