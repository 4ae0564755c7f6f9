//! A table of values beside a mesh: `face,<band>,...` or `vertex,<band>,...`, numbers in file order from 0.

use super::{bytes_of, shown};
use crate::io::FileError;
use crate::io::scene::mesh::{ERROR_TAIL, band_names};
use std::collections::HashMap;
use std::path::Path;

/// Rows as they stand in the file.
pub(super) struct Table {
    pub bands: Vec<String>,
    /// True if rows are faces, false if vertices.
    pub of_faces: bool,
    pub notices: Vec<String>,
    rows: HashMap<u64, Row>,
}

struct Row {
    line: u64,
    values: Vec<f64>,
}

/// Reads a table; `fields` names the columns wanted.
pub(super) fn read(path: &Path, fields: Option<&[String]>) -> Result<Table, FileError> {
    let bytes = bytes_of(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|e| {
        let line = bytes[..e.valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
        FileError::new(path, "is not text in UTF-8").at(format!("line {line}")).mend("write a table of commas")
    })?;
    let text = text.trim_start_matches('\u{feff}');
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let mut records = reader.records();
    let broken = |e: csv::Error| {
        let line = e.position().map_or(1, csv::Position::line);
        FileError::new(path, e.to_string()).at(format!("line {line}")).mend("write a table of commas")
    };
    let head = match records.next() {
        Some(head) => head.map_err(broken)?,
        None => return Err(FileError::new(path, "is empty").mend("begin with face,<band>,... or vertex,<band>,...")),
    };
    let (mut table, columns) = header(path, &head, fields)?;
    for record in records {
        let record = record.map_err(broken)?;
        table.add(path, &record, head.len(), &columns)?;
    }
    Ok(table)
}

/// The empty table that a header asks for, and the columns of its bands.
fn header(path: &Path, head: &csv::StringRecord, fields: Option<&[String]>) -> Result<(Table, Vec<usize>), FileError> {
    let refuse = |problem: String, mend: &str| Err(FileError::new(path, problem).at("line 1").mend(mend));
    let of_faces = match head.get(0).unwrap_or_default() {
        "face" => true,
        "vertex" => false,
        other => {
            let problem = format!("the first column is called \"{}\"", shown(other));
            return refuse(problem, "call it face or vertex: rows are numbered in the order of the mesh, from 0");
        }
    };
    let names: Vec<&str> = head.iter().skip(1).collect();
    if let Some(k) = (0..names.len()).find(|k| names[*k].is_empty() || names[..*k].contains(&names[*k])) {
        let problem = format!("column {} is called \"{}\", like another or like nothing", k + 2, shown(names[k]));
        return refuse(problem, "give every band a name of its own");
    }
    let is_error = |n: &str| n.ends_with(ERROR_TAIL);
    let wanted: Vec<String> = match fields {
        Some(fields) => fields.to_vec(),
        None => names.iter().filter(|n| !is_error(n)).map(|n| n.to_string()).collect(),
    };
    if wanted.is_empty() {
        return refuse("the table has no bands".into(), "add a column for each band: face,r,g,b");
    }
    let mut columns = Vec::with_capacity(wanted.len());
    for name in &wanted {
        match names.iter().position(|n| n == name) {
            Some(k) => columns.push(k + 1),
            None => {
                let problem = format!("there is no column \"{}\"", shown(name));
                let all: Vec<String> = names.iter().map(|n| shown(n)).collect();
                return refuse(problem, &format!("name others (--fields); there are {}", all.join(", ")));
            }
        }
    }
    let errors = names.iter().filter(|n| is_error(n) && fields.is_none()).count();
    let notices = if errors == 0 { Vec::new() } else { vec![format!("{errors} columns of errors were left out")] };
    // Columns of a table are bands already, unless colours or the one value go by another name.
    let bands = if fields.is_some() || wanted.len() == 3 { band_names(&wanted) } else { wanted };
    Ok((Table { bands, of_faces, notices, rows: HashMap::new() }, columns))
}

impl Table {
    fn kind(&self) -> &'static str {
        if self.of_faces { "face" } else { "vertex" }
    }

    fn add(
        &mut self,
        path: &Path,
        record: &csv::StringRecord,
        width: usize,
        columns: &[usize],
    ) -> Result<(), FileError> {
        let line = record.position().map_or(1, csv::Position::line);
        let at = |problem: String, mend: &str| Err(FileError::new(path, problem).at(format!("line {line}")).mend(mend));
        if record.len() != width {
            let problem = format!("the row has {} cells, the header {width}", record.len());
            return at(problem, "complete the row");
        }
        let word = record.get(0).unwrap_or_default();
        let Ok(number) = word.parse::<u64>() else {
            let problem = format!("\"{}\" is not the number of a {}", shown(word), self.kind());
            return at(problem, "give whole numbers, from 0");
        };
        let mut values = Vec::with_capacity(columns.len());
        for (column, band) in columns.iter().zip(&self.bands) {
            let word = record.get(*column).unwrap_or_default();
            match word.parse::<f64>() {
                Ok(v) if v.is_finite() => values.push(v),
                _ => {
                    let (kind, word) = (self.kind(), shown(word));
                    let problem = format!("{kind} {number}: {} is \"{word}\", not a finite number", shown(band));
                    return at(problem, "give decimal numbers");
                }
            }
        }
        if let Some(before) = self.rows.insert(number, Row { line, values }) {
            let problem = format!("{} {number} stands in line {} already", self.kind(), before.line);
            return at(problem, "give every row once");
        }
        Ok(())
    }

    /// Values of all `count` faces or vertices of a mesh, in its order.
    pub(super) fn dense(self, path: &Path, count: usize, mesh: &str) -> Result<Vec<f64>, FileError> {
        let kind = self.kind();
        let mut beyond: Vec<(u64, u64)> =
            self.rows.iter().filter(|(n, _)| **n >= count as u64).map(|(n, row)| (row.line, *n)).collect();
        beyond.sort_unstable();
        if let Some((line, number)) = beyond.first() {
            let problem = format!("{kind} {number} does not exist: {mesh} has {count}");
            return Err(FileError::new(path, problem).at(format!("line {line}")).mend("they count from 0"));
        }
        let mut values = Vec::with_capacity(count * self.bands.len());
        for number in 0..count as u64 {
            match self.rows.get(&number) {
                Some(row) => values.extend_from_slice(&row.values),
                None => {
                    let problem = format!("{kind} {number} of {mesh} has no row");
                    return Err(FileError::new(path, problem)
                        .at(format!("{} rows for {count}", self.rows.len()))
                        .mend("give each a row: missing is not zero"));
                }
            }
        }
        Ok(values)
    }
}
