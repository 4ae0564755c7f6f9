//! Whether the parts of an appearance fit together.

use super::fault::{Fault, unsound};
use super::sound::is_strength;
use crate::math::DVec3;
use crate::scene::{Appearance, Distribution, Finish, Light, LightShape, SkyModel, Texture, Tree};

/// Most pixels a side of a picture.
const MOST_SIDE: u32 = 16_384;

pub(super) fn check(look: &Appearance, bands: usize) -> Result<(), Fault> {
    for p in &look.pictures {
        let [w, h] = p.size.map(u64::from);
        let sides = p.size.iter().all(|s| (1..=MOST_SIDE).contains(s));
        if !sides || p.rgba.len() as u64 != w * h * 4 {
            return unsound(named("picture", &p.name), format!("{w} x {h} pixels in {} bytes", p.rgba.len()));
        }
    }
    let known = |picture: usize| picture < look.pictures.len();
    for light in &look.lights {
        if !is_strength(&light.strength, bands) || !is_light(light) {
            return unsound(named("light", &light.name), "its numbers are not those of a light of its kind");
        }
    }
    if let Some(fog) = &look.fog {
        let at = fog.background_at.is_none_or(is_length);
        if !(is_length(fog.extinction) && at && is_strength(&fog.radiance, bands)) {
            return unsound("fog", "extinction, radiance and distance must be finite, none negative");
        }
    }
    let back = &look.background;
    let radiance = back.radiance.is_empty() || is_strength(&back.radiance, bands);
    let clouds = back
        .clouds
        .as_ref()
        .is_none_or(|c| known(c.picture) && c.height.is_finite() && is_tile(c.tile) && is_strength(&c.radiance, bands));
    if !(radiance && clouds && back.picture.is_none_or(known)) {
        return unsound("background", "radiance, picture or clouds do not fit");
    }
    for f in &look.finishes {
        if !is_finish(f, look.pictures.len()) {
            return unsound(named("finish of material", &f.material), "shares, maps or refraction do not fit");
        }
    }
    match look.trees.iter().find(|t| !(known(t.picture) && is_tree(t))) {
        None => Ok(()),
        Some(tree) => unsound(named("tree", &tree.name), "place, size or picture do not fit"),
    }
}

fn named(what: &str, name: &str) -> String {
    format!("{what} \"{}\"", name.escape_debug())
}

fn is_length(v: f64) -> bool {
    v.is_finite() && v >= 0.0
}

fn is_unit(v: DVec3) -> bool {
    (v.length() - 1.0).abs() < 1e-6
}

fn is_tile(tile: [f64; 2]) -> bool {
    tile.iter().all(|t| t.is_finite() && *t > 0.0)
}

fn is_polygon(corners: &[DVec3]) -> bool {
    corners.len() >= 3 && corners.iter().all(|c| c.is_finite())
}

fn is_light(light: &Light) -> bool {
    match &light.shape {
        LightShape::Parallel { direction } => is_unit(*direction),
        LightShape::Point { position, distribution, curve } => {
            let axis = match distribution {
                Distribution::Isotropic => true,
                Distribution::Lambert(axis) => is_unit(*axis),
            };
            let curve = curve.as_ref().is_none_or(|c| {
                let factors = c.samples.iter().all(|(a, f)| (0.0..=180.0).contains(a) && is_length(*f));
                is_unit(c.axis) && factors && !c.samples.is_empty() && c.samples.windows(2).all(|w| w[0].0 < w[1].0)
            });
            position.is_finite() && axis && curve
        }
        LightShape::Linear { from, to } => from.is_finite() && to.is_finite() && from != to,
        LightShape::Area { polygon } => is_polygon(polygon),
        LightShape::Polyhedron { faces } => !faces.is_empty() && faces.iter().all(|f| is_polygon(f)),
        LightShape::Sky { model, up } => match model {
            SkyModel::Clear { sun } => is_unit(*up) && is_unit(*sun),
            SkyModel::Uniform | SkyModel::Overcast => is_unit(*up),
        },
    }
}

fn is_finish(f: &Finish, pictures: usize) -> bool {
    let texture = |t: &Texture| t.picture < pictures && t.origin.is_finite() && is_tile(t.tile);
    let maps = [&f.colour, &f.bump, &f.reflection_map, &f.transparency_map];
    let share = |v: f64| (0.0..=1.0).contains(&v);
    let whole = share(f.reflection) && share(f.transparency) && f.reflection + f.transparency <= 1.0 + 1e-9;
    let bends = f.refraction.is_finite() && f.refraction > 0.0;
    maps.into_iter().flatten().all(texture) && whole && bends && f.bump_height.is_finite()
}

fn is_tree(t: &Tree) -> bool {
    t.foot.is_finite() && is_unit(t.up) && is_tile(t.size)
}
