//! Which format a matrix is written in, and what its rows are.

use crate::io::FileError;
use std::path::Path;
use std::str::FromStr;

/// Formats that hold any sparse matrix, chosen by the file's ending.
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

/// How a matrix is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixStyle {
    /// Numbers of rows and columns.
    Plain(MatrixFormat),
    /// View3D's output: areas, a square of numbers, emittances.
    View3d,
    /// `ZoneProperty:UserViewFactors:BySurfaceName`.
    EnergyPlus,
}

/// What a row stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// A patch.
    Patch,
    /// A surface, or a group of its mesh.
    Surface,
}

/// Style and details: `view3d`, `view3d:by=patch`, `energyplus:zone=Attic`, `csv:by=surface`, `csv:names`.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixLayout {
    /// The format.
    pub style: MatrixStyle,
    /// `by=`; `None` leaves it to the format.
    pub by: Option<Level>,
    /// `zone=`: the zone of an EnergyPlus object; default: the name of the scene.
    pub zone: Option<String>,
    /// `names`: four more columns in `.csv`.
    pub names: bool,
}

impl From<MatrixStyle> for MatrixLayout {
    fn from(style: MatrixStyle) -> Self {
        Self { style, by: None, zone: None, names: false }
    }
}

impl MatrixLayout {
    /// What is asked for, else what the file name says.
    pub fn of(path: &Path, asked: Option<&Self>) -> Result<Self, FileError> {
        if let Some(asked) = asked {
            return Ok(asked.clone());
        }
        match path.extension().and_then(|e| e.to_str()) {
            Some("vf") => Ok(MatrixStyle::View3d.into()),
            Some("idf") => Ok(MatrixStyle::EnergyPlus.into()),
            _ => MatrixFormat::of(path).map(|f| MatrixStyle::Plain(f).into()).map_err(|e| {
                e.mend("use .npz, .csv, .mtx, .vf (View3D) or .idf (EnergyPlus), or name the format with --format")
            }),
        }
    }

    /// The layout of a matrix that is to be read again for the same scene: by patch.
    pub fn for_reuse(path: &Path) -> Result<Self, FileError> {
        let layout = Self::of(path, None)?;
        if layout.style == MatrixStyle::EnergyPlus {
            let problem = "would hold view factors by surface, which no solver of patches can read";
            return Err(FileError::new(path, problem).mend("use .npz, .csv, .mtx or .vf, or etalon form-factors"));
        }
        Ok(Self { by: Some(Level::Patch), ..layout })
    }

    /// The layout of the standard errors of a matrix with this layout.
    pub fn of_errors(&self, path: &Path) -> Result<Self, FileError> {
        let layout = Self::of(path, None)?;
        if layout.style == MatrixStyle::EnergyPlus {
            let problem = "cannot hold standard errors: EnergyPlus has no object for them";
            return Err(FileError::new(path, problem).mend("use .npz, .csv, .mtx or .vf"));
        }
        Ok(Self { by: Some(self.level()), names: self.names, ..layout })
    }

    /// What rows stand for: surfaces in the formats that know nothing else, patches in the others.
    pub fn level(&self) -> Level {
        let plain = matches!(self.style, MatrixStyle::Plain(_));
        self.by.unwrap_or(if plain { Level::Patch } else { Level::Surface })
    }
}

impl FromStr for MatrixLayout {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, details) = text.split_once(':').map_or((text, None), |(n, d)| (n, Some(d)));
        let style = match name {
            "npz" => MatrixStyle::Plain(MatrixFormat::Npz),
            "csv" => MatrixStyle::Plain(MatrixFormat::Csv),
            "mtx" => MatrixStyle::Plain(MatrixFormat::Mtx),
            "view3d" => MatrixStyle::View3d,
            "energyplus" => MatrixStyle::EnergyPlus,
            _ => return Err(format!("\"{name}\" is no format: write npz, csv, mtx, view3d or energyplus")),
        };
        let mut layout = Self::from(style);
        for detail in details.into_iter().flat_map(|d| d.split(',')) {
            match (detail.split_once('='), style) {
                (Some(("by", "surface")), _) => layout.by = Some(Level::Surface),
                (Some(("by", "patch")), MatrixStyle::EnergyPlus) => {
                    return Err("EnergyPlus knows surfaces by name, not patches: leave by=patch out".into());
                }
                (Some(("by", "patch")), _) => layout.by = Some(Level::Patch),
                (Some(("zone", zone)), MatrixStyle::EnergyPlus) if !zone.trim().is_empty() => {
                    layout.zone = Some(zone.trim().into());
                }
                (None, MatrixStyle::Plain(MatrixFormat::Csv)) if detail == "names" => layout.names = true,
                _ => {
                    let known = match style {
                        MatrixStyle::EnergyPlus => "zone=NAME",
                        MatrixStyle::Plain(MatrixFormat::Csv) => "by=patch, by=surface or names",
                        _ => "by=patch or by=surface",
                    };
                    return Err(format!("\"{detail}\" says nothing about {name}: write {name}:{known}"));
                }
            }
        }
        Ok(layout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_named_with_their_details() {
        let of = |t: &str| t.parse::<MatrixLayout>();
        assert_eq!(of("view3d").unwrap().level(), Level::Surface);
        assert_eq!(of("view3d:by=patch").unwrap().level(), Level::Patch);
        assert_eq!(of("energyplus:zone=Attic 2").unwrap().zone.as_deref(), Some("Attic 2"));
        assert!(of("csv:by=surface,names").unwrap().names);
        for wrong in ["vtk", "view3d:zone=a", "energyplus:by=patch", "npz:names", "energyplus:zone=", "csv:by=face"] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
        assert!(MatrixLayout::of(Path::new("f.txt"), None).is_err());
        assert!(of("view3d").unwrap().of_errors(Path::new("e.idf")).is_err());
        assert_eq!(of("view3d").unwrap().of_errors(Path::new("e.csv")).unwrap().level(), Level::Surface);
    }
}
