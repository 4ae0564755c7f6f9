//! Matrix Market coordinate format, 1-based; names and areas in comments.

use super::entries::{Entries, Reader, is_index};
use super::rows::Rows;
use super::stored;
use crate::io::FileError;
use crate::solution::FormFactors;
use std::fmt::Write;

pub(super) fn write(f: &FormFactors, values: &[f64], rows: Option<&Rows>) -> Vec<u8> {
    let mut out = String::from("%%MatrixMarket matrix coordinate real general\n");
    if let Some(rows) = rows {
        out += "% row, area in m2, name\n";
        for (i, (area, name)) in rows.areas.iter().zip(&rows.names).enumerate() {
            let _ = writeln!(out, "% {} {area:?} {name}", i + 1);
        }
    }
    let _ = writeln!(out, "{n} {n} {s}", n = f.n, s = f.stored());
    for (i, j, k) in stored(f) {
        let _ = writeln!(out, "{} {} {:?}", i + 1, j + 1, values[k]);
    }
    out.into_bytes()
}

pub(super) fn read(reader: &Reader, bytes: &[u8]) -> Result<Entries, FileError> {
    let text = reader.text(bytes)?;
    let first = text.lines().next().unwrap_or("").to_lowercase();
    let symmetric = first.ends_with("symmetric");
    if !first.starts_with("%%matrixmarket matrix coordinate") || !(symmetric || first.ends_with("general")) {
        return Err(reader
            .wrong("is not a Matrix Market coordinate matrix")
            .at("line 1")
            .mend("it begins with %%MatrixMarket matrix coordinate real general"));
    }
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.starts_with('%') && !l.trim().is_empty());
    let parse = |(number, line): (usize, &str)| -> Result<[f64; 3], FileError> {
        let fields: Option<Vec<f64>> = line.split_whitespace().map(|w| w.parse().ok()).collect();
        fields
            .and_then(|f| <[f64; 3]>::try_from(f).ok())
            .ok_or_else(|| reader.wrong("does not hold three numbers").at(format!("line {}", number + 1)))
    };
    let size = lines.next().ok_or_else(|| reader.wrong("has no size line").at("line 2"))?;
    let [rows, columns, announced] = parse(size)?;
    reader.check_shape(rows, columns)?;
    let mut out = Vec::new();
    for (number, line) in lines {
        let [i, j, f] = parse((number, line))?;
        if !(is_index(i - 1.0) && is_index(j - 1.0)) {
            return Err(reader
                .wrong(format!("({i}, {j}) is no row and column: numbers count from 1 in .mtx"))
                .at(format!("line {}", number + 1)));
        }
        out.push((i as usize - 1, j as usize - 1, f, f64::NAN));
        if symmetric && i != j {
            out.push((j as usize - 1, i as usize - 1, f, f64::NAN));
        }
    }
    let read = out.iter().filter(|(i, j, ..)| !symmetric || i >= j).count();
    if read as f64 != announced {
        return Err(reader.wrong(format!("announces {announced} entries but holds {read}")).mend("is it cut off?"));
    }
    Ok(Entries::exact(out))
}
