//! From text to a checked scene.

use super::SceneOptions;
use super::cameras::cameras;
use super::check::{Check, Checked, known_names};
use super::edits::{self, Read};
use super::error::{Refusal, SceneFileError};
use super::finishes::Keys;
use super::folder::{Folder, text_of};
use super::format::{check_format, syntax};
use super::lighting::{lights, receivers};
use super::look::Look;
use super::mesh::Gathered;
use super::photometry::{materials, photometry, reserved};
use super::raw;
use super::source::Source;
use super::surfaces::{replacement, surfaces};
use crate::scene::{Edit, Scene, SceneError, SharedArea, Surface};
use crate::view::{Photometry, Primaries};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// The format that this version reads.
pub const SCENE_FORMAT: &str = "etalon-scene/1";

/// Reads and checks a scene file and the meshes it names.
///
/// Every refusal of the scene format names the file, the line, the surface and the mend.
pub fn read_scene(path: &Path, options: &SceneOptions) -> Result<Scene, SceneFileError> {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    let text = text_of(path).map_err(|why| {
        SceneFileError::whole(&path.display().to_string(), Refusal::Unreadable, format!("cannot read the scene: {why}"))
            .mend("give a scene file, or builtin:NAME")
    })?;
    let stem = path.file_stem().map_or(name, |s| s.to_string_lossy().into_owned());
    parse(&Source::new(path, text), &stem, &Folder::of(path), options)
}

/// Reads a scene from text that names no files.
pub(super) fn parse_text(name: &str, text: &str, options: &SceneOptions) -> Result<Scene, SceneFileError> {
    let source = Source { name: format!("builtin:{name}"), text: text.into() };
    parse(&source, name, &Folder::none(), options)
}

/// The scene as radiosity knows it; what only pictures show is left out, with a notice.
fn parse(source: &Source, stem: &str, folder: &Folder, options: &SceneOptions) -> Checked<Scene> {
    let check = Check { source };
    let file = file(check)?;
    let mut scene = gather(check, &file, stem, folder, max_edge(check, &file, options)?)?;
    scene.lights = lights(check, &file.light, &scene.photometry.bands)?;
    scene.notices.extend(left_out(&file));
    settle(check, &file, scene)
}

/// The scene with what pictures show; it has the point lights that radiosity knows.
pub(super) fn parse_with_look(
    source: &Source,
    stem: &str,
    folder: &Folder,
    options: &SceneOptions,
) -> Checked<(Scene, Look)> {
    let check = Check { source };
    let file = file(check)?;
    let mut scene = gather(check, &file, stem, folder, max_edge(check, &file, options)?)?;
    let look = Look::of_scene(check, &file, folder, &scene.photometry.bands)?;
    scene.lights = look.point_lights();
    Ok((settle(check, &file, scene)?, look))
}

/// The tables of the file.
fn file(check: Check) -> Checked<raw::File> {
    check_format(check, SCENE_FORMAT)?;
    let file: raw::File = toml::from_str(&check.source.text).map_err(|e| syntax(check.source, &e))?;
    reserved(check, "texture", file.texture.as_ref().map(Spanned::span))?;
    if file.surface.is_empty() {
        let whole = 0..check.source.text.len().min(1);
        return check.refuse(Refusal::Empty, whole, "the scene has no surface", "add a [[surface]]");
    }
    Ok(file)
}

/// What radiosity passes over.
fn left_out(file: &raw::File) -> Option<String> {
    let finishes = file.material.iter().filter(|m| !Keys::of_material(m).are_none()).count();
    let counted = |n: usize, what: &str| (n > 0).then(|| format!("{n} {what}{}", if n == 1 { "" } else { "s" }));
    let parts = [
        counted(finishes, "material finish").map(|t| t.replace("finishs", "finishes")),
        counted(file.tree.len(), "tree"),
        file.fog.as_ref().map(|_| "fog".to_string()),
        file.background.as_ref().map(|_| "the background".to_string()),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| {
        format!("left out, since only pictures show them: {} (radiosity knows the material alone)", parts.join(", "))
    })
}

/// Puts the scene together, not yet looking at how its parts fit.
fn gather(check: Check, file: &raw::File, stem: &str, folder: &Folder, max_edge: Option<f64>) -> Checked<Scene> {
    let photometry = photometry(check, file.photometry.as_ref())?;
    let mut notices = Vec::new();
    let mut materials = materials(check, &file.material, &photometry.bands, &mut notices)?;
    let rgb = is_rgb(&photometry);
    let mut gathered = Gathered { materials: &mut materials, notices: &mut notices, bands: &photometry.bands, rgb };
    let mut surfaces = surfaces(check, folder, &file.surface, max_edge, &mut gathered)?;
    let edits = edits(check, file, folder, max_edge, &mut surfaces, &mut gathered)?;
    Ok(Scene {
        name: file.name.as_ref().map_or(Ok(stem.to_string()), |n| check.name("scene name", n))?,
        enclosure: file.enclosure,
        absent: absent(check, file)?,
        edits,
        cameras: cameras(check, &file.camera)?,
        lights: Vec::new(),
        receivers: receivers(check, &file.receiver)?,
        materials: materials.list,
        photometry,
        surfaces,
        notices,
    })
}

/// Material libraries speak of red, green and blue as Rec. 709 does.
fn is_rgb(photometry: &Photometry) -> bool {
    let w = &photometry.weights;
    w.len() == 3 && w != Primaries::Xyz.weights() && w != Primaries::Rec2020.weights()
}

/// The command line's largest edge, else the file's.
fn max_edge(check: Check, file: &raw::File, options: &SceneOptions) -> Checked<Option<f64>> {
    let own = file.discretisation.as_ref().and_then(|d| d.max_edge.as_ref());
    let own = own.map(|v| check.positive("max_edge", v)).transpose()?;
    Ok(edge_asked(options)?.or(own))
}

/// The command line's largest edge.
pub(super) fn edge_asked(options: &SceneOptions) -> Checked<Option<f64>> {
    match options.max_edge_override {
        Some(v) if v.is_nan() || v <= 0.0 => {
            Err(SceneFileError::whole("--max-edge", Refusal::Number, format!("the largest edge is {v}"))
                .mend("give a length in metres greater than zero"))
        }
        asked => Ok(asked),
    }
}

fn absent(check: Check, file: &raw::File) -> Checked<Vec<String>> {
    let mut names: Vec<String> = Vec::new();
    for name in file.initial.iter().flat_map(|i| &i.absent) {
        if names.contains(name.get_ref()) {
            return check.refuse(
                Refusal::Name,
                name.span(),
                format!("the object \"{}\" is listed twice", name.get_ref()),
                "name it once",
            );
        }
        names.push(name.get_ref().clone());
    }
    Ok(names)
}

fn edits(
    check: Check,
    file: &raw::File,
    folder: &Folder,
    max_edge: Option<f64>,
    surfaces: &mut Vec<Surface>,
    gathered: &mut Gathered,
) -> Checked<Vec<Edit>> {
    let mut edits = Vec::with_capacity(file.edit.len());
    for (at, table) in file.edit.iter().enumerate() {
        let read = edits::edit(check, table, gathered.materials, gathered.bands)?;
        edits.push(match read {
            Read::Done(edit) => edit,
            Read::Mesh { object, mesh } => {
                let Some(old) = surfaces.iter().position(|s| s.object == object) else {
                    return check.refuse(
                        Refusal::Edit,
                        table.span(),
                        format!("no surface belongs to the object \"{object}\""),
                        known_names(&object, surfaces.iter().map(|s| s.object.as_str())),
                    );
                };
                let old = (&surfaces[old].clone(), file.surface.get(old).map(Spanned::get_ref));
                let new = replacement(check, folder, (at + 1, table), (&object, mesh), old, max_edge, gathered)?;
                surfaces.push(new);
                Edit::Replace { object, by: surfaces.len() - 1, same_numbers: false }
            }
        });
    }
    Ok(edits)
}

/// Looks at the scene as a whole, in every state.
fn settle(check: Check, file: &raw::File, mut scene: Scene) -> Checked<Scene> {
    survey(&mut scene).map_err(|e| at_place(check, file, &scene, &e))?;
    Ok(scene)
}

/// Looks at the geometry of every state, leaving notices.
pub(super) fn survey(scene: &mut Scene) -> Result<(), SceneError> {
    scene.settle_replacements()?;
    for state in 0..=scene.edits.len() {
        if state > 0 && matches!(scene.edits[state - 1], Edit::Material { .. }) {
            continue;
        }
        for notice in scene.shared_areas(state)?.iter().map(SharedArea::notice) {
            if !scene.notices.contains(&notice) {
                scene.notices.push(notice);
            }
        }
    }
    Ok(())
}

/// The counts, or else the name, of the surface with the most elements.
fn finest(file: &raw::File, scene: &Scene) -> Option<Range<usize>> {
    let size =
        |s: &Surface| s.faces.iter().map(|f| f.patches.count() as u128 * f.elements.count() as u128).sum::<u128>();
    let (_, table) = scene.surfaces.iter().zip(&file.surface).max_by_key(|(s, _)| size(s))?;
    let raw = table.get_ref();
    Some(raw.patches.as_ref().or(raw.elements.as_ref()).map_or_else(|| raw.name.span(), Spanned::span))
}

/// Finds the line that a fault of the whole scene comes from.
fn at_place(check: Check, file: &raw::File, scene: &Scene, e: &SceneError) -> SceneFileError {
    let edit = |at: usize| file.edit.get(at.wrapping_sub(1)).map(Spanned::span);
    let top = 0..check.source.text.lines().next().map_or(0, str::len);
    let (refusal, span) = match e {
        SceneError::SameFacing { second_index, state, .. } => {
            let surface = file.surface.get(*second_index as usize).map(|s| s.get_ref().name.span());
            (Refusal::Overlap, surface.or(edit(*state)))
        }
        SceneError::UnknownObject { edit: 0, object, .. } => {
            let names = file.initial.iter().flat_map(|i| &i.absent);
            (Refusal::Name, names.into_iter().find(|n| n.get_ref() == object).map(Spanned::span))
        }
        SceneError::UnknownObject { edit: at, .. }
        | SceneError::AlreadyThere { edit: at, .. }
        | SceneError::NotThere { edit: at, .. }
        | SceneError::Collapsed { edit: at, .. } => (Refusal::Edit, edit(*at)),
        SceneError::Empty { state: 0 } => (Refusal::Empty, None),
        SceneError::Empty { state } => (Refusal::Empty, edit(*state)),
        SceneError::TooMany { .. } => (Refusal::Counts, finest(file, scene)),
        SceneError::NoSuchState { .. } => (Refusal::Edit, None),
    };
    let text = e.to_string();
    let (message, mend) = text.split_once("; ").unwrap_or((&text, ""));
    SceneFileError::new(check.source, refusal, span.unwrap_or(top), message).mend(mend)
}
