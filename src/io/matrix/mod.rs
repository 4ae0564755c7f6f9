//! Form-factor matrices: `.npz` (SciPy CSR), `.csv`, Matrix Market `.mtx`, View3D's output, EnergyPlus objects.

mod by_surface;
mod csv;
mod energyplus;
mod entries;
mod layout;
mod mtx;
mod rows;
mod scipy;
mod view3d;

use super::FileError;
use crate::scene::{OBSTRUCTIONS, Stage};
use crate::solution::FormFactors;
pub use by_surface::{SurfaceRows, read_by_surface, surface_rows};
use entries::{Entries, Reader};
pub use layout::{Level, MatrixFormat, MatrixLayout, MatrixStyle};
use rows::{Rows, merged};
use std::path::Path;

/// The matrix (or, with `errors`, its standard errors) as the bytes of a file, without names and areas.
pub fn write_form_factors(f: &FormFactors, format: MatrixFormat, errors: bool) -> Vec<u8> {
    plain(f, format, None, errors, false)
}

/// The same with the names and areas of its rows; `path` is named where a format cannot hold them.
///
/// By surface, `A_g F_gh` is the sum of `A_i F_ij` over their patches, and standard errors are upper bounds: the
/// sums of those of the parts, for parts whose correlation nobody knows.
pub fn write_matrix(
    path: &Path,
    stage: &Stage,
    f: &FormFactors,
    layout: &MatrixLayout,
    errors: bool,
) -> Result<Vec<u8>, FileError> {
    let by_surface = layout.level() == Level::Surface;
    let only_surfaces = by_surface || layout.style == MatrixStyle::View3d;
    let rows = if by_surface { Rows::surfaces(stage) } else { Rows::patches(stage, only_surfaces) };
    let merged = only_surfaces.then(|| merged(stage, f, &rows));
    let f = merged.as_ref().unwrap_or(f);
    match layout.style {
        MatrixStyle::Plain(format) => Ok(plain(f, format, Some(&rows), errors, layout.names || by_surface)),
        MatrixStyle::View3d => view3d::write(path, f, &rows, stage.enclosure == Some(true), errors),
        MatrixStyle::EnergyPlus => {
            energyplus::write(path, f, &rows, layout.zone.as_deref().unwrap_or(&stage.name), errors)
        }
    }
}

fn plain(f: &FormFactors, format: MatrixFormat, rows: Option<&Rows>, errors: bool, names: bool) -> Vec<u8> {
    let unknown;
    let values = match (errors, &f.std_err) {
        (false, _) => &f.values,
        (true, Some(e)) => e,
        (true, None) => {
            unknown = vec![f64::NAN; f.values.len()];
            &unknown
        }
    };
    match format {
        MatrixFormat::Npz => scipy::write(f, values, rows, errors),
        MatrixFormat::Csv => csv::write(f, values, rows.filter(|_| names), errors),
        MatrixFormat::Mtx => mtx::write(f, values, rows),
    }
}

/// Row, column and index of each stored entry.
fn stored(f: &FormFactors) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
    (0..f.n).flat_map(move |i| (f.row_starts[i]..f.row_starts[i + 1]).map(move |k| (i, f.columns[k] as usize, k)))
}

/// Reads an N x N matrix; ours or anybody's.
pub fn read_form_factors(path: &Path, n: usize) -> Result<FormFactors, FileError> {
    let bytes = std::fs::read(path).map_err(|e| FileError::system(path, "read", &e))?;
    let reader = Reader { path, n };
    let entries = match view3d::Output::of(path, &bytes)? {
        Some(output) => output.entries(&reader)?,
        None => plain_entries(&reader, &bytes)?,
    };
    reader.build(entries)
}

/// Reads the matrix of a scene. View3D's output may leave out what only blocks, and its areas have to be those
/// of the patches.
pub fn read_form_factors_of(path: &Path, stage: &Stage) -> Result<FormFactors, FileError> {
    let bytes = std::fs::read(path).map_err(|e| FileError::system(path, "read", &e))?;
    let reader = Reader { path, n: stage.patch_count() };
    let Some(output) = view3d::Output::of(path, &bytes)? else {
        return reader.build(plain_entries(&reader, &bytes)?);
    };
    let blocks = |i: &usize| stage.surfaces[stage.patches[*i].surface as usize].object == OBSTRUCTIONS;
    let all: Vec<usize> = (0..reader.n).collect();
    let radiating: Vec<usize> = all.iter().copied().filter(|i| !blocks(i)).collect();
    let patches = if output.n == radiating.len() { radiating } else { all };
    let mut entries = output.entries(&Reader { path, n: patches.len() })?;
    output.compare_areas(path, stage, &patches)?;
    for (i, j, ..) in &mut entries.list {
        (*i, *j) = (patches[*i], patches[*j]);
    }
    reader.build(entries)
}

fn plain_entries(reader: &Reader, bytes: &[u8]) -> Result<Entries, FileError> {
    let format = match bytes {
        [b'P', b'K', 3, 4, ..] => MatrixFormat::Npz,
        _ if bytes.starts_with(b"%%MatrixMarket") => MatrixFormat::Mtx,
        _ => MatrixFormat::of(reader.path)?,
    };
    match format {
        MatrixFormat::Npz => scipy::read(reader, bytes),
        MatrixFormat::Csv => csv::read(reader, bytes),
        MatrixFormat::Mtx => mtx::read(reader, bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> FormFactors {
        FormFactors::from_rows(vec![vec![(1, 0.1, 0.01), (2, 1.0 / 3.0, 0.0)], vec![], vec![(0, 0.25, 1e-17)]])
    }

    #[test]
    fn every_format_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        for (name, format) in [("f.npz", MatrixFormat::Npz), ("f.csv", MatrixFormat::Csv), ("f.mtx", MatrixFormat::Mtx)]
        {
            let path = folder.path().join(name);
            std::fs::write(&path, write_form_factors(&sample(), format, false)).unwrap();
            let mut expected = sample();
            if format == MatrixFormat::Mtx {
                expected.std_err = None;
            }
            assert_eq!(read_form_factors(&path, 3).unwrap(), expected, "{name}");
            assert!(read_form_factors(&path, 2).is_err());
        }
    }

    #[test]
    fn content_goes_before_the_ending() {
        let folder = tempfile::tempdir().unwrap();
        for format in [MatrixFormat::Npz, MatrixFormat::Mtx] {
            let path = folder.path().join("f.dat");
            std::fs::write(&path, write_form_factors(&sample(), format, false)).unwrap();
            assert_eq!(read_form_factors(&path, 3).unwrap().values, sample().values, "{format:?}");
        }
    }
}
