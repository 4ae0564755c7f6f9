//! Form-factor matrices as `.npz` (SciPy CSR), `.csv` and Matrix Market `.mtx`.

use super::solution::csv_error;
use super::{FileError, npz};
use crate::solution::FormFactors;
use std::fmt::Write;
use std::path::Path;

/// Formats of a form-factor matrix, chosen by the file's ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixFormat {
    /// `scipy.sparse.load_npz`.
    Npz,
    /// `i,j,form_factor,std_err`, 0-based.
    Csv,
    /// Matrix Market coordinate format, 1-based.
    Mtx,
}

impl MatrixFormat {
    /// The format a file name asks for.
    pub fn of(path: &Path) -> Result<Self, FileError> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("npz") => Ok(Self::Npz),
            Some("csv") => Ok(Self::Csv),
            Some("mtx") => Ok(Self::Mtx),
            _ => Err(FileError::new(path, "has no ending that names a matrix format").mend("use .npz, .csv or .mtx")),
        }
    }
}

/// The matrix (or, with `errors`, its standard errors) as the bytes of a file.
pub fn write_form_factors(f: &FormFactors, format: MatrixFormat, errors: bool) -> Vec<u8> {
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
        MatrixFormat::Npz => write_npz(f, values),
        MatrixFormat::Csv if errors => write_csv(f, "i,j,std_err", |k| format!("{:?}", values[k])),
        MatrixFormat::Csv => write_csv(f, "i,j,form_factor,std_err", |k| match &f.std_err {
            Some(e) => format!("{:?},{:?}", values[k], e[k]),
            None => format!("{:?},", values[k]),
        }),
        MatrixFormat::Mtx => write_mtx(f, values),
    }
}

fn write_npz(f: &FormFactors, values: &[f64]) -> Vec<u8> {
    let mut members = npz::Members::default();
    // SciPy wants both index arrays of one type.
    if i32::try_from(f.stored()).is_ok() {
        members
            .add("indices", npz::array(&[f.stored() as u64], &f.columns.iter().map(|c| *c as i32).collect::<Vec<_>>()));
        let starts: Vec<i32> = f.row_starts.iter().map(|s| *s as i32).collect();
        members.add("indptr", npz::array(&[starts.len() as u64], &starts));
    } else {
        members.add(
            "indices",
            npz::array(&[f.stored() as u64], &f.columns.iter().map(|c| i64::from(*c)).collect::<Vec<_>>()),
        );
        let starts: Vec<i64> = f.row_starts.iter().map(|s| *s as i64).collect();
        members.add("indptr", npz::array(&[starts.len() as u64], &starts));
    }
    members.add("format", npz::byte_string("csr"));
    members.add("shape", npz::array(&[2], &[f.n as i64, f.n as i64]));
    members.add("data", npz::array(&[f.stored() as u64], values));
    members.zip()
}

fn entries(f: &FormFactors) -> impl Iterator<Item = (usize, u32, usize)> + '_ {
    (0..f.n).flat_map(move |i| (f.row_starts[i]..f.row_starts[i + 1]).map(move |k| (i, f.columns[k], k)))
}

fn write_csv(f: &FormFactors, header: &str, cell: impl Fn(usize) -> String) -> Vec<u8> {
    let mut out = format!("{header}\n");
    for (i, j, k) in entries(f) {
        let _ = writeln!(out, "{i},{j},{}", cell(k));
    }
    out.into_bytes()
}

fn write_mtx(f: &FormFactors, values: &[f64]) -> Vec<u8> {
    let mut out = format!("%%MatrixMarket matrix coordinate real general\n{n} {n} {s}\n", n = f.n, s = f.stored());
    for (i, j, k) in entries(f) {
        let _ = writeln!(out, "{} {} {:?}", i + 1, j + 1, values[k]);
    }
    out.into_bytes()
}

/// Reads an N x N matrix; ours or anybody's.
pub fn read_form_factors(path: &Path, n: usize) -> Result<FormFactors, FileError> {
    let format = MatrixFormat::of(path)?;
    let bytes = std::fs::read(path).map_err(|e| FileError::system(path, "read", &e))?;
    let reader = Reader { path, n };
    let (entries, has_errors) = match format {
        MatrixFormat::Npz => (reader.npz(&bytes)?, false),
        MatrixFormat::Csv => reader.csv(&bytes)?,
        MatrixFormat::Mtx => (reader.mtx(&bytes)?, false),
    };
    reader.build(entries, has_errors)
}

/// What to do about arrays that are no sparse matrix.
const SAVE: &str = "save it with scipy.sparse.save_npz";

/// True for 0, 1, 2, ...
fn is_index(x: f64) -> bool {
    x >= 0.0 && x.fract() == 0.0
}

/// Row, column, form factor, standard error.
type Triplet = (usize, usize, f64, f64);

struct Reader<'a> {
    path: &'a Path,
    n: usize,
}

impl Reader<'_> {
    fn wrong(&self, problem: impl Into<String>) -> FileError {
        FileError::new(self.path, problem)
    }

    /// Sorts entries into rows and checks each.
    fn build(&self, entries: Vec<Triplet>, has_errors: bool) -> Result<FormFactors, FileError> {
        let mut rows = vec![Vec::new(); self.n];
        for (i, j, f, se) in entries {
            let entry = format!("entry ({i}, {j})");
            if i >= self.n || j >= self.n {
                return Err(self
                    .wrong(format!("lies outside a {0} x {0} matrix", self.n))
                    .at(entry)
                    .mend("is it the matrix of another scene? numbers count from 0 in .csv and .npz, from 1 in .mtx"));
            }
            if !f.is_finite() || f < 0.0 {
                return Err(self.wrong(format!("form factor {f} is not a number >= 0")).at(entry));
            }
            if se < 0.0 {
                return Err(self.wrong(format!("standard error {se} is below 0")).at(entry));
            }
            if f != 0.0 {
                rows[i].push((j as u32, f, se));
            }
        }
        for (i, row) in rows.iter_mut().enumerate() {
            row.sort_unstable_by_key(|e| e.0);
            if let Some(w) = row.windows(2).find(|w| w[0].0 == w[1].0) {
                return Err(self
                    .wrong("stands twice")
                    .at(format!("entry ({i}, {})", w[0].0))
                    .mend("give each pair once: add the parts up, or drop one"));
            }
        }
        let mut f = FormFactors::from_rows(rows);
        if !has_errors {
            f.std_err = None;
        }
        Ok(f)
    }

    fn check_shape(&self, rows: f64, columns: f64) -> Result<(), FileError> {
        let n = self.n as f64;
        if rows == n && columns == n {
            return Ok(());
        }
        Err(self
            .wrong(format!("is {rows} x {columns}, but the scene has {} patches", self.n))
            .mend("was it computed for another scene, state or --max-edge?"))
    }

    fn npz(&self, bytes: &[u8]) -> Result<Vec<Triplet>, FileError> {
        let members = npz::unzip(self.path, bytes)?;
        let member =
            |name: &str| members.get(name).ok_or_else(|| self.wrong(format!("has no array \"{name}\"")).mend(SAVE));
        let numbers = |name: &str| Ok(npz::numbers(self.path, name, member(name)?)?.1);
        let shape = numbers("shape")?;
        let [rows, columns] = shape[..] else {
            return Err(self.wrong("does not hold two numbers").at("array \"shape\"").mend(SAVE));
        };
        self.check_shape(rows, columns)?;
        let data = numbers("data")?;
        let format = npz::text(member("format")?);
        let pairs: Vec<(f64, f64)> = match format.as_str() {
            "coo" => numbers("row")?.into_iter().zip(numbers("col")?).collect(),
            "csr" | "csc" => {
                let (starts, indices) = (numbers("indptr")?, numbers("indices")?);
                let whole = starts.iter().all(|s| s.fract() == 0.0);
                if !whole || starts.len() != self.n + 1 || starts.windows(2).any(|w| w[1] < w[0]) || starts[0] != 0.0 {
                    let problem = format!("is not a rising list of {} whole numbers from 0", self.n + 1);
                    return Err(self.wrong(problem).at("array \"indptr\"").mend(SAVE));
                }
                if starts[self.n] as usize != indices.len() {
                    let problem = format!("ends with {}, but there are {} indices", starts[self.n], indices.len());
                    return Err(self.wrong(problem).at("array \"indptr\"").mend(SAVE));
                }
                let major =
                    (0..self.n).flat_map(|i| std::iter::repeat_n(i as f64, (starts[i + 1] - starts[i]) as usize));
                let pairs = major.zip(indices);
                if format == "csr" { pairs.collect() } else { pairs.map(|(j, i)| (i, j)).collect() }
            }
            other => {
                return Err(self.wrong(format!("format \"{other}\" is not read")).mend("convert it with .tocsr()"));
            }
        };
        if pairs.len() != data.len() {
            let problem = format!("holds {} values for {} indices", data.len(), pairs.len());
            return Err(self.wrong(problem).at("array \"data\"").mend(SAVE));
        }
        if let Some((i, j)) = pairs.iter().find(|(i, j)| !(is_index(*i) && is_index(*j))) {
            return Err(self.wrong("is not at a row and a column").at(format!("entry ({i}, {j})")).mend(SAVE));
        }
        Ok(pairs.into_iter().zip(data).map(|((i, j), f)| (i as usize, j as usize, f, f64::NAN)).collect())
    }

    fn csv(&self, bytes: &[u8]) -> Result<(Vec<Triplet>, bool), FileError> {
        let mut csv = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
        let header = csv.headers().map_err(|e| csv_error(self.path, &e))?.clone();
        let names: Vec<&str> = header.iter().collect();
        if !names.starts_with(&["i", "j", "form_factor"]) {
            return Err(self
                .wrong("does not begin with i,j,form_factor")
                .at("line 1")
                .mend("the first line names the columns: i,j,form_factor,std_err"));
        }
        let mut all_have_errors = names.get(3) == Some(&"std_err");
        let mut out = Vec::new();
        for record in csv.records() {
            let record = record.map_err(|e| csv_error(self.path, &e))?;
            let line = format!("line {}", record.position().map_or(0, csv::Position::line));
            let field = |k: usize| record.get(k).unwrap_or("");
            let index = |k: usize| {
                field(k)
                    .parse::<usize>()
                    .map_err(|_| self.wrong(format!("\"{}\" is not a patch number", field(k))).at(line.clone()))
            };
            let value: f64 = field(2)
                .parse()
                .map_err(|_| self.wrong(format!("\"{}\" is not a number", field(2))).at(line.clone()))?;
            let std_err = match field(3) {
                "" => f64::NAN,
                _ if names.get(3) != Some(&"std_err") => f64::NAN,
                text => text.parse().map_err(|_| self.wrong(format!("\"{text}\" is not a number")).at(line.clone()))?,
            };
            all_have_errors &= f64::is_finite(std_err);
            out.push((index(0)?, index(1)?, value, std_err));
        }
        Ok((out, all_have_errors))
    }

    fn mtx(&self, bytes: &[u8]) -> Result<Vec<Triplet>, FileError> {
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let line = bytes[..e.valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
            self.wrong("is not text").at(format!("line {line}")).mend("save it as plain text")
        })?;
        let first = text.lines().next().unwrap_or("").to_lowercase();
        let symmetric = first.ends_with("symmetric");
        if !first.starts_with("%%matrixmarket matrix coordinate") || !(symmetric || first.ends_with("general")) {
            return Err(self
                .wrong("is not a Matrix Market coordinate matrix")
                .at("line 1")
                .mend("it begins with %%MatrixMarket matrix coordinate real general"));
        }
        let mut lines = text.lines().enumerate().filter(|(_, l)| !l.starts_with('%') && !l.trim().is_empty());
        let parse = |(number, line): (usize, &str)| -> Result<[f64; 3], FileError> {
            let fields: Option<Vec<f64>> = line.split_whitespace().map(|w| w.parse().ok()).collect();
            fields
                .and_then(|f| <[f64; 3]>::try_from(f).ok())
                .ok_or_else(|| self.wrong("does not hold three numbers").at(format!("line {}", number + 1)))
        };
        let [rows, columns, stored] = parse(lines.next().ok_or_else(|| self.wrong("has no size line").at("line 2"))?)?;
        self.check_shape(rows, columns)?;
        let mut out = Vec::new();
        for (number, line) in lines {
            let [i, j, f] = parse((number, line))?;
            if !(is_index(i - 1.0) && is_index(j - 1.0)) {
                return Err(self
                    .wrong(format!("({i}, {j}) is no row and column: numbers count from 1 in .mtx"))
                    .at(format!("line {}", number + 1)));
            }
            out.push((i as usize - 1, j as usize - 1, f, f64::NAN));
            if symmetric && i != j {
                out.push((j as usize - 1, i as usize - 1, f, f64::NAN));
            }
        }
        let read = out.iter().filter(|(i, j, ..)| !symmetric || i >= j).count();
        if read as f64 != stored {
            return Err(self.wrong(format!("announces {stored} entries but holds {read}")).mend("is it cut off?"));
        }
        Ok(out)
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
            if format != MatrixFormat::Csv {
                expected.std_err = None;
            }
            assert_eq!(read_form_factors(&path, 3).unwrap(), expected, "{name}");
            assert!(read_form_factors(&path, 2).is_err());
        }
    }
}
