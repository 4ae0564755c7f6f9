//! A series of snapshots: a folder with `index.csv` (`file,seconds,shots,rays,edit`) and a solution file for each line.

use super::solution::csv_error;
use super::{BandNames, FileError, SolutionFormat, atomic, read_solution, write_solution};
use crate::scene::Stage;
use crate::solution::{Series, Snapshot};
use std::path::{Component, Path, PathBuf};

/// The list of snapshots in a series' folder.
pub const INDEX: &str = "index.csv";
/// Columns of the index as they are written; read in any order.
const COLUMNS: [&str; 5] = ["file", "seconds", "shots", "rays", "edit"];
/// Snapshot files are called so, then their number.
const STEM: &str = "snapshot-";

/// A line of the index.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    file: String,
    seconds: f64,
    shots: u64,
    rays: u64,
    edit: usize,
    /// Where it stands, for messages.
    at: u64,
}

/// Reads a series of a scene whose states are `stages`, in order.
///
/// # Errors
/// Names file, line and mend: an index that is missing or empty, a column that is missing or unknown, what is not a
/// number or falls, a file that is missing or outside of the folder, a state that the scene has not, radiosities
/// that do not fit it.
pub fn read_series(folder: &Path, name: &str, stages: &[Stage]) -> Result<Series, FileError> {
    let index = folder.join(INDEX);
    let lines = read_index(&index)?;
    let snapshots = lines.iter().map(|line| snapshot(folder, &index, line, stages)).collect::<Result<_, _>>()?;
    Ok(Series { name: name.into(), snapshots })
}

fn snapshot(folder: &Path, index: &Path, line: &Line, stages: &[Stage]) -> Result<Snapshot, FileError> {
    let wrong = |problem: String| FileError::new(index, problem).at(format!("line {}", line.at));
    let Some(stage) = stages.get(line.edit) else {
        let (last, scene) = (stages.len().saturating_sub(1), stages.first().map_or("", |s| s.name.as_str()));
        return Err(wrong(format!("edit {} is beyond the {last} edits of {scene}", line.edit))
            .mend("edit is the number of edits applied: 0 before the first"));
    };
    if Path::new(&line.file).components().any(|c| !matches!(c, Component::Normal(_))) {
        return Err(wrong(format!("file \"{}\" leaves the folder", line.file)).mend("name a file beside the index"));
    }
    let path = folder.join(&line.file);
    if !path.is_file() {
        return Err(wrong(format!("there is no file \"{}\" beside the index", line.file))
            .mend("copy it there, or take the line out"));
    }
    let present: Vec<bool> = stage.patches.iter().map(|p| p.is_present()).collect();
    let solution = read_solution(&path)?;
    let radiosity = solution.fit(&stage.photometry.bands, &present).map_err(|mut e| {
        e.problem += &format!(" ({INDEX}, line {}, edit {})", line.at, line.edit);
        e
    })?;
    let Line { edit, shots, rays, seconds, .. } = *line;
    Ok(Snapshot { edit, shots, rays, seconds, radiosity })
}

fn read_index(path: &Path) -> Result<Vec<Line>, FileError> {
    let bytes = std::fs::read(path).map_err(|e| {
        FileError::system(path, "read", &e).mend(format!("a series is a folder with {INDEX}: {}", COLUMNS.join(",")))
    })?;
    let mut csv = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes.as_slice());
    let header = csv.headers().map_err(|e| csv_error(path, &e))?.clone();
    let columns = columns(path, &header)?;
    let mut lines: Vec<Line> = Vec::new();
    for record in csv.records() {
        let record = record.map_err(|e| csv_error(path, &e))?;
        let at = record.position().map_or(0, csv::Position::line);
        let wrong = |problem: String| FileError::new(path, problem).at(format!("line {at}"));
        if record.len() != header.len() {
            return Err(wrong(format!("has {} fields, the header {}", record.len(), header.len()))
                .mend("give every column a value"));
        }
        let line = parse(columns.map(|c| &record[c]), at).map_err(|(problem, mend)| wrong(problem).mend(mend))?;
        if let Some(before) = lines.last()
            && let Some(what) = falls(before, &line)
        {
            return Err(wrong(format!("{what} fall from the line before"))
                .mend("seconds, shots, rays and edit count from the beginning of the series: they never fall"));
        }
        lines.push(line);
    }
    match lines.is_empty() {
        true => Err(FileError::new(path, "lists no snapshot").mend("a series has at least one")),
        false => Ok(lines),
    }
}

/// Where each of [`COLUMNS`] stands.
fn columns(path: &Path, header: &csv::StringRecord) -> Result<[usize; 5], FileError> {
    let wrong = |problem: String| {
        FileError::new(path, problem).at("line 1").mend(format!("the first line is {}", COLUMNS.join(",")))
    };
    if let Some(odd) = header.iter().find(|h| !COLUMNS.contains(h)) {
        return Err(wrong(format!("has a column \"{odd}\" that is unknown")));
    }
    let mut out = [0; 5];
    for (place, name) in out.iter_mut().zip(COLUMNS) {
        let mut all = header.iter().enumerate().filter(|(_, h)| *h == name).map(|(k, _)| k);
        *place = all.next().ok_or_else(|| wrong(format!("has no column \"{name}\"")))?;
        if all.next().is_some() {
            return Err(wrong(format!("names the column \"{name}\" twice")));
        }
    }
    Ok(out)
}

fn parse([file, seconds, shots, rays, edit]: [&str; 5], at: u64) -> Result<Line, (String, &'static str)> {
    fn whole<T: std::str::FromStr>(name: &str, text: &str) -> Result<T, (String, &'static str)> {
        text.parse().map_err(|_| (format!("{name} \"{text}\" is not a whole number >= 0"), "write 0, 1, 2, ..."))
    }
    let number: Option<f64> = seconds.parse().ok().filter(|s: &f64| s.is_finite() && *s >= 0.0);
    let seconds =
        number.ok_or_else(|| (format!("seconds \"{seconds}\" is not a number >= 0"), "write seconds, as 1.25"))?;
    if file.is_empty() {
        return Err(("names no file".into(), "name the solution file beside the index"));
    }
    let (shots, rays, edit) = (whole("shots", shots)?, whole("rays", rays)?, whole("edit", edit)?);
    Ok(Line { file: file.into(), seconds, shots, rays, edit, at })
}

/// What is lower than before.
fn falls(before: &Line, line: &Line) -> Option<&'static str> {
    let falling = [
        ("seconds", line.seconds < before.seconds),
        ("shots", line.shots < before.shots),
        ("rays", line.rays < before.rays),
        ("edits", line.edit < before.edit),
    ];
    falling.into_iter().find(|(_, falls)| *falls).map(|(what, _)| what)
}

/// Writes a series one snapshot at a time: after each, the folder is whole.
#[derive(Debug)]
pub struct SeriesWriter {
    folder: PathBuf,
    ending: &'static str,
    format: SolutionFormat,
    lines: Vec<Line>,
}

impl SeriesWriter {
    /// A series in a folder, which is made where it is missing. A series that stands there gives way; snapshot files
    /// are `.csv` or `.npy`, as `format` says.
    ///
    /// # Errors
    /// If the folder holds something else, cannot be written, or the format is another.
    pub fn create(folder: &Path, format: SolutionFormat) -> Result<Self, FileError> {
        let ending = match format {
            SolutionFormat::Csv => "csv",
            SolutionFormat::Npy => "npy",
            _ => return Err(FileError::new(folder, "snapshots are written as .csv or .npy")),
        };
        atomic::create_folder(folder).map_err(|e| FileError::new(folder, e.to_string()))?;
        let entries = std::fs::read_dir(folder).map_err(|e| FileError::system(folder, "read", &e))?;
        let names: Vec<String> = entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        let is_ours = |n: &String| n == INDEX || is_snapshot(n);
        if let Some(other) = names.iter().find(|n| !is_ours(n)) {
            return Err(FileError::new(folder, format!("holds something else ({other})"))
                .mend("name an empty folder, or one that holds a series"));
        }
        // The index first: what it names has to be there.
        for name in names.iter().filter(|n| *n == INDEX).chain(names.iter().filter(|n| *n != INDEX)) {
            let path = folder.join(name);
            std::fs::remove_file(&path).map_err(|e| FileError::system(&path, "removed", &e))?;
        }
        Ok(Self { folder: folder.into(), ending, format, lines: Vec::new() })
    }

    /// Adds a snapshot.
    ///
    /// # Errors
    /// If it cannot be written, or counts less than the one before it. The folder is as it was.
    pub fn add(&mut self, snapshot: &Snapshot, names: BandNames) -> Result<(), FileError> {
        let file = format!("{STEM}{:04}.{}", self.lines.len(), self.ending);
        let Snapshot { edit, shots, rays, seconds, .. } = *snapshot;
        let line = Line { file, seconds, shots, rays, edit, at: 0 };
        if let Some(what) = self.lines.last().and_then(|before| falls(before, &line)) {
            return Err(FileError::new(&self.folder, format!("snapshot {}: {what} fall", self.lines.len())));
        }
        let write = |name: &str, bytes: &[u8]| {
            let path = self.folder.join(name);
            atomic::write(&path, bytes).map_err(|e| FileError::new(&path, e.to_string()))
        };
        write(&line.file, &write_solution(&snapshot.radiosity, names, self.format))?;
        self.lines.push(line);
        let written = write(INDEX, self.index().as_bytes());
        if written.is_err() {
            self.lines.pop();
        }
        written
    }

    fn index(&self) -> String {
        let mut out = COLUMNS.join(",") + "\n";
        for l in &self.lines {
            // The shortest digits that read back to the same number.
            out += &format!("{},{:?},{},{},{}\n", l.file, l.seconds, l.shots, l.rays, l.edit);
        }
        out
    }
}

/// snapshot-0000.csv and the like.
fn is_snapshot(name: &str) -> bool {
    let number = name.strip_prefix(STEM).and_then(|n| n.strip_suffix(".csv").or_else(|| n.strip_suffix(".npy")));
    number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests;
