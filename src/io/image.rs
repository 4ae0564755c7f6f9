//! PNG and OpenEXR, as bytes. Same pixels, same bytes.

use exr::prelude as ex;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::io::Cursor;

/// Why a picture could not be encoded.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// Width, height and number of pixels do not agree, or there are none.
    #[error("a picture of {width} x {height} pixels cannot be made of {pixels} pixels in {part}")]
    Size {
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
        /// Pixels that were given.
        pixels: usize,
        /// Which part of the picture.
        part: String,
    },
    /// The PNG encoder refused.
    #[error("the PNG picture could not be encoded: {0}")]
    Png(#[from] image::ImageError),
    /// The EXR encoder refused.
    #[error("the EXR picture could not be encoded: {0}")]
    Exr(#[from] exr::error::Error),
}

/// One channel of an EXR picture, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// `layer.channel`, or only `channel` for what every viewer shows first.
    pub name: String,
    /// One entry per pixel.
    pub samples: Samples,
}

/// Samples of a channel.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Numbers.
    F32(Vec<f32>),
    /// Names of things, as numbers.
    U32(Vec<u32>),
}

impl Samples {
    fn len(&self) -> usize {
        match self {
            Self::F32(v) => v.len(),
            Self::U32(v) => v.len(),
        }
    }
}

/// A PNG of sRGB pixels with straight alpha: four bytes a pixel, rows from the top.
///
/// # Errors
/// [`ImageError::Size`] where the bytes do not fill the picture.
pub fn png(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, ImageError> {
    check(width, height, rgba.len() / 4, "the raster")?;
    let mut bytes = Vec::new();
    // Flat patches pack best unfiltered: smaller than with any filter, and in a tenth of the time.
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::NoFilter);
    encoder.write_image(rgba, width, height, ExtendedColorType::Rgba8)?;
    Ok(bytes)
}

/// An OpenEXR picture, single part, ZIP-compressed without loss; `comments` go into its header.
///
/// # Errors
/// [`ImageError::Size`] where a channel does not fill the picture.
pub fn exr(width: u32, height: u32, channels: &[Channel], comments: &str) -> Result<Vec<u8>, ImageError> {
    for c in channels {
        check(width, height, c.samples.len(), &c.name)?;
    }
    if channels.is_empty() {
        check(0, 0, 0, "an EXR without channels")?;
    }
    let size = ex::Vec2(width as usize, height as usize);
    let encoding = ex::Encoding {
        compression: ex::Compression::ZIP16,
        blocks: ex::Blocks::ScanLines,
        line_order: ex::LineOrder::Increasing,
    };
    let attributes = ex::LayerAttributes { comments: Some(comments.into()), ..ex::LayerAttributes::default() };
    let list = ex::AnyChannels::sort(channels.iter().map(any_channel).collect());
    let picture = ex::Image::from_layer(ex::Layer::new(size, attributes, encoding, list));
    let mut bytes = Cursor::new(Vec::new());
    ex::WritableImage::write(&picture).non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// Names that viewers know (R, G, B, Y) where the bands have them, else the bands' own, without the dots that
/// would make layers of them; made different where two are alike.
pub fn channel_names(bands: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (k, band) in bands.iter().enumerate() {
        let name = match band.to_lowercase().as_str() {
            known @ ("r" | "g" | "b" | "y") => known.to_uppercase(),
            _ => band.chars().map(|c| if c.is_ascii_graphic() && c != '.' { c } else { '_' }).collect(),
        };
        let taken = name.is_empty() || name == "A" || names.contains(&name);
        names.push(if taken { format!("{name}_{k}") } else { name });
    }
    names
}

fn any_channel(channel: &Channel) -> ex::AnyChannel<ex::FlatSamples> {
    let samples = match &channel.samples {
        Samples::F32(v) => ex::FlatSamples::F32(v.clone()),
        Samples::U32(v) => ex::FlatSamples::U32(v.clone()),
    };
    ex::AnyChannel::new(channel.name.as_str(), samples)
}

fn check(width: u32, height: u32, pixels: usize, part: &str) -> Result<(), ImageError> {
    if pixels > 0 && width as usize * height as usize == pixels {
        return Ok(());
    }
    Err(ImageError::Size { width, height, pixels, part: part.into() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ex::{ReadChannels, ReadLayers};

    fn channels() -> Vec<Channel> {
        let wild = [0.1f32, -3.25e-7, 1e30, f32::MIN_POSITIVE, 0.0, 7.0];
        vec![
            Channel { name: "R".into(), samples: Samples::F32(wild.to_vec()) },
            Channel { name: "std_err.R".into(), samples: Samples::F32(wild.map(|v| v * 0.5).to_vec()) },
            Channel { name: "patch.number".into(), samples: Samples::U32(vec![0, 1, 16_777_217, 3, 4, u32::MAX]) },
        ]
    }

    #[test]
    fn exr_values_come_back_exactly() {
        let bytes = exr(3, 2, &channels(), "two rows").expect("encodes");
        let read = ex::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let back = read.all_attributes().from_buffered(Cursor::new(bytes)).expect("decodes");
        assert_eq!(back.layer_data.size, ex::Vec2(3, 2));
        assert_eq!(back.layer_data.attributes.comments, Some("two rows".into()));
        for c in channels() {
            let found = back.layer_data.channel_data.list.iter().find(|f| f.name == *c.name.as_str());
            let same = match (&found.expect("channel").sample_data, &c.samples) {
                (ex::FlatSamples::F32(a), Samples::F32(b)) => {
                    a.iter().map(|v| v.to_bits()).eq(b.iter().map(|v| v.to_bits()))
                }
                (ex::FlatSamples::U32(a), Samples::U32(b)) => a == b,
                _ => false,
            };
            assert!(same, "{}", c.name);
        }
    }

    #[test]
    fn same_pixels_same_bytes() {
        assert_eq!(exr(3, 2, &channels(), "x").expect("exr"), exr(3, 2, &channels(), "x").expect("exr"));
        let rgba: Vec<u8> = (0..64 * 48 * 4).map(|k| (k * k / 91) as u8).collect();
        let first = png(64, 48, &rgba).expect("png");
        assert_eq!(first, png(64, 48, &rgba).expect("png"));
        let back = image::load_from_memory(&first).expect("decodes").into_rgba8();
        assert_eq!(back.into_raw(), rgba);
    }

    #[test]
    fn sizes_that_do_not_agree_are_refused() {
        assert!(matches!(png(2, 2, &[0; 15]), Err(ImageError::Size { pixels: 3, .. })));
        assert!(matches!(png(0, 0, &[]), Err(ImageError::Size { .. })));
        assert!(matches!(exr(3, 2, &[], ""), Err(ImageError::Size { .. })));
        let e = exr(4, 2, &channels(), "").expect_err("too few");
        assert!(e.to_string().contains("6 pixels in R"), "{e}");
    }

    #[test]
    fn bands_of_any_name_make_channels() {
        let names = channel_names(&["r", "450.5 nm", "A", "a b", "a\tb"].map(String::from));
        assert_eq!(names, ["R", "450_5_nm", "A_2", "a_b", "a_b_4"]);
    }
}
