//! `.npz` as SciPy stores sparse matrices, with arrays beside them that SciPy leaves alone: `std_err` of each stored
//! value, `area` and `name` of each row.

use super::entries::{Entries, Reader, is_index};
use super::rows::Rows;
use crate::io::{FileError, npz};
use crate::solution::FormFactors;

pub(super) fn write(f: &FormFactors, values: &[f64], rows: Option<&Rows>, errors: bool) -> Vec<u8> {
    let mut members = npz::Members::default();
    let stored = [f.stored() as u64];
    // SciPy wants both index arrays of one type.
    if i32::try_from(f.stored()).is_ok() {
        members.add("indices", npz::array(&stored, &f.columns.iter().map(|c| *c as i32).collect::<Vec<_>>()));
        let starts: Vec<i32> = f.row_starts.iter().map(|s| *s as i32).collect();
        members.add("indptr", npz::array(&[starts.len() as u64], &starts));
    } else {
        members.add("indices", npz::array(&stored, &f.columns.iter().map(|c| i64::from(*c)).collect::<Vec<_>>()));
        let starts: Vec<i64> = f.row_starts.iter().map(|s| *s as i64).collect();
        members.add("indptr", npz::array(&[starts.len() as u64], &starts));
    }
    members.add("format", npz::byte_string("csr"));
    members.add("shape", npz::array(&[2], &[f.n as i64, f.n as i64]));
    members.add("data", npz::array(&stored, values));
    if let Some(e) = f.std_err.as_ref().filter(|_| !errors) {
        members.add("std_err", npz::array(&stored, e));
    }
    if let Some(rows) = rows {
        members.add("area", npz::array(&[rows.areas.len() as u64], &rows.areas));
        members.add("name", npz::texts(&rows.names));
    }
    members.zip()
}

/// What to do about arrays that are no sparse matrix.
const SAVE: &str = "save it with scipy.sparse.save_npz";

pub(super) fn read(reader: &Reader, bytes: &[u8]) -> Result<Entries, FileError> {
    let members = npz::unzip(reader.path, bytes)?;
    let member =
        |name: &str| members.get(name).ok_or_else(|| reader.wrong(format!("has no array \"{name}\"")).mend(SAVE));
    let numbers = |name: &str| Ok(npz::numbers(reader.path, name, member(name)?)?.1);
    let shape = numbers("shape")?;
    let [rows, columns] = shape[..] else {
        return Err(reader.wrong("does not hold two numbers").at("array \"shape\"").mend(SAVE));
    };
    reader.check_shape(rows, columns)?;
    let data = numbers("data")?;
    let format = npz::text(member("format")?);
    let pairs: Vec<(f64, f64)> = match format.as_str() {
        "coo" => numbers("row")?.into_iter().zip(numbers("col")?).collect(),
        "csr" | "csc" => {
            let pairs = compressed(reader, &numbers("indptr")?, numbers("indices")?)?;
            if format == "csr" { pairs } else { pairs.into_iter().map(|(j, i)| (i, j)).collect() }
        }
        other => {
            return Err(reader.wrong(format!("format \"{other}\" is not read")).mend("convert it with .tocsr()"));
        }
    };
    if pairs.len() != data.len() {
        let problem = format!("holds {} values for {} indices", data.len(), pairs.len());
        return Err(reader.wrong(problem).at("array \"data\"").mend(SAVE));
    }
    if let Some((i, j)) = pairs.iter().find(|(i, j)| !(is_index(*i) && is_index(*j))) {
        return Err(reader.wrong("is not at a row and a column").at(format!("entry ({i}, {j})")).mend(SAVE));
    }
    let errors = if members.contains_key("std_err") { numbers("std_err")? } else { Vec::new() };
    if !errors.is_empty() && errors.len() != data.len() {
        let problem = format!("holds {} standard errors for {} values", errors.len(), data.len());
        return Err(reader.wrong(problem).at("array \"std_err\"").mend("leave the array out, or give one per value"));
    }
    let has_errors = !errors.is_empty() && errors.iter().all(|e| e.is_finite());
    let error = |k: usize| errors.get(k).copied().unwrap_or(f64::NAN);
    let entries = pairs.into_iter().zip(data).enumerate();
    let list = entries.map(|(k, ((i, j), f))| (i as usize, j as usize, f, error(k))).collect();
    Ok(Entries { list, has_errors })
}

/// (major, minor) of each entry of a compressed matrix.
fn compressed(reader: &Reader, starts: &[f64], indices: Vec<f64>) -> Result<Vec<(f64, f64)>, FileError> {
    let n = reader.n;
    let whole = starts.iter().all(|s| s.fract() == 0.0);
    if !whole || starts.len() != n + 1 || starts.windows(2).any(|w| w[1] < w[0]) || starts[0] != 0.0 {
        let problem = format!("is not a rising list of {} whole numbers from 0", n + 1);
        return Err(reader.wrong(problem).at("array \"indptr\"").mend(SAVE));
    }
    if starts[n] as usize != indices.len() {
        let problem = format!("ends with {}, but there are {} indices", starts[n], indices.len());
        return Err(reader.wrong(problem).at("array \"indptr\"").mend(SAVE));
    }
    let major = (0..n).flat_map(|i| std::iter::repeat_n(i as f64, (starts[i + 1] - starts[i]) as usize));
    Ok(major.zip(indices).collect())
}
