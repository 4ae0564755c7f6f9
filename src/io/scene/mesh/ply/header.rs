//! The header of a PLY file: which elements follow, with which properties.

use super::Wanted;
use crate::io::scene::error::Refusal;
use crate::io::scene::mesh::model::{At, MeshFault, fault, shown};

/// How the body is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Types of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn named(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// What stands for 1 in colours; `None` for numbers that mean themselves.
    pub(super) fn full(self) -> Option<f64> {
        match self {
            Self::U8 => Some(255.0),
            Self::U16 => Some(65535.0),
            _ => None,
        }
    }

    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// One property: a number, or a list with the type of its count.
#[derive(Debug)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
    pub count: Option<Kind>,
}

/// One kind of element.
#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
    /// Line of the header.
    pub line: usize,
}

impl Element {
    /// Fewest bytes of one element in a binary file.
    pub(super) fn least_bytes(&self) -> u64 {
        self.properties.iter().map(|p| p.count.unwrap_or(p.kind).size() as u64).sum()
    }

    pub(super) fn has_colours(&self) -> bool {
        self.properties.iter().any(|p| matches!(p.name.as_str(), "red" | "r" | "diffuse_red"))
    }

    pub(super) fn scalar(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name && p.count.is_none())
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Where the body starts, and the number of its first line.
    pub body: usize,
    pub first_line: usize,
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, MeshFault> {
        let mut lines = Lines { bytes, at: 0, line: 0 };
        if lines.next().as_deref() != Some("ply") {
            return fault(1, "the file does not begin with \"ply\"", "is this a PLY file?");
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        while let Some(text) = lines.next() {
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let line = lines.line;
            match words.as_slice() {
                [] | ["comment" | "obj_info", ..] => {}
                ["format", rest @ ..] => encoding = Some(format(line, rest)?),
                ["element", name, count] => elements.push(element(line, name, count, &elements)?),
                ["property", rest @ ..] => match elements.last_mut() {
                    Some(element) => element.properties.push(property(line, rest)?),
                    None => return fault(line, "a property before the first element", "put it below its element"),
                },
                ["end_header"] => {
                    let Some(encoding) = encoding else {
                        return fault(line, "the header has no format line", "write format ascii 1.0");
                    };
                    return Ok(Self { encoding, elements, body: lines.at, first_line: line + 1 });
                }
                [word, ..] => {
                    return fault(line, format!("unknown header line \"{}\"", shown(word)), "is this a PLY file?");
                }
            }
        }
        fault(lines.line.max(1), "the header does not end", "write end_header after the last property")
    }

    /// Which properties are vertices and faces.
    pub(super) fn wanted(&self) -> Result<Vec<Wanted>, MeshFault> {
        for needed in ["vertex", "face"] {
            if !self.elements.iter().any(|e| e.name == needed) {
                let message = format!("the file has no element \"{needed}\"");
                let mend = match needed {
                    "vertex" => "write element vertex with the properties x, y and z",
                    _ if self.elements.iter().any(|e| e.name == "tristrips") => "write faces instead of tristrips",
                    _ => "a cloud of points cannot radiate: write element face with the list vertex_indices",
                };
                return MeshFault::new(At::File, message).of(Refusal::Empty).mend(mend);
            }
        }
        self.elements.iter().map(wanted).collect()
    }
}

fn wanted(element: &Element) -> Result<Wanted, MeshFault> {
    let line = element.line;
    if element.properties.is_empty() && element.count > 0 {
        let message = format!("the element \"{}\" has no properties", shown(&element.name));
        return fault(line, message, "list them below the element");
    }
    match element.name.as_str() {
        "vertex" => match ["x", "y", "z"].map(|name| element.scalar(name)) {
            [Some(x), Some(y), Some(z)] => Ok(Wanted::Vertex([x, y, z])),
            _ => fault(line, "the vertices lack x, y or z", "write property float x, y and z"),
        },
        "face" => {
            let name = |p: &Property| matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
            let Some(list) = element.properties.iter().position(|p| name(p) && p.count.is_some()) else {
                return fault(
                    line,
                    "the faces have no list vertex_indices",
                    "write property list uchar int vertex_indices",
                );
            };
            match element.properties[list].kind.is_whole() {
                true => Ok(Wanted::Face(list)),
                false => {
                    fault(line, "vertex_indices is a list of fractions", "write property list uchar int vertex_indices")
                }
            }
        }
        _ => Ok(Wanted::Nothing),
    }
}

fn format(line: usize, words: &[&str]) -> Result<Encoding, MeshFault> {
    let encoding = match words {
        ["ascii", ..] => Encoding::Ascii,
        ["binary_little_endian", ..] => Encoding::LittleEndian,
        ["binary_big_endian", ..] => Encoding::BigEndian,
        _ => {
            let message = format!("unknown format \"{}\"", shown(&words.join(" ")));
            return fault(line, message, "use ascii, binary_little_endian or binary_big_endian");
        }
    };
    match words {
        [_, "1.0"] => Ok(encoding),
        _ => fault(line, "the format version is not 1.0", "write format ascii 1.0, or the binary one"),
    }
}

fn element(line: usize, name: &str, count: &str, before: &[Element]) -> Result<Element, MeshFault> {
    if before.iter().any(|e| e.name == name) {
        return fault(line, format!("a second element \"{}\"", shown(name)), "write each element once");
    }
    match count.parse() {
        Ok(count) => Ok(Element { name: name.into(), count, properties: Vec::new(), line }),
        Err(_) => fault(line, format!("\"{}\" is not a count", shown(count)), "give a whole number"),
    }
}

fn property(line: usize, words: &[&str]) -> Result<Property, MeshFault> {
    let kind = |word: &str| match Kind::named(word) {
        Some(kind) => Ok(kind),
        None => fault(line, format!("unknown type \"{}\"", shown(word)), "use char to double, or int8 to float64"),
    };
    match words {
        ["list", count, of, name] => {
            let (count, of) = (kind(count)?, kind(of)?);
            match count.is_whole() {
                true => Ok(Property { name: (*name).into(), kind: of, count: Some(count) }),
                false => fault(line, "the count of a list is a fraction", "use uchar"),
            }
        }
        [of, name] if *of != "list" => Ok(Property { name: (*name).into(), kind: kind(of)?, count: None }),
        _ => fault(
            line,
            "a property of this shape does not exist",
            "write property TYPE NAME or property list TYPE TYPE NAME",
        ),
    }
}

/// Lines of the header, which may end in CR, LF or both.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Number of the line given last, counted from 1.
    line: usize,
}

impl Lines<'_> {
    fn next(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..).filter(|r| !r.is_empty())?;
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        let crlf = rest.get(end..end + 2) == Some(b"\r\n");
        self.at += (end + 1 + usize::from(crlf)).min(rest.len());
        self.line += 1;
        Some(String::from_utf8_lossy(&rest[..end]).into_owned())
    }
}
