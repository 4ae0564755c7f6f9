//! View3D's output: a header, areas, a square of form factors, emittances. Facts: `references/view3d-format.md`.
//!
//! After the emittances, where View3D and its companions have stopped reading, our files go on with lines that
//! begin with `!`: names, and standard errors row by row (`-` where a pair was never hit).

use super::entries::{Entries, Reader, Triplet};
use super::rows::Rows;
use crate::io::FileError;
use crate::scene::Stage;
use crate::solution::FormFactors;
use std::fmt::Write;
use std::path::Path;

/// Most rows that are written: the format holds every zero.
const MOST_ROWS: usize = 20_000;
/// Length of the header of View3D, line end included.
const HEADER: usize = 32;
/// How far areas may differ from those of the scene: View3D writes six digits.
pub(super) const AREA_TOLERANCE: f64 = 2e-5;

/// The matrix, or its standard errors, as text.
pub(super) fn write(
    path: &Path,
    f: &FormFactors,
    rows: &Rows,
    encloses: bool,
    errors: bool,
) -> Result<Vec<u8>, FileError> {
    let n = rows.len();
    if n > MOST_ROWS {
        let problem = format!("cannot hold {n} rows: View3D's format writes every zero");
        return Err(FileError::new(path, problem).mend("use .npz, or rows by surface: --format view3d:by=surface"));
    }
    let mut out = format!("View3D etalon-{} 0 {} 0 {n}", env!("CARGO_PKG_VERSION"), u8::from(encloses));
    // View3D pads its header: some readers take it by length.
    let _ = writeln!(out, "{:1$}", "", 30usize.saturating_sub(out.len()));
    line(&mut out, rows.areas.iter().map(|a| number(*a)));
    for i in 0..n {
        match errors {
            false => line(&mut out, dense(f, i, "0", Some(&f.values)).into_iter()),
            // Where nothing was hit the error is not zero: nobody knows it.
            true => line(&mut out, dense(f, i, "nan", f.std_err.as_ref()).into_iter()),
        }
    }
    line(&mut out, rows.emittances.iter().map(|e| number(*e)));
    let _ = writeln!(out, "! names; then standard errors of the form factors, row by row, - where there is none");
    for (i, name) in rows.names.iter().enumerate() {
        let _ = writeln!(out, "! name {} {name}", i + 1);
    }
    if let Some(e) = f.std_err.as_ref().filter(|_| !errors) {
        for i in 0..n {
            let _ = write!(out, "! std_err {} ", i + 1);
            line(&mut out, dense(f, i, "-", Some(e)).into_iter());
        }
    }
    Ok(out.into_bytes())
}

/// All cells of a row, with `empty` where nothing is stored.
fn dense(f: &FormFactors, i: usize, empty: &str, values: Option<&Vec<f64>>) -> Vec<String> {
    let mut cells = vec![empty.to_string(); f.n];
    for k in f.row_starts[i]..f.row_starts[i + 1] {
        if let Some(values) = values {
            cells[f.columns[k] as usize] = number(values[k]);
        }
    }
    cells
}

fn line(out: &mut String, cells: impl Iterator<Item = String>) {
    for (k, cell) in cells.enumerate() {
        if k > 0 {
            out.push(' ');
        }
        out.push_str(&cell);
    }
    out.push('\n');
}

/// The shortest decimals that read back to the same double.
fn number(x: f64) -> String {
    if x == 0.0 { "0".into() } else { format!("{x:?}") }
}

/// View3D's output, taken apart.
pub(super) struct Output {
    pub n: usize,
    pub areas: Vec<f64>,
    values: Vec<f64>,
    /// Standard errors that our own files carry; NaN where a pair has none.
    errors: Option<Vec<f64>>,
}

impl Output {
    /// `None` if the bytes are not those of View3D.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<Option<Self>, FileError> {
        let begins = bytes.get(..7).is_some_and(|b| b.eq_ignore_ascii_case(b"View3D "));
        if !begins {
            return Ok(None);
        }
        let end = bytes.iter().position(|b| *b == b'\n').unwrap_or(bytes.len());
        let header = String::from_utf8_lossy(&bytes[..end]).into_owned();
        let words: Vec<Option<usize>> = header.split_whitespace().skip(2).map(|w| w.parse().ok()).collect();
        let [Some(_), Some(_), Some(emit), Some(n)] = words[..] else {
            let problem = format!("has the header \"{}\"", header.trim().escape_debug());
            return Err(FileError::new(path, problem).at("line 1").mend("it is: View3D VERSION OUT ENCL EMIT N"));
        };
        if emit != 0 {
            let problem = "holds factors with reflections (script-F, emit=1), not form factors";
            return Err(FileError::new(path, problem).at("line 1").mend("run View3D with emit=0"));
        }
        let body = &bytes[(end + 1).min(bytes.len())..];
        let is_text = |b: &u8| b.is_ascii_graphic() || b.is_ascii_whitespace() || !b.is_ascii();
        let size = n.checked_mul(n).and_then(|q| q.checked_add(2 * n));
        let binary = size.and_then(|s| s.checked_mul(4)).is_some_and(|s| s + HEADER == bytes.len());
        match binary && !body.iter().all(is_text) {
            true => Ok(Some(Self::binary(n, &bytes[HEADER..]))),
            false => Self::text(&Reader { path, n }, body).map(Some),
        }
    }

    /// Single precision, little-endian, without line ends.
    fn binary(n: usize, body: &[u8]) -> Self {
        let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let all: Vec<f64> = body.chunks_exact(4).map(number).collect();
        Self { n, areas: all[..n].to_vec(), values: all[n..n + n * n].to_vec(), errors: None }
    }

    fn text(reader: &Reader, body: &[u8]) -> Result<Self, FileError> {
        let n = reader.n;
        let (mut numbers, mut errors) = (Vec::new(), Vec::new());
        for (index, line) in reader.text(body)?.lines().enumerate() {
            let place = || format!("line {}", index + 2);
            if let Some(note) = line.strip_prefix('!') {
                if let Some(row) = note.trim().strip_prefix("std_err ") {
                    let cells = row.split_whitespace().skip(1);
                    errors.extend(cells.map(|w| w.parse::<f64>().unwrap_or(f64::NAN)));
                }
                continue;
            }
            for word in line.split_whitespace() {
                let value = word
                    .parse::<f64>()
                    .map_err(|_| reader.wrong(format!("\"{}\" is not a number", word.escape_debug())).at(place()))?;
                numbers.push(value);
            }
        }
        let needed = n.checked_mul(n).and_then(|q| q.checked_add(2 * n));
        if needed != Some(numbers.len()) {
            let have = numbers.len();
            let problem =
                format!("holds {have} numbers; {n} surfaces need {n} areas, {n} x {n} factors, {n} emittances");
            return Err(reader.wrong(problem).mend("is it cut off?"));
        }
        let errors = (errors.len() == n * n).then_some(errors);
        Ok(Self { n, areas: numbers[..n].to_vec(), values: numbers[n..n + n * n].to_vec(), errors })
    }

    /// The entries, if the size is right.
    pub(super) fn entries(&self, reader: &Reader) -> Result<Entries, FileError> {
        let n = self.n as f64;
        reader.check_shape(n, n).map_err(|e| {
            e.mend(
                "was it computed for another scene? where surfaces are combined or divided into patches, View3D's rows \
                 are surfaces: write it with --format view3d:by=patch",
            )
        })?;
        let error = |k: usize| self.errors.as_ref().map_or(f64::NAN, |e| e[k]);
        let all = self.values.iter().enumerate();
        let list: Vec<Triplet> =
            all.filter(|(_, v)| **v != 0.0).map(|(k, v)| (k / self.n, k % self.n, *v, error(k))).collect();
        let has_errors = self.errors.is_some() && list.iter().all(|e| e.3.is_finite());
        Ok(Entries { list, has_errors })
    }

    /// Areas that differ mean another scene, other units or another order.
    pub(super) fn compare_areas(&self, path: &Path, stage: &Stage, patches: &[usize]) -> Result<(), FileError> {
        for (row, (i, area)) in patches.iter().zip(&self.areas).enumerate() {
            let own = stage.patches[*i].area;
            if (own - area).abs() > AREA_TOLERANCE * own.max(*area) {
                let problem =
                    format!("has the area {area}, but patch {i} ({}) has {own:.6} m2", stage.surface_name(*i));
                let mend = "is it the file of another scene, in other units, or with rows in another order?";
                return Err(FileError::new(path, problem).at(format!("row {}", row + 1)).mend(mend));
            }
        }
        Ok(())
    }
}
