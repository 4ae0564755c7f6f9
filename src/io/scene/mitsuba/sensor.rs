//! `<sensor>`: a camera, where it is one of perspective. Nothing of it changes light, so faults only leave notices.

use super::transform::{Affine, transform};
use super::tree::{Id, Tree};
use crate::math::DVec3;
use crate::view::Camera;

/// Largest side of a picture, pixels.
const MAX_SIDE: f64 = 16_384.0;

/// The camera of a sensor, or why there is none.
pub(super) fn camera(tree: &Tree, at: Id, name: String) -> Result<Camera, String> {
    match tree.attribute(at, "type") {
        Some("perspective" | "thinlens") => {}
        _ => return Err("only perspective ones are cameras here".into()),
    }
    let mut to_world = Affine::IDENTITY;
    let (mut fov, mut axis, mut size) = (None, "x", [768.0, 576.0]);
    for child in tree.children(at) {
        match (tree.tag(child), tree.name(child)) {
            ("transform", "to_world") => to_world = transform(tree, child).map_err(|e| e.message().to_string())?,
            (_, "fov") => fov = Some(tree.number(child, "value").map_err(|e| e.message().to_string())?),
            (_, "fov_axis") => axis = tree.attribute(child, "value").unwrap_or_default(),
            ("film", _) => size = film(tree, child, size),
            _ => {}
        }
    }
    let sound = size.iter().all(|n| (1.0..=MAX_SIDE).contains(n) && n.fract() == 0.0);
    if !sound {
        return Err(format!("its picture would have {} x {} pixels", size[0], size[1]));
    }
    let fov = fov.ok_or("it has no fov")?;
    let vertical = vertical(fov, axis, size[0] / size[1]).ok_or(format!("its field of view is {fov} along {axis}"))?;
    let forward = to_world.vector(DVec3::Z).normalize_or_zero();
    let up = to_world.vector(DVec3::Y).normalize_or_zero();
    let eye = to_world.translation;
    let target = eye + forward;
    if forward.cross(up).length() < 1e-6 || (target - eye).length() < 0.5 {
        return Err("it has no direction".into());
    }
    Ok(Camera { name, eye, target, up, fov: vertical, size: size.map(|n| n as u32) })
}

fn film(tree: &Tree, at: Id, default: [f64; 2]) -> [f64; 2] {
    let side = |name: &str| {
        let found = tree.children(at).find(|c| tree.name(*c) == name);
        found.and_then(|c| tree.attribute(c, "value")?.trim().parse().ok())
    };
    [side("width").unwrap_or(default[0]), side("height").unwrap_or(default[1])]
}

/// The vertical angle of view, degrees; `None` if there is none.
fn vertical(fov: f64, axis: &str, aspect: f64) -> Option<f64> {
    if !(fov > 0.0 && fov < 180.0) {
        return None;
    }
    let half = (0.5 * fov).to_radians().tan();
    let half = match axis {
        "x" => half / aspect,
        "y" => half,
        "smaller" if aspect < 1.0 => half / aspect,
        "larger" if aspect > 1.0 => half / aspect,
        "smaller" | "larger" => half,
        "diagonal" => half / aspect.hypot(1.0),
        _ => return None,
    };
    let vertical = 2.0 * half.atan().to_degrees();
    (vertical > 0.0 && vertical < 180.0).then_some(vertical)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_view_are_made_vertical() {
        let is = |fov, axis, aspect, expected: f64| {
            let found = vertical(fov, axis, aspect).unwrap();
            assert!((found - expected).abs() < 1e-12, "{fov} {axis} {aspect}: {found}");
        };
        is(90.0, "y", 2.0, 90.0);
        is(90.0, "x", 2.0, 2.0 * 0.5f64.atan().to_degrees());
        is(90.0, "smaller", 2.0, 90.0);
        is(90.0, "larger", 2.0, 2.0 * 0.5f64.atan().to_degrees());
        is(90.0, "smaller", 0.5, 2.0 * 2f64.atan().to_degrees());
        is(90.0, "diagonal", 1.0, 2.0 * 0.5f64.sqrt().atan().to_degrees());
        assert!(vertical(180.0, "x", 1.0).is_none() && vertical(40.0, "z", 1.0).is_none());
    }
}
