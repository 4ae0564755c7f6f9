//! The face table, its corners, and the depth planes for readers that want them ready.

use super::bytes::{Reader, planes, put, words};
use super::fault::{Fault, damaged};
use super::frame::{Sections, Writer};
use super::head::Head;
use crate::compositing::{SpanFace, SpanImage};
use crate::math::DVec3;

const FACE: &str = "section \"face\"";
const TWO_SIDED: u8 = 1;
const TREE: u8 = 2;

pub(super) fn write(image: &SpanImage, out: &mut Writer) -> Result<(), Fault> {
    let mut table = Vec::new();
    let mut surface = 0u64;
    for (k, face) in image.faces.iter().enumerate() {
        surface += u64::from(k > 0 && image.faces[k - 1].key.0 != face.key.0);
        put(&mut table, surface);
        put(&mut table, u64::from(face.key.1));
        put(&mut table, face.vertices.len() as u64);
        put(&mut table, u64::from(face.material));
        put(&mut table, u64::from(face.cluster));
        let tree = if face.tree.is_some() { TREE } else { 0 };
        table.push(tree | if face.two_sided { TWO_SIDED } else { 0 });
        if let Some(tree) = face.tree {
            put(&mut table, u64::from(tree));
        }
    }
    out.section(*b"face", &table)?;
    let corners = || image.faces.iter().flat_map(|f| &f.vertices);
    let axis = |a: usize| corners().map(move |v| v[a].to_bits());
    out.section(*b"vert", &planes(&(0..3).flat_map(axis).collect::<Vec<_>>()))?;
    let depths: Vec<_> = image.faces.iter().map(|f| f.depth(&image.camera)).collect();
    let parts = depths.iter().map(|d| d.at).chain(depths.iter().map(|d| d.along_x));
    let bits: Vec<u64> = parts.chain(depths.iter().map(|d| d.along_y)).map(f64::to_bits).collect();
    out.section(*b"dpth", &planes(&bits))
}

pub(super) fn read(head: &Head, sections: &mut Sections) -> Result<Vec<SpanFace>, Fault> {
    let table = sections.next(*b"face")?;
    let corners = sections.next(*b"vert")?;
    let depths = sections.next(*b"dpth")?;
    let fits = |bytes: &[u8], count: usize| count.checked_mul(24) == Some(bytes.len());
    if !fits(&corners, head.vertices) || !fits(&depths, head.faces) {
        return Err(damaged("section \"vert\"", "has not the numbers that the header counts"));
    }
    let corners = words(&corners).unwrap_or_default();
    let coordinate = |axis: usize, k: usize| f64::from_bits(corners[axis * head.vertices + k]);
    let mut reader = Reader::new(FACE, &table);
    let mut used = 0;
    // No count is believed: memory grows with what has been read.
    let mut faces = Vec::new();
    for _ in 0..head.faces {
        let (surface, facet, sides) = (reader.index()?, reader.index()?, reader.index()? as usize);
        let (material, cluster, flags) = (reader.index()?, reader.index()?, reader.byte()?);
        let tree = if flags & TREE != 0 { Some(reader.index()?) } else { None };
        if flags & !(TREE | TWO_SIDED) != 0 {
            return Err(damaged(FACE, format!("the marks {flags} are not known")));
        }
        let name = head.surfaces.get(surface as usize).ok_or_else(|| damaged(FACE, "a surface has no name"))?;
        if sides > head.vertices - used {
            return Err(damaged(FACE, "the faces have more corners than there are"));
        }
        let corner = |k| DVec3::new(coordinate(0, k), coordinate(1, k), coordinate(2, k));
        let vertices = (used..used + sides).map(corner).collect();
        used += sides;
        let (key, two_sided) = ((name.clone(), facet), flags & TWO_SIDED != 0);
        faces.push(SpanFace { key, vertices, material, cluster, two_sided, tree });
    }
    reader.done()?;
    match used == head.vertices {
        true => Ok(faces),
        false => Err(damaged(FACE, "corners are left over")),
    }
}
