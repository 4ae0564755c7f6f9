//! Bytes of buffers, and numbers of accessors: every range is checked before anything is set aside.

use super::json::{Accessor, Root, View};
use crate::io::scene::error::Refusal;
use crate::io::scene::mesh::Near;
use crate::io::scene::mesh::model::{At, MeshFault, shown};
use base64::Engine;
use std::borrow::Cow;

/// The buffers that accessors have asked for so far.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    near: &'a Near<'a>,
    /// The buffer inside a GLB file.
    bin: Option<&'a [u8]>,
    loaded: Vec<Option<Cow<'a, [u8]>>>,
}

/// Types of components, by their number in the file.
#[derive(Debug, Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn numbered(n: u32) -> Option<Self> {
        Some(match n {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number at the start of `b`, and what stands for 1 where numbers are normalised.
    fn read(self, b: &[u8]) -> (f64, f64) {
        match self {
            Self::I8 => (f64::from(b[0] as i8), 127.0),
            Self::U8 => (f64::from(b[0]), 255.0),
            Self::I16 => (f64::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Self::U16 => (f64::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            Self::U32 => (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.0),
            Self::F32 => (f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.0),
        }
    }
}

/// Numbers of each item of a shape.
fn width_of(shape: &str) -> usize {
    match shape {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 1,
    }
}

/// Numbers that vertices have.
pub(super) struct Attribute {
    pub numbers: Vec<f64>,
    /// How many each vertex has.
    pub width: usize,
    /// Steps from 0 to 1, for whole numbers.
    pub steps: Option<f64>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(root: &'a Root, near: &'a Near<'a>, bin: Option<&'a [u8]>) -> Self {
        Self { root, near, bin, loaded: root.buffers.iter().map(|_| None).collect() }
    }

    /// Positions; also quantised ones (`KHR_mesh_quantization`).
    pub(super) fn positions(&mut self, index: usize) -> Result<Vec<[f64; 3]>, MeshFault> {
        let (numbers, _) = self.numbers(index, "VEC3", |_| true)?;
        Ok(numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect())
    }

    /// Indices of vertices.
    pub(super) fn indices(&mut self, index: usize) -> Result<Vec<u32>, MeshFault> {
        let whole = |c| matches!(c, Component::U8 | Component::U16 | Component::U32);
        let (numbers, normalised) = self.numbers(index, "SCALAR", whole)?;
        match normalised {
            true => at(index, "").with("indices cannot be normalised", "export the mesh again"),
            false => Ok(numbers.into_iter().map(|v| v as u32).collect()),
        }
    }

    /// Floats or normalised whole numbers of an attribute in one of these shapes.
    pub(super) fn attribute(&mut self, index: usize, shapes: &[&'static str]) -> Result<Attribute, MeshFault> {
        let accessor = self.root.accessors.get(index);
        let own = accessor.and_then(|a| shapes.iter().find(|s| **s == a.shape)).unwrap_or(&shapes[0]);
        let fits = |c| matches!(c, Component::U8 | Component::U16 | Component::F32);
        let (numbers, normalised) = self.numbers(index, own, fits)?;
        let component = accessor.and_then(|a| Component::numbered(a.component_type));
        let steps = match component {
            Some(Component::U8) => Some(255.0),
            Some(Component::U16) => Some(65535.0),
            _ => None,
        };
        if steps.is_some() && !normalised {
            return at(index, ".normalized").with("whole numbers that are not normalised", "set \"normalized\": true");
        }
        Ok(Attribute { numbers, width: width_of(own), steps })
    }

    /// All numbers of an accessor, and whether they are normalised.
    fn numbers(
        &mut self,
        index: usize,
        shape: &str,
        allowed: fn(Component) -> bool,
    ) -> Result<(Vec<f64>, bool), MeshFault> {
        let root = self.root;
        let Some(accessor) = root.accessors.get(index) else {
            let message = format!("the file has {} accessors", root.accessors.len());
            return at(index, "").with(message, "export the mesh again");
        };
        if accessor.sparse.is_some() {
            return at(index, ".sparse").with("sparse accessors are not read", "export without sparse data");
        }
        if accessor.shape != shape {
            let message = format!("the type is \"{}\", but {shape} is needed", shown(&accessor.shape));
            return at(index, ".type").with(message, "export the mesh again");
        }
        let Some(component) = Component::numbered(accessor.component_type).filter(|c| allowed(*c)) else {
            let message = format!("the component type {} cannot be used here", accessor.component_type);
            return at(index, ".componentType")
                .with(message, "positions are floats, indices unsigned whole numbers, colours either");
        };
        let width = width_of(shape);
        let (bytes, stride) = self.bytes(index, accessor, width * component.size())?;
        let scale = |(v, one): (f64, f64)| if accessor.normalized { (v / one).max(-1.0) } else { v };
        let mut numbers = Vec::with_capacity(accessor.count as usize * width);
        for k in 0..accessor.count as usize {
            let item = &bytes[k * stride..];
            numbers.extend((0..width).map(|i| scale(component.read(&item[i * component.size()..]))));
        }
        Ok((numbers, accessor.normalized))
    }

    /// The bytes that an accessor reaches, from its first item on, and the distance between items.
    fn bytes(&mut self, index: usize, accessor: &Accessor, item: usize) -> Result<(&[u8], usize), MeshFault> {
        let root = self.root;
        let Some(number) = accessor.buffer_view else {
            let mend = "export without compression: data without a buffer view are zeros or compressed";
            return at(index, ".bufferView").with("the accessor has no buffer view", mend);
        };
        let Some(view) = root.buffer_views.get(number) else {
            let message = format!("there is no buffer view {number}; the file has {}", root.buffer_views.len());
            return at(index, ".bufferView").with(message, "export the mesh again");
        };
        let stride = view.byte_stride.unwrap_or(item as u64);
        if stride < item as u64 || stride > 1 << 16 {
            let message = format!("a stride of {stride} bytes for items of {item}");
            return view_at(number, ".byteStride").with(message, "export the mesh again");
        }
        let data = self.view(number, view)?;
        let needed = accessor.count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(item as u64));
        let end = needed.and_then(|n| n.checked_add(accessor.byte_offset));
        match end.filter(|e| *e <= data.len() as u64) {
            // Also right where there are no items and the offset lies at the end.
            Some(end) => Ok((&data[accessor.byte_offset as usize..end as usize], stride as usize)),
            None => {
                let message = format!(
                    "{} items do not fit into the {} bytes of buffer view {number}",
                    accessor.count,
                    data.len()
                );
                at(index, ".count").with(message, "is the file cut short? Or correct the count")
            }
        }
    }

    fn view(&mut self, number: usize, view: &View) -> Result<&[u8], MeshFault> {
        let Some(buffer) = self.root.buffers.get(view.buffer) else {
            let message = format!("there is no buffer {}; the file has {}", view.buffer, self.root.buffers.len());
            return view_at(number, ".buffer").with(message, "export the mesh again");
        };
        let end = view.byte_offset.checked_add(view.byte_length).filter(|e| *e <= buffer.byte_length);
        let Some(end) = end else {
            let message = format!("the view ends beyond the {} bytes of buffer {}", buffer.byte_length, view.buffer);
            return view_at(number, ".byteLength").with(message, "export the mesh again");
        };
        let data = self.buffer(view.buffer)?;
        Ok(&data[view.byte_offset as usize..end as usize])
    }

    /// A buffer, read when it is first asked for; as long as the file says, or longer.
    fn buffer(&mut self, number: usize) -> Result<&[u8], MeshFault> {
        if self.loaded[number].is_none() {
            let data = self.load(number)?;
            let (have, need) = (data.len() as u64, self.root.buffers[number].byte_length);
            if have < need {
                let message = format!("the buffer has {have} bytes, but {need} are needed");
                return buffer_at(number, ".byteLength").with(message, "is its file cut short?");
            }
            self.loaded[number] = Some(data);
        }
        Ok(self.loaded[number].as_deref().unwrap_or_default())
    }

    fn load(&self, number: usize) -> Result<Cow<'a, [u8]>, MeshFault> {
        let place = buffer_at(number, ".uri");
        let Some(uri) = &self.root.buffers[number].uri else {
            return match self.bin.filter(|_| number == 0) {
                Some(bin) => Ok(Cow::Borrowed(bin)),
                None => {
                    place.with("the buffer has no uri, and there is no binary chunk for it", "export the mesh again")
                }
            };
        };
        if let Some(data) = uri.strip_prefix("data:") {
            return inline(data, place).map(Cow::Owned);
        }
        let scheme =
            uri.split_once(':').map(|(s, _)| s).filter(|s| s.len() > 1 && s.chars().all(char::is_alphanumeric));
        if let Some(scheme) = scheme {
            let message = format!("the buffer lies at a {} address", shown(scheme));
            return MeshFault { refusal: Refusal::Path, ..place.fault(message) }
                .mend("nothing is fetched: put the file beside the mesh and name it");
        }
        let Some(name) = percent_decoded(uri) else {
            return place.with(format!("\"{}\" is no sound address", shown(uri)), "write the file name");
        };
        self.near.bytes(&place.0, &name).map(Cow::Owned)
    }
}

/// The bytes of a `data:` address after its first word.
fn inline(data: &str, place: Place) -> Result<Vec<u8>, MeshFault> {
    let Some(text) = data.split_once(',').filter(|(kind, _)| kind.ends_with(";base64")).map(|(_, text)| text) else {
        return place.with("the data address is not in base64", "write data:application/octet-stream;base64,...");
    };
    let engine = base64::engine::GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        base64::engine::GeneralPurposeConfig::new()
            .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent),
    );
    engine.decode(text).or_else(|e| place.with(format!("the data are broken: {e}"), "export the mesh again"))
}

/// `%20` and the like as the bytes they stand for.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut out = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(b) = bytes.next() {
        out.push(match b {
            b'%' => {
                let digits = [bytes.next()?, bytes.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            b => b,
        });
    }
    String::from_utf8(out).ok()
}

/// A place in the JSON.
struct Place(At);

fn at(accessor: usize, key: &str) -> Place {
    Place(At::Part(format!("accessors[{accessor}]{key}")))
}

fn view_at(view: usize, key: &str) -> Place {
    Place(At::Part(format!("bufferViews[{view}]{key}")))
}

fn buffer_at(buffer: usize, key: &str) -> Place {
    Place(At::Part(format!("buffers[{buffer}]{key}")))
}

impl Place {
    fn fault(self, message: impl Into<String>) -> MeshFault {
        MeshFault::new(self.0, message)
    }

    fn with<T>(self, message: impl Into<String>, mend: &str) -> Result<T, MeshFault> {
        self.fault(message).mend(mend)
    }
}
