//! glTF 2.0 (`.gltf` with its buffers, or `.glb`): triangles where the nodes of the scene put them.
//!
//! Our own reader on serde: the `gltf` crate holds colours and placements in single precision, so that a
//! reflectance of 0.7 would come out as 0.699999988, and refuses files that lack data nobody needs here.

mod buffers;
mod carried;
mod container;
mod json;
mod materials;
mod nodes;
mod primitives;

use super::Near;
use super::keep::Keep;
use super::model::{At, FaceTags, Mesh, MeshFault, one_line, shown};
use crate::io::scene::error::Refusal;
use crate::io::scene::folder::lossy;
use crate::io::scene::source::Source;
use crate::math::DVec3;
use crate::scene::MAX_PATCHES;
use buffers::Buffers;
use json::{Primitive, Root};
use nodes::Shown;
use primitives::{Mode, triangles};

/// Most vertices over all nodes: a small file may show a mesh many times.
const MAX_VERTICES: usize = 1 << 24;

/// Parses a file; the source is its JSON.
pub(super) fn parse(bytes: Vec<u8>, near: &Near) -> (Source, Result<Mesh, MeshFault>) {
    if !container::is_glb(&bytes) {
        let source = Source::new(near.path, lossy(bytes));
        let mesh = read_json(&source.text, false).and_then(|root| mesh_of(&root, near, &source.name, None));
        return (source, mesh);
    }
    let source = Source::new(near.path, String::new());
    let mesh = container::chunks(&bytes).and_then(|chunks| {
        let root = read_json(&String::from_utf8_lossy(&bytes[chunks.json]), true)?;
        mesh_of(&root, near, &source.name, chunks.bin.map(|range| &bytes[range]))
    });
    (source, mesh)
}

/// Reads the JSON; in a GLB file its lines are places in words.
fn read_json(text: &str, glb: bool) -> Result<Root, MeshFault> {
    let root: Root = serde_json::from_str(text.trim_start_matches('\u{feff}')).or_else(|e| {
        let at = if glb { At::Part(format!("JSON chunk, line {}", e.line())) } else { At::Line(e.line().max(1)) };
        let message = e.to_string();
        let message = message.split(" at line ").next().unwrap_or_default().to_string();
        MeshFault::new(at, message).mend("is this a glTF 2.0 file? Export it again")
    })?;
    let needed = root.asset.min_version.as_deref();
    if !root.asset.version.starts_with("2.") || needed.is_some_and(|v| v != "2.0") {
        let message = format!("the glTF version is {}", shown(needed.unwrap_or(&root.asset.version)));
        return MeshFault::new(At::Part("asset".into()), message).of(Refusal::Format).mend("export glTF 2.0");
    }
    for name in &root.extensions_required {
        if !is_harmless(name) {
            let message = format!("the file needs the extension {}, which is not read", shown(name));
            return MeshFault::new(At::Part("extensionsRequired".into()), message)
                .of(Refusal::Format)
                .mend("export without it (compression and instancing off)");
        }
    }
    Ok(root)
}

/// Extensions that change no geometry, or that are read.
fn is_harmless(extension: &str) -> bool {
    let looks = ["KHR_materials_", "KHR_texture_", "EXT_texture_"];
    looks.iter().any(|l| extension.starts_with(l))
        || matches!(extension, "KHR_mesh_quantization" | "KHR_lights_punctual")
}

/// A mesh under construction.
struct Builder<'a> {
    root: &'a Root,
    buffers: Buffers<'a>,
    mesh: Mesh,
    keep: Keep<'a>,
    /// Primitives of points and lines.
    thin: usize,
}

fn mesh_of(root: &Root, near: &Near, file: &str, bin: Option<&[u8]>) -> Result<Mesh, MeshFault> {
    let mut mesh = Mesh::default();
    mesh.materials = materials::materials(root, file);
    let mut builder = Builder { root, buffers: Buffers::new(root, near, bin), mesh, keep: near.keep, thin: 0 };
    let shown = nodes::shown(root)?;
    for node in &shown {
        builder.node(node)?;
    }
    builder.tell(&shown);
    Ok(builder.mesh)
}

impl Builder<'_> {
    /// Adds the mesh of a node.
    fn node(&mut self, shown: &Shown) -> Result<(), MeshFault> {
        let (node, mesh) = (&self.root.nodes[shown.node], &self.root.meshes[shown.mesh]);
        let name = node.name.as_ref().or(mesh.name.as_ref()).map(|n| one_line(n)).filter(|n| !n.is_empty());
        let group = name.map(|n| self.mesh.groups.number(&n));
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("meshes[{}].primitives[{number}]", shown.mesh);
            match Mode::of(primitive, &place)? {
                Some(mode) => self.primitive(primitive, mode, shown, group, &place)?,
                None => self.thin += 1,
            }
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        primitive: &Primitive,
        mode: Mode,
        shown: &Shown,
        group: Option<u32>,
        place: &str,
    ) -> Result<(), MeshFault> {
        let part = |key: &str| At::Part(format!("{place}{key}"));
        let Some(positions) = primitive.attributes.get("POSITION") else {
            return MeshFault::new(part(".attributes"), "the primitive has no POSITION").mend("export the mesh again");
        };
        if let Some(m) = primitive.material.filter(|m| *m >= self.root.materials.len()) {
            let message = format!("there is no material {m}; the file has {}", self.root.materials.len());
            return MeshFault::new(part(".material"), message).mend("export the mesh again");
        }
        let positions = self.buffers.positions(*positions)?;
        self.carry(primitive, positions.len(), place)?;
        let corners = match primitive.indices {
            Some(indices) => self.buffers.indices(indices)?,
            None => (0..positions.len() as u32).collect(),
        };
        let triangles = triangles(mode, corners.len(), place)?;
        let (faces, vertices) = (self.mesh.faces.len() + triangles.len(), self.mesh.vertices.len() + positions.len());
        if faces as u64 > MAX_PATCHES || vertices > MAX_VERTICES {
            let message = format!("the nodes show {faces} triangles and {vertices} vertices or more");
            return MeshFault::new(At::Part(format!("nodes[{}]", shown.node)), message)
                .of(Refusal::Counts)
                .mend(format!("at most {MAX_PATCHES} and {MAX_VERTICES} fit: use a coarser mesh"));
        }
        let first = self.mesh.vertices.len() as u32;
        self.mesh.vertices.extend(positions.iter().map(|p| shown.placement.transform_point3(DVec3::from(*p))));
        self.mesh.parts.push(format!("nodes[{}], {place}, triangle", shown.node));
        let textured = self.keep == Keep::Textures;
        // A mirror turns the winding round: turned back, the front stays the front.
        let mirrored = shown.placement.determinant() < 0.0;
        for (number, [a, b, c]) in triangles.into_iter().enumerate() {
            let part = Some(self.mesh.parts.len() as u32 - 1);
            let material = primitive.material.map(|m| m as u32);
            let tags = FaceTags { at: number as u32, part, material, group };
            let order = if mirrored { [a, c, b] } else { [a, b, c] };
            let corners = order.map(|k| match corners[k] {
                v if (v as usize) < positions.len() => Ok((first + v, textured.then_some(first + v))),
                v => {
                    let message = format!("the triangle names vertex {v}, but there are {}", positions.len());
                    MeshFault::new(At::Part(format!("{place}, triangle {number}")), message)
                        .mend("vertices count from 0")
                }
            });
            self.mesh.add_textured_face(corners, tags)?;
        }
        Ok(())
    }

    /// Leaves notices about what radiosity does not show.
    fn tell(&mut self, shown: &[Shown]) {
        let nodes = || shown.iter().map(|s| &self.root.nodes[s.node]);
        let primitives = || shown.iter().flat_map(|s| &self.root.meshes[s.mesh].primitives);
        let skins = nodes().filter(|n| n.skin.is_some()).count();
        let instanced = nodes().filter(|n| n.extensions.contains_key("EXT_mesh_gpu_instancing")).count();
        let lights = self.root.nodes.iter().filter(|n| n.extensions.contains_key("KHR_lights_punctual")).count();
        let morphed = primitives().filter(|p| p.targets.is_some()).count();
        let coloured = primitives().filter(|p| p.attributes.contains_key("COLOR_0")).count();
        let others = self.root.scenes.len().saturating_sub(1);
        let told = [
            (self.thin, "primitives of points and lines were left out"),
            (skins, "skins are left out: the mesh stands as it is modelled"),
            (instanced, "instanced nodes are shown once"),
            (lights, "lights are left out: surfaces are lit by emitting surfaces"),
            (morphed, "morph targets are left out"),
            (
                if self.keep == Keep::Shape { coloured } else { 0 },
                "vertex colours are left out: they are no reflectances",
            ),
            (others, "further scenes are left out"),
        ];
        let told = told.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect::<Vec<_>>();
        self.mesh.notices.extend(told);
    }
}

#[cfg(test)]
mod tests;
