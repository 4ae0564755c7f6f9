//! EnergyPlus: the object `ZoneProperty:UserViewFactors:BySurfaceName`, from surface to surface.
//!
//! EnergyPlus wants every pair of the zone's surfaces, zeros included, and compares names without regard to case.

use super::rows::Rows;
use crate::io::FileError;
use crate::solution::FormFactors;
use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;

/// Most surfaces of one zone: every pair takes a line.
const MOST_SURFACES: usize = 3000;
/// Longest name that EnergyPlus keeps.
const LONGEST_NAME: usize = 100;

/// The object, with standard errors in comments.
pub(super) fn write(path: &Path, f: &FormFactors, rows: &Rows, zone: &str, errors: bool) -> Result<Vec<u8>, FileError> {
    if errors {
        let problem = "cannot hold standard errors: EnergyPlus has no object for them";
        return Err(FileError::new(path, problem).mend("use .npz, .csv, .mtx or .vf"));
    }
    let n = rows.len();
    if n > MOST_SURFACES {
        let problem = format!("would need {n} x {n} lines");
        return Err(
            FileError::new(path, problem).mend("put the polygons of a wall into one surface (a mesh, or a group)")
        );
    }
    check_names(path, rows, zone)?;
    let sums = (0..n).map(|i| f.row_sum(i));
    let (low, high) = sums.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
    let mut out = format!(
        "! View factors of {n} surfaces by etalon {}; row sums {low:.9} to {high:.9}.\n\
         ! std_err: standard error; where a surface has several patches, an upper bound of it.\n",
        env!("CARGO_PKG_VERSION")
    );
    rows.names.iter().zip(&rows.areas).for_each(|(name, area)| {
        let _ = writeln!(out, "! {name}: {area:?} m2");
    });
    out += "ZoneProperty:UserViewFactors:BySurfaceName,\n";
    let _ = write!(out, "  {zone}");
    out += ",  !- Zone, Space or ZoneList Name\n";
    for (i, from) in rows.names.iter().enumerate() {
        for (j, to) in rows.names.iter().enumerate() {
            let end = if i + 1 == n && j + 1 == n { ';' } else { ',' };
            // EnergyPlus refuses what rounding lifts above 1.
            let value = match f.get(i, j) {
                v if v > 1.0 && v < 1.0 + 1e-9 => 1.0,
                v => v,
            };
            let _ = write!(out, "  {from},{to},{value:?}{end}");
            let _ = match f.std_err_of(i, j) {
                Some(e) => writeln!(out, "  !- std_err {e:.2e}"),
                None => writeln!(out),
            };
        }
    }
    Ok(out.into_bytes())
}

/// Names end at `,` `;` and `!`, and are the same in capitals.
fn check_names(path: &Path, rows: &Rows, zone: &str) -> Result<(), FileError> {
    let mut seen = HashSet::new();
    let zone = std::iter::once(("zone", zone));
    let surfaces = rows.names.iter().map(|n| ("surface", n.as_str()));
    for (kind, name) in zone.chain(surfaces) {
        let refuse = |problem: &str, mend: &str| {
            let problem = format!("cannot be written for EnergyPlus: the {kind} name \"{name}\" {problem}");
            Err(FileError::new(path, problem).mend(mend))
        };
        if name.contains([',', ';', '!']) {
            return refuse(
                "holds a comma, semicolon or exclamation mark",
                "rename it in the scene (a zone: zone=NAME)",
            );
        }
        if name.chars().count() > LONGEST_NAME {
            return refuse(&format!("has more than {LONGEST_NAME} characters"), "give it a shorter one");
        }
        if kind == "surface" && !seen.insert(name.to_lowercase()) {
            return refuse("occurs twice, apart from capitals", "give every surface its own name");
        }
    }
    Ok(())
}
