//! OBJ files with their material libraries.

use super::model::{At, FileMaterial, Unusable, optics};
use super::mtl::{self, Mtl};
use super::obj::Obj;
use super::{Format, Loaded, Near};
use crate::io::scene::check::{Checked, known_names};
use crate::io::scene::error::Refusal;
use crate::io::scene::folder::lossy;
use crate::io::scene::source::Source;
use std::collections::BTreeMap;

/// Materials by name, with the names of the files that define them.
type Library = BTreeMap<String, (Mtl, String)>;

/// Reads an OBJ file and the libraries that it needs.
pub(super) fn read_obj(bytes: Vec<u8>, near: &Near) -> Checked<Loaded> {
    let source = Source::new(near.path, lossy(bytes));
    let mut obj = Obj::parse(&source.text, near.keep).map_err(|e| near.refusal(&source, e))?;
    if near.spec.material.is_none() && !obj.materials.is_empty() {
        let library = library(&mut obj, &source, near)?;
        obj.mesh.materials = (0..obj.materials.len()).map(|m| material(&obj, m, &library)).collect();
    } else {
        obj.mesh.faces.iter_mut().for_each(|f| f.tags.material = None);
    }
    Ok(Loaded { mesh: obj.mesh, source, format: Format::Obj })
}

/// All materials of the libraries that the file names.
fn library(obj: &mut Obj, source: &Source, near: &Near) -> Checked<Library> {
    let mut library = Library::new();
    for (file, line) in obj.libraries.clone() {
        let read = match file_of(&file, line, source, near) {
            Ok(read) => read,
            // Without its library the mesh can still be read where the scene file gives a material.
            Err(e) if near.has_fallback() => {
                obj.mesh.notices.push(format!("the library \"{}\" is left out: {}", file.escape_debug(), e.message()));
                continue;
            }
            Err(e) => return Err(e.mend("add the file, or give the surface a material = ")),
        };
        for material in mtl::parse(&read.text).map_err(|e| near.refusal(&read, e))? {
            library.entry(material.name.clone()).or_insert((material, read.name.clone()));
        }
    }
    Ok(library)
}

/// The text of a library that a line of an OBJ file names.
fn file_of(file: &str, line: usize, obj: &Source, near: &Near) -> Checked<Source> {
    let at = At::Line(line);
    let path = near.locate(&at, file).map_err(|e| near.refusal(obj, e))?;
    let bytes = near.bytes(&at, file).map_err(|e| near.refusal(obj, e))?;
    Ok(Source::new(&path, lossy(bytes)))
}

/// The material that a `usemtl` means.
fn material(obj: &Obj, number: usize, library: &Library) -> FileMaterial {
    let name = obj.materials[number].0.clone();
    let used_at = obj.used_at(number);
    let unusable = |message| Err(Unusable { refusal: Refusal::Name, message });
    let Some((mtl, file)) = library.get(&name) else {
        let known = known_names(&name, library.keys().map(String::as_str));
        let optics = unusable(format!("no material library defines \"{name}\" ({known})"));
        return FileMaterial {
            name,
            used_at,
            optics,
            defined_at: String::new(),
            left_out: Vec::new(),
            double_sided: false,
        };
    };
    let at = |line: usize| format!("{file}:{line}");
    let optics = if mtl.kd.is_none() && mtl.ke.is_none() {
        unusable(format!("material \"{name}\" ({}) has neither Kd nor Ke", at(mtl.line)))
    } else {
        let (kd, kd_line) = mtl.kd.unwrap_or(([0.0; 3], mtl.line));
        let (ke, ke_line) = mtl.ke.unwrap_or(([0.0; 3], mtl.line));
        optics(&name, (kd, "Kd", at(kd_line)), (ke, "Ke", at(ke_line)))
    };
    let left_out = mtl.left_out.iter().map(|what| what.to_string()).collect();
    FileMaterial { name, used_at, optics, defined_at: at(mtl.line), left_out, double_sided: false }
}
