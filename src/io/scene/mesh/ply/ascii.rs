//! The body of a text PLY file: one element a line.

use super::header::{Element, Header};
use super::{Sink, Wanted};
use crate::io::scene::mesh::model::{At, MeshFault, fault, number, shown};

/// Reads all elements.
pub(super) fn read(header: &Header, bytes: &[u8], sink: &mut Sink) -> Result<(), MeshFault> {
    let body = String::from_utf8_lossy(&bytes[header.body..]);
    let filled = |(_, l): &(usize, &str)| !l.trim().is_empty();
    let mut lines = body.lines().enumerate().map(|(i, l)| (header.first_line + i, l)).filter(filled);
    let mut last = header.first_line;
    for (which, element) in header.elements.iter().enumerate() {
        for done in 0..element.count {
            let Some((line, text)) = lines.next() else {
                let message = format!("the file ends after {done} of {} elements \"{}\"", element.count, element.name);
                return fault(last, message, "is the file cut short? Or correct the count in the header");
            };
            last = line;
            row(element, which, line, text, sink)?;
        }
    }
    match lines.next() {
        None => Ok(()),
        Some((line, _)) => fault(line, "lines are left after the last element", "correct the counts in the header"),
    }
}

fn row(element: &Element, which: usize, line: usize, text: &str, sink: &mut Sink) -> Result<(), MeshFault> {
    let mut words = text.split_ascii_whitespace();
    let mut word = || match words.next() {
        Some(word) => Ok(word),
        None => fault(line, format!("the element \"{}\" has too few numbers", element.name), "complete the line"),
    };
    let mut point = [0.0; 3];
    let mut values = vec![0.0; sink.kept.width(which)];
    let mut corners = Vec::new();
    for (place, property) in element.properties.iter().enumerate() {
        let wanted = &sink.wanted[which];
        if property.count.is_none() {
            let axis = if let Wanted::Vertex(places) = wanted { places.iter().position(|p| *p == place) } else { None };
            let word = word()?;
            if let Some(axis) = axis {
                point[axis] = number(line, word)?;
            }
            if let Some((slot, full)) = sink.kept.slot(which, place) {
                values[slot] = value(line, word)? / full;
            }
            continue;
        }
        let is_face = matches!(wanted, Wanted::Face(list) if *list == place);
        let count = whole(line, word()?)?;
        for _ in 0..count {
            let word = word()?;
            if is_face {
                corners.push(whole(line, word)?);
            }
        }
    }
    if words.next().is_some() {
        return fault(line, format!("the element \"{}\" has too many numbers", element.name), "split the line");
    }
    match sink.wanted[which] {
        Wanted::Vertex(_) => sink.vertex(point, &values, || At::Line(line)),
        Wanted::Face(_) => sink.face(&corners, &values, line as u32),
        Wanted::Nothing => Ok(()),
    }
}

/// Any number, also one that is not finite: the sink says where.
fn value(line: usize, word: &str) -> Result<f64, MeshFault> {
    match word.parse() {
        Ok(v) => Ok(v),
        Err(_) => fault(line, format!("\"{}\" is not a number", shown(word)), "give a decimal number"),
    }
}

fn whole(line: usize, word: &str) -> Result<i64, MeshFault> {
    match word.parse() {
        Ok(v) => Ok(v),
        Err(_) => fault(line, format!("\"{}\" is not a whole number", shown(word)), "give a count or a vertex number"),
    }
}
