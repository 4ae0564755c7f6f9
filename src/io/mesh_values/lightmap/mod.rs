//! An EXR lightmap on a mesh with texture coordinates: every face is cut along the borders of texels, and every piece
//! has the value of its texel (no interpolation between texels).
//!
//! Pictures begin with their top row. Texture coordinates of OBJ count v from the bottom, those of glTF from the top.

mod cut;
mod picture;

use super::laying::Laying;
use super::{MeshValuesOptions, file_name, shown};
use crate::io::FileError;
use crate::io::scene::mesh::{Brought, Keep, bring};
use crate::math::{DVec3, area_vector};
use crate::solution::{MeshValues, ValuesPer};
use cut::{Chart, by_texels};
use picture::Picture;
use std::path::Path;

/// Most pieces of faces that are made.
const MAX_PIECES: usize = 1 << 23;
/// How far texture coordinates may leave the picture by rounding.
const SLACK: f64 = 1e-6;

/// Reads a lightmap with the mesh that it lies on.
pub(super) fn read(path: &Path, options: &MeshValuesOptions) -> Result<MeshValues, FileError> {
    let Some(mesh_file) = &options.mesh else {
        return Err(FileError::new(path, "a lightmap needs the mesh that it lies on")
            .mend("name an OBJ or glTF file with texture coordinates (--mesh FILE)"));
    };
    let kind = mesh_file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !matches!(kind.as_str(), "obj" | "gltf" | "glb") {
        return Err(FileError::new(mesh_file, format!("\".{}\" is no mesh with texture coordinates", shown(&kind)))
            .mend("give an .obj, .gltf or .glb file"));
    }
    let picture = Picture::read(path, options.fields.as_deref())?;
    let mesh = bring(mesh_file, Keep::Textures)?;
    let laying = Laying::new(mesh_file, options, mesh.is_gltf(), picture.bands.clone(), ValuesPer::Face);
    let mut map =
        Mapping { file: mesh_file, mesh: &mesh, picture: &picture, laying, without_area: 0, empty: 0.0, all: 0.0 };
    for face in 0..mesh.len() {
        map.face(face)?;
    }
    map.finish(path)
}

/// A lightmap on its way onto a mesh.
struct Mapping<'a> {
    file: &'a Path,
    mesh: &'a Brought,
    picture: &'a Picture,
    laying: Laying<'a>,
    /// Faces without area.
    without_area: usize,
    /// Area of empty texels and of everything, m^2.
    empty: f64,
    all: f64,
}

impl Mapping<'_> {
    fn refuse<T>(&self, face: usize, problem: impl Into<String>, mend: &str) -> Result<T, FileError> {
        Err(FileError::new(self.file, problem).at(self.mesh.place(face)).mend(mend))
    }

    /// Cuts a face and adds its pieces.
    fn face(&mut self, face: usize) -> Result<(), FileError> {
        let corners = self.laying.placed(&self.mesh.corners(face), || self.mesh.place(face))?;
        let texels = self.in_texels(face)?;
        let flat = crate::io::scene::mesh::parts(&corners);
        use crate::io::scene::mesh::Parts;
        let triangles = match flat {
            Parts::Nothing => {
                self.without_area += 1;
                return Ok(());
            }
            Parts::Crossed => return self.refuse(face, "the face crosses itself", "split it into triangles"),
            Parts::Whole => {
                if let Some(chart) = Chart::of_polygon(&texels, &corners) {
                    return self.pieces(face, &texels, &chart);
                }
                (1..corners.len() - 1).map(|k| [0, k, k + 1]).collect()
            }
            Parts::Triangles(triangles, _) => triangles,
        };
        for t in triangles {
            let (flat, corners) = (t.map(|i| texels[i]), t.map(|i| corners[i]));
            match Chart::of(flat, corners) {
                Some(chart) => self.pieces(face, &flat, &chart)?,
                None => {
                    let mend = "unwrap the mesh so that every face has room in the picture";
                    return self.refuse(face, "the face has no area in the picture", mend);
                }
            }
        }
        Ok(())
    }

    /// Texture coordinates in texels: x from the left, y from the top.
    fn in_texels(&self, face: usize) -> Result<Vec<DVec3>, FileError> {
        let uvs = self.mesh.textures(face);
        if let Some(uv) =
            uvs.iter().find(|p| !((-SLACK..=1.0 + SLACK).contains(&p.x) && (-SLACK..=1.0 + SLACK).contains(&p.y)))
        {
            let problem = format!("the texture coordinates {} {} lie outside the picture", uv.x, uv.y);
            return self.refuse(face, problem, "unwrap the mesh into 0..1: pictures are not repeated");
        }
        let from_top = self.mesh.is_gltf();
        let (width, height) = (self.picture.width as f64, self.picture.height as f64);
        let texel = |p: &DVec3| {
            let (u, v) = (p.x.clamp(0.0, 1.0), p.y.clamp(0.0, 1.0));
            DVec3::new(u * width, if from_top { v } else { 1.0 - v } * height, 0.0)
        };
        Ok(uvs.iter().map(texel).collect())
    }

    fn pieces(&mut self, face: usize, texels: &[DVec3], chart: &Chart) -> Result<(), FileError> {
        let mut broken = None;
        let (picture, laying) = (self.picture, &mut self.laying);
        let (mut empty, mut all) = (0.0, 0.0);
        let within = by_texels(texels, |column, row, piece| {
            let corners: Vec<DVec3> = piece.iter().map(|p| chart.at(*p)).collect();
            let area = area_vector(&corners).length();
            all += area;
            match picture.texel(column, row) {
                Ok(Some(values)) => laying.push(&corners, &values),
                Ok(None) => empty += area,
                Err(e) => broken = Some(e),
            }
            laying.len() < MAX_PIECES && broken.is_none()
        });
        self.empty += empty;
        self.all += all;
        if let Some(e) = broken {
            return Err(e.at_face(&file_name(self.file), &self.mesh.place(face)));
        }
        match within {
            true => Ok(()),
            false => {
                let problem = format!("the texels cut the faces into more than {MAX_PIECES} pieces");
                self.refuse(face, problem, "use a smaller picture")
            }
        }
    }

    fn finish(self, path: &Path) -> Result<MeshValues, FileError> {
        let mut notices = Vec::new();
        if self.without_area > 0 {
            notices.push(format!("{} faces without area were left out", self.without_area));
        }
        if self.empty > 0.0 {
            let share = 100.0 * self.empty / self.all;
            notices.push(format!("{share:.3} % of the area lies on empty texels (alpha 0 or NaN) and was left out"));
        }
        let picture = file_name(path);
        let coarse = format!("{picture}: {} x {} texels, each of one value", self.picture.width, self.picture.height);
        self.laying.finish(notices.into_iter().chain([coarse]))
    }
}
