//! PLY: polygons from text or binary files, with the line or face of every mistake.

mod ascii;
mod binary;
mod header;
mod kept;

use super::keep::Keep;
use super::model::{At, FaceTags, Mesh, MeshFault, within_reach};
use crate::io::scene::check::LARGEST;
use crate::io::scene::error::Refusal;
use crate::math::DVec3;
use header::{Encoding, Header};
use kept::Kept;

/// The part of a file that has lines: all of it, or the header of a binary one.
pub(super) fn text(bytes: &[u8]) -> &[u8] {
    match Header::parse(bytes) {
        Ok(Header { encoding: Encoding::LittleEndian | Encoding::BigEndian, body, .. }) => &bytes[..body],
        _ => bytes,
    }
}

/// Parses a file.
pub(super) fn parse(bytes: &[u8], keep: Keep) -> Result<Mesh, MeshFault> {
    let header = Header::parse(bytes)?;
    let mut sink = Sink::new(&header, keep)?;
    match header.encoding {
        Encoding::Ascii => ascii::read(&header, bytes, &mut sink)?,
        Encoding::LittleEndian => binary::read::<true>(&header, bytes, &mut sink)?,
        Encoding::BigEndian => binary::read::<false>(&header, bytes, &mut sink)?,
    }
    sink.finish(&header)
}

/// Which properties of an element are wanted, by their place in it.
enum Wanted {
    Vertex([usize; 3]),
    Face(usize),
    Nothing,
}

/// Collects what the elements hold.
struct Sink {
    mesh: Mesh,
    wanted: Vec<Wanted>,
    kept: Kept,
    /// True if colours are not told of.
    silent: bool,
    /// Corners as read, face by face: vertices may follow the faces.
    corners: Vec<i64>,
    /// Per face: end of its corners, and its place.
    faces: Vec<(usize, u32)>,
    /// False if places are lines.
    binary: bool,
}

impl Sink {
    fn new(header: &Header, keep: Keep) -> Result<Self, MeshFault> {
        let wanted = header.wanted()?;
        let mut kept = kept::choose(header, keep)?;
        let binary = header.encoding != Encoding::Ascii;
        let parts = if binary { vec!["face".to_string()] } else { Vec::new() };
        let mut mesh = Mesh::default();
        mesh.parts = parts;
        mesh.carried.bands = std::mem::take(&mut kept.bands);
        mesh.notices.extend(kept.notice.take());
        let silent = keep != Keep::Shape;
        Ok(Self { mesh, wanted, kept, silent, corners: Vec::new(), faces: Vec::new(), binary })
    }

    fn vertex(&mut self, p: [f64; 3], values: &[f64], at: impl Fn() -> At) -> Result<(), MeshFault> {
        if let Some(v) = p.iter().find(|v| within_reach(**v).is_none()) {
            let message = format!("a coordinate is {v}, which is not finite or beyond {LARGEST:e}");
            return MeshFault::new(at(), message).mend("give finite numbers");
        }
        self.mesh.vertices.push(DVec3::from(p));
        self.mesh.carried.of_vertices.extend_from_slice(sound(values, at)?);
        Ok(())
    }

    /// The corners of a face, `at` its line or number.
    fn face(&mut self, corners: &[i64], values: &[f64], at: u32) -> Result<(), MeshFault> {
        if corners.len() < 3 {
            let place = self.mesh.place_of(&self.tags(at));
            let message = format!("the face has {} corners", corners.len());
            return MeshFault::new(place, message).mend("give three or more; edges and points cannot radiate");
        }
        let values = sound(values, || self.mesh.place_of(&self.tags(at)))?;
        self.mesh.carried.of_faces.extend_from_slice(values);
        self.corners.extend_from_slice(corners);
        self.faces.push((self.corners.len(), at));
        Ok(())
    }

    fn tags(&self, at: u32) -> FaceTags {
        FaceTags { at, part: self.binary.then_some(0), ..FaceTags::default() }
    }

    fn finish(mut self, header: &Header) -> Result<Mesh, MeshFault> {
        let count = self.mesh.vertices.len();
        let mut start = 0;
        for (end, at) in std::mem::take(&mut self.faces) {
            let tags = self.tags(at);
            let binary = self.binary;
            let place = || if binary { At::Part(format!("face {at}")) } else { At::Line(at as usize) };
            let corners = self.corners[start..end].iter().map(|i| match usize::try_from(*i) {
                Ok(index) if index < count => Ok(index as u32),
                _ => MeshFault::new(place(), format!("the face names vertex {i}, but there are {count}"))
                    .mend("vertices count from 0"),
            });
            self.mesh.add_face(corners, tags)?;
            start = end;
        }
        let coloured: Vec<&str> = header.elements.iter().filter(|e| e.has_colours()).map(|e| e.name.as_str()).collect();
        if !coloured.is_empty() && !self.silent {
            let which = coloured.join(" and ");
            self.mesh.notices.push(format!("colours ({which}) are left out: they are no reflectances"));
        }
        Ok(self.mesh)
    }
}

/// Values that are all finite.
fn sound(values: &[f64], at: impl Fn() -> At) -> Result<&[f64], MeshFault> {
    match values.iter().find(|v| !v.is_finite()) {
        None => Ok(values),
        Some(v) => MeshFault::new(at(), format!("a value is {v}"))
            .of(Refusal::Number)
            .mend("give finite numbers, or leave faces without a value out of the file"),
    }
}

#[cfg(test)]
mod tests;
