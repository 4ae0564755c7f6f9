//! What stands in the header, as JSON, and the bytes of pictures.

use super::SPAN_FORMAT;
use super::fault::{Fault, damaged};
use crate::compositing::{Cluster, SpanImage};
use crate::scene::{Appearance, Material};
use crate::view::{Camera, Photometry};
use serde::{Deserialize, Serialize};

/// Everything but faces, segments and pixels.
#[derive(Serialize, Deserialize)]
struct Written {
    format: String,
    camera: Camera,
    per_line: u32,
    photometry: Photometry,
    materials: Vec<Material>,
    clusters: Vec<Cluster>,
    appearance: Appearance,
    surfaces: Vec<String>,
    faces: u64,
    vertices: u64,
    lines: u64,
    solid: u64,
    over: u64,
}

/// What the other sections are read with.
pub(super) struct Head {
    /// Names that faces refer to by number.
    pub surfaces: Vec<String>,
    pub faces: usize,
    pub vertices: usize,
    pub lines: usize,
    /// Segments in `solid` and `over` of all lines.
    pub segments: [u64; 2],
}

/// Names of surfaces in order of their first face.
pub(super) fn surfaces(image: &SpanImage) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for face in &image.faces {
        // Faces are in order of names.
        if names.last() != Some(&face.key.0) {
            names.push(face.key.0.clone());
        }
    }
    names
}

pub(super) fn write(image: &SpanImage) -> Result<Vec<u8>, Fault> {
    let head = Written {
        format: SPAN_FORMAT.into(),
        camera: image.camera.clone(),
        per_line: image.per_line,
        photometry: image.photometry.clone(),
        materials: image.materials.clone(),
        clusters: image.clusters.clone(),
        appearance: without_pixels(&image.appearance),
        surfaces: surfaces(image),
        faces: image.faces.len() as u64,
        vertices: image.faces.iter().map(|f| f.vertices.len() as u64).sum(),
        lines: image.lines.len() as u64,
        solid: image.lines.iter().map(|l| l.solid.len() as u64).sum(),
        over: image.lines.iter().map(|l| l.over.len() as u64).sum(),
    };
    serde_json::to_vec(&head).map_err(|e| damaged("section \"head\"", format!("cannot be written: {e}")))
}

/// A copy without the bytes of pictures, which may be many.
fn without_pixels(appearance: &Appearance) -> Appearance {
    let light =
        |p: &crate::scene::Picture| crate::scene::Picture { name: p.name.clone(), size: p.size, rgba: Vec::new() };
    Appearance {
        lights: appearance.lights.clone(),
        fog: appearance.fog.clone(),
        background: appearance.background.clone(),
        finishes: appearance.finishes.clone(),
        trees: appearance.trees.clone(),
        pictures: appearance.pictures.iter().map(light).collect(),
    }
}

/// The image without faces, pixels and lines, and what is needed to read them.
pub(super) fn read(bytes: &[u8]) -> Result<(SpanImage, Head), Fault> {
    let broken = |problem: String| damaged("section \"head\"", problem);
    let written: Written = serde_json::from_slice(bytes).map_err(|e| broken(format!("is no sound header: {e}")))?;
    if written.format != SPAN_FORMAT {
        return Err(broken(format!("is of format {}", written.format.escape_debug())));
    }
    let count = |n: u64| usize::try_from(n).map_err(|_| broken(format!("the count {n} is out of range")));
    let head = Head {
        faces: count(written.faces)?,
        vertices: count(written.vertices)?,
        lines: count(written.lines)?,
        segments: [written.solid, written.over],
        surfaces: written.surfaces,
    };
    let image = SpanImage {
        camera: written.camera,
        per_line: written.per_line,
        photometry: written.photometry,
        materials: written.materials,
        clusters: written.clusters,
        faces: Vec::new(),
        appearance: written.appearance,
        lines: Vec::new(),
    };
    Ok((image, head))
}

/// All pictures, one after the other.
pub(super) fn picture_bytes(image: &SpanImage) -> Vec<u8> {
    image.appearance.pictures.iter().flat_map(|p| p.rgba.iter().copied()).collect()
}

/// Gives the pictures of a header their bytes.
pub(super) fn read_pictures(appearance: &mut Appearance, bytes: &[u8]) -> Result<(), Fault> {
    let mut rest = bytes;
    for picture in &mut appearance.pictures {
        let [w, h] = picture.size.map(u64::from);
        let length = usize::try_from(w.saturating_mul(h).saturating_mul(4)).ok();
        let cut = length.and_then(|n| rest.split_at_checked(n));
        let (own, after) =
            cut.ok_or_else(|| damaged("section \"pict\"", "has not the pixels that the header names"))?;
        picture.rgba = own.to_vec();
        rest = after;
    }
    match rest.len() {
        0 => Ok(()),
        left => Err(damaged("section \"pict\"", format!("{left} bytes are left over"))),
    }
}
