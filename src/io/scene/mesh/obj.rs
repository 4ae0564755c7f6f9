//! Wavefront OBJ: vertices, faces, groups and materials, with the line of every mistake.

use super::model::{At, FaceTags, Mesh, MeshFault, fault, number, one_line, shown};
use crate::math::DVec3;
use std::collections::{BTreeMap, HashMap};

/// What an OBJ file holds; its materials are still to be looked up in libraries.
#[derive(Debug, Default)]
pub(super) struct Obj {
    pub mesh: Mesh,
    /// Names used by `usemtl`, in order of appearance, each with the line that a face first has it from.
    pub materials: Vec<(String, usize)>,
    /// `mtllib` files with their lines.
    pub libraries: Vec<(String, usize)>,
}

/// All words after the keyword, as one name.
pub(super) fn name_in(statement: &str) -> String {
    statement.split_ascii_whitespace().skip(1).collect::<Vec<_>>().join(" ")
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
    pub(super) fn parse(text: &str) -> Result<Self, MeshFault> {
        let mut obj = Self::default();
        let mut numbers = HashMap::new();
        let mut ignored: BTreeMap<&str, usize> = BTreeMap::new();
        // The usemtl in force: name and line, with a number once a face has it.
        let mut material: Option<(String, usize, Option<u32>)> = None;
        let mut group = None;
        for (line, statement) in statements(text) {
            let mut words = statement.split_ascii_whitespace();
            let Some(keyword) = words.next() else { continue };
            match keyword {
                "v" => obj.mesh.vertices.push(vertex(line, words)?),
                "f" => {
                    let number = material.as_mut().map(|(name, line, number)| {
                        *number.get_or_insert_with(|| obj.material(&mut numbers, name, *line))
                    });
                    let tags = FaceTags { at: line as u32, part: None, material: number, group };
                    let vertices = obj.mesh.vertices.len();
                    obj.mesh.add_face(words.map(|w| corner(line, w, vertices)), tags)?;
                }
                "usemtl" => match name_in(&statement) {
                    name if name.is_empty() => return fault(line, "a name is missing", "write it after the keyword"),
                    name => material = Some((name, line, None)),
                },
                "o" | "g" => {
                    let name = one_line(&name_in(&statement));
                    group = (!name.is_empty()).then(|| obj.mesh.groups.number(&name));
                }
                "mtllib" => obj.libraries.push((name_in(&statement), line)),
                _ if SILENT.contains(&keyword) => {}
                _ => match IGNORED.iter().find(|k| **k == keyword) {
                    Some(known) => *ignored.entry(known).or_default() += 1,
                    None => {
                        let message = format!("unknown statement \"{}\"", shown(keyword));
                        return fault(line, message, "is this a Wavefront OBJ file?");
                    }
                },
            }
        }
        let told = ignored.iter().map(|(statement, n)| format!("{n} statements \"{statement}\" were left out"));
        obj.mesh.notices.extend(told);
        Ok(obj)
    }

    fn material(&mut self, numbers: &mut HashMap<String, u32>, name: &str, line: usize) -> u32 {
        *numbers.entry(name.to_string()).or_insert_with(|| {
            self.materials.push((name.to_string(), line));
            self.materials.len() as u32 - 1
        })
    }

    /// Where a material is first used.
    pub(super) fn used_at(&self, material: usize) -> At {
        At::Line(self.materials[material].1)
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

fn vertex<'w>(line: usize, words: impl Iterator<Item = &'w str>) -> Result<DVec3, MeshFault> {
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

/// Vertex index of `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers count back from the last vertex.
fn corner(line: usize, word: &str, vertices: usize) -> Result<u32, MeshFault> {
    let mut parts = word.split('/');
    let index = parts.next().and_then(|v| v.parse::<i64>().ok());
    let others_sound = parts.clone().count() <= 2 && parts.all(|p| p.is_empty() || p.parse::<i64>().is_ok());
    let Some(index) = index.filter(|_| others_sound) else {
        return fault(
            line,
            format!("\"{}\" is not a corner of a face", shown(word)),
            "write v, v/vt, v//vn or v/vt/vn",
        );
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
        assert_eq!(obj.mesh.vertices.len(), 3);
        assert_eq!(obj.materials, [("a b".to_string(), 8)]);
        let lines: Vec<usize> = obj.mesh.faces.iter().map(|f| f.tags.at as usize).collect();
        assert_eq!(lines, [9, 10, 12]);
        for face in &obj.mesh.faces {
            assert_eq!(obj.mesh.corners(face), obj.mesh.vertices);
            assert_eq!((face.tags.material, face.tags.group), (Some(0), Some(0)));
        }
    }

    #[test]
    fn mistakes_name_their_line() {
        let line = |text: &str| Obj::parse(text).unwrap_err().at;
        assert_eq!(line("v 0 0 0\nf 1 2 3\n"), At::Line(2));
        assert_eq!(line("v 0 0 0\n\nv 0 zero 0\n"), At::Line(3));
        assert_eq!(line("v 0 0\n"), At::Line(1));
        assert_eq!(line("v 0 0 inf\n"), At::Line(1));
        assert_eq!(line("v 0 0 0\nf 0 1 1\n"), At::Line(2));
        assert_eq!(line("v 0 0 0\nf 1/x 1 1\n"), At::Line(2));
        assert_eq!(line("solid cube\n"), At::Line(1));
        assert_eq!(line("v 0 0 0\nf\n"), At::Line(2));
    }
}
