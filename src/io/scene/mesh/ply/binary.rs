//! The body of a binary PLY file, of either byte order.

use super::header::{Element, Header, Kind};
use super::{Sink, Wanted};
use crate::io::scene::mesh::model::{At, MeshFault};

/// Reads all elements; `LITTLE` is the byte order.
pub(super) fn read<const LITTLE: bool>(header: &Header, bytes: &[u8], sink: &mut Sink) -> Result<(), MeshFault> {
    let mut rest = Cursor { bytes: &bytes[header.body..] };
    for (which, element) in header.elements.iter().enumerate() {
        // Nothing is set aside for a count that the file cannot hold.
        let least = element.count.saturating_mul(element.least_bytes());
        if least > rest.bytes.len() as u64 {
            let (name, count, left) = (&element.name, element.count, rest.bytes.len());
            let message = format!("{count} elements \"{name}\" need at least {least} bytes, but {left} are left");
            return MeshFault::new(At::Part(format!("element {name}")), message)
                .mend("is the file cut short? Or correct the count in the header");
        }
        for number in 0..element.count {
            row::<LITTLE>(element, which, number, &mut rest, sink)?;
        }
    }
    match rest.bytes.len() {
        0 => Ok(()),
        left => MeshFault::new(At::File, format!("{left} bytes are left after the last element"))
            .mend("correct the counts and types in the header"),
    }
}

fn row<const LITTLE: bool>(
    element: &Element,
    which: usize,
    number: u64,
    rest: &mut Cursor,
    sink: &mut Sink,
) -> Result<(), MeshFault> {
    let at = || At::Part(format!("{} {number}", element.name));
    let cut = || MeshFault::new(at(), "the file ends within the element").mend("is the file cut short?");
    let mut point = [0.0; 3];
    let mut values = vec![0.0; sink.kept.width(which)];
    let mut corners = Vec::new();
    for (place, property) in element.properties.iter().enumerate() {
        let wanted = &sink.wanted[which];
        let Some(count) = property.count else {
            let Some(value) = rest.number::<LITTLE>(property.kind) else { return cut() };
            if let Some((slot, full)) = sink.kept.slot(which, place) {
                values[slot] = value / full;
            }
            if let Wanted::Vertex(places) = wanted {
                places.iter().zip(&mut point).filter(|(p, _)| **p == place).for_each(|(_, c)| *c = value);
            }
            continue;
        };
        let Some(count) = rest.number::<LITTLE>(count) else { return cut() };
        if count < 0.0 || count * property.kind.size() as f64 > rest.bytes.len() as f64 {
            let message = format!("a list of {count} numbers, but {} bytes are left", rest.bytes.len());
            return MeshFault::new(at(), message).mend("is the file cut short, or of the other byte order?");
        }
        let is_face = matches!(wanted, Wanted::Face(list) if *list == place);
        for _ in 0..count as usize {
            let Some(value) = rest.number::<LITTLE>(property.kind) else { return cut() };
            if is_face {
                corners.push(value as i64);
            }
        }
    }
    match sink.wanted[which] {
        Wanted::Vertex(_) => sink.vertex(point, &values, at),
        Wanted::Face(_) => sink.face(&corners, &values, number as u32),
        Wanted::Nothing => Ok(()),
    }
}

/// Bytes not yet read.
struct Cursor<'a> {
    bytes: &'a [u8],
}

impl Cursor<'_> {
    fn take<const N: usize, const LITTLE: bool>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.bytes.split_first_chunk::<N>()?;
        self.bytes = rest;
        let mut bytes = *head;
        if !LITTLE {
            bytes.reverse();
        }
        Some(bytes)
    }

    /// The next number; every type fits into a double exactly.
    fn number<const LITTLE: bool>(&mut self, kind: Kind) -> Option<f64> {
        Some(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes(self.take::<1, LITTLE>()?)),
            Kind::U8 => f64::from(u8::from_le_bytes(self.take::<1, LITTLE>()?)),
            Kind::I16 => f64::from(i16::from_le_bytes(self.take::<2, LITTLE>()?)),
            Kind::U16 => f64::from(u16::from_le_bytes(self.take::<2, LITTLE>()?)),
            Kind::I32 => f64::from(i32::from_le_bytes(self.take::<4, LITTLE>()?)),
            Kind::U32 => f64::from(u32::from_le_bytes(self.take::<4, LITTLE>()?)),
            Kind::F32 => f64::from(f32::from_le_bytes(self.take::<4, LITTLE>()?)),
            Kind::F64 => f64::from_le_bytes(self.take::<8, LITTLE>()?),
        })
    }
}
