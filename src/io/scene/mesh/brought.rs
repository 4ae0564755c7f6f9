//! A mesh file that is read for what it carries: values, texture coordinates.

use super::keep::{Carried, Keep};
use super::model::At;
use super::{Fallback, Format, Loaded, MeshFile, MeshSpec, load};
use crate::io::FileError;
use crate::io::scene::error::SceneFileError;
use crate::io::scene::folder::Folder;
use crate::io::scene::polygon::Division;
use crate::math::DVec3;
use std::path::Path;

/// The faces of a mesh in the file's own units and axes, with what was kept of it.
pub(in crate::io) struct Brought {
    loaded: Loaded,
}

/// Reads a mesh file. Materials are of no interest: libraries are not opened.
pub(in crate::io) fn bring(path: &Path, keep: Keep) -> Result<Brought, FileError> {
    let spec = MeshSpec {
        surface: "",
        file: MeshFile::given(path),
        scale: 1.0,
        y_up: None,
        two_sided: None,
        material: Some(0),
        fallback: Fallback::Refuse,
        division: Division { patches: None, elements: None, max_edge: None, mesh: true },
    };
    let loaded = load(&Folder::of(path), &spec, keep).map_err(|e| of_file(path, &e))?;
    Ok(Brought { loaded })
}

impl Brought {
    /// Number of faces; they keep the order of the file.
    pub(in crate::io) fn len(&self) -> usize {
        self.loaded.mesh.faces.len()
    }

    /// Number of vertices.
    pub(in crate::io) fn vertices(&self) -> usize {
        self.loaded.mesh.vertices.len()
    }

    /// Corners of a face.
    pub(in crate::io) fn corners(&self, face: usize) -> Vec<DVec3> {
        self.loaded.mesh.corners(&self.loaded.mesh.faces[face])
    }

    /// Numbers of the vertices of a face.
    pub(in crate::io) fn numbers(&self, face: usize) -> &[u32] {
        self.loaded.mesh.vertex_numbers(&self.loaded.mesh.faces[face])
    }

    /// Texture coordinates of the corners of a face, with z = 0; empty if not kept.
    pub(in crate::io) fn textures(&self, face: usize) -> Vec<DVec3> {
        let mesh = &self.loaded.mesh;
        let numbers = mesh.texture_numbers(&mesh.faces[face]);
        numbers.iter().map(|i| mesh.carried.uvs[*i as usize]).map(|[u, v]| DVec3::new(u, v, 0.0)).collect()
    }

    /// What was kept.
    pub(in crate::io) fn carried(&self) -> &Carried {
        &self.loaded.mesh.carried
    }

    /// True if y is up unless the user says otherwise, and v counts from the top of pictures: glTF.
    pub(in crate::io) fn is_gltf(&self) -> bool {
        self.loaded.format == Format::Gltf
    }

    /// Where a face stands in the file, for messages.
    pub(in crate::io) fn place(&self, face: usize) -> String {
        match self.loaded.mesh.place_of(&self.loaded.mesh.faces[face].tags) {
            At::Line(line) => format!("line {line}"),
            At::Part(part) => part,
            At::File => String::new(),
        }
    }

    /// What was left out, and what is coarse.
    pub(in crate::io) fn notices(&self) -> &[String] {
        &self.loaded.mesh.notices
    }
}

/// The refusal of a mesh as that of a file.
fn of_file(path: &Path, e: &SceneFileError) -> FileError {
    let place = e.place();
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let place = place.strip_prefix(&name).unwrap_or(if place == path.display().to_string() { "" } else { &place });
    let place = match place.strip_prefix(':') {
        Some(line) => format!("line {line}"),
        None => place.trim_start_matches(", ").to_string(),
    };
    FileError::new(path, e.message()).at(place).mend(e.help_text())
}
