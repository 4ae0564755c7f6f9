//! Scenes that come with the program.

use super::SceneOptions;
use super::alone::{is_mesh, read_mesh};
use super::check::known_names;
use super::error::{Refusal, SceneFileError};
use super::mitsuba::{is_mitsuba, read_mitsuba};
use super::radiance::{is_radiance, read_radiance};
use super::read::{parse_text, read_scene};
use super::view3d::{is_view3d, read_view3d};
use crate::scene::Scene;
use std::path::Path;

/// A name with the text of `references/scenes/NAME.toml`.
macro_rules! scene {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../references/scenes/", $name, ".toml")))
    };
}

/// Names and texts, in the order in which they are listed.
const SCENES: &[(&str, &str)] = &[
    scene!("cornell-box"),
    scene!("cornell-box-coarse"),
    scene!("furnace"),
    scene!("furnace-l"),
    scene!("opposed-squares"),
    scene!("edge-squares"),
    scene!("cube-one-emitter"),
    scene!("l-room"),
    scene!("furnished-room"),
    scene!("dynamic-cube"),
    scene!("cube-room"),
    scene!("cube-room-edits"),
    scene!("robot-room"),
    scene!("office"),
    scene!("small-lamp"),
    scene!("aliasing-only"),
    scene!("proximity-only"),
    scene!("visibility-only"),
    scene!("cie171-5-2"),
    scene!("cie171-5-3"),
    scene!("cie171-5-4"),
    scene!("cie171-5-6"),
    scene!("cie171-5-6-small"),
    scene!("cie171-5-6-large"),
    scene!("cie171-5-7"),
    scene!("cie171-5-8"),
];

/// Names of the built-in scenes.
pub fn builtin_names() -> Vec<&'static str> {
    SCENES.iter().map(|(name, _)| *name).collect()
}

/// The scene file of a built-in scene.
pub fn builtin_text(name: &str) -> Option<&'static str> {
    SCENES.iter().find(|(n, _)| *n == name).map(|(_, text)| *text)
}

/// A built-in scene as its file has it.
pub fn builtin(name: &str) -> Option<Scene> {
    // The texts are part of the program, and a test reads every one of them.
    parse_text(name, builtin_text(name)?, &SceneOptions::default()).ok()
}

/// Opens `builtin:NAME`, the scene file at a path, a scene of View3D (`.vs3`), Mitsuba 3 (`.xml`) or Radiance (`.rad`),
/// or a mesh (`.obj`, `.ply`, `.gltf`, `.glb`) as a scene of one surface.
pub fn open_scene(spec: &str, options: &SceneOptions) -> Result<Scene, SceneFileError> {
    let Some(name) = spec.strip_prefix("builtin:") else {
        let path = Path::new(spec);
        return match path {
            _ if is_mesh(path) => read_mesh(path, options),
            _ if is_view3d(path) => read_view3d(path, options),
            _ if is_mitsuba(path) => read_mitsuba(path, options),
            _ if is_radiance(path) => read_radiance(path, options),
            _ => read_scene(path, options),
        };
    };
    match builtin_text(name) {
        Some(text) => parse_text(name, text, options),
        None => {
            let message = format!("there is no built-in scene \"{}\"", name.escape_debug());
            let mend = match known_names(name, builtin_names()) {
                near if near.starts_with("did") => format!("{near} There are: {}", builtin_names().join(", ")),
                all => all,
            };
            Err(SceneFileError::whole(spec, Refusal::Builtin, message).mend(mend))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_scene_is_read_and_set_up() {
        for name in builtin_names() {
            let scene = parse_text(name, builtin_text(name).unwrap(), &SceneOptions::default()).unwrap();
            for state in 0..=scene.edits.len() {
                assert!(scene.at(state).unwrap().areas().iter().sum::<f64>() > 0.0, "{name}");
            }
        }
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        let e = open_scene("builtin:cornel-box", &SceneOptions::default()).unwrap_err();
        assert!(e.to_string().contains("did you mean \"cornell-box\"?"), "{e}");
        assert!(e.to_string().contains("furnace"), "{e}");
    }
}
