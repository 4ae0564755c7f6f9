//! Solutions that came on a mesh of their own: PLY, OBJ, glTF, VTU, and EXR lightmaps.
//!
//! Numbers are taken as they stand in the file (colours of whole numbers as 0 to 1): which quantity they are, and in
//! which unit, is for the caller to say.

mod laying;
mod lightmap;
mod mesh;
mod table;
mod vtu;

pub use vtu::write_vtu;

use super::FileError;
use crate::solution::MeshValues;
use std::path::{Path, PathBuf};

/// Largest file that is read, bytes.
const MAX_FILE: u64 = 1 << 30;

/// How a file of values is to be read.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshValuesOptions {
    /// Table of values that goes with an OBJ, PLY or glTF mesh: `face,<band>,...` or `vertex,<band>,...`, numbers in the
    /// order of the file from 0.
    pub table: Option<PathBuf>,
    /// Mesh with texture coordinates (OBJ, glTF) that goes with an EXR lightmap.
    pub mesh: Option<PathBuf>,
    /// Names of the properties, arrays, channels or columns that hold the values, band by band; `None` for the usual
    /// ones.
    pub fields: Option<Vec<String>>,
    /// File units to metres.
    pub scale: f64,
    /// Whether y is up; `None` leaves it to the format: y for glTF, z for all others.
    pub y_up: Option<bool>,
}

impl Default for MeshValuesOptions {
    fn default() -> Self {
        Self { table: None, mesh: None, fields: None, scale: 1.0, y_up: None }
    }
}

/// Formats of values on meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    /// OBJ, PLY or glTF.
    Mesh,
    Vtu,
    Lightmap,
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" | "ply" | "gltf" | "glb" => Some(Self::Mesh),
            "vtu" => Some(Self::Vtu),
            "exr" => Some(Self::Lightmap),
            _ => None,
        }
    }
}

/// True if the ending of a file name is that of values on a mesh.
pub fn is_mesh_values(path: &Path) -> bool {
    Format::of(path).is_some()
}

/// Reads values with the mesh that they stand on: faces in metres, z up, in the order of the file. Faces that are not
/// planar or not convex fall into triangles, those without area are left out; the notices say so.
///
/// # Errors
/// [`FileError`] with place and mend for whatever is wrong with the file, or does not go with its format.
pub fn read_mesh_values(path: &Path, options: &MeshValuesOptions) -> Result<MeshValues, FileError> {
    let Some(format) = Format::of(path) else {
        return Err(FileError::new(path, "has no ending that names a format of values on a mesh")
            .mend("use .ply, .obj, .gltf, .glb, .vtu or .exr"));
    };
    if !(options.scale.is_finite() && options.scale > 0.0) {
        let problem = format!("the length of its unit is {} m", options.scale);
        return Err(FileError::new(path, problem).mend("give a number greater than zero"));
    }
    if let Some(table) = options.table.as_ref().filter(|_| format != Format::Mesh) {
        return Err(FileError::new(table, "a table of values goes with an OBJ, PLY or glTF mesh")
            .mend(format!("leave it out: {} has its own values", path.display())));
    }
    if let Some(mesh) = options.mesh.as_ref().filter(|_| format != Format::Lightmap) {
        return Err(FileError::new(mesh, "a mesh is named beside a file that has its own")
            .mend("leave it out: it goes with EXR lightmaps only"));
    }
    match format {
        Format::Mesh => mesh::read(path, options),
        Format::Vtu => vtu::read(path, options),
        Format::Lightmap => lightmap::read(path, options),
    }
}

/// The bytes of a file of a size that can be read.
fn bytes_of(path: &Path) -> Result<Vec<u8>, FileError> {
    let system = |e: std::io::Error| FileError::system(path, "read", &e);
    let meta = std::fs::metadata(path).map_err(system)?;
    if meta.is_dir() {
        return Err(FileError::new(path, "is a folder").mend("name a file"));
    }
    if meta.len() > MAX_FILE {
        let problem = format!("has {} bytes, more than the {MAX_FILE} that are read", meta.len());
        return Err(FileError::new(path, problem).mend("use a coarser mesh, or a binary format"));
    }
    std::fs::read(path).map_err(system)
}

/// A word of a file as it can stand in a message.
fn shown(word: &str) -> String {
    word.chars().take(60).collect::<String>().escape_debug().to_string()
}

/// The last part of a path, for notices.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned())
}
