//! Our own files of world maps.

use super::{BANDS, LAYOUT};
use crate::io::image::{ImageError, channel_names};
use crate::world::{Layout, WorldMap, unfolded};
use exr::meta::attribute::{AttributeValue, EnvironmentMap};
use exr::prelude as ex;
use std::io::Cursor;

/// A world map as an OpenEXR picture, ZIP-compressed without loss: a cube as the horizontal cross of its faces (4 N x 3 N),
/// alpha 1 where there is one, a fish-eye with alpha 1 within its circle, the others as they are. The header names
/// layout and bands, and latitude-longitude maps have OpenEXR's `envmap` attribute; read back, the values are the same to
/// the bit. Same map, same bytes. `comments` go into the header; `more` are further channels, one value a texel each.
///
/// # Errors
/// [`ImageError::Size`] where there is not one name a band, [`ImageError::Exr`] where the encoder refuses.
pub fn world_map_exr(
    map: &WorldMap,
    bands: &[String],
    comments: &str,
    more: &[(String, Vec<f32>)],
) -> Result<Vec<u8>, ImageError> {
    let picture = unfolded(map.shape());
    let (width, height) = (picture.width, picture.height);
    if bands.len() != map.bands() || bands.is_empty() {
        let part = format!("{} bands with {} names", map.bands(), bands.len());
        return Err(ImageError::Size { width, height, pixels: 0, part });
    }
    let (layout, whole) = match map.shape().layout {
        Layout::Cube => ("cube".to_string(), false),
        Layout::LatLong => ("latlong".to_string(), true),
        Layout::SineLatLong => ("sine-latlong".to_string(), true),
        Layout::Fisheye { field } => (format!("fisheye {field}"), false),
    };
    let channel = |name: &str, samples| ex::AnyChannel::new(name, ex::FlatSamples::F32(samples));
    let of_band = |b: usize| picture.texels.iter().map(|t| t.map_or(0.0, |k| map.texel(k)[b])).collect();
    let mut channels: Vec<_> = channel_names(bands).iter().enumerate().map(|(b, n)| channel(n, of_band(b))).collect();
    for (name, values) in more.iter().filter(|(_, v)| v.len() == map.shape().texels()) {
        channels.push(channel(name, picture.texels.iter().map(|t| t.map_or(0.0, |k| values[k])).collect()));
    }
    if !whole {
        let drawn = picture.texels.iter().map(|t| if t.is_some() { 1.0 } else { 0.0 });
        channels.push(channel("A", drawn.collect()));
    }
    let mut attributes = ex::LayerAttributes { comments: Some(comments.into()), ..ex::LayerAttributes::default() };
    let latlong = map.shape().layout == Layout::LatLong;
    attributes.environment_map = latlong.then_some(EnvironmentMap::LatitudeLongitude);
    // One attribute of our own for the layer and one for the picture: a table of two would be written in any order.
    attributes.other.insert(LAYOUT.into(), AttributeValue::Text(layout.as_str().into()));
    let encoding = ex::Encoding {
        compression: ex::Compression::ZIP16,
        blocks: ex::Blocks::ScanLines,
        line_order: ex::LineOrder::Increasing,
    };
    let size = ex::Vec2(width as usize, height as usize);
    let list = ex::AnyChannels::sort(channels.into_iter().collect());
    let mut image = ex::Image::from_layer(ex::Layer::new(size, attributes, encoding, list));
    image.attributes.other.insert(BANDS.into(), AttributeValue::Text(bands.join("\n").as_str().into()));
    let mut bytes = Cursor::new(Vec::new());
    ex::WritableImage::write(&image).non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}
