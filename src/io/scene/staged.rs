//! Scenes with everything that pictures show, and lighting files.

use super::SceneOptions;
use super::alone::is_mesh;
use super::builtin::{builtin_text, open_scene};
use super::check::{Check, Checked};
use super::error::{Refusal, SceneFileError};
use super::folder::{Folder, text_of};
use super::format::{check_format, syntax};
use super::look::Look;
use super::mitsuba::is_mitsuba;
use super::radiance::is_radiance;
use super::read::parse_with_look;
use super::source::Source;
use super::view3d::is_view3d;
use crate::scene::{Appearance, Distribution, Light, LightShape, PointLight, Scene};
use std::path::Path;

/// The format of lighting files that this version reads.
pub const LIGHTING_FORMAT: &str = "etalon-lighting/1";

/// As [`open_scene`], with what the file says about pictures: lights of every kind, fog, background, finishes, trees.
/// The scene has the point lights that radiosity knows; the look has all lights. Scenes of other formats have a look of
/// their point lights alone.
///
/// # Errors
/// [`SceneFileError`] with file, line and mend.
pub fn open_with_look(spec: &str, options: &SceneOptions) -> Result<(Scene, Look), SceneFileError> {
    let path = Path::new(spec);
    if let Some(name) = spec.strip_prefix("builtin:") {
        let Some(text) = builtin_text(name) else { return plain(spec, options) };
        let source = Source { name: spec.to_string(), text: text.into() };
        return parse_with_look(&source, name, &Folder::none(), options);
    }
    if [is_mesh, is_view3d, is_mitsuba, is_radiance].iter().any(|is| is(path)) {
        return plain(spec, options);
    }
    let text = text_of(path).map_err(|why| {
        SceneFileError::whole(spec, Refusal::Unreadable, format!("cannot read the scene: {why}"))
            .mend("give a scene file, or builtin:NAME")
    })?;
    let stem = path.file_stem().map_or_else(|| spec.to_string(), |s| s.to_string_lossy().into_owned());
    parse_with_look(&Source::new(path, text), &stem, &Folder::of(path), options)
}

/// A scene with its appearance in its first state: [`open_with_look`], with the lights in the shapes that stand there before
/// the first edit. For another state: `look.on(&scene.at(state)?)`.
///
/// # Errors
/// [`SceneFileError`] with file, line and mend.
pub fn open_staged(spec: &str, options: &SceneOptions) -> Result<(Scene, Appearance), SceneFileError> {
    let (scene, look) = open_with_look(spec, options)?;
    let stage = scene.at(0).map_err(|e| {
        let text = e.to_string();
        let (message, mend) = text.split_once("; ").unwrap_or((&text, ""));
        SceneFileError::whole(spec, Refusal::Geometry, message).mend(mend)
    })?;
    let appearance = look.on(&stage)?;
    Ok((scene, appearance))
}

/// A scene that has no words for pictures.
fn plain(spec: &str, options: &SceneOptions) -> Checked<(Scene, Look)> {
    let scene = open_scene(spec, options)?;
    let source = Source { name: spec.to_string(), text: String::new() };
    let look = Look::of_lights(source, &scene.photometry.bands, scene.lights.iter().map(light).collect());
    Ok((scene, look))
}

fn light(point: &PointLight) -> Light {
    let (position, distribution): (_, Distribution) = (point.position, point.distribution);
    let shape = LightShape::Point { position, distribution, curve: None };
    Light { name: point.name.clone(), strength: point.intensity.clone(), shape }
}

/// Reads a lighting file: lights, fog, background and finishes that take the place of a scene's, for these bands. Pictures
/// lie beside or below it. [`Look::over`] puts it over an appearance.
///
/// # Errors
/// [`SceneFileError`] with file, line and mend.
pub fn read_lighting(path: &Path, bands: &[String]) -> Result<Look, SceneFileError> {
    let text = text_of(path).map_err(|why| {
        let message = format!("cannot read the lighting: {why}");
        SceneFileError::whole(&path.display().to_string(), Refusal::Unreadable, message)
            .mend(format!("give a file that begins with format = \"{LIGHTING_FORMAT}\""))
    })?;
    let source = Source::new(path, text);
    let check = Check { source: &source };
    check_format(check, LIGHTING_FORMAT)?;
    let file = toml::from_str(&source.text).map_err(|e| syntax(&source, &e))?;
    Look::of_lighting(check, &file, &Folder::of(path), bands)
}
