//! What `scan`, `composite` and `shade` share: span files, and what is said of them.

use crate::cli::exit::Failure;
use crate::compositing::SpanImage;
use crate::io::{read_span, write_span};
use serde_json::{Value, json};
use std::path::Path;

/// Reads a span file.
pub fn read(path: &Path) -> Result<SpanImage, Failure> {
    Ok(read_span(path)?)
}

/// Fails unless the name is that of a span file.
pub fn check_name(path: &Path) -> Result<(), Failure> {
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("span")) {
        return super::inputs::check_writable(path);
    }
    let message = format!("{}: name a .span file", path.display());
    Err(Failure::input(message).at(path.display().to_string()))
}

/// Segments of an image: solid, and such as can be seen through.
pub fn segments(image: &SpanImage) -> [usize; 2] {
    image.lines.iter().fold([0, 0], |[s, o], l| [s + l.solid.len(), o + l.over.len()])
}

/// Writes an image; what is said of it, in words and as JSON.
pub fn write(path: &Path, image: &SpanImage) -> Result<(String, Value), Failure> {
    let bytes = write_span(path, image)?;
    let [solid, over] = segments(image);
    let [width, height] = image.camera.size;
    let clusters: Vec<&str> = image.clusters.iter().map(|c| c.name.as_str()).collect();
    let words = format!(
        "{}: {width} x {height} pixels, {} sub-scanlines each, {} faces, {} segments, {} bytes",
        path.display(),
        image.per_line,
        image.faces.len(),
        solid + over,
        super::inputs::thousands(bytes),
    );
    let json = json!({
        "file": path, "width": width, "height": height, "sub_scanlines": image.per_line, "clusters": clusters,
        "faces": image.faces.len(), "segments": solid, "segments_seen_through": over, "bytes": bytes,
    });
    Ok((words, json))
}
