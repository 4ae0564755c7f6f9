//! Faces of a surface from an OBJ mesh, with its materials.

use super::check::{Check, Checked, known_names};
use super::error::{Refusal, SceneFileError};
use super::folder::{Folder, open};
use super::mtl::{self, Mtl};
use super::obj::{LineError, Obj, ObjFace};
use super::photometry::Materials;
use super::polygon::{Division, Flaw, flaw};
use super::source::Source;
use super::split::ears;
use crate::math::{DVec3, diameter, plane_defect};
use crate::scene::{Face, Grid, Material};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// What the scene file says about a mesh.
pub(super) struct MeshSpec<'a> {
    /// Surface it becomes.
    pub surface: &'a str,
    /// File, as written.
    pub file: &'a Spanned<String>,
    /// File units to metres.
    pub scale: f64,
    /// Turn y up into z up.
    pub y_up: bool,
    /// Material for all faces.
    pub material: Option<u32>,
    /// Material for faces whose own is not usable, with `None` if that is a mistake.
    pub fallback: Option<u32>,
    pub division: Division<'a>,
}

/// What a scene file is read into.
pub(super) struct Gathered<'a> {
    pub materials: &'a mut Materials,
    pub notices: &'a mut Vec<String>,
    pub bands: &'a [String],
    /// True if red, green and blue of material libraries mean the scene's bands.
    pub rgb: bool,
}

/// A mesh file being read.
struct Reader<'a, 'g> {
    check: Check<'a>,
    spec: &'a MeshSpec<'a>,
    source: Source,
    obj: Obj,
    gathered: &'a mut Gathered<'g>,
    tally: Tally,
}

/// Mended faces: how many, and the line of the first.
#[derive(Default)]
struct Tally {
    split: Option<(usize, usize, f64)>,
    dropped: Option<(usize, usize)>,
    whole: usize,
}

/// Reads the faces of a mesh; planar convex ones stay whole, others are cut into triangles.
pub(super) fn faces(check: Check, folder: &Folder, spec: &MeshSpec, gathered: &mut Gathered) -> Checked<Vec<Face>> {
    let path = folder.locate(check, spec.file.span(), Path::new(""), spec.file.get_ref())?;
    let source = open(check, spec.file.span(), &path)?;
    let outer = outer(check, spec);
    let obj = Obj::parse(&source.text).map_err(|e| in_line(&source, Refusal::Syntax, e).within(&outer))?;
    let mut reader = Reader { check, spec, source, obj, gathered, tally: Tally::default() };
    let numbers = reader.material_numbers(folder, &path)?;
    let mut faces = Vec::with_capacity(reader.obj.faces.len());
    for face in reader.obj.faces.clone() {
        let material = reader.material_of(&face, &numbers)?;
        reader.add(&face, material, &mut faces)?;
    }
    if faces.is_empty() {
        let message = format!("\"{}\" has no face with an area", spec.file.get_ref());
        return check.refuse(Refusal::Empty, spec.file.span(), message, "give a mesh with faces (f lines)");
    }
    reader.tell();
    Ok(faces)
}

/// The place in the scene file that names the mesh.
fn outer(check: Check, spec: &MeshSpec) -> String {
    let span = spec.file.span();
    format!("{}, {}", check.source.at(&span), check.source.block(&span))
}

/// A mistake in a line of a mesh or a library.
fn in_line(source: &Source, refusal: Refusal, e: LineError) -> SceneFileError {
    SceneFileError::new(source, refusal, span_of_line(&source.text, e.line), e.message).mend(e.mend)
}

fn span_of_line(text: &str, line: usize) -> Range<usize> {
    let mut start = 0;
    for (i, l) in text.split_inclusive('\n').enumerate() {
        if i + 1 == line {
            return start..start + l.trim_end().len();
        }
        start += l.len();
    }
    start..start
}

impl Reader<'_, '_> {
    fn refuse<T>(&self, refusal: Refusal, line: usize, message: String, mend: &str) -> Checked<T> {
        let e = LineError { line, message, mend: mend.into() };
        Err(in_line(&self.source, refusal, e).within(&outer(self.check, self.spec)))
    }

    /// Scene materials for the file's own, by their number there; `None` for those of no use.
    fn material_numbers(&mut self, folder: &Folder, path: &Path) -> Checked<Vec<Option<u32>>> {
        let names = self.obj.materials.list.clone();
        if self.spec.material.is_some() || names.is_empty() {
            return Ok(vec![None; names.len()]);
        }
        let library = self.library(folder, path)?;
        let mut used = vec![None; names.len()];
        for face in &self.obj.faces {
            if let Some((m, line)) = face.material {
                used[m as usize].get_or_insert(line);
            }
        }
        names
            .iter()
            .zip(used)
            .map(|(name, line)| match line {
                Some(line) => self.adopt(name, line, &library),
                None => Ok(None),
            })
            .collect()
    }

    /// All materials of the libraries that the file names, by name.
    fn library(&mut self, folder: &Folder, path: &Path) -> Checked<BTreeMap<String, (Mtl, Source)>> {
        let base = folder.relative(path).parent().unwrap_or(Path::new("")).to_path_buf();
        let outer = outer(self.check, self.spec);
        let mut library = BTreeMap::new();
        for (file, line) in self.obj.libraries.clone() {
            let check = Check { source: &self.source };
            let span = span_of_line(&self.source.text, line);
            let found = folder.locate(check, span.clone(), &base, &file);
            let source = match found.and_then(|p| open(check, span, &p)) {
                Ok(source) => source,
                // Without its library the mesh can still be read where the scene file gives a material.
                Err(_) if self.spec.fallback.is_some() => continue,
                Err(e) => return Err(e.mend("add the file, or give the surface a material = ").within(&outer)),
            };
            let read = mtl::parse(&source.text).map_err(|e| in_line(&source, Refusal::Syntax, e).within(&outer))?;
            for material in read {
                library
                    .entry(material.name.clone())
                    .or_insert((material, Source { name: source.name.clone(), text: String::new() }));
            }
        }
        Ok(library)
    }

    /// Makes a material of the scene from one of a library.
    fn adopt(&mut self, name: &str, line: usize, library: &BTreeMap<String, (Mtl, Source)>) -> Checked<Option<u32>> {
        let mend = "give the surface a material = ";
        if self.spec.fallback.is_some() && !self.usable(library.get(name)) {
            return Ok(None);
        }
        let Some((mtl, source)) = library.get(name) else {
            let known = known_names(name, library.keys().map(String::as_str));
            return self.refuse(Refusal::Name, line, format!("no material library defines \"{name}\" ({known})"), mend);
        };
        if !self.gathered.rgb {
            let bands = self.gathered.bands.join(", ");
            let message =
                format!("material \"{name}\" has red, green and blue, but the bands of the scene are {bands}");
            return self.refuse(Refusal::Bands, line, message, mend);
        }
        let at = |line: usize| format!("{}:{line}", source.name);
        if mtl.kd.is_none() && mtl.ke.is_none() {
            let message = format!("material \"{name}\" ({}) has neither Kd nor Ke", at(mtl.line));
            return self.refuse(Refusal::Name, line, message, mend);
        }
        let (kd, kd_line) = mtl.kd.unwrap_or(([0.0; 3], mtl.line));
        let (ke, ke_line) = mtl.ke.unwrap_or(([0.0; 3], mtl.line));
        if let Some(v) = kd.iter().find(|v| !(0.0..1.0).contains(*v)) {
            let message = format!("material \"{name}\" reflects Kd = {v} ({}), outside [0, 1)", at(kd_line));
            return self.refuse(Refusal::Number, line, message, mend);
        }
        if let Some(v) = ke.iter().find(|v| **v < 0.0) {
            let message = format!("material \"{name}\" emits Ke = {v} ({}), less than nothing", at(ke_line));
            return self.refuse(Refusal::Number, line, message, mend);
        }
        for what in &mtl.left_out {
            self.gathered.notices.push(format!("{}: material \"{name}\": {what} is left out", at(mtl.line)));
        }
        let full = format!("{}/{name}", self.spec.surface);
        let material = Material { name: full.clone(), reflectance: kd.to_vec(), emission: ke.to_vec() };
        if !self.gathered.materials.add(material) {
            let message = format!("the scene has a material \"{full}\" already");
            return self.refuse(
                Refusal::Name,
                line,
                message,
                "rename that one: mesh materials are called surface/material",
            );
        }
        Ok(self.gathered.materials.number(&full))
    }

    fn usable(&self, found: Option<&(Mtl, Source)>) -> bool {
        let in_range = |m: &Mtl| {
            let kd = m.kd.map_or([0.0; 3], |k| k.0);
            kd.iter().all(|v| (0.0..1.0).contains(v)) && m.ke.is_none_or(|k| k.0.iter().all(|v| *v >= 0.0))
        };
        self.gathered.rgb && found.is_some_and(|(m, _)| (m.kd.is_some() || m.ke.is_some()) && in_range(m))
    }

    fn material_of(&self, face: &ObjFace, numbers: &[Option<u32>]) -> Checked<u32> {
        let own = face.material.and_then(|(m, _)| numbers[m as usize]);
        match self.spec.material.or(own).or(self.spec.fallback) {
            Some(number) => Ok(number),
            None => self.refuse(
                Refusal::Key,
                face.line,
                "the face has no material".into(),
                "add usemtl and mtllib to the mesh, or give the surface a material = ",
            ),
        }
    }

    /// Adds a face, mended where it must be.
    fn add(&mut self, face: &ObjFace, material: u32, faces: &mut Vec<Face>) -> Checked<()> {
        let corners: Vec<DVec3> = self.obj.corners(face).into_iter().map(|p| self.placed(p)).collect();
        match flaw(&corners) {
            None => self.push(corners, material, faces),
            Some(Flaw::NoArea) => {
                self.drop(face.line);
                Ok(())
            }
            Some(other) => {
                let Some(parts) = ears(&corners) else {
                    let message = self.titled(face, "the face crosses itself");
                    return self.refuse(Refusal::Geometry, face.line, message, "split it into triangles");
                };
                let off =
                    if matches!(other, Flaw::NotPlanar(_)) { plane_defect(&corners) * diameter(&corners) } else { 0.0 };
                let (count, first, most) = self.tally.split.unwrap_or((0, face.line, 0.0));
                self.tally.split = Some((count + 1, first, most.max(off)));
                for part in parts {
                    match flaw(&part) {
                        None => self.push(part.to_vec(), material, faces)?,
                        Some(_) => self.drop(face.line),
                    }
                }
                Ok(())
            }
        }
    }

    fn titled(&self, face: &ObjFace, what: &str) -> String {
        match face.group {
            Some(g) => format!("{what} (in \"{}\")", self.obj.groups.list[g as usize].escape_debug()),
            None => what.into(),
        }
    }

    fn drop(&mut self, line: usize) {
        let (count, first) = self.tally.dropped.unwrap_or((0, line));
        self.tally.dropped = Some((count + 1, first));
    }

    fn push(&mut self, vertices: Vec<DVec3>, material: u32, faces: &mut Vec<Face>) -> Checked<()> {
        let (patches, elements) = self.spec.division.of(self.check, &vertices)?;
        let asked = self.spec.division.patches.is_some() || self.spec.division.elements.is_some();
        self.tally.whole += usize::from(asked && patches == Grid::Whole);
        faces.push(Face { vertices, material, patches, elements });
        Ok(())
    }

    /// From file units and axes to metres, z up.
    fn placed(&self, p: DVec3) -> DVec3 {
        let p = p * self.spec.scale;
        if self.spec.y_up { DVec3::new(p.x, -p.z, p.y) } else { p }
    }

    /// Leaves notices about what was mended.
    fn tell(&mut self) {
        let file = &self.source.name;
        let mut notices = Vec::new();
        if let Some((count, line, off)) = self.tally.split {
            notices.push(format!(
                "{file}:{line}: {count} faces that are not planar or not convex were split into triangles \
                 (up to {off:.1e} m off their planes)"
            ));
        }
        if let Some((count, line)) = self.tally.dropped {
            notices.push(format!("{file}:{line}: {count} faces without area were left out"));
        }
        if self.tally.whole > 0 {
            let count = self.tally.whole;
            notices.push(format!("{file}: {count} faces that cannot be divided (five or more corners) stay one patch"));
        }
        for (statement, count) in &self.obj.ignored {
            notices.push(format!("{file}: {count} statements \"{statement}\" were left out"));
        }
        self.gathered.notices.append(&mut notices);
    }
}
