//! Wavefront OBJ: vertices, faces, groups and materials, with the line of every mistake.

use super::check::LARGEST;
use super::polygon::MAX_CORNERS;
use crate::math::DVec3;
use std::collections::{BTreeMap, HashMap};

/// A mesh as the file has it, in file units.
#[derive(Debug, Default)]
pub(super) struct Obj {
    pub vertices: Vec<DVec3>,
    pub faces: Vec<ObjFace>,
    /// Names used by `usemtl`.
    pub materials: Names,
    /// Names of `o` and `g`.
    pub groups: Names,
    /// `mtllib` files with their lines.
    pub libraries: Vec<(String, usize)>,
    /// Statements left out, with how often.
    pub ignored: BTreeMap<String, usize>,
    /// All corners, face by face.
    corners: Vec<u32>,
}

/// Names in order of appearance.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub list: Vec<String>,
    numbers: HashMap<String, u32>,
}

impl Names {
    /// The number of the name that follows a keyword, added if new.
    fn number(&mut self, statement: &str, line: usize) -> Result<u32, LineError> {
        let name = name_in(statement);
        if name.is_empty() {
            return fault(line, "a name is missing", "write it after the keyword");
        }
        Ok(*self.numbers.entry(name).or_insert_with_key(|name| {
            self.list.push(name.clone());
            self.list.len() as u32 - 1
        }))
    }
}

/// All words after the keyword, as one name.
pub(super) fn name_in(statement: &str) -> String {
    statement.split_ascii_whitespace().skip(1).collect::<Vec<_>>().join(" ")
}

/// One face of an OBJ file.
#[derive(Debug, Clone, Copy)]
pub(super) struct ObjFace {
    start: u32,
    count: u32,
    /// Line, counted from 1.
    pub line: usize,
    /// Index into [`Obj::materials`], and the line of its `usemtl`.
    pub material: Option<(u32, usize)>,
    /// Index into [`Obj::groups`].
    pub group: Option<u32>,
}

/// What is wrong in which line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub(super) struct LineError {
    pub line: usize,
    pub message: String,
    pub mend: String,
}

pub(super) fn fault<T>(line: usize, message: impl Into<String>, mend: impl Into<String>) -> Result<T, LineError> {
    Err(LineError { line, message: message.into(), mend: mend.into() })
}

/// Statements without meaning for radiosity, left out with a notice (except those nobody misses).
const SILENT: [&str; 4] = ["vt", "vn", "s", "vp"];
const IGNORED: [&str; 24] = [
    "l",
    "p",
    "curv",
    "curv2",
    "surf",
    "cstype",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "mg",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "maplib",
    "usemap",
    "shadow_obj",
];

impl Obj {
    /// Parses a file.
    pub(super) fn parse(text: &str) -> Result<Self, LineError> {
        let mut obj = Self::default();
        let (mut material, mut group) = (None, None);
        for (line, statement) in statements(text) {
            let mut words = statement.split_ascii_whitespace();
            let Some(keyword) = words.next() else { continue };
            match keyword {
                "v" => obj.vertices.push(vertex(line, words)?),
                "f" => obj.face(line, words, material, group)?,
                "usemtl" => material = Some((obj.materials.number(&statement, line)?, line)),
                "o" | "g" => group = obj.groups.number(&statement, line).ok(),
                "mtllib" => obj.libraries.push((name_in(&statement), line)),
                _ if SILENT.contains(&keyword) => {}
                _ if IGNORED.contains(&keyword) => *obj.ignored.entry(keyword.into()).or_default() += 1,
                _ => {
                    let shown: String = keyword.chars().take(40).collect();
                    return fault(
                        line,
                        format!("unknown statement \"{}\"", shown.escape_debug()),
                        "is this a Wavefront OBJ file?",
                    );
                }
            }
        }
        Ok(obj)
    }

    /// Corners of a face.
    pub(super) fn corners(&self, face: &ObjFace) -> Vec<DVec3> {
        let corners = &self.corners[face.start as usize..][..face.count as usize];
        corners.iter().map(|i| self.vertices[*i as usize]).collect()
    }

    fn face<'w>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'w str>,
        material: Option<(u32, usize)>,
        group: Option<u32>,
    ) -> Result<(), LineError> {
        let start = self.corners.len() as u32;
        for word in words {
            let index = corner(line, word, self.vertices.len())?;
            // A corner written twice in a row is the same corner.
            if self.corners.len() as u32 == start || self.corners.last() != Some(&index) {
                self.corners.push(index);
            }
        }
        let first = self.corners.get(start as usize).copied();
        if self.corners.len() as u32 > start + 1 && self.corners.last().copied() == first {
            self.corners.pop();
        }
        let count = self.corners.len() as u32 - start;
        if count == 0 {
            return fault(line, "the face has no corners", "give three or more vertex numbers");
        }
        if count as usize > MAX_CORNERS {
            return fault(line, format!("the face has {count} corners"), "split it into smaller ones");
        }
        self.faces.push(ObjFace { start, count, line, material, group });
        Ok(())
    }
}

/// Lines with their numbers, comments taken off, lines ending in a backslash joined to the next.
fn statements(text: &str) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let mut whole = std::borrow::Cow::Borrowed(line.split('#').next().unwrap_or_default());
        while whole.trim_end().ends_with('\\') {
            let head = whole.trim_end().trim_end_matches('\\').to_string();
            let next = lines.next().map_or("", |(_, l)| l.split('#').next().unwrap_or_default());
            whole = std::borrow::Cow::Owned(head + " " + next);
        }
        Some((number + 1, whole))
    })
}

fn vertex<'w>(line: usize, words: impl Iterator<Item = &'w str>) -> Result<DVec3, LineError> {
    let mut p = [0.0; 3];
    let mut count = 0;
    for word in words {
        let value = number(line, word)?;
        if count < 3 {
            p[count] = value;
        }
        count += 1;
    }
    // Weights and colours may follow.
    match count {
        3 | 4 | 6 | 7 => Ok(DVec3::from(p)),
        _ => fault(line, format!("the vertex has {count} numbers"), "give three: v x y z"),
    }
}

/// A finite number within reach.
pub(super) fn number(line: usize, word: &str) -> Result<f64, LineError> {
    match word.parse::<f64>() {
        Ok(v) if v.is_finite() && v.abs() <= LARGEST => Ok(v),
        Ok(v) => fault(line, format!("the number {v} is not finite or beyond {LARGEST:e}"), "give a finite number"),
        Err(_) => {
            let shown: String = word.chars().take(40).collect();
            fault(line, format!("\"{}\" is not a number", shown.escape_debug()), "give a decimal number")
        }
    }
}

/// Vertex index of `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers count back from the last vertex.
fn corner(line: usize, word: &str, vertices: usize) -> Result<u32, LineError> {
    let shown = || word.chars().take(40).collect::<String>().escape_debug().to_string();
    let mut parts = word.split('/');
    let index = parts.next().and_then(|v| v.parse::<i64>().ok());
    let others_sound = parts.clone().count() <= 2 && parts.all(|p| p.is_empty() || p.parse::<i64>().is_ok());
    let Some(index) = index.filter(|_| others_sound) else {
        return fault(line, format!("\"{}\" is not a corner of a face", shown()), "write v, v/vt, v//vn or v/vt/vn");
    };
    let place = if index > 0 { index - 1 } else { vertices as i64 + index };
    if index == 0 || place < 0 || place >= vertices as i64 {
        return fault(
            line,
            format!("the face names vertex {index}, but {vertices} vertices are defined above it"),
            "vertices count from 1, or back from -1",
        );
    }
    Ok(place as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_forms_of_corners_are_read() {
        let text = "# a\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .5 .5 .5\nvt 0 0\nvn 0 0 1\no thing\nusemtl a b\n\
                    f 1/1 2/1 3/1\nf -3//1 \\\n -2//1 -1//1 # end\nf 1/1/1 2/1/1 2/1/1 3/1/1 1/1/1\n";
        let obj = Obj::parse(text).unwrap();
        assert_eq!(obj.vertices.len(), 3);
        assert_eq!(obj.materials.list, ["a b"]);
        let lines: Vec<usize> = obj.faces.iter().map(|f| f.line).collect();
        assert_eq!(lines, [9, 10, 12]);
        for face in &obj.faces {
            assert_eq!(obj.corners(face), obj.vertices);
            assert_eq!(face.material, Some((0, 8)));
        }
    }

    #[test]
    fn mistakes_name_their_line() {
        let line = |text: &str| Obj::parse(text).unwrap_err().line;
        assert_eq!(line("v 0 0 0\nf 1 2 3\n"), 2);
        assert_eq!(line("v 0 0 0\n\nv 0 zero 0\n"), 3);
        assert_eq!(line("v 0 0\n"), 1);
        assert_eq!(line("v 0 0 inf\n"), 1);
        assert_eq!(line("v 0 0 0\nf 0 1 1\n"), 2);
        assert_eq!(line("v 0 0 0\nf 1/x 1 1\n"), 2);
        assert_eq!(line("solid cube\n"), 1);
        assert_eq!(line("v 0 0 0\nf\n"), 2);
    }
}
