//! OBJ, PLY and glTF: values of faces or vertices in the file, or in a table beside it.

use super::laying::Laying;
use super::table::{self, Table};
use super::{MeshValuesOptions, file_name};
use crate::io::FileError;
use crate::io::scene::mesh::{Brought, Keep, bring};
use crate::solution::{MeshValues, ValuesPer};
use std::path::Path;

/// Reads a mesh file with its values.
pub(super) fn read(path: &Path, options: &MeshValuesOptions) -> Result<MeshValues, FileError> {
    match &options.table {
        Some(file) => {
            let table = table::read(file, options.fields.as_deref())?;
            with_table(path, &bring(path, Keep::Shape)?, file, table, options)
        }
        None => own(path, &bring(path, Keep::Values(options.fields.as_deref()))?, options),
    }
}

/// The values in the file itself.
fn own(path: &Path, mesh: &Brought, options: &MeshValuesOptions) -> Result<MeshValues, FileError> {
    let carried = mesh.carried();
    let (per, values) = match carried.of_faces.is_empty() {
        false => (ValuesPer::Face, &carried.of_faces),
        true => (ValuesPer::Corner, &carried.of_vertices),
    };
    lay(path, mesh, options, carried.bands.clone(), per, values)?.finish(mesh.notices().to_vec())
}

/// The values in a table.
fn with_table(
    path: &Path,
    mesh: &Brought,
    file: &Path,
    table: Table,
    options: &MeshValuesOptions,
) -> Result<MeshValues, FileError> {
    let (per, count) = match table.of_faces {
        true => (ValuesPer::Face, mesh.len()),
        false => (ValuesPer::Corner, mesh.vertices()),
    };
    let bands = table.bands.clone();
    let notices: Vec<String> = table.notices.clone();
    let values = table.dense(file, count, &file_name(path))?;
    lay(path, mesh, options, bands, per, &values)?.finish(notices)
}

fn lay<'p>(
    path: &'p Path,
    mesh: &Brought,
    options: &MeshValuesOptions,
    bands: Vec<String>,
    per: ValuesPer,
    values: &[f64],
) -> Result<Laying<'p>, FileError> {
    let width = bands.len();
    let mut laying = Laying::new(path, options, mesh.is_gltf(), bands, per);
    let of = |number: usize| &values[number * width..(number + 1) * width];
    for face in 0..mesh.len() {
        let own: Vec<f64> = match per {
            ValuesPer::Face => of(face).to_vec(),
            ValuesPer::Corner => mesh.numbers(face).iter().flat_map(|v| of(*v as usize)).copied().collect(),
        };
        laying.add(&mesh.corners(face), &own, || mesh.place(face))?;
    }
    Ok(laying)
}
