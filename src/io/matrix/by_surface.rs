//! Matrices with a row per surface: View3D's, where surfaces are combined, or divided into patches here.

use super::entries::Reader;
use super::rows::{Rows, merged};
use super::view3d::{AREA_TOLERANCE, Output};
use crate::io::FileError;
use crate::scene::Stage;
use crate::solution::FormFactors;
use std::path::Path;

/// The surfaces that have a row: all that take part and do more than block.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceRows {
    /// Their names.
    pub names: Vec<String>,
    /// Their areas, m^2.
    pub areas: Vec<f64>,
    /// The matrix between them.
    pub form_factors: FormFactors,
}

/// A matrix by patch, put together by surface: `A_g F_gh` is the sum of `A_i F_ij`, standard errors are upper bounds.
pub fn surface_rows(stage: &Stage, f: &FormFactors) -> SurfaceRows {
    let rows = Rows::surfaces(stage);
    let form_factors = merged(stage, f, &rows);
    SurfaceRows { names: rows.names, areas: rows.areas, form_factors }
}

/// Reads View3D's output if it has a row per surface, and not per patch; `None` if it has, or is no output of View3D.
///
/// # Errors
/// A file that cannot be read, or whose areas are not those of the surfaces.
pub fn read_by_surface(path: &Path, stage: &Stage) -> Result<Option<FormFactors>, FileError> {
    let bytes = std::fs::read(path).map_err(|e| FileError::system(path, "read", &e))?;
    let Some(output) = Output::of(path, &bytes)? else { return Ok(None) };
    let rows = Rows::surfaces(stage);
    if output.n != rows.len() || output.n == Rows::patches(stage, true).len() {
        return Ok(None);
    }
    for (row, (own, area)) in rows.areas.iter().zip(&output.areas).enumerate() {
        if (own - area).abs() > AREA_TOLERANCE * own.max(*area) {
            let problem = format!("has the area {area}, but surface \"{}\" has {own:.6} m2", rows.names[row]);
            let mend = "is it the file of another scene, in other units, or with rows in another order?";
            return Err(FileError::new(path, problem).at(format!("row {}", row + 1)).mend(mend));
        }
    }
    let reader = Reader { path, n: output.n };
    reader.build(output.entries(&reader)?).map(Some)
}
