//! `<shape>`: outlines in the world, and what the surface is made of.

use super::bsdf::{Bsdf, bsdf};
use super::emitter::{Area, area};
use super::transform::{Affine, transform};
use super::tree::{Id, Tree, shown};
use crate::io::scene::check::Checked;
use crate::io::scene::error::Refusal;
use crate::math::DVec3;

/// Corners of the cube, face by face in Mitsuba's order, outwards.
const CUBE: [[[i8; 3]; 4]; 6] = [
    [[1, -1, -1], [1, -1, 1], [-1, -1, 1], [-1, -1, -1]],
    [[1, 1, -1], [-1, 1, -1], [-1, 1, 1], [1, 1, 1]],
    [[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]],
    [[1, -1, 1], [1, 1, 1], [-1, 1, 1], [-1, -1, 1]],
    [[-1, -1, 1], [-1, 1, 1], [-1, 1, -1], [-1, -1, -1]],
    [[1, 1, -1], [1, -1, -1], [-1, -1, -1], [-1, 1, -1]],
];

/// Parameters of shapes that say nothing about what is read here.
const HARMLESS: [&str; 5] =
    ["face_normals", "flip_tex_coords", "flip_uvs", "silhouette_sampling_weight", "max_smooth_angle"];

/// A shape as the file has it.
pub(super) struct Shape {
    pub geometry: Geometry,
    pub to_world: Affine,
    pub flipped: bool,
    pub bsdf: Bsdf,
    /// No BSDF is given.
    pub bare: bool,
    pub area: Option<Area>,
}

/// Where a shape's outlines come from.
pub(super) enum Geometry {
    /// Own outlines, in the shape's space.
    Outlines(Vec<Vec<DVec3>>),
    /// A mesh file: the element that names it.
    Mesh(Id),
}

/// Reads a shape; `None` for those of types that only hold others.
pub(super) fn shape(tree: &Tree, at: Id) -> Checked<Shape> {
    let kind = tree.kind(at)?;
    let point = |c: &[i8; 3]| DVec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]));
    let own = match kind {
        "rectangle" => Some(vec![[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]].iter().map(point).collect()]),
        "cube" => Some(CUBE.iter().map(|face| face.iter().map(point).collect()).collect()),
        "obj" | "ply" => None,
        other => {
            let message = format!("a shape of type \"{}\" is not read", shown(other));
            let mend = "shapes are rectangle, cube, obj and ply: write it as a mesh";
            return tree.refuse(at, Refusal::Reserved, message, mend);
        }
    };
    let parts = parts(tree, at, own.is_none())?;
    let geometry = match (own, parts.file) {
        (Some(outlines), _) => Geometry::Outlines(outlines),
        (None, Some(file)) => Geometry::Mesh(file),
        (None, None) => {
            let mend = "add <string name=\"filename\" value=\"...\"/>";
            return tree.refuse(at, Refusal::Key, format!("the {kind} has no filename"), mend);
        }
    };
    Ok(Shape {
        geometry,
        to_world: parts.to_world,
        flipped: parts.flipped,
        bare: parts.bsdf.is_none(),
        bsdf: parts.bsdf.unwrap_or_else(|| Bsdf::default_of(parts.area.is_some())),
        area: parts.area,
    })
}

struct Parts {
    to_world: Affine,
    flipped: bool,
    bsdf: Option<Bsdf>,
    area: Option<Area>,
    file: Option<Id>,
}

fn parts(tree: &Tree, at: Id, mesh: bool) -> Checked<Parts> {
    let mut parts = Parts { to_world: Affine::IDENTITY, flipped: false, bsdf: None, area: None, file: None };
    let twice = |child: Id, what: &str| {
        let message = format!("the shape has a second {what}");
        tree.refuse(child, Refusal::Key, message, "keep one")
    };
    for child in tree.children(at) {
        let meant = tree.resolved(child)?;
        match (tree.tag(meant), tree.name(child)) {
            ("transform", "to_world") => parts.to_world = transform(tree, meant)?,
            ("boolean", "flip_normals") => parts.flipped = tree.truth(meant)?,
            ("string", "filename") if mesh => parts.file = Some(child),
            ("bsdf", _) if parts.bsdf.is_some() => return twice(child, "BSDF"),
            ("bsdf", _) => parts.bsdf = Some(bsdf(tree, meant)?),
            ("emitter", _) if parts.area.is_some() => return twice(child, "emitter"),
            ("emitter", _) => parts.area = Some(area(tree, meant)?),
            (_, name) if HARMLESS.contains(&name) => {}
            _ => return tree.unknown(child, "the shape", &["to_world", "flip_normals", "filename"]),
        }
    }
    Ok(parts)
}
