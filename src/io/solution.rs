//! Solution files: radiosities per patch and band as `.csv`, `.json`, `.npy` or `.npz`.

use super::{FileError, npz};
use crate::solution::Radiosity;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Name of the JSON format.
const JSON_FORMAT: &str = "etalon-solution/1";

/// Formats of a solution, chosen by the file's ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolutionFormat {
    /// `patch,<band>,...` with optional `<band>_std_err`.
    Csv,
    /// `{"format": "etalon-solution/1", ...}`.
    Json,
    /// N x bands array.
    Npy,
    /// `radiosity`: N x bands, and `std_err` where known.
    Npz,
}

impl SolutionFormat {
    /// The format a file name asks for.
    pub fn of(path: &Path) -> Result<Self, FileError> {
        match path.extension().and_then(|e| e.to_str()) {
            Some("csv") => Ok(Self::Csv),
            Some("json") => Ok(Self::Json),
            Some("npy") => Ok(Self::Npy),
            Some("npz") => Ok(Self::Npz),
            _ => Err(FileError::new(path, "has no ending that names a solution format")
                .mend("use .csv, .json, .npy or .npz, or name a reference directory")),
        }
    }
}

/// What a solution belongs to; written beside the values where the format has room.
#[derive(Debug, Clone, Copy)]
pub struct BandNames<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Hash of the scene at its state.
    pub scene_hash: &'a str,
    /// Band names.
    pub bands: &'a [String],
    /// Receivers that take part; the others get no row where the format has rows.
    pub present: &'a [bool],
}

/// A solution as it stands in a file, not yet fitted to a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SolutionFile {
    path: std::path::PathBuf,
    /// Band names, where the format has them.
    pub bands: Option<Vec<String>>,
    /// Hash of the scene it was computed for, if it says so.
    pub scene_hash: Option<String>,
    /// Values and standard errors by receiver number.
    rows: BTreeMap<usize, Row>,
    /// Bands per row.
    width: usize,
    /// True if every receiver has a place in the file (arrays), absent ones too.
    dense: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct Row {
    values: Vec<f64>,
    std_err: Option<Vec<f64>>,
}

#[derive(Serialize, Deserialize)]
struct Json {
    format: String,
    #[serde(default)]
    scene: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scene_hash: Option<String>,
    bands: Vec<String>,
    radiosity: Vec<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    std_err: Option<Vec<Vec<f64>>>,
}

/// A solution as the bytes of a file.
pub fn write_solution(b: &Radiosity, names: BandNames, format: SolutionFormat) -> Vec<u8> {
    match format {
        SolutionFormat::Csv => write_csv(b, names),
        SolutionFormat::Json => write_json(b, names),
        SolutionFormat::Npy => npz::array(&[b.len() as u64, b.bands as u64], &b.values),
        SolutionFormat::Npz => {
            let shape = [b.len() as u64, b.bands as u64];
            let mut members = npz::Members::default();
            members.add("radiosity", npz::array(&shape, &b.values));
            if let Some(e) = &b.std_err {
                members.add("std_err", npz::array(&shape, e));
            }
            members.zip()
        }
    }
}

fn write_csv(b: &Radiosity, names: BandNames) -> Vec<u8> {
    let mut out = format!("patch,{}", names.bands.join(","));
    if b.std_err.is_some() {
        names.bands.iter().for_each(|n| out += &format!(",{n}_std_err"));
    }
    out.push('\n');
    for i in (0..b.len()).filter(|i| names.present[*i]) {
        let _ = write!(out, "{i}");
        for x in b.of(i).iter().chain(b.std_err_of(i).unwrap_or(&[])) {
            let _ = write!(out, ",{x:?}");
        }
        out.push('\n');
    }
    out.into_bytes()
}

fn write_json(b: &Radiosity, names: BandNames) -> Vec<u8> {
    let json = Json {
        format: JSON_FORMAT.into(),
        scene: names.scene.into(),
        scene_hash: Some(names.scene_hash.into()),
        bands: names.bands.to_vec(),
        radiosity: (0..b.len()).map(|i| b.of(i).to_vec()).collect(),
        std_err: b
            .std_err
            .as_ref()
            .map(|_| (0..b.len()).filter_map(|i| b.std_err_of(i)).map(<[f64]>::to_vec).collect()),
    };
    let mut bytes = serde_json::to_vec(&json).expect("finite numbers serialise");
    bytes.push(b'\n');
    bytes
}

/// Reads a solution file; [`SolutionFile::fit`] fits it to a scene.
pub fn read_solution(path: &Path) -> Result<SolutionFile, FileError> {
    let format = SolutionFormat::of(path)?;
    let bytes = std::fs::read(path).map_err(|e| FileError::system(path, "read", &e))?;
    match format {
        SolutionFormat::Csv => read_csv(path, &bytes),
        SolutionFormat::Json => read_json(path, &bytes),
        SolutionFormat::Npy => read_array(path, &bytes, None),
        SolutionFormat::Npz => {
            let members = npz::unzip(path, &bytes)?;
            let values = members.get("radiosity").ok_or_else(|| {
                FileError::new(path, "has no array \"radiosity\"").mend("save it with numpy.savez(..., radiosity=B)")
            })?;
            read_array(path, values, members.get("std_err").map(Vec::as_slice))
        }
    }
}

fn read_csv(path: &Path, bytes: &[u8]) -> Result<SolutionFile, FileError> {
    let mut csv = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
    let header = csv.headers().map_err(|e| csv_error(path, &e))?.clone();
    let names: Vec<&str> = header.iter().collect();
    if names.first() != Some(&"patch") || names.len() < 2 {
        return Err(FileError::new(path, "does not begin with patch,<band>,...")
            .at("line 1")
            .mend("the first line names the columns: patch,r,g,b for example"));
    }
    if let Some(twice) = (1..names.len()).find(|k| names[..*k].contains(&names[*k])) {
        return Err(FileError::new(path, format!("names the column \"{}\" twice", names[twice]))
            .at("line 1")
            .mend("one column per band"));
    }
    let bands: Vec<String> = names[1..].iter().filter(|n| !n.ends_with("_std_err")).map(|n| n.to_string()).collect();
    let column = |name: &str| names.iter().position(|n| *n == name);
    let value_columns: Vec<usize> = bands.iter().filter_map(|b| column(b)).collect();
    let error_columns: Vec<usize> = bands.iter().filter_map(|b| column(&format!("{b}_std_err"))).collect();
    if names.len() != 1 + value_columns.len() + error_columns.len()
        || !(error_columns.is_empty() || error_columns.len() == bands.len())
    {
        return Err(FileError::new(path, "has columns that are neither bands nor all of their _std_err")
            .at("line 1")
            .mend("give every band its <band>_std_err column, or none"));
    }
    let mut rows = BTreeMap::new();
    for record in csv.records() {
        let record = record.map_err(|e| csv_error(path, &e))?;
        let line = format!("line {}", record.position().map_or(0, csv::Position::line));
        let wrong = |problem: String| FileError::new(path, problem).at(line.clone());
        if record.len() != names.len() {
            return Err(wrong(format!("has {} fields, the header {}", record.len(), names.len())));
        }
        let patch: usize = record[0].parse().map_err(|_| wrong(format!("\"{}\" is not a patch number", &record[0])))?;
        let read = |columns: &[usize]| -> Result<Vec<f64>, FileError> {
            let number = |c: &usize| {
                record[*c].parse::<f64>().map_err(|_| wrong(format!("\"{}\" is not a number", &record[*c])))
            };
            columns.iter().map(number).collect()
        };
        let std_err = if error_columns.is_empty() { None } else { Some(read(&error_columns)?) };
        if rows.insert(patch, Row { values: read(&value_columns)?, std_err }).is_some() {
            return Err(wrong(format!("patch {patch} stands twice")));
        }
    }
    let width = bands.len();
    let file = SolutionFile { path: path.into(), bands: Some(bands), scene_hash: None, rows, width, dense: false };
    file.check_finite()
}

/// A line that is no CSV, by number.
pub(super) fn csv_error(path: &Path, e: &csv::Error) -> FileError {
    let line = e.position().map_or("line 1".into(), |p| format!("line {}", p.line()));
    let problem = match e.kind() {
        csv::ErrorKind::Utf8 { .. } => "is not text in UTF-8".into(),
        _ => e.to_string(),
    };
    FileError::new(path, problem).at(line).mend("save it as plain comma-separated text")
}

fn read_json(path: &Path, bytes: &[u8]) -> Result<SolutionFile, FileError> {
    let json: Json = serde_json::from_slice(bytes).map_err(|e| {
        FileError::new(path, format!("is not an {JSON_FORMAT} file: {e}"))
            .at(format!("line {}", e.line()))
            .mend("it holds \"format\", \"bands\" and \"radiosity\", a list of numbers for each patch")
    })?;
    if json.format != JSON_FORMAT {
        return Err(FileError::new(path, format!("has format \"{}\"", json.format))
            .mend(format!("this version reads {JSON_FORMAT}")));
    }
    let width = json.bands.len();
    let errors = json.std_err.unwrap_or_default();
    let lengths_fit = errors.is_empty() || errors.len() == json.radiosity.len();
    if width == 0 {
        return Err(FileError::new(path, "names no band").at("\"bands\"").mend("\"bands\": [\"r\", \"g\", \"b\"]"));
    }
    for (what, rows) in [("radiosity", &json.radiosity), ("std_err", &errors)] {
        if let Some(i) = rows.iter().position(|r| r.len() != width) {
            return Err(FileError::new(path, format!("has {} values for {width} bands", rows[i].len()))
                .at(format!("\"{what}\", patch {i}"))
                .mend("one value per band"));
        }
    }
    if !lengths_fit {
        let (n, m) = (json.radiosity.len(), errors.len());
        return Err(FileError::new(path, format!("has {m} rows, but \"radiosity\" has {n}")).at("\"std_err\""));
    }
    let mut errors = errors.into_iter();
    let rows = json.radiosity.into_iter().enumerate().map(|(i, values)| (i, Row { values, std_err: errors.next() }));
    let file = SolutionFile {
        path: path.into(),
        bands: Some(json.bands),
        scene_hash: json.scene_hash,
        rows: rows.collect(),
        width,
        dense: true,
    };
    file.check_finite()
}

fn read_array(path: &Path, values: &[u8], errors: Option<&[u8]>) -> Result<SolutionFile, FileError> {
    let (shape, values) = npz::numbers(path, "radiosity", values)?;
    let width = match shape[..] {
        [_] => 1,
        [_, bands] if bands > 0 => bands as usize,
        _ => return Err(FileError::new(path, format!("has shape {shape:?}, not N x bands")).at("array \"radiosity\"")),
    };
    let errors = errors.map(|e| npz::numbers(path, "std_err", e)).transpose()?;
    if let Some((other, _)) = errors.as_ref().filter(|(s, _)| *s != shape) {
        return Err(FileError::new(path, format!("has shape {other:?}, but \"radiosity\" {shape:?}"))
            .at("array \"std_err\"")
            .mend("one standard error for each value"));
    }
    let errors = errors.map(|(_, e)| e);
    let row = |(i, v): (usize, &[f64])| {
        let std_err = errors.as_ref().map(|e| e[i * width..(i + 1) * width].to_vec());
        (i, Row { values: v.to_vec(), std_err })
    };
    let rows = values.chunks(width).enumerate().map(row).collect();
    SolutionFile { path: path.into(), bands: None, scene_hash: None, rows, width, dense: true }.check_finite()
}

impl SolutionFile {
    fn wrong(&self, problem: impl Into<String>) -> FileError {
        FileError::new(&self.path, problem)
    }

    fn check_finite(self) -> Result<Self, FileError> {
        for (i, row) in &self.rows {
            let errors = || row.std_err.iter().flatten();
            if let Some(x) = row.values.iter().chain(errors()).find(|x| !x.is_finite()) {
                return Err(self.wrong(format!("{x} is not a finite number")).at(format!("patch {i}")));
            }
            if let Some(x) = errors().find(|x| **x < 0.0) {
                return Err(self.wrong(format!("{x} is not a standard error: it is below 0")).at(format!("patch {i}")));
            }
        }
        Ok(self)
    }

    /// Number of receivers the file speaks of.
    pub fn len(&self) -> usize {
        self.rows.keys().next_back().map_or(0, |k| k + 1)
    }

    /// True if the file holds no receiver.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of bands.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Refuses a file without any patch, or that leaves one out: where no scene says which patches there are, the
    /// file alone does.
    ///
    /// # Errors
    /// Names the first patch that is missing.
    pub fn check_complete(&self) -> Result<(), FileError> {
        match (0..).zip(self.rows.keys()).find(|(i, k)| i != *k) {
            Some((i, _)) => Err(self.missing(i)),
            None if self.rows.is_empty() => Err(self.missing(0)),
            None => Ok(()),
        }
    }

    fn missing(&self, i: usize) -> FileError {
        self.wrong("is missing").at(format!("patch {i}")).mend("every present patch needs a row")
    }

    /// The radiosities of a scene before its last change: receivers without a row did not exist and count as 0.
    pub fn fit_before(&self, bands: &[String], n: usize) -> Result<Radiosity, FileError> {
        let spoken_of: Vec<bool> = (0..n).map(|i| self.rows.contains_key(&i)).collect();
        self.fit(bands, &spoken_of)
    }

    /// The radiosities of a scene with these bands and receivers: one value for each that is present.
    pub fn fit(&self, bands: &[String], present: &[bool]) -> Result<Radiosity, FileError> {
        let order = self.band_order(bands)?;
        let n = present.len();
        if self.dense && self.len() != n {
            return Err(self
                .wrong(format!("holds {} patches, but the scene has {n}", self.len()))
                .mend("was it computed for another scene, state, --max-edge or --per?"));
        }
        if let Some(i) = self.rows.keys().find(|i| **i >= n) {
            return Err(self
                .wrong(format!("the scene has only {n} patches"))
                .at(format!("patch {i}"))
                .mend("patches count from 0; was it computed for another scene, state, --max-edge or --per?"));
        }
        let mut values = vec![0.0; n * bands.len()];
        let all_have_errors = self.rows.values().all(|r| r.std_err.is_some());
        let mut errors = vec![0.0; n * bands.len()];
        for i in (0..n).filter(|i| present[*i]) {
            let row = self.rows.get(&i).ok_or_else(|| self.missing(i))?;
            for (c, from) in order.iter().enumerate() {
                values[i * bands.len() + c] = row.values[*from];
                errors[i * bands.len() + c] = row.std_err.as_ref().map_or(0.0, |e| e[*from]);
            }
        }
        Ok(Radiosity { bands: bands.len(), values, std_err: all_have_errors.then_some(errors) })
    }

    /// Column of each of the scene's bands.
    fn band_order(&self, bands: &[String]) -> Result<Vec<usize>, FileError> {
        let mismatch = |found: String| {
            self.wrong(format!("has bands {found}, but the scene has {}", bands.join(", ")))
                .mend("name one column per band of the scene")
        };
        if self.width != bands.len() {
            return Err(mismatch(self.bands.as_ref().map_or(format!("{} in number", self.width), |b| b.join(", "))));
        }
        let Some(names) = &self.bands else { return Ok((0..bands.len()).collect()) };
        let find = |b: &String| names.iter().position(|n| n == b).ok_or_else(|| mismatch(names.join(", ")));
        bands.iter().map(find).collect()
    }
}

#[cfg(test)]
mod tests;
