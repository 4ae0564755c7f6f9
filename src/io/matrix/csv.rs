//! `i,j,form_factor,std_err`, 0-based, zero entries left out; on request with names and areas.

use super::entries::{Entries, Reader};
use super::rows::Rows;
use super::stored;
use crate::io::FileError;
use crate::io::solution::csv_error;
use crate::solution::FormFactors;

pub(super) fn write(f: &FormFactors, values: &[f64], rows: Option<&Rows>, errors: bool) -> Vec<u8> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut header = if errors { vec!["i", "j", "std_err"] } else { vec!["i", "j", "form_factor", "std_err"] };
    header.extend(rows.iter().flat_map(|_| ["from", "to", "area_from", "area_to"]));
    // Writing to memory does not fail.
    let _ = table.write_record(&header);
    for (i, j, k) in stored(f) {
        let mut record = vec![i.to_string(), j.to_string(), format!("{:?}", values[k])];
        if !errors {
            record.push(f.std_err.as_ref().map_or(String::new(), |e| format!("{:?}", e[k])));
        }
        if let Some(rows) = rows {
            record.extend([i, j].map(|r| rows.names[r].clone()));
            record.extend([i, j].map(|r| format!("{:?}", rows.areas[r])));
        }
        let _ = table.write_record(&record);
    }
    table.into_inner().unwrap_or_default()
}

pub(super) fn read(reader: &Reader, bytes: &[u8]) -> Result<Entries, FileError> {
    let mut csv = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
    let header = csv.headers().map_err(|e| csv_error(reader.path, &e))?.clone();
    let names: Vec<&str> = header.iter().collect();
    if !names.starts_with(&["i", "j", "form_factor"]) {
        return Err(reader
            .wrong("does not begin with i,j,form_factor")
            .at("line 1")
            .mend("the first line names the columns: i,j,form_factor,std_err"));
    }
    let mut has_errors = names.get(3) == Some(&"std_err");
    let mut list = Vec::new();
    for record in csv.records() {
        let record = record.map_err(|e| csv_error(reader.path, &e))?;
        let line = format!("line {}", record.position().map_or(0, csv::Position::line));
        let field = |k: usize| record.get(k).unwrap_or("");
        let index = |k: usize| {
            field(k)
                .parse::<usize>()
                .map_err(|_| reader.wrong(format!("\"{}\" is not a patch number", field(k))).at(line.clone()))
        };
        let number =
            |text: &str| text.parse().map_err(|_| reader.wrong(format!("\"{text}\" is not a number")).at(line.clone()));
        let value: f64 = number(field(2))?;
        let std_err = match field(3) {
            "" => f64::NAN,
            _ if names.get(3) != Some(&"std_err") => f64::NAN,
            text => number(text)?,
        };
        has_errors &= f64::is_finite(std_err);
        list.push((index(0)?, index(1)?, value, std_err));
    }
    Ok(Entries { list, has_errors })
}
