//! Corners of a surface: by vertex numbers, or from an origin and two angles.

use super::parse::Reader;
use super::words::Word;
use crate::io::scene::check::{Checked, LARGEST};
use crate::io::scene::error::Refusal;
use crate::math::DVec3;

/// Four vertex numbers, the last 0 for a triangle; a vertex named twice in a row is one corner.
pub(super) fn vertices(reader: &mut Reader, all: &[DVec3]) -> Checked<Vec<DVec3>> {
    let mut numbers: Vec<usize> = Vec::with_capacity(4);
    for place in ["first", "second", "third", "fourth"] {
        let number = reader.count(&format!("its {place} vertex"))?;
        if number > all.len() || (number == 0 && place != "fourth") {
            let message = format!("its {place} vertex is {number}, and there are {}", all.len());
            return reader.refuse(Refusal::Number, &message, "name a vertex of the file (0 only as the fourth)");
        }
        if number > 0 && numbers.last() != Some(&number) {
            numbers.push(number);
        }
    }
    if numbers.len() > 1 && numbers.last() == numbers.first() {
        numbers.pop();
    }
    checked(reader, numbers.into_iter().map(|n| all[n - 1]).collect())
}

/// Origin, azimuth and tilt of a plane, then a rectangle (width, height) or corners within the plane.
pub(super) fn blast(reader: &mut Reader, shape: &Word) -> Checked<Vec<DVec3>> {
    let origin = DVec3::new(reader.number("x")?, reader.number("y")?, reader.number("z")?);
    let (sa, ca) = sine_cosine(reader.number("the azimuth")?);
    let (st, ct) = sine_cosine(reader.number("the tilt")?);
    // Azimuth: clockwise from the y axis (north); tilt: 0 faces up, 90 is a wall.
    let across = DVec3::new(-ca, sa, 0.0);
    let up = DVec3::new(-ct * sa, -ct * ca, st);
    let flat = match shape.text.chars().next().map(|c| c.to_ascii_uppercase()) {
        Some('R') => {
            let (w, h) = (reader.number("the width")?, reader.number("the height")?);
            vec![(0.0, h), (0.0, 0.0), (w, 0.0), (w, h)]
        }
        Some(s @ ('T' | 'Q')) => {
            let mut corners = Vec::with_capacity(4);
            for k in 1..=if s == 'T' { 3 } else { 4 } {
                corners
                    .push((reader.number(&format!("x of corner {k}"))?, reader.number(&format!("y of corner {k}"))?));
            }
            corners
        }
        _ => {
            let message = format!("the shape \"{}\" is unknown", shape.text.escape_debug());
            return reader.refuse(Refusal::Syntax, &message, "write R (rectangle), Q (quadrilateral) or T (triangle)");
        }
    };
    checked(reader, flat.into_iter().map(|(x, y)| origin + across * x + up * y).collect())
}

fn checked(reader: &Reader, corners: Vec<DVec3>) -> Checked<Vec<DVec3>> {
    match corners.iter().all(|p| p.is_finite() && p.abs().max_element() <= LARGEST) {
        true => Ok(corners),
        false => {
            let message = format!("a corner lies beyond {LARGEST:e} m");
            reader.refuse(Refusal::Number, &message, "coordinates are taken as metres; check the unit")
        }
    }
}

/// Exact at multiples of 90 degrees: walls of a room have to meet.
fn sine_cosine(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        turned => turned.to_radians().sin_cos(),
    }
}
