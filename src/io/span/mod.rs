//! Span files, `etalon-span/1`: intermediate images [NINT89 fig. 2]; references/span-format.md has the layout.

mod bytes;
mod faces;
mod fault;
mod frame;
mod head;
mod lines;
mod look;
mod sound;
mod track;

use super::FileError;
use super::atomic::{self, WriteError};
use crate::compositing::SpanImage;
use fault::{Fault, damaged};
use frame::{Sections, Writer};
use std::path::Path;

/// The format that this version writes and reads.
pub const SPAN_FORMAT: &str = "etalon-span/1";
/// Largest file that is read, bytes.
const MAX_FILE: u64 = 1 << 32;

/// Why a span file was not written.
#[derive(Debug, thiserror::Error)]
pub enum SpanWriteError {
    /// The image is not one that could be read back.
    #[error("{0}")]
    Image(#[from] FileError),
    /// The file cannot be written.
    #[error("{0}")]
    Write(#[from] WriteError),
}

/// Writes an intermediate image; it is read back to the bit. The file is whole or not there. Returns its length in bytes.
///
/// # Errors
/// [`SpanWriteError`]: an image whose parts do not fit together (indices, order and ends of segments, numbers that are
/// not finite), or a file that cannot be written.
pub fn write_span(path: &Path, image: &SpanImage) -> Result<u64, SpanWriteError> {
    let bytes = encode(image).map_err(|fault| fault.in_file(path))?;
    atomic::write(path, &bytes)?;
    Ok(bytes.len() as u64)
}

/// The bytes that [`write_span`] writes.
///
/// # Errors
/// [`FileError`] for an image whose parts do not fit together.
pub fn span_bytes(image: &SpanImage) -> Result<Vec<u8>, FileError> {
    encode(image).map_err(|fault| fault.in_file(Path::new("the image")))
}

/// Reads an intermediate image.
///
/// # Errors
/// [`FileError`] with place and mend for files that are cut off, changed, of another version, or whose parts do not fit
/// together.
pub fn read_span(path: &Path) -> Result<SpanImage, FileError> {
    let system = |e: std::io::Error| FileError::system(path, "read", &e);
    let meta = std::fs::metadata(path).map_err(system)?;
    if meta.is_dir() {
        return Err(FileError::new(path, "is a folder").mend("name a file"));
    }
    if meta.len() > MAX_FILE {
        let problem = format!("has {} bytes, more than the {MAX_FILE} that are read", meta.len());
        return Err(FileError::new(path, problem).mend("scan fewer clusters into one file"));
    }
    let bytes = std::fs::read(path).map_err(system)?;
    decode(&bytes).map_err(|fault| fault.in_file(path))
}

/// The bytes of a file. Same image, same bytes.
fn encode(image: &SpanImage) -> Result<Vec<u8>, Fault> {
    sound::check(image)?;
    let mut out = Writer::new();
    out.section(*b"head", &head::write(image)?)?;
    faces::write(image, &mut out)?;
    out.section(*b"pict", &head::picture_bytes(image))?;
    lines::write(image, &mut out)?;
    out.section(frame::END, &[])?;
    Ok(out.finish())
}

fn decode(bytes: &[u8]) -> Result<SpanImage, Fault> {
    let mut sections = Sections::open(bytes)?;
    let (mut image, head) = head::read(&sections.next(*b"head")?)?;
    image.faces = faces::read(&head, &mut sections)?;
    head::read_pictures(&mut image.appearance, &sections.next(*b"pict")?)?;
    image.lines = lines::read(&head, &mut sections)?;
    if !sections.next(frame::END)?.is_empty() || !sections.is_done() {
        return Err(damaged("end", "something follows the end mark"));
    }
    sound::check(&image)?;
    Ok(image)
}

#[cfg(test)]
mod tests;
