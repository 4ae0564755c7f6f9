//! The numbers of an EXR picture or a PNG photograph.

use super::{BANDS, LAYOUT};
use crate::io::FileError;
use crate::io::image::channel_names;
use exr::meta::attribute::{AttributeValue, EnvironmentMap};
use exr::prelude as ex;
use exr::prelude::{ReadChannels, ReadLayers};
use std::io::Cursor;
use std::path::Path;

/// Largest file that is read, bytes.
const MAX_FILE: u64 = 1 << 31;
/// Most pixels that are read: 16,384 x 8,192.
const MAX_PIXELS: u64 = 1 << 27;
/// Most samples of all channels: four of them in that size.
const MAX_SAMPLES: u64 = 1 << 29;
/// More samples than this for one byte of the file no compression packs.
const MAX_PACKED: u64 = 1 << 12;

/// A picture, rows from the top.
pub(super) struct Picture {
    pub width: usize,
    pub height: usize,
    pub bands: Vec<String>,
    /// Of each band, one value a pixel.
    pub channels: Vec<Vec<f32>>,
    /// What the header says of the layout: our attribute, and OpenEXR's.
    pub layout: Option<String>,
    pub environment: Option<EnvironmentMap>,
}

impl Picture {
    pub(super) fn read(path: &Path) -> Result<Self, FileError> {
        let system = |e: std::io::Error| FileError::system(path, "read", &e);
        let meta = std::fs::metadata(path).map_err(system)?;
        if meta.is_dir() {
            return Err(FileError::new(path, "is a folder").mend("name a file"));
        }
        if meta.len() > MAX_FILE {
            let problem = format!("has {} bytes, more than the {MAX_FILE} that are read", meta.len());
            return Err(FileError::new(path, problem).mend("save a smaller picture"));
        }
        let bytes = std::fs::read(path).map_err(system)?;
        if bytes.starts_with(b"\x89PNG") { photograph(path, &bytes) } else { numbers(path, &bytes) }
    }
}

/// Refuses a picture that would not fit before any pixel is read.
fn check(path: &Path, width: u64, height: u64, channels: u64, bytes: u64) -> Result<(), FileError> {
    let (pixels, refuse) = (width.saturating_mul(height), |problem: String, mend: &str| {
        Err(FileError::new(path, problem).at("header").mend(mend))
    });
    if pixels == 0 || channels == 0 {
        return refuse("the picture is empty".into(), "save it again with pixels");
    }
    let samples = pixels.saturating_mul(channels);
    if pixels > MAX_PIXELS || samples > MAX_SAMPLES {
        let problem = format!("{width} x {height} pixels of {channels} channels are more than can be read");
        return refuse(problem, "save at most 16384 x 8192 pixels of four channels");
    }
    if samples / MAX_PACKED > bytes {
        let problem = format!("{bytes} bytes cannot hold {width} x {height} pixels of {channels} channels");
        return refuse(problem, "the file is cut off or damaged: save it again");
    }
    Ok(())
}

/// An EXR picture, single part or the first flat part; any channels and compression that are not deep.
fn numbers(path: &Path, bytes: &[u8]) -> Result<Picture, FileError> {
    let broken = |e: exr::error::Error| {
        FileError::new(path, format!("is no sound EXR or PNG picture: {e}"))
            .mend("save it again as OpenEXR, single part")
    };
    let meta = ex::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
    if meta.headers.iter().all(|h| h.deep) {
        return Err(FileError::new(path, "the picture is deep").at("header").mend("save a flat picture"));
    }
    for header in &meta.headers {
        let (size, channels) = (header.layer_size, header.channels.list.len());
        check(path, size.0 as u64, size.1 as u64, channels as u64, bytes.len() as u64)?;
    }
    let reader = ex::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let picture = reader.all_attributes().non_parallel().from_buffered(Cursor::new(bytes)).map_err(broken)?;
    let (layer, window) = (picture.layer_data, picture.attributes.display_window);
    if window.size != layer.size || window.position != layer.attributes.layer_position {
        let problem = "the data window is not the display window: parts of the picture are cut away";
        return Err(FileError::new(path, problem).at("header").mend("save the whole picture"));
    }
    let (width, height) = (layer.size.0, layer.size.1);
    let text = |name: &str| {
        let own = [&layer.attributes.other, &picture.attributes.other];
        own.into_iter().find_map(|other| match other.get(&ex::Text::from(name)) {
            Some(AttributeValue::Text(text)) => Some(text.to_string()),
            _ => None,
        })
    };
    let list = &layer.channel_data.list;
    let names: Vec<String> = list.iter().map(|c| c.name.to_string()).collect();
    let layout = text(LAYOUT);
    let bands = layout.as_ref().and_then(|_| text(BANDS)).map(|b| b.split('\n').map(String::from).collect());
    let (bands, chosen) = choose(path, &names, bands)?;
    let samples = |name: &String| {
        let found = list.iter().find(|c| c.name == *name.as_str());
        let values: Option<Vec<f32>> = found.map(|c| c.sample_data.values_as_f32().collect());
        values.filter(|v| v.len() == width * height).ok_or_else(|| {
            let place = format!("channel {}", shown(name));
            FileError::new(path, "the channel is subsampled").at(place).mend("save every channel in full size")
        })
    };
    let channels = chosen.iter().map(samples).collect::<Result<_, _>>()?;
    Ok(Picture { width, height, bands, channels, layout, environment: layer.attributes.environment_map })
}

/// Names of bands and their channels: those of our own file; else red, green and blue, else Y, else all but alpha.
fn choose(path: &Path, names: &[String], own: Option<Vec<String>>) -> Result<(Vec<String>, Vec<String>), FileError> {
    let has = |n: &String| names.contains(n);
    if let Some(bands) = own {
        let channels = channel_names(&bands);
        if channels.iter().all(has) {
            return Ok((bands, channels));
        }
    }
    let rgb = ["R", "G", "B"].map(String::from).to_vec();
    let y = vec!["Y".to_string()];
    let others: Vec<String> = names.iter().filter(|n| *n != "A" && !n.ends_with(".A")).cloned().collect();
    let chosen = [rgb, y, others].into_iter().find(|c| !c.is_empty() && c.iter().all(has));
    match chosen {
        Some(channels) => Ok((channels.iter().map(|c| c.to_lowercase()).collect(), channels)),
        None => {
            Err(FileError::new(path, "has no channel but alpha").at("header").mend("save it with R, G and B, or Y"))
        }
    }
}

/// A PNG photograph: sRGB decoded to linear values from 0 to 1.
fn photograph(path: &Path, bytes: &[u8]) -> Result<Picture, FileError> {
    let broken = |e: image::ImageError| {
        FileError::new(path, format!("is no sound PNG picture: {e}")).mend("save it again as PNG, or as OpenEXR")
    };
    let reader = || image::ImageReader::with_format(Cursor::new(bytes), image::ImageFormat::Png);
    let (width, height) = reader().into_dimensions().map_err(broken)?;
    check(path, width.into(), height.into(), 3, bytes.len() as u64)?;
    let mut reader = reader();
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(MAX_FILE);
    reader.limits(limits);
    let pixels = reader.decode().map_err(broken)?.into_rgb16();
    let channel = |k: usize| pixels.pixels().map(|p| linear(f64::from(p.0[k]) / 65535.0) as f32).collect();
    Ok(Picture {
        width: width as usize,
        height: height as usize,
        bands: ["r", "g", "b"].map(String::from).to_vec(),
        channels: (0..3).map(channel).collect(),
        layout: None,
        environment: None,
    })
}

/// Light of an sRGB value (IEC 61966-2-1).
fn linear(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// A word of a file as it can stand in a message.
fn shown(word: &str) -> String {
    word.chars().take(60).collect::<String>().escape_debug().to_string()
}
