//! Faces of a surface from a mesh file (OBJ, PLY, glTF), with its materials and groups.

mod adopt;
mod brought;
mod gltf;
mod keep;
mod library;
mod model;
mod mtl;
mod obj;
mod place;
mod ply;
mod split;

use super::check::{Check, Checked};
use super::error::{Refusal, SceneFileError};
use super::folder::{Folder, bytes_of};
use super::photometry::Materials;
use super::polygon::Division;
use super::source::Source;
use crate::scene::Face;
pub(in crate::io) use brought::{Brought, bring};
pub(in crate::io) use keep::{ERROR_TAIL, Keep, STEM, band_names, stemmed};
use model::{At, Mesh, MeshFault};
pub(super) use split::ears;
pub(in crate::io) use split::{Parts, parts};
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// What the scene file says about a mesh.
pub(super) struct MeshSpec<'a> {
    /// Surface it becomes.
    pub surface: &'a str,
    pub file: MeshFile<'a>,
    /// File units to metres.
    pub scale: f64,
    /// Whether y is up; `None` leaves it to the format.
    pub y_up: Option<bool>,
    /// Whether the faces radiate from both sides; `None` leaves it to the file.
    pub two_sided: Option<bool>,
    /// Material for all faces.
    pub material: Option<u32>,
    /// For faces whose own material is not usable.
    pub fallback: Fallback,
    pub division: Division<'a>,
}

/// What faces without a usable material of their own are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fallback {
    /// Nothing: it is a mistake.
    Refuse,
    /// A material of the scene.
    Material(u32),
    /// Grey, with a notice.
    Grey,
}

/// A mesh file, and how it came to be read.
pub(super) struct MeshFile<'a> {
    path: PathBuf,
    /// As the author wrote it.
    shown: String,
    /// The place in the scene file that names it; `None` if the user named the mesh itself.
    named: Option<(Check<'a>, Range<usize>)>,
}

impl<'a> MeshFile<'a> {
    /// A file that a scene file names.
    pub(super) fn named(check: Check<'a>, folder: &Folder, file: &Spanned<String>) -> Checked<Self> {
        let path = folder.locate(check, file.span(), Path::new(""), file.get_ref())?;
        Ok(Self { path, shown: file.get_ref().clone(), named: Some((check, file.span())) })
    }

    /// A file that stands for a scene by itself.
    pub(super) fn given(path: &Path) -> Self {
        Self { path: path.to_path_buf(), shown: path.display().to_string(), named: None }
    }

    /// A refusal of the file as a whole.
    fn refuse<T>(&self, refusal: Refusal, message: String, mend: &str) -> Checked<T> {
        match &self.named {
            Some((check, span)) => check.refuse(refusal, span.clone(), message, mend),
            None => Err(SceneFileError::whole(&self.shown, refusal, message).mend(mend)),
        }
    }

    /// Adds the place that names the file.
    fn within(&self, e: SceneFileError) -> SceneFileError {
        match &self.named {
            Some((check, span)) => e.within(&format!("{}, {}", check.source.at(span), check.source.block(span))),
            None => e,
        }
    }
}

/// What a scene file is read into.
pub(super) struct Gathered<'a> {
    pub materials: &'a mut Materials,
    pub notices: &'a mut Vec<String>,
    pub bands: &'a [String],
    /// True if red, green and blue of mesh files mean the scene's bands.
    pub rgb: bool,
}

/// Formats of mesh files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Obj,
    Ply,
    Gltf,
}

impl Format {
    /// The format that the ending of a file name tells.
    pub(super) fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// A mesh that has been read, with the text that its lines refer to.
struct Loaded {
    mesh: Mesh,
    source: Source,
    format: Format,
}

/// Reads a mesh: its faces, and the names of their groups.
pub(super) fn faces(
    check: Check,
    folder: &Folder,
    spec: &MeshSpec,
    gathered: &mut Gathered,
) -> Checked<(Vec<Face>, Vec<String>)> {
    let loaded = load(folder, spec, Keep::Shape)?;
    let numbers = adopt::materials(&loaded, spec, gathered)?;
    place::faces(check, &loaded, spec, &numbers, gathered)
}

fn load(folder: &Folder, spec: &MeshSpec, keep: Keep) -> Checked<Loaded> {
    let file = &spec.file;
    let bytes = match bytes_of(&file.path) {
        Ok(bytes) => bytes,
        Err(why) => {
            let what = if file.named.is_some() { format!("\"{}\"", file.shown) } else { "the mesh".into() };
            return file.refuse(
                Refusal::Unreadable,
                format!("cannot read {what}: {why}"),
                "name a file that is there and can be read",
            );
        }
    };
    let Some(format) = Format::of(&file.path) else {
        let message = format!("\"{}\" has no ending that names a mesh format", file.shown.escape_debug());
        return file.refuse(Refusal::Format, message, "give an .obj, .ply, .gltf or .glb file");
    };
    let near = Near { folder, path: &file.path, spec, keep };
    match format {
        Format::Obj => library::read_obj(bytes, &near),
        Format::Ply => {
            let source = Source::new(&file.path, String::from_utf8_lossy(ply::text(&bytes)).into_owned());
            let mesh = ply::parse(&bytes, keep).map_err(|e| near.refusal(&source, e))?;
            Ok(Loaded { mesh, source, format })
        }
        Format::Gltf => {
            let (source, read) = gltf::parse(bytes, &near);
            Ok(Loaded { mesh: read.map_err(|e| near.refusal(&source, e))?, source, format })
        }
    }
}

/// What lies around a mesh file: other files that it names.
struct Near<'a> {
    folder: &'a Folder,
    path: &'a Path,
    spec: &'a MeshSpec<'a>,
    keep: Keep<'a>,
}

impl Near<'_> {
    fn refusal(&self, source: &Source, fault: MeshFault) -> SceneFileError {
        self.spec.file.within(fault.in_file(source))
    }

    /// The path of a file named in the mesh at some place: beside or below, never outside the scene's folder.
    fn locate(&self, at: &At, name: &str) -> Result<PathBuf, MeshFault> {
        let base = self.folder.relative(self.path).parent().unwrap_or(Path::new(""));
        let source = Source { name: String::new(), text: String::new() };
        let located = self.folder.locate(Check { source: &source }, 0..0, base, name);
        located.map_err(|e| MeshFault {
            refusal: e.refusal(),
            at: at.clone(),
            message: e.message().into(),
            mend: e.help_text().into(),
        })
    }

    /// The bytes of a file named in the mesh at some place.
    fn bytes(&self, at: &At, name: &str) -> Result<Vec<u8>, MeshFault> {
        bytes_of(&self.locate(at, name)?).or_else(|why| {
            let message = format!("cannot read \"{}\": {why}", name.escape_debug());
            MeshFault::new(at.clone(), message)
                .of(Refusal::Unreadable)
                .mend("name a file that is there and can be read")
        })
    }

    /// True if faces may go without a material of the file's own.
    fn has_fallback(&self) -> bool {
        self.spec.material.is_some() || self.spec.fallback != Fallback::Refuse
    }
}
