//! Faces of a mesh placed in the scene: planar convex ones stay whole, others are cut into triangles.

use super::adopt::{grey, grey_notice};
use super::model::{Mesh, MeshFace, MeshFault};
use super::split::ears;
use super::{Fallback, Format, Gathered, Loaded, MeshSpec};
use crate::io::scene::check::{Check, Checked, LARGEST};
use crate::io::scene::error::Refusal;
use crate::io::scene::polygon::{Flaw, flaw};
use crate::math::{DVec3, diameter, plane_defect};
use crate::scene::{Face, Grid, MAX_PATCHES};

/// A mesh on its way into the scene.
struct Placing<'a> {
    check: Check<'a>,
    loaded: &'a Loaded,
    spec: &'a MeshSpec<'a>,
    y_up: bool,
    faces: Vec<Face>,
    /// Names of groups that have faces, and their numbers by those in the file.
    groups: Vec<String>,
    renumbered: Vec<Option<u32>>,
    tally: Tally,
}

/// Mended faces: how many, and the first of them.
#[derive(Default)]
struct Tally {
    split: Option<(usize, MeshFace, f64)>,
    dropped: Option<(usize, MeshFace)>,
    whole: usize,
    grey: usize,
}

/// The faces of a mesh in metres, z up, and the names of their groups.
pub(super) fn faces(
    check: Check,
    loaded: &Loaded,
    spec: &MeshSpec,
    numbers: &[Option<u32>],
    gathered: &mut Gathered,
) -> Checked<(Vec<Face>, Vec<String>)> {
    let mesh = &loaded.mesh;
    let mut placing = Placing {
        check,
        loaded,
        spec,
        // glTF says that y is up; OBJ and PLY say nothing, and the scene's own axis is z.
        y_up: spec.y_up.unwrap_or(loaded.format == Format::Gltf),
        faces: Vec::with_capacity(mesh.faces.len()),
        groups: Vec::new(),
        renumbered: vec![None; mesh.groups.list.len()],
        tally: Tally::default(),
    };
    for face in &mesh.faces {
        let own = face.tags.material.and_then(|m| numbers[m as usize]);
        let material = placing.material_of(face, own, gathered)?;
        placing.add(face, material)?;
    }
    if placing.faces.is_empty() {
        let message = format!("\"{}\" has no face with an area", spec.file.shown);
        let mend = "give a mesh with faces (f lines of OBJ, faces of PLY, triangles shown by a node of glTF)";
        return spec.file.refuse(Refusal::Empty, message, mend);
    }
    placing.tell(gathered);
    Ok((placing.faces, placing.groups))
}

impl Placing<'_> {
    fn mesh(&self) -> &Mesh {
        &self.loaded.mesh
    }

    fn refuse<T>(&self, refusal: Refusal, face: &MeshFace, message: String, mend: &str) -> Checked<T> {
        let fault = MeshFault { refusal, at: self.mesh().place_of(&face.tags), message, mend: mend.into() };
        Err(self.spec.file.within(fault.in_file(&self.loaded.source)))
    }

    fn material_of(&mut self, face: &MeshFace, own: Option<u32>, gathered: &mut Gathered) -> Checked<u32> {
        match (self.spec.material.or(own), self.spec.fallback) {
            (Some(number), _) | (None, Fallback::Material(number)) => Ok(number),
            (None, Fallback::Grey) => {
                self.tally.grey += 1;
                Ok(grey(gathered))
            }
            (None, Fallback::Refuse) => self.refuse(
                Refusal::Key,
                face,
                "the face has no material".into(),
                match self.loaded.format {
                    Format::Obj => "add usemtl and mtllib to the mesh, or give the surface a material = ",
                    Format::Ply => "PLY has no reflectances: give the surface a material = ",
                    Format::Gltf => "give the mesh a material, or give the surface a material = ",
                },
            ),
        }
    }

    /// Adds a face, mended where it must be.
    fn add(&mut self, face: &MeshFace, material: u32) -> Checked<()> {
        let corners: Vec<DVec3> = self.mesh().corners(face).into_iter().map(|p| self.placed(p)).collect();
        if corners.iter().any(|p| !(p.is_finite() && p.abs().max_element() <= LARGEST)) {
            let message = format!("a corner lies beyond {LARGEST:e} m");
            return self.refuse(Refusal::Number, face, message, "coordinates are in metres; check the unit and scale");
        }
        match flaw(&corners) {
            None => self.push(corners, material, face),
            Some(Flaw::NoArea) => {
                self.drop(face);
                Ok(())
            }
            Some(other) => self.split(&corners, other, material, face),
        }
    }

    fn split(&mut self, corners: &[DVec3], flaw_of_it: Flaw, material: u32, face: &MeshFace) -> Checked<()> {
        let Some(parts) = ears(corners) else {
            let message = self.titled(face, "the face crosses itself");
            return self.refuse(Refusal::Geometry, face, message, "split it into triangles");
        };
        let bent = matches!(flaw_of_it, Flaw::NotPlanar(_));
        let off = if bent { plane_defect(corners) * diameter(corners) } else { 0.0 };
        let (count, first, most) = self.tally.split.unwrap_or((0, *face, 0.0));
        self.tally.split = Some((count + 1, first, most.max(off)));
        for part in parts {
            match flaw(&part) {
                None => self.push(part.to_vec(), material, face)?,
                Some(_) => self.drop(face),
            }
        }
        Ok(())
    }

    fn titled(&self, face: &MeshFace, what: &str) -> String {
        match face.tags.group {
            Some(g) => format!("{what} (in \"{}\")", self.mesh().groups.list[g as usize].escape_debug()),
            None => what.into(),
        }
    }

    fn drop(&mut self, face: &MeshFace) {
        let (count, first) = self.tally.dropped.unwrap_or((0, *face));
        self.tally.dropped = Some((count + 1, first));
    }

    fn push(&mut self, vertices: Vec<DVec3>, material: u32, face: &MeshFace) -> Checked<()> {
        let (patches, elements) = self.spec.division.of(self.check, &vertices)?;
        let asked = self.spec.division.patches.is_some() || self.spec.division.elements.is_some();
        self.tally.whole += usize::from(asked && patches == Grid::Whole);
        if self.faces.len() as u64 >= MAX_PATCHES {
            let message = format!("the mesh has more faces than the {MAX_PATCHES} patches that fit");
            return self.refuse(Refusal::Counts, face, message, "use a coarser mesh");
        }
        let two_sided = self
            .spec
            .two_sided
            .unwrap_or_else(|| face.tags.material.is_some_and(|m| self.mesh().materials[m as usize].double_sided));
        let group = face.tags.group.map(|g| self.group(g));
        self.faces.push(Face { vertices, material, patches, elements, two_sided, group });
        Ok(())
    }

    /// Groups are numbered by their first face that stays: others have no patch to name.
    fn group(&mut self, in_file: u32) -> u32 {
        let name = &self.loaded.mesh.groups.list[in_file as usize];
        *self.renumbered[in_file as usize].get_or_insert_with(|| {
            self.groups.push(name.clone());
            self.groups.len() as u32 - 1
        })
    }

    /// From file units and axes to metres, z up.
    fn placed(&self, p: DVec3) -> DVec3 {
        let p = p * self.spec.scale;
        if self.y_up { DVec3::new(p.x, -p.z, p.y) } else { p }
    }

    /// Leaves notices about what was mended.
    fn tell(&self, gathered: &mut Gathered) {
        let file = &self.loaded.source.name;
        let place = |face: &MeshFace| match self.mesh().place_of(&face.tags) {
            super::At::Line(line) => format!("{file}:{line}"),
            super::At::Part(part) => format!("{file}, {part}"),
            super::At::File => file.clone(),
        };
        let mut notices = Vec::new();
        if let Some((count, face, off)) = &self.tally.split {
            notices.push(format!(
                "{}: {count} faces that are not planar or not convex were split into triangles \
                 (up to {off:.1e} m off their planes)",
                place(face)
            ));
        }
        if let Some((count, face)) = &self.tally.dropped {
            notices.push(format!("{}: {count} faces without area were left out", place(face)));
        }
        if self.tally.whole > 0 {
            let count = self.tally.whole;
            notices.push(format!("{file}: {count} faces that cannot be divided (five or more corners) stay one patch"));
        }
        if self.tally.grey > 0 {
            notices.push(grey_notice(file, self.tally.grey));
        }
        notices.extend(self.mesh().notices.iter().map(|n| format!("{file}: {n}")));
        gathered.notices.append(&mut notices);
    }
}
