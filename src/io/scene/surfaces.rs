//! `[[surface]]`, and the surfaces that edits bring in.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::folder::Folder;
use super::mesh::{self, Fallback, Gathered, MeshFile, MeshSpec};
use super::photometry::reserved;
use super::polygon::{Division, polygon};
use super::raw::{self, Numbers};
use crate::scene::{Face, Surface};
use std::ops::Range;
use toml::Spanned;

/// Object of surfaces that name none.
const DEFAULT_OBJECT: &str = "scene";

/// Reads all `[[surface]]` tables; `max_edge` divides those without `patches`.
pub(super) fn surfaces(
    check: Check,
    folder: &Folder,
    tables: &[Spanned<raw::Surface>],
    max_edge: Option<f64>,
    gathered: &mut Gathered,
) -> Checked<Vec<Surface>> {
    let mut names = std::collections::HashSet::new();
    let mut surfaces = Vec::with_capacity(tables.len());
    for table in tables {
        let raw = table.get_ref();
        let name = check.name("surface name", &raw.name)?;
        if !names.insert(name.clone()) {
            return check.refuse(
                Refusal::Name,
                raw.name.span(),
                format!("a second surface \"{name}\""),
                "give every surface its own name",
            );
        }
        reserved(check, "surface.texture", raw.texture.as_ref().map(Spanned::span))?;
        let object = raw.object.as_ref().map_or(Ok(DEFAULT_OBJECT.into()), |o| check.name("object name", o))?;
        let (faces, groups) = match (&raw.polygon, &raw.mesh) {
            (Some(_), None) => (vec![face(check, raw, max_edge, gathered)?], Vec::new()),
            (None, Some(file)) => mesh_faces(check, folder, &name, raw, file, max_edge, gathered)?,
            (Some(_), Some(mesh)) => {
                return check.refuse(
                    Refusal::Key,
                    mesh.span(),
                    "the surface has both polygon and mesh",
                    "make two surfaces of it",
                );
            }
            (None, None) => {
                return check.refuse(
                    Refusal::Key,
                    raw.name.span(),
                    "the surface has neither polygon nor mesh",
                    "add polygon = [[x, y, z], ...] or mesh = \"file.obj\"",
                );
            }
        };
        surfaces.push(Surface { name, object, faces, groups, from_mesh: raw.mesh.is_some() });
    }
    Ok(surfaces)
}

/// The one face of a polygon.
fn face(check: Check, raw: &raw::Surface, max_edge: Option<f64>, gathered: &Gathered) -> Checked<Face> {
    let only_meshes = [("scale", raw.scale.as_ref().map(Spanned::span)), ("up", raw.up.as_ref().map(Spanned::span))];
    for (key, span) in only_meshes {
        if let Some(span) = span {
            return check.refuse(
                Refusal::Key,
                span,
                format!("{key} is for meshes only"),
                "write the polygon in metres, z up",
            );
        }
    }
    let (Some(outline), Some(material)) = (&raw.polygon, &raw.material) else {
        return check.refuse(
            Refusal::Key,
            raw.name.span(),
            "the surface has no material",
            "add material = \"...\" with the name of a [[material]]",
        );
    };
    let vertices = polygon(check, outline)?;
    let material = gathered.materials.named(check, material)?;
    let division = Division { patches: raw.patches.as_ref(), elements: raw.elements.as_ref(), max_edge, mesh: false };
    let (patches, elements) = division.of(check, &vertices)?;
    let two_sided = raw.two_sided.unwrap_or(false);
    Ok(Face { vertices, material, patches, elements, two_sided, group: None })
}

fn mesh_faces(
    check: Check,
    folder: &Folder,
    name: &str,
    raw: &raw::Surface,
    file: &Spanned<String>,
    max_edge: Option<f64>,
    gathered: &mut Gathered,
) -> Checked<(Vec<Face>, Vec<String>)> {
    let material = raw.material.as_ref().map(|m| gathered.materials.named(check, m)).transpose()?;
    let spec = MeshSpec {
        surface: name,
        file: MeshFile::named(check, folder, file)?,
        scale: raw.scale.as_ref().map_or(Ok(1.0), |s| check.positive("scale", s))?,
        y_up: y_up(check, raw.up.as_ref())?,
        two_sided: raw.two_sided,
        material,
        fallback: Fallback::Refuse,
        division: Division { patches: raw.patches.as_ref(), elements: raw.elements.as_ref(), max_edge, mesh: true },
    };
    mesh::faces(check, folder, &spec, gathered)
}

fn y_up(check: Check, up: Option<&Spanned<String>>) -> Checked<Option<bool>> {
    match up.map(|u| (u.get_ref().as_str(), u.span())) {
        None => Ok(None),
        Some(("z", _)) => Ok(Some(false)),
        Some(("y", _)) => Ok(Some(true)),
        Some((other, span)) => check.refuse(
            Refusal::Key,
            span,
            format!("up is \"{}\"", other.escape_debug()),
            "use \"y\" or \"z\": the axis of the mesh file that points up",
        ),
    }
}

/// The surface that takes the place of an object in edit number `at` (counted from 1). It inherits what the
/// edit does not say: division, sidedness, and the material for faces without a usable one of their own.
pub(super) fn replacement(
    check: Check,
    folder: &Folder,
    (at, table): (usize, &Spanned<raw::Edit>),
    (object, file): (&str, &Spanned<String>),
    (old, old_table): (&Surface, Option<&raw::Surface>),
    max_edge: Option<f64>,
    gathered: &mut Gathered,
) -> Checked<Surface> {
    let raw = table.get_ref();
    let name = format!("{object} (edit {at})");
    let scale = match raw.scale.as_ref().map(|s| (s.get_ref(), s.span())) {
        None => 1.0,
        Some((Numbers::One(v), span)) => check.positive("scale", &Spanned::new(span, *v))?,
        Some((Numbers::List(_), span)) => return one_scale(check, span),
    };
    let patches = raw.patches.as_ref().or(old_table.and_then(|t| t.patches.as_ref()));
    let elements = raw.elements.as_ref().or(old_table.and_then(|t| t.elements.as_ref()));
    let spec = MeshSpec {
        surface: &name,
        file: MeshFile::named(check, folder, file)?,
        scale,
        y_up: y_up(check, raw.up.as_ref())?,
        two_sided: old.faces.first().map(|f| f.two_sided),
        material: None,
        fallback: old.faces.first().map_or(Fallback::Refuse, |f| Fallback::Material(f.material)),
        division: Division { patches, elements, max_edge, mesh: true },
    };
    let (faces, groups) = mesh::faces(check, folder, &spec, gathered)?;
    Ok(Surface { name, object: object.to_string(), faces, groups, from_mesh: true })
}

fn one_scale<T>(check: Check, span: Range<usize>) -> Checked<T> {
    check.refuse(
        Refusal::Edit,
        span,
        "scale is a list, but a mesh takes one number",
        "give file units to metres, such as 0.001; scale a standing object in an edit without mesh",
    )
}
