//! PNG pictures beside or below a scene file; one that is used twice is held once.

use super::check::{Check, Checked};
use super::error::Refusal;
use super::folder::{Folder, bytes_of};
use crate::scene::Picture;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Most pixels a side, and of all pictures: a gigabyte.
const MOST_SIDE: u32 = 16_384;
const MOST_PIXELS: u64 = 1 << 28;

/// The pictures that have been read.
pub(super) struct Pictures<'f> {
    folder: &'f Folder,
    known: BTreeMap<PathBuf, usize>,
    pixels: u64,
    pub list: Vec<Picture>,
}

impl<'f> Pictures<'f> {
    pub(super) fn of(folder: &'f Folder) -> Self {
        Self { folder, known: BTreeMap::new(), pixels: 0, list: Vec::new() }
    }

    /// The number of a picture that a file names.
    pub(super) fn named(&mut self, check: Check, name: &Spanned<String>) -> Checked<usize> {
        let path = self.folder.locate(check, name.span(), Path::new(""), name.get_ref())?;
        if let Some(number) = self.known.get(&path) {
            return Ok(*number);
        }
        let picture = self.read(&path, name.get_ref()).map_err(|why| {
            let message = format!("\"{}\": {why}", name.get_ref().escape_debug());
            super::SceneFileError::new(check.source, Refusal::Unreadable, name.span(), message)
                .mend("save it as PNG, RGB or RGBA, and look at it in a viewer")
        })?;
        self.known.insert(path, self.list.len());
        self.list.push(picture);
        Ok(self.list.len() - 1)
    }

    fn read(&mut self, path: &Path, name: &str) -> Result<Picture, String> {
        let bytes = bytes_of(path)?;
        let broken = |e: image::ImageError| format!("is no sound PNG picture: {e}");
        let open = || image::ImageReader::with_format(Cursor::new(bytes.as_slice()), image::ImageFormat::Png);
        let (width, height) = open().into_dimensions().map_err(broken)?;
        // Asked before any pixel is read: a small file may name a huge picture.
        let pixels = self.pixels + u64::from(width) * u64::from(height);
        if width == 0 || height == 0 || width > MOST_SIDE || height > MOST_SIDE || pixels > MOST_PIXELS {
            return Err(format!("{width} x {height} pixels are too many, or none: at most {MOST_SIDE} a side"));
        }
        let rgba = open().decode().map_err(broken)?.into_rgba8().into_raw();
        self.pixels = pixels;
        Ok(Picture { name: name.to_string(), size: [width, height], rgba })
    }
}
