//! Deep pictures in OpenEXR: several samples a pixel, one behind the other.
//!
//! The encoder that the other pictures go through has no deep data; of the format only what is written here is needed:
//! one part, scanlines, 32-bit floats, each line packed by itself (ZIPS).

use super::image::ImageError;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// What a part of a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeepSample {
    /// Depth of its nearest point along the viewing direction, metres.
    pub z: f32,
    /// Depth of its farthest point.
    pub z_back: f32,
    /// Share of the pixel that it covers, 0 to 1.
    pub alpha: f32,
    /// Radiance times that share.
    pub rgb: [f32; 3],
}

/// A pixel: its samples, nearest first.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DeepPixel {
    /// One for each part that is seen.
    pub samples: Vec<DeepSample>,
}

/// Channels in the order of their names, as the format wants them.
const CHANNELS: [&str; 6] = ["A", "B", "G", "R", "Z", "ZBack"];

/// Value of a channel.
fn value(s: &DeepSample, channel: usize) -> f32 {
    match channel {
        0 => s.alpha,
        1..=3 => s.rgb[3 - channel],
        4 => s.z,
        _ => s.z_back,
    }
}

/// A deep OpenEXR picture with the channels A, R, G, B (premultiplied), Z and ZBack; pixels row by row from the top.
/// `comments` go into its header. Same pixels, same bytes.
///
/// # Errors
/// [`ImageError::Size`] where the pixels do not fill the picture.
pub fn deep_exr(width: u32, height: u32, pixels: &[DeepPixel], comments: &str) -> Result<Vec<u8>, ImageError> {
    let fits = u64::from(width) * u64::from(height) == pixels.len() as u64;
    if pixels.is_empty() || !fits || width > i32::MAX as u32 || height > i32::MAX as u32 {
        return Err(ImageError::Size { width, height, pixels: pixels.len(), part: "the deep picture".into() });
    }
    let mut out = header(width, height, pixels, comments);
    let table = out.len();
    out.resize(table + 8 * height as usize, 0);
    for (y, row) in pixels.chunks(width as usize).enumerate() {
        let begin = (out.len() as u64).to_le_bytes();
        out[table + 8 * y..table + 8 * y + 8].copy_from_slice(&begin);
        line(&mut out, y as i32, row)?;
    }
    Ok(out)
}

/// Magic number, version 2 with the mark of deep parts, attributes.
fn header(width: u32, height: u32, pixels: &[DeepPixel], comments: &str) -> Vec<u8> {
    let mut out = 20_000_630u32.to_le_bytes().to_vec();
    out.extend_from_slice(&(2u32 | 0x800).to_le_bytes());
    let mut channels = Vec::new();
    for name in CHANNELS {
        channels.extend_from_slice(name.as_bytes());
        channels.push(0);
        // Float, not perceptually linear, every pixel in x and y.
        [2u32, 0, 1, 1].iter().for_each(|n| channels.extend_from_slice(&n.to_le_bytes()));
    }
    channels.push(0);
    let window = [0, 0, width - 1, height - 1].map(u32::to_le_bytes).concat();
    let most = pixels.iter().map(|p| p.samples.len()).max().unwrap_or(0) as u32;
    let attributes: [(&str, &str, &[u8]); 13] = [
        ("channels", "chlist", &channels),
        ("chunkCount", "int", &height.to_le_bytes()),
        ("comments", "string", comments.as_bytes()),
        ("compression", "compression", &[2]),
        ("dataWindow", "box2i", &window),
        ("displayWindow", "box2i", &window),
        ("lineOrder", "lineOrder", &[0]),
        ("maxSamplesPerPixel", "int", &most.to_le_bytes()),
        ("pixelAspectRatio", "float", &1f32.to_le_bytes()),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &1f32.to_le_bytes()),
        ("type", "string", b"deepscanline"),
        ("version", "int", &1u32.to_le_bytes()),
    ];
    for (name, kind, bytes) in attributes {
        for word in [name, kind] {
            out.extend_from_slice(word.as_bytes());
            out.push(0);
        }
        out.extend_from_slice(&(bytes.len() as u32).to_le_bytes());
        out.extend_from_slice(bytes);
    }
    out.push(0);
    out
}

/// One chunk: the line's number, lengths, running counts of samples, samples channel by channel.
fn line(out: &mut Vec<u8>, y: i32, row: &[DeepPixel]) -> Result<(), ImageError> {
    let mut total = 0u32;
    let counts = row.iter().flat_map(|p| {
        total = total.saturating_add(p.samples.len() as u32);
        total.to_le_bytes()
    });
    let counts: Vec<u8> = counts.collect();
    let samples = || row.iter().flat_map(|p| &p.samples);
    let whole: Vec<u8> =
        (0..CHANNELS.len()).flat_map(|c| samples().flat_map(move |s| value(s, c).to_le_bytes())).collect();
    let (packed_counts, packed) = (zip(&counts)?, zip(&whole)?);
    out.extend_from_slice(&y.to_le_bytes());
    for length in [packed_counts.len(), packed.len(), whole.len()] {
        out.extend_from_slice(&(length as u64).to_le_bytes());
    }
    out.extend_from_slice(&packed_counts);
    out.extend_from_slice(&packed);
    Ok(())
}

/// The format's ZIP: bytes at even places, then those at odd ones; differences plus 128; zlib. What does not get smaller
/// stays as it is.
fn zip(bytes: &[u8]) -> Result<Vec<u8>, ImageError> {
    let mut parted: Vec<u8> = bytes.iter().step_by(2).chain(bytes.iter().skip(1).step_by(2)).copied().collect();
    for k in (1..parted.len()).rev() {
        parted[k] = parted[k].wrapping_sub(parted[k - 1]).wrapping_add(128);
    }
    let broken = |e: std::io::Error| ImageError::Exr(exr::error::Error::Io(e));
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&parted).map_err(broken)?;
    let packed = encoder.finish().map_err(broken)?;
    Ok(if packed.len() < bytes.len() { packed } else { bytes.to_vec() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    fn picture(width: u32, height: u32) -> Vec<DeepPixel> {
        let sample = |k: u32, i: u32| {
            let v = (k * 7 + i) as f32;
            DeepSample { z: v + 0.1, z_back: v + 0.2, alpha: 0.25, rgb: [v / 3.0, v * v, -v] }
        };
        let pixel = |k: u32| DeepPixel { samples: (0..k % 4).map(|i| sample(k, i)).collect() };
        (0..width * height).map(pixel).collect()
    }

    /// The inverse of [`zip`], written from the format's description.
    fn unzip(packed: &[u8], length: usize) -> Vec<u8> {
        if packed.len() == length {
            return packed.to_vec();
        }
        let mut parted = Vec::new();
        ZlibDecoder::new(packed).read_to_end(&mut parted).expect("zlib");
        for k in 1..parted.len() {
            parted[k] = parted[k - 1].wrapping_add(parted[k]).wrapping_sub(128);
        }
        let first = length.div_ceil(2);
        (0..length).map(|k| parted[if k % 2 == 0 { k / 2 } else { first + k / 2 }]).collect()
    }

    #[test]
    fn lines_hold_running_counts_and_channels_in_order() {
        let pixels = picture(5, 3);
        let bytes = deep_exr(5, 3, &pixels, "deep").expect("encodes");
        assert_eq!(bytes, deep_exr(5, 3, &pixels, "deep").expect("encodes"));
        let number = |at: usize, n: usize| bytes[at..at + n].iter().rev().fold(0usize, |v, b| v << 8 | usize::from(*b));
        assert_eq!((number(0, 4), number(4, 4)), (20_000_630, 0x802));
        let table = header(5, 3, &pixels, "deep").len();
        for y in 0..3 {
            let at = number(table + 8 * y, 8);
            assert_eq!(number(at, 4), y);
            let (counts, data, whole) = (number(at + 4, 8), number(at + 12, 8), number(at + 20, 8));
            let row = &pixels[5 * y..5 * y + 5];
            let own: Vec<u8> = unzip(&bytes[at + 28..at + 28 + counts], 20);
            let running: Vec<u32> = own.chunks(4).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]])).collect();
            let mut total = 0;
            let expected: Vec<u32> = row
                .iter()
                .map(|p| {
                    total += p.samples.len() as u32;
                    total
                })
                .collect();
            assert_eq!(running, expected);
            assert_eq!(whole, total as usize * 24);
            let own = unzip(&bytes[at + 28 + counts..at + 28 + counts + data], whole);
            let values: Vec<f32> = own.chunks(4).map(|c| f32::from_le_bytes([c[0], c[1], c[2], c[3]])).collect();
            let samples: Vec<DeepSample> = row.iter().flat_map(|p| p.samples.clone()).collect();
            let parts: [fn(&DeepSample) -> f32; 6] =
                [|s| s.alpha, |s| s.rgb[2], |s| s.rgb[1], |s| s.rgb[0], |s| s.z, |s| s.z_back];
            assert_eq!(values, parts.iter().flat_map(|p| samples.iter().map(p)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn pixels_that_do_not_fill_the_picture_are_refused() {
        assert!(matches!(deep_exr(2, 2, &picture(3, 1), ""), Err(ImageError::Size { pixels: 3, .. })));
        assert!(matches!(deep_exr(0, 0, &[], ""), Err(ImageError::Size { .. })));
    }
}
