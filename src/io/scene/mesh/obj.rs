//! Wavefront OBJ: vertices, faces, groups and materials, with the line of every mistake.

use super::keep::Keep;
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
const COLOUR_MEND: &str = "write v x y z r g b for every vertex, or give the values in a table (--values FILE)";
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
    pub(super) fn parse(text: &str, keep: Keep) -> Result<Self, MeshFault> {
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
                "v" => obj.vertex(line, words, keep)?,
                "vt" if keep == Keep::Textures => obj.mesh.carried.uvs.push(texture_point(line, words)?),
                "f" => {
                    let number = material.as_mut().map(|(name, line, number)| {
                        *number.get_or_insert_with(|| obj.material(&mut numbers, name, *line))
                    });
                    let tags = FaceTags { at: line as u32, part: None, material: number, group };
                    let vertices = obj.mesh.vertices.len();
                    let textures = (keep == Keep::Textures).then_some(obj.mesh.carried.uvs.len());
                    let both = |w| Ok((corner(line, w, vertices)?, textures.map(|n| texture(line, w, n)).transpose()?));
                    obj.mesh.add_textured_face(words.map(both), tags)?;
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
        if !obj.mesh.carried.of_vertices.is_empty() {
            obj.mesh.carried.bands = ["r", "g", "b"].map(String::from).to_vec();
        }
        let told = ignored.iter().map(|(statement, n)| format!("{n} statements \"{statement}\" were left out"));
        obj.mesh.notices.extend(told);
        Ok(obj)
    }

    fn vertex<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>, keep: Keep) -> Result<(), MeshFault> {
        let (place, colour) = vertex(line, words)?;
        self.mesh.vertices.push(place);
        if let Keep::Values(_) = keep {
            let Some(colour) = colour else { return fault(line, "the vertex has no colour", COLOUR_MEND) };
            self.mesh.carried.of_vertices.extend(colour);
        }
        Ok(())
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

/// The place of a vertex, and its colour where it has one.
fn vertex<'w>(line: usize, words: impl Iterator<Item = &'w str>) -> Result<(DVec3, Option<[f64; 3]>), MeshFault> {
    let mut all = [0.0; 7];
    let mut count = 0;
    for word in words {
        let value = number(line, word)?;
        if let Some(place) = all.get_mut(count) {
            *place = value;
        }
        count += 1;
    }
    let place = DVec3::new(all[0], all[1], all[2]);
    // Weights and colours may follow.
    match count {
        3 | 4 => Ok((place, None)),
        6 | 7 => Ok((place, Some([all[count - 3], all[count - 2], all[count - 1]]))),
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

/// Texture coordinates: u and v, perhaps a third number of no meaning for pictures.
fn texture_point<'w>(line: usize, words: impl Iterator<Item = &'w str>) -> Result<[f64; 2], MeshFault> {
    let numbers = words.map(|w| number(line, w)).collect::<Result<Vec<_>, _>>()?;
    match numbers[..] {
        [u, v] | [u, v, _] => Ok([u, v]),
        _ => fault(line, format!("the texture point has {} numbers", numbers.len()), "give two: vt u v"),
    }
}

/// The number of the texture coordinates of a corner written v/vt or v/vt/vn.
fn texture(line: usize, word: &str, count: usize) -> Result<u32, MeshFault> {
    let Some(index) = word.split('/').nth(1).and_then(|t| t.parse::<i64>().ok()) else {
        let message = format!("the corner \"{}\" has no texture coordinates", shown(word));
        return fault(line, message, "write v/vt: a lightmap needs them at every corner");
    };
    let place = if index > 0 { index - 1 } else { count as i64 + index };
    if index == 0 || place < 0 || place >= count as i64 {
        let message = format!("the face names texture point {index}, but {count} are defined above it");
        return fault(line, message, "texture points count from 1, or back from -1");
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
        let obj = Obj::parse(text, Keep::Shape).unwrap();
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
        let line = |text: &str| Obj::parse(text, Keep::Shape).unwrap_err().at;
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
