//! A mesh as its file has it, whatever the format.

use super::keep::Carried;
use crate::io::scene::check::LARGEST;
use crate::io::scene::error::{Refusal, SceneFileError};
use crate::io::scene::polygon::MAX_CORNERS;
use crate::io::scene::source::Source;
use crate::math::DVec3;
use std::collections::HashMap;
use std::ops::Range;

/// Vertices and faces in file units and file axes.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    pub vertices: Vec<DVec3>,
    pub faces: Vec<MeshFace>,
    pub materials: Vec<FileMaterial>,
    /// Names of groups, objects or nodes.
    pub groups: Names,
    /// What the places of faces are called in files without lines.
    pub parts: Vec<String>,
    /// What was left out, without the file name.
    pub notices: Vec<String>,
    /// What was asked for beside the shape.
    pub carried: Carried,
    /// All corners, face by face.
    corners: Vec<u32>,
    /// Texture coordinates of all corners, by number; empty if not kept.
    textures: Vec<u32>,
}

/// One face of a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct MeshFace {
    start: u32,
    count: u32,
    /// Where it stands and what it belongs to.
    pub tags: FaceTags,
}

/// What a face belongs to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FaceTags {
    /// Line, counted from 1; with `part`, number in it, counted from 0.
    pub at: u32,
    /// Index into [`Mesh::parts`].
    pub part: Option<u32>,
    /// Index into [`Mesh::materials`].
    pub material: Option<u32>,
    /// Index into [`Mesh::groups`].
    pub group: Option<u32>,
}

impl Mesh {
    /// Corners of a face.
    pub(super) fn corners(&self, face: &MeshFace) -> Vec<DVec3> {
        self.vertex_numbers(face).iter().map(|i| self.vertices[*i as usize]).collect()
    }

    /// Numbers of the vertices of a face.
    pub(super) fn vertex_numbers(&self, face: &MeshFace) -> &[u32] {
        &self.corners[face.start as usize..][..face.count as usize]
    }

    /// Numbers of the texture coordinates of a face's corners; empty if not kept.
    pub(super) fn texture_numbers(&self, face: &MeshFace) -> &[u32] {
        self.textures.get(face.start as usize..(face.start + face.count) as usize).unwrap_or_default()
    }

    /// Adds a face; a corner written twice in a row is the same corner.
    pub(super) fn add_face(
        &mut self,
        corners: impl IntoIterator<Item = Result<u32, MeshFault>>,
        tags: FaceTags,
    ) -> Result<(), MeshFault> {
        self.add_textured_face(corners.into_iter().map(|c| c.map(|vertex| (vertex, None))), tags)
    }

    /// The same with the number of each corner's texture coordinates: for all corners of the mesh, or for none.
    pub(super) fn add_textured_face(
        &mut self,
        corners: impl IntoIterator<Item = Result<(u32, Option<u32>), MeshFault>>,
        tags: FaceTags,
    ) -> Result<(), MeshFault> {
        let start = self.corners.len();
        for corner in corners {
            let (index, texture) = corner?;
            if self.corners.len() == start || self.corners.last() != Some(&index) {
                self.corners.push(index);
                self.textures.extend(texture);
            }
        }
        if self.corners.len() > start + 1 && self.corners.last() == self.corners.get(start) {
            self.corners.pop();
            self.textures.pop();
        }
        let count = self.corners.len() - start;
        let at = || self.place_of(&tags);
        if count == 0 {
            return MeshFault::new(at(), "the face has no corners").mend("give three or more vertex numbers");
        }
        if count > MAX_CORNERS {
            return MeshFault::new(at(), format!("the face has {count} corners")).mend("split it into smaller ones");
        }
        let (Ok(start), Ok(count)) = (u32::try_from(start), u32::try_from(count)) else {
            return MeshFault::new(at(), "the mesh has more corners than can be numbered").mend("split the file");
        };
        self.faces.push(MeshFace { start, count, tags });
        Ok(())
    }

    /// Where a face stands.
    pub(super) fn place_of(&self, tags: &FaceTags) -> At {
        match tags.part {
            None => At::Line(tags.at as usize),
            Some(part) => At::Part(format!("{} {}", self.parts[part as usize], tags.at)),
        }
    }
}

/// A material as the mesh file or its library has it.
#[derive(Debug)]
pub(super) struct FileMaterial {
    pub name: String,
    /// Where the mesh names it first.
    pub used_at: At,
    /// Its colours, or why it is of no use.
    pub optics: Result<Optics, Unusable>,
    /// Where it is defined.
    pub defined_at: String,
    /// Textures, mirrors and transparency that diffuse radiosity leaves out.
    pub left_out: Vec<String>,
    /// The file wants both sides of its faces to be seen.
    pub double_sided: bool,
}

/// Red, green and blue of Rec. 709, linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Optics {
    pub reflectance: [f64; 3],
    /// Self-emitted radiosity, W/m^2.
    pub emission: [f64; 3],
}

/// Why a material cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unusable {
    pub refusal: Refusal,
    pub message: String,
}

/// A colour with its name in the file and its place, for messages.
pub(super) type Colour<'a> = ([f64; 3], &'a str, String);

/// Checks the colours of a material.
pub(super) fn optics(name: &str, reflectance: Colour, emission: Colour) -> Result<Optics, Unusable> {
    let unusable = |message| Err(Unusable { refusal: Refusal::Number, message });
    let (kd, key, at) = reflectance;
    if let Some(v) = kd.iter().find(|v| !(0.0..1.0).contains(*v)) {
        return unusable(format!("material \"{name}\" reflects {key} = {v} ({at}), outside [0, 1)"));
    }
    let (ke, key, at) = emission;
    if let Some(v) = ke.iter().find(|v| **v < 0.0) {
        return unusable(format!("material \"{name}\" emits {key} = {v} ({at}), less than nothing"));
    }
    match ke.iter().find(|v| !v.is_finite()) {
        Some(v) => unusable(format!("material \"{name}\" emits {key} = {v} ({at})")),
        None => Ok(Optics { reflectance: kd, emission: ke }),
    }
}

/// Names in order of appearance.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub list: Vec<String>,
    numbers: HashMap<String, u32>,
}

impl Names {
    /// The number of a name, added if new.
    pub(super) fn number(&mut self, name: &str) -> u32 {
        if let Some(number) = self.numbers.get(name) {
            return *number;
        }
        let number = self.list.len() as u32;
        self.list.push(name.to_string());
        self.numbers.insert(name.to_string(), number);
        number
    }
}

/// A place in a mesh file.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum At {
    /// Line, counted from 1.
    Line(usize),
    /// In words: `face 12`, `buffers[0].uri`.
    Part(String),
    /// The file as a whole.
    File,
}

/// What is wrong with a mesh file, where, and the mend.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeshFault {
    pub refusal: Refusal,
    pub at: At,
    pub message: String,
    pub mend: String,
}

impl MeshFault {
    /// A fault of syntax; `mend` finishes it.
    pub(super) fn new(at: At, message: impl Into<String>) -> Self {
        Self { refusal: Refusal::Syntax, at, message: message.into(), mend: String::new() }
    }

    /// Of another kind.
    pub(super) fn of(mut self, refusal: Refusal) -> Self {
        self.refusal = refusal;
        self
    }

    /// The fault as a result, with its mend.
    pub(super) fn mend<T>(mut self, mend: impl Into<String>) -> Result<T, Self> {
        self.mend = mend.into();
        Err(self)
    }

    /// The refusal of the scene that comes of it.
    pub(super) fn in_file(self, source: &Source) -> SceneFileError {
        let e = match self.at {
            At::Line(line) => SceneFileError::new(source, self.refusal, span_of_line(&source.text, line), self.message),
            At::Part(part) => SceneFileError::whole(&format!("{}, {part}", source.name), self.refusal, self.message),
            At::File => SceneFileError::whole(&source.name, self.refusal, self.message),
        };
        e.mend(self.mend)
    }
}

/// A fault of syntax in a line.
pub(super) fn fault<T>(line: usize, message: impl Into<String>, mend: impl Into<String>) -> Result<T, MeshFault> {
    MeshFault::new(At::Line(line), message).mend(mend)
}

/// Bytes of a line, counted from 1.
pub(super) fn span_of_line(text: &str, line: usize) -> Range<usize> {
    let mut start = 0;
    for (i, l) in text.split_inclusive('\n').enumerate() {
        if i + 1 == line {
            return start..start + l.trim_end().len();
        }
        start += l.len();
    }
    start..start
}

/// A word of a file as it can stand in a message.
pub(super) fn shown(word: &str) -> String {
    word.chars().take(40).collect::<String>().escape_debug().to_string()
}

/// A name of a group or material as it can stand in one line of a table.
pub(super) fn one_line(name: &str) -> String {
    name.chars().take(120).map(|c| if c.is_control() { '_' } else { c }).collect::<String>().trim().to_string()
}

/// A finite number within reach, from text.
pub(super) fn number(line: usize, word: &str) -> Result<f64, MeshFault> {
    match word.parse::<f64>() {
        Ok(v) => within_reach(v).ok_or(()).or_else(|()| {
            fault(line, format!("the number {v} is not finite or beyond {LARGEST:e}"), "give a finite number")
        }),
        Err(_) => fault(line, format!("\"{}\" is not a number", shown(word)), "give a decimal number"),
    }
}

/// The number if it is finite and not beyond all sense.
pub(super) fn within_reach(v: f64) -> Option<f64> {
    (v.is_finite() && v.abs() <= LARGEST).then_some(v)
}
