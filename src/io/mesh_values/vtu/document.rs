//! The XML of a grid: where its arrays stand and how they are written.

use super::{blocks, numbers};
use crate::io::FileError;
use crate::io::mesh_values::shown;
use numbers::Kind;
use roxmltree::{Node, ParsingOptions};
use std::borrow::Cow;
use std::path::Path;

/// A file as text without its appended data, and these.
pub(super) struct Split<'a> {
    pub xml: Cow<'a, str>,
    pub appended: Option<Appended<'a>>,
}

/// Data behind the XML, after the underscore.
#[derive(Clone, Copy)]
pub(super) enum Appended<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

const OPEN: &[u8] = b"<AppendedData";
const CLOSE: &[u8] = b"</AppendedData";

/// Takes the appended data off: raw bytes are no XML.
pub(super) fn split<'a>(path: &Path, bytes: &'a [u8]) -> Result<Split<'a>, FileError> {
    let find = |what: &[u8], from: usize| bytes[from..].windows(what.len()).position(|w| w == what).map(|i| from + i);
    let Some(open) = find(OPEN, 0) else {
        return Ok(Split { xml: String::from_utf8_lossy(bytes), appended: None });
    };
    let at = |problem: &str| {
        Err(FileError::new(path, problem)
            .at("<AppendedData>")
            .mend("is the file cut short? Save it again, or as ascii"))
    };
    let Some(tag_end) = find(b">", open) else { return at("the tag does not end") };
    let tag = String::from_utf8_lossy(&bytes[open..tag_end]).replace('\'', "\"");
    let body = &bytes[tag_end + 1..];
    let Some(start) = body.iter().position(|b| !b.is_ascii_whitespace()).filter(|i| body[*i] == b'_') else {
        return at("the data do not begin with an underscore");
    };
    let data = &body[start + 1..];
    let appended = match tag.split("encoding=\"").nth(1).and_then(|r| r.split('"').next()) {
        Some("raw") => Appended::Raw(data),
        Some("base64") => {
            let end = data.windows(CLOSE.len()).position(|w| w == CLOSE).unwrap_or(data.len());
            Appended::Base64(data[..end].trim_ascii_end())
        }
        _ => return at("the encoding is neither raw nor base64"),
    };
    let xml = Cow::Owned(String::from_utf8_lossy(&bytes[..open]).into_owned() + "</VTKFile>");
    Ok(Split { xml, appended: Some(appended) })
}

/// Parses the XML.
pub(super) fn parse<'t>(path: &Path, text: &'t str) -> Result<roxmltree::Document<'t>, FileError> {
    let options = ParsingOptions { nodes_limit: 1 << 20, ..ParsingOptions::default() };
    roxmltree::Document::parse_with_options(text, options).map_err(|e| {
        let said = e.to_string();
        let said = said.split(" at ").next().unwrap_or_default();
        FileError::new(path, format!("is no sound XML: {said}"))
            .at(format!("line {}", e.pos().row))
            .mend("is this a .vtu file, and whole? Save it again")
    })
}

/// Parts of a piece that hold arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    Points,
    Cells,
    PointData,
    CellData,
}

impl Section {
    pub(super) fn tag(self) -> &'static str {
        match self {
            Self::Points => "Points",
            Self::Cells => "Cells",
            Self::PointData => "PointData",
            Self::CellData => "CellData",
        }
    }
}

/// An array, not yet read.
#[derive(Clone)]
pub(super) struct Array<'a> {
    pub node: Node<'a, 'a>,
    pub name: String,
    pub components: usize,
    pub kind: Kind,
}

/// A grid with what is needed to read its arrays.
pub(super) struct Document<'a> {
    pub path: &'a Path,
    root: Node<'a, 'a>,
    coding: blocks::Coding,
    appended: Option<Appended<'a>>,
    /// Offsets of all arrays in the appended data, ascending.
    offsets: Vec<usize>,
}

impl<'a> Document<'a> {
    pub(super) fn new(
        path: &'a Path,
        xml: &'a roxmltree::Document<'a>,
        appended: Option<Appended<'a>>,
    ) -> Result<Self, FileError> {
        let root = xml.root_element();
        let coding = blocks::Coding { little: true, wide: false, zlib: false };
        let mut document = Self { path, root, coding, appended, offsets: Vec::new() };
        let kind = root.attribute("type").unwrap_or("nothing");
        if !root.has_tag_name("VTKFile") || kind != "UnstructuredGrid" {
            let what = if root.has_tag_name("VTKFile") { kind } else { root.tag_name().name() };
            let problem = format!("holds {}, no UnstructuredGrid", shown(what));
            return document.refuse(root, &problem, "save it as an unstructured grid (.vtu)");
        }
        document.coding = document.coding_of(root)?;
        let offsets = xml.descendants().filter(|n| n.has_tag_name("DataArray"));
        document.offsets = offsets.filter_map(|n| n.attribute("offset")?.parse().ok()).collect();
        document.offsets.sort_unstable();
        Ok(document)
    }

    fn coding_of(&self, root: Node) -> Result<blocks::Coding, FileError> {
        let little = match root.attribute("byte_order").unwrap_or("LittleEndian") {
            "LittleEndian" => true,
            "BigEndian" => false,
            other => {
                let problem = format!("the byte order \"{}\" does not exist", shown(other));
                return self.refuse(root, &problem, "write LittleEndian or BigEndian");
            }
        };
        let wide = match root.attribute("header_type").unwrap_or("UInt32") {
            "UInt32" => false,
            "UInt64" => true,
            other => {
                let problem = format!("the header type \"{}\" is not known", shown(other));
                return self.refuse(root, &problem, "write UInt32 or UInt64");
            }
        };
        let zlib = match root.attribute("compressor") {
            None => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let problem = format!("the compressor \"{}\" is not read", shown(other));
                return self.refuse(root, &problem, "save it with zlib, or without compression");
            }
        };
        Ok(blocks::Coding { little, wide, zlib })
    }

    /// A refusal at a node.
    pub(super) fn refuse<T>(&self, node: Node, problem: &str, mend: &str) -> Result<T, FileError> {
        let line = node.document().text_pos_at(node.range().start).row;
        let name = node.attribute("Name").map(|n| format!(", array \"{}\"", shown(n))).unwrap_or_default();
        Err(FileError::new(self.path, problem).at(format!("line {line}{name}")).mend(mend))
    }

    /// The pieces of the grid.
    pub(super) fn pieces(&self) -> Result<Vec<Node<'a, 'a>>, FileError> {
        let grid = self.root.children().find(|n| n.has_tag_name("UnstructuredGrid"));
        match grid {
            Some(grid) => Ok(grid.children().filter(|n| n.has_tag_name("Piece")).collect()),
            None => self.refuse(self.root, "there is no <UnstructuredGrid>", "save an unstructured grid"),
        }
    }

    /// A count that a piece states.
    pub(super) fn count(&self, piece: Node, key: &str) -> Result<usize, FileError> {
        match piece.attribute(key).map(|v| v.trim().parse::<u32>()) {
            Some(Ok(count)) => Ok(count as usize),
            Some(Err(_)) => {
                let problem = format!("{key} is \"{}\"", shown(piece.attribute(key).unwrap_or_default()));
                self.refuse(piece, &problem, "give a whole number")
            }
            None => self.refuse(piece, &format!("the piece has no {key}"), "state it"),
        }
    }

    /// The arrays of a section; none if it is not there.
    pub(super) fn section(&self, piece: Node<'a, 'a>, section: Section) -> Result<Vec<Array<'a>>, FileError> {
        let Some(node) = piece.children().find(|n| n.has_tag_name(section.tag())) else { return Ok(Vec::new()) };
        node.children().filter(|n| n.has_tag_name("DataArray")).map(|n| self.array(n)).collect()
    }

    fn array(&self, node: Node<'a, 'a>) -> Result<Array<'a>, FileError> {
        let kind = node.attribute("type").unwrap_or_default();
        let Some(kind) = Kind::named(kind) else {
            let problem = format!("the type \"{}\" is not read", shown(kind));
            return self.refuse(node, &problem, "use Int8 to Int64, UInt8 to UInt64, Float32 or Float64");
        };
        let components = match node.attribute("NumberOfComponents").map(|c| c.trim().parse::<usize>()) {
            None => 1,
            Some(Ok(c @ 1..=4096)) => c,
            _ => return self.refuse(node, "NumberOfComponents is no count", "give a whole number of at least 1"),
        };
        Ok(Array { node, name: node.attribute("Name").unwrap_or_default().to_string(), components, kind })
    }

    /// The numbers of an array; `count` of them, where that is known.
    pub(super) fn numbers(&self, array: &Array, count: Option<usize>) -> Result<Vec<f64>, FileError> {
        let text = || array.node.children().filter_map(|n| n.text()).collect::<String>();
        let read = match array.node.attribute("format").unwrap_or("ascii") {
            "ascii" => numbers::ascii(&text(), array.kind),
            "binary" => {
                let decoded = blocks::base64(text().as_bytes());
                decoded.and_then(|b| self.decoded(&b, array, count))
            }
            "appended" => self.appended(array, count),
            other => Err((format!("the format \"{}\" does not exist", shown(other)), "use ascii, binary or appended")),
        };
        let numbers = match read {
            Ok(numbers) => numbers,
            Err((problem, mend)) => return self.refuse(array.node, &problem, mend),
        };
        match count.filter(|c| *c != numbers.len()) {
            None => Ok(numbers),
            Some(count) => {
                let problem = format!("the array has {} numbers, but {count} are needed", numbers.len());
                self.refuse(array.node, &problem, "is the file cut short? Or correct the counts of the piece")
            }
        }
    }

    fn appended(&self, array: &Array, count: Option<usize>) -> numbers::Read {
        let cut = "is the file cut short? Save it again";
        let Some(offset) = array.node.attribute("offset").and_then(|o| o.trim().parse::<usize>().ok()) else {
            return Err(("the array has no offset into the appended data".into(), cut));
        };
        let beyond = || format!("the offset {offset} lies beyond the appended data");
        match self.appended {
            None => Err(("there is no <AppendedData>".into(), cut)),
            Some(Appended::Raw(bytes)) => match bytes.get(offset..) {
                Some(bytes) => self.decoded(bytes, array, count),
                None => Err((beyond(), cut)),
            },
            Some(Appended::Base64(text)) => {
                let next = self.offsets.iter().copied().find(|o| *o > offset).unwrap_or(text.len());
                match text.get(offset..next.min(text.len())) {
                    Some(text) => blocks::base64(text).and_then(|b| self.decoded(&b, array, count)),
                    None => Err((beyond(), cut)),
                }
            }
        }
    }

    fn decoded(&self, bytes: &[u8], array: &Array, count: Option<usize>) -> numbers::Read {
        let needed = count.map(|c| c.saturating_mul(array.kind.size()));
        let data = blocks::data(bytes, self.coding, needed)?;
        numbers::binary(&data, array.kind, self.coding.little)
    }
}
