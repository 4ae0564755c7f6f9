//! World projections and other rasters of radiances as pictures.

use super::{Raster, Shade, to_byte};
use crate::world::{WorldMap, unfolded};
use rayon::prelude::*;
use std::f64::consts::PI;

/// A map as it is laid out, a cube unfolded [G86 fig. 2]: radiances times pi are shaded as radiosities are. What is no
/// part of the layout is transparent.
pub fn paint_world(map: &WorldMap, shade: &dyn Shade) -> Raster {
    let sheet = unfolded(map.shape());
    let pixel = |texel: &Option<usize>| texel.map(|k| map.texel(k));
    paint_pixels(sheet.width, sheet.height, &sheet.texels.iter().map(pixel).collect::<Vec<_>>(), shade)
}

/// A raster of radiances, `bands` a pixel.
pub fn paint_radiances(width: u32, height: u32, bands: usize, values: &[f32], shade: &dyn Shade) -> Raster {
    paint_pixels(width, height, &values.chunks(bands).map(Some).collect::<Vec<_>>(), shade)
}

fn paint_pixels(width: u32, height: u32, pixels: &[Option<&[f32]>], shade: &dyn Shade) -> Raster {
    let colour = |radiance: &Option<&[f32]>| -> [u8; 4] {
        let Some(radiance) = radiance else { return [0; 4] };
        let radiosity: Vec<f64> = radiance.iter().map(|l| PI * f64::from(*l)).collect();
        let [r, g, b] = shade.display(&radiosity).map(|c| to_byte(shade.response(), c));
        [r, g, b, 255]
    };
    let rgba: Vec<[u8; 4]> = pixels.par_iter().map(colour).collect();
    Raster { width, height, rgba: rgba.concat() }
}
