//! Whether the parts of an intermediate image fit together: asked before it is written and after it is read.

use super::fault::{Fault, unsound};
use super::look;
use crate::compositing::{Line, Span, SpanFace, SpanImage};
use crate::math::DVec3;
use crate::scene::Material;

/// Most pixels a side, sub-scanlines a scanline, bands, corners of a face.
const MOST_SIDE: u32 = 16_384;
const MOST_PER_LINE: u32 = 64;
const MOST_BANDS: usize = 64;
const MOST_CORNERS: usize = 4096;

/// The first thing that does not fit.
pub(super) fn check(image: &SpanImage) -> Result<(), Fault> {
    camera(image)?;
    let bands = &image.photometry;
    let count = bands.bands.len();
    if count == 0 || count > MOST_BANDS || bands.weights.len() != count || !all_finite(&bands.weights) {
        return unsound("photometry", format!("{count} bands with {} weights do not fit", bands.weights.len()));
    }
    image.materials.iter().try_for_each(|m| material(m, count))?;
    if image.clusters.windows(2).any(|w| w[0] >= w[1]) {
        return unsound("clusters", "they are not in order of their names, or two are the same");
    }
    look::check(&image.appearance, count)?;
    image.faces.iter().try_for_each(|f| face(image, f))?;
    if image.faces.windows(2).any(|w| w[0].key >= w[1].key) {
        return unsound("faces", "they are not in order of their keys, or two have one key");
    }
    let need = image.per_line as usize * image.camera.size[1] as usize + 1;
    if image.lines.len() != need {
        return unsound("lines", format!("{} sub-scanlines where the camera has {need}", image.lines.len()));
    }
    image.lines.iter().enumerate().try_for_each(|(j, l)| line(image, j, l))
}

pub(super) fn all_finite(values: &[f64]) -> bool {
    values.iter().all(|v| v.is_finite())
}

/// Finite numbers, one a band, none negative.
pub(super) fn is_strength(values: &[f64], bands: usize) -> bool {
    values.len() == bands && values.iter().all(|v| v.is_finite() && *v >= 0.0)
}

fn camera(image: &SpanImage) -> Result<(), Fault> {
    let c = &image.camera;
    let sides = c.size.iter().all(|s| (1..=MOST_SIDE).contains(s));
    if !sides || !(1..=MOST_PER_LINE).contains(&image.per_line) {
        let problem = format!("{} x {} pixels of {} sub-scanlines", c.size[0], c.size[1], image.per_line);
        return unsound("camera", format!("{problem}: up to {MOST_SIDE} a side and {MOST_PER_LINE} are kept"));
    }
    let (forward, up) = ((c.target - c.eye).normalize_or_zero(), c.up.normalize_or_zero());
    let sound = c.eye.is_finite() && forward.cross(up).length() > 1e-9 && c.fov > 0.0 && c.fov < 180.0;
    if sound { Ok(()) } else { unsound("camera", "eye, target, up and field of view are not those of a camera") }
}

fn material(material: &Material, bands: usize) -> Result<(), Fault> {
    let reflects = is_strength(&material.reflectance, bands) && material.reflectance.iter().all(|v| *v <= 1.0);
    match reflects && is_strength(&material.emission, bands) {
        true => Ok(()),
        false => unsound(
            format!("material \"{}\"", material.name.escape_debug()),
            "reflectance or emission are not numbers within their range, one a band",
        ),
    }
}

fn face(image: &SpanImage, face: &SpanFace) -> Result<(), Fault> {
    let place = || format!("face {} of \"{}\"", face.key.1, face.key.0.escape_debug());
    let points =
        (3..=MOST_CORNERS).contains(&face.vertices.len()) && face.vertices.iter().all(|v: &DVec3| v.is_finite());
    if !points {
        return unsound(place(), format!("{} corners, or one that is not finite", face.vertices.len()));
    }
    let known = [
        ("material", Some(face.material), image.materials.len()),
        ("cluster", Some(face.cluster), image.clusters.len()),
        ("tree", face.tree, image.appearance.trees.len()),
    ];
    match known.into_iter().find(|(_, number, count)| number.is_some_and(|n| n as usize >= *count)) {
        None => Ok(()),
        Some((what, number, count)) => {
            unsound(place(), format!("refers to {what} {} of {count}", number.unwrap_or_default()))
        }
    }
}

fn line(image: &SpanImage, number: usize, line: &Line) -> Result<(), Fault> {
    let width = f64::from(image.camera.size[0]);
    let place = || format!("sub-scanline {number}");
    let wrong = |s: &&Span| !(s.from >= 0.0 && s.from <= s.to && s.to <= width);
    if let Some(s) = line.solid.iter().chain(&line.over).find(wrong) {
        return unsound(place(), format!("a segment from {} to {} of {width} pixels", s.from, s.to));
    }
    if let Some(s) = line.solid.iter().chain(&line.over).find(|s| s.face as usize >= image.faces.len()) {
        return unsound(place(), format!("a segment of face {} of {}", s.face, image.faces.len()));
    }
    if line.solid.windows(2).any(|w| w[0].to > w[1].from) || line.over.windows(2).any(|w| w[0].from > w[1].from) {
        return unsound(place(), "segments are not in order, or overlap");
    }
    Ok(())
}
