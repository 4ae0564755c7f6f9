//! The patches of a stage as a table or a mesh: what a solver needs to write a solution.
//!
//! Numbers are written in full (the shortest decimals that read back to the same double). Centroid and area are
//! those of the part that takes part; corners are those of the whole cell, also where some of it is in contact
//! with another surface. Absent patches keep their row, with area 0; in meshes they are left out.

use super::FileError;
use super::scene::mesh::{ERROR_TAIL, STEM};
use crate::math::{DVec3, centroid};
use crate::scene::{Patch, Stage};
use crate::solution::Radiosity;
use std::fmt::Write;
use std::path::Path;

/// File formats for patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PatchFormat {
    /// One row per patch, absent ones included.
    Csv,
    /// Wavefront OBJ: one face per present patch, in order of number.
    Obj,
    /// PLY, text, with double coordinates: one face per present patch, with its number.
    Ply,
}

impl PatchFormat {
    /// The format a file name asks for.
    pub fn of(path: &Path) -> Result<Self, FileError> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("csv") => Ok(Self::Csv),
            Some("obj") => Ok(Self::Obj),
            Some("ply") => Ok(Self::Ply),
            _ => Err(FileError::new(path, "has no ending that names a patch format").mend("use .csv, .obj or .ply")),
        }
    }
}

/// The patches as the bytes of a file.
pub fn write_patches(stage: &Stage, format: PatchFormat) -> Vec<u8> {
    match format {
        PatchFormat::Csv => csv_table(stage),
        PatchFormat::Obj => obj_mesh(stage).into_bytes(),
        PatchFormat::Ply => ply_mesh(stage, &[]).into_bytes(),
    }
}

/// Radiosities on the patches as a text PLY: faces have double properties `radiosity_<band>` in W/m^2 and, where known,
/// `radiosity_<band>_std_err`, and the number of the patch. Same solution, same bytes.
///
/// # Panics
/// If the radiosities are not one per patch and band of the stage, which is a mistake of the program.
pub fn write_ply_values(stage: &Stage, b: &Radiosity) -> Vec<u8> {
    let bands = &stage.photometry.bands;
    assert_eq!((b.len(), b.bands), (stage.patch_count(), bands.len()), "radiosities of the patches");
    let mut columns = Vec::new();
    for (tail, values) in [("", Some(&b.values)), (ERROR_TAIL, b.std_err.as_ref())] {
        let Some(values) = values else { continue };
        for (band, name) in bands.iter().enumerate() {
            let own: Vec<f64> = values.iter().skip(band).step_by(b.bands).copied().collect();
            columns.push((format!("{STEM}{}{tail}", word(name)), own));
        }
    }
    ply_mesh(stage, &columns).into_bytes()
}

/// Columns of the table; `corners` holds `x y z;x y z;...`.
const COLUMNS: [&str; 14] = [
    "patch",
    "surface",
    "object",
    "a",
    "b",
    "centroid_x",
    "centroid_y",
    "centroid_z",
    "normal_x",
    "normal_y",
    "normal_z",
    "area",
    "material",
    "corners",
];

fn csv_table(stage: &Stage) -> Vec<u8> {
    let mut table = csv::Writer::from_writer(Vec::new());
    // Writing to memory does not fail.
    let _ = table.write_record(COLUMNS);
    for (number, patch) in stage.patches.iter().enumerate() {
        let _ = table.write_record(row(stage, number, patch));
    }
    table.into_inner().unwrap_or_default()
}

fn row(stage: &Stage, number: usize, patch: &Patch) -> [String; 14] {
    let surface = &stage.surfaces[patch.surface as usize];
    let stands = !patch.corners.is_empty();
    let middle = patch.region.centroid().or_else(|| stands.then(|| centroid(&patch.corners)));
    let [cx, cy, cz] = numbers(middle);
    let [nx, ny, nz] = numbers(stands.then_some(patch.normal));
    let corners: Vec<String> = patch.corners.iter().map(|c| numbers(Some(*c)).join(" ")).collect();
    [
        number.to_string(),
        surface.name.clone(),
        surface.object.clone(),
        patch.a.to_string(),
        patch.b.to_string(),
        cx,
        cy,
        cz,
        nx,
        ny,
        nz,
        format!("{:?}", patch.area),
        stage.materials[patch.material as usize].name.clone(),
        corners.join(";"),
    ]
}

/// Three numbers in full, or three empty cells.
fn numbers(p: Option<DVec3>) -> [String; 3] {
    // Adding zero turns -0 into 0.
    p.map_or_else(Default::default, |p| p.to_array().map(|x| format!("{:?}", x + 0.0)))
}

/// What the head of a mesh says about patches that are not in it.
fn absence(stage: &Stage) -> String {
    let absent: Vec<usize> = (0..stage.patch_count()).filter(|i| !stage.patches[*i].is_present()).collect();
    if absent.is_empty() {
        return "every patch is here, in order of number".into();
    }
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for i in absent {
        match runs.last_mut() {
            Some((_, end)) if *end + 1 == i => *end = i,
            _ => runs.push((i, i)),
        }
    }
    let runs: Vec<String> = runs.iter().map(|(a, b)| if a == b { a.to_string() } else { format!("{a}-{b}") }).collect();
    format!("absent or wholly covered patches are left out: {}", runs.join(" "))
}

fn present(stage: &Stage) -> impl Iterator<Item = (usize, &Patch)> {
    stage.patches.iter().enumerate().filter(|(_, p)| p.is_present())
}

/// A name as it can stand on one line of a mesh file.
fn word(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}

fn obj_mesh(stage: &Stage) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "# patches of \"{}\", state {}: metres, z up", stage.name.escape_debug(), stage.state);
    let _ = writeln!(out, "# {}", absence(stage));
    let (mut group, mut material, mut next) = (None, None, 1);
    for (number, patch) in present(stage) {
        if group.replace(patch.surface) != Some(patch.surface) {
            let _ = writeln!(out, "g {}", word(&stage.surfaces[patch.surface as usize].name));
        }
        if material.replace(patch.material) != Some(patch.material) {
            let _ = writeln!(out, "usemtl {}", word(&stage.materials[patch.material as usize].name));
        }
        let _ = writeln!(out, "# patch {number}");
        for corner in &patch.corners {
            let _ = writeln!(out, "v {}", numbers(Some(*corner)).join(" "));
        }
        let places: Vec<String> = (next..next + patch.corners.len()).map(|i| i.to_string()).collect();
        let _ = writeln!(out, "f {}", places.join(" "));
        next += patch.corners.len();
    }
    out
}

/// A mesh whose faces have further properties, each with a value for every patch.
fn ply_mesh(stage: &Stage, columns: &[(String, Vec<f64>)]) -> String {
    let vertices: usize = present(stage).map(|(_, p)| p.corners.len()).sum();
    let mut out = String::from("ply\nformat ascii 1.0\n");
    let _ = writeln!(out, "comment patches of \"{}\", state {}: metres, z up", stage.name.escape_debug(), stage.state);
    let _ = writeln!(out, "comment {}", absence(stage));
    let _ = writeln!(out, "element vertex {vertices}");
    out.push_str("property double x\nproperty double y\nproperty double z\n");
    let _ = writeln!(out, "element face {}", present(stage).count());
    out.push_str("property list uchar uint vertex_indices\nproperty uint patch\n");
    for (name, _) in columns {
        let _ = writeln!(out, "property double {name}");
    }
    out.push_str("end_header\n");
    for (_, patch) in present(stage) {
        for corner in &patch.corners {
            let _ = writeln!(out, "{}", numbers(Some(*corner)).join(" "));
        }
    }
    let mut next = 0;
    for (number, patch) in present(stage) {
        let k = patch.corners.len();
        let places: Vec<String> = (next..next + k).map(|i| i.to_string()).collect();
        let _ = write!(out, "{k} {} {number}", places.join(" "));
        for (_, values) in columns {
            let _ = write!(out, " {:?}", values[number]);
        }
        out.push('\n');
        next += k;
    }
    out
}
